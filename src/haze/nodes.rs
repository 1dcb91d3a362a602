//! Where along a segment the source is evaluated.
//!
//! The segment is divided into panels that hold equal shares of what can be seen of it: of 1 − T at a typical wavelength. In
//! each panel the columns of all constituents are exact, and so is the mean transmittance; only what the light does there is
//! taken at one point, the middle of the share.

use crate::air::{Amounts, Layers, Line, Segment};

/// Most panels of a segment.
pub(crate) const MOST_PANELS: usize = 12;
/// Most pieces of a segment in layers that are told apart when panels are placed.
const MOST_PIECES: usize = 72;

/// A panel.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Panel {
    /// Columns in the panel, m.
    pub columns: Amounts,
    /// Distance from the tangent point where the panel is represented, m.
    pub at: f64,
}

/// Where the optical depth of a segment has got to.
#[derive(Clone, Copy, Default)]
struct Mark {
    distance: f64,
    depth: f32,
}

struct Marks {
    marks: [Mark; MOST_PIECES],
    len: usize,
}

impl Marks {
    /// Optical depths at the ends of the pieces, from the start of the segment.
    fn new(layers: &Layers, segment: &Segment, grey: &Amounts) -> Self {
        let mut out = Self {
            marks: [Mark::default(); MOST_PIECES],
            len: 1,
        };
        out.marks[0].distance = segment.from;
        let (line, from, to) = (segment.line, segment.from, segment.to());
        if from < 0.0 {
            // Inwards: the pieces come from the inside, so they are turned round.
            let mut inner = [(0.0, 0.0f32); MOST_PIECES];
            let mut n = 0;
            layers.pieces(line, from, to.min(0.0), |_, end, column| {
                let slot = n.min(MOST_PIECES / 2 - 1);
                inner[slot] = (-end, inner[slot].1 + grey.dot(&column));
                n += 1;
            });
            let n = n.min(MOST_PIECES / 2);
            for i in (0..n).rev() {
                let end = if i == 0 { to.min(0.0) } else { inner[i - 1].0 };
                out.push(end, inner[i].1);
            }
        }
        if to > 0.0 {
            layers.pieces(line, from.max(0.0), to, |_, end, column| {
                out.push(end, grey.dot(&column));
            });
        }
        out
    }

    fn push(&mut self, distance: f64, depth: f32) {
        let last = self.marks[self.len - 1];
        self.len = (self.len + 1).min(MOST_PIECES);
        self.marks[self.len - 1] = Mark {
            distance,
            depth: last.depth + depth,
        };
    }

    fn depth(&self) -> f32 {
        self.marks[self.len - 1].depth
    }

    /// The distance at an optical depth; `piece` only grows.
    fn distance(&self, depth: f32, piece: &mut usize) -> f64 {
        while *piece + 2 < self.len && self.marks[*piece + 1].depth < depth {
            *piece += 1;
        }
        let (a, b) = (
            self.marks[*piece],
            self.marks[(*piece + 1).min(self.len - 1)],
        );
        let t = (depth - a.depth) / (b.depth - a.depth).max(f32::MIN_POSITIVE);
        a.distance + f64::from(t.clamp(0.0, 1.0)) * (b.distance - a.distance)
    }
}

/// Fills the panels of a segment; returns how many there are.
#[inline]
pub(crate) fn place(
    layers: &Layers,
    segment: &Segment,
    grey: &Amounts,
    panels: &mut [Panel; MOST_PANELS],
) -> usize {
    let marks = Marks::new(layers, segment, grey);
    let total = marks.depth();
    let count = MOST_PANELS;
    let opacity = -(-total).exp_m1();
    let mut piece = 0;
    let mut start = segment.from;
    for (i, panel) in panels[..count].iter_mut().enumerate() {
        let mut distance = |share: f32| {
            let depth = -(-share * opacity).ln_1p();
            marks.distance(depth.min(total), &mut piece)
        };
        let at = distance((i as f32 + 0.5) / count as f32);
        let end = match i + 1 == count {
            true => segment.to(),
            false => distance((i as f32 + 1.0) / count as f32),
        };
        let end = end.max(start);
        *panel = Panel {
            columns: layers.columns(segment.line, start, end),
            at: at.clamp(start, end),
        };
        start = end;
    }
    count
}

/// A point on a line at a distance from its tangent point: altitude (m) and cosine of the local zenith angle of the line.
#[inline(always)]
pub(crate) fn point(layers: &Layers, line: Line, s: f64) -> (f64, f64) {
    let radius = layers.planet().radius;
    let w = line.lowest + s * s / (2.0 * radius);
    let h = 2.0 * w / (1.0 + (1.0 + 2.0 * w / radius).max(0.0).sqrt());
    (h, (s / (radius + h)).clamp(-1.0, 1.0))
}

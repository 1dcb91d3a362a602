//! Where along a segment the source is evaluated.
//!
//! The segment is divided into panels that hold equal shares of what can be seen of it: of 1 − T at a typical wavelength. In
//! each panel the columns of all constituents are exact, and so is the mean transmittance; only what the light does there is
//! taken at one point, the middle of the share.

use crate::air::{Amounts, Layers, Line, Segment};
use crate::math::{LANES, log2, one_minus_exp_neg};

/// Most panels of a segment.
pub(crate) const MOST_PANELS: usize = 9;
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
    fn new(layers: &Layers, segment: &Segment, grey: &Amounts, sky: &Heaven) -> Self {
        let seen = |a: f64, b: f64, column: &Amounts| {
            grey.dot(column) * sky.light(layers, segment, 0.5 * (a + b))
        };
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
            layers.pieces(line, from, to.min(0.0), |start, end, column| {
                let slot = n.min(MOST_PIECES / 2 - 1);
                inner[slot] = (-end, inner[slot].1 + seen(-start, -end, &column));
                n += 1;
            });
            let n = n.min(MOST_PIECES / 2);
            for i in (0..n).rev() {
                let end = if i == 0 { to.min(0.0) } else { inner[i - 1].0 };
                out.push(end, inner[i].1);
            }
        }
        if to > 0.0 {
            layers.pieces(line, from.max(0.0), to, |start, end, column| {
                out.push(end, seen(start, end, &column));
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

/// The panels of a segment.
pub(crate) struct Panels {
    panels: [Panel; MOST_PANELS],
    count: usize,
}

impl Panels {
    #[inline]
    pub fn place(layers: &Layers, segment: &Segment, grey: &Amounts, sky: &Heaven) -> Self {
        let mut out = Self {
            panels: [Panel::default(); MOST_PANELS],
            count: count(layers, segment, sky),
        };
        if out.count == 1 {
            out.panels[0] = Panel {
                columns: layers.columns(segment.line, segment.from, segment.to()),
                at: segment.from + 0.5 * segment.length,
            };
            return out;
        }
        let marks = Marks::new(layers, segment, grey, sky);
        let total = marks.depth();
        let opacity = one_minus_exp_neg(total);
        let shares = 2 * out.count;
        let (mut piece, mut start) = (0, segment.from);
        let mut distance = |share: usize| {
            let rest = (1.0 - share as f32 / shares as f32 * opacity).max(f32::MIN_POSITIVE);
            let depth = -core::f32::consts::LN_2 * log2(rest);
            marks.distance(depth.min(total), &mut piece)
        };
        let last = out.count - 1;
        for (i, panel) in out.panels[..out.count].iter_mut().enumerate() {
            let at = distance(2 * i + 1);
            let end = if i == last {
                segment.to()
            } else {
                distance(2 * i + 2)
            };
            let end = end.max(start);
            *panel = Panel {
                columns: layers.columns(segment.line, start, end),
                at: at.clamp(start, end),
            };
            start = end;
        }
        out
    }

    pub fn as_slice(&self) -> &[Panel] {
        &self.panels[..self.count]
    }
}

/// How many panels a segment needs: an odd number. Light changes with altitude above all; near the shadow of the planet
/// it changes along level lines, too.
fn count(layers: &Layers, segment: &Segment, sky: &Heaven) -> usize {
    let diameter = 2.0 * layers.planet().radius;
    let squared = |s: f64| s * s / diameter;
    let rise = (squared(segment.from) - squared(segment.to())).abs();
    let [step, stride] = if sky.low { [300.0, 4e3] } else { [1000.0, 3e4] };
    match rise / step + segment.length / stride {
        change if change < 0.25 => 1,
        change if change < 2.0 => 3,
        change if change < 5.0 => 5,
        change if change < 10.0 => 7,
        _ => MOST_PANELS,
    }
}

/// The sun as far as panels care.
pub(crate) struct Heaven {
    /// Towards the sun.
    pub sun: [f64; 3],
    /// Whether it may be in shadow somewhere.
    pub low: bool,
}

impl Heaven {
    /// How much light is where a line is at `s`: roughly, between the glow of a dark sky and the light of day.
    #[inline]
    fn light(&self, layers: &Layers, segment: &Segment, s: f64) -> f32 {
        const GLOW: f64 = 0.03;
        const CLEAR: f64 = 20_000.0;
        if !self.low {
            return 1.0;
        }
        let radius = layers.planet().radius;
        let (h, _) = point(layers, segment.line, s);
        let sine = segment.sine_of(self.sun, s, radius + h);
        // How high above the ground the sunlight of this point passes.
        let clearance = match sine < 0.0 {
            true => h - (radius + h) * (1.0 - (1.0 - sine * sine).sqrt()),
            false => h + 10.0 * CLEAR * sine,
        };
        (GLOW + (clearance / CLEAR).clamp(0.0, 1.0)) as f32
    }
}

/// The panels at which the diffuse source is looked up; between them it is interpolated.
pub(crate) struct Stations {
    count: usize,
}

impl Stations {
    pub fn along(panels: usize) -> Self {
        Self { count: panels }
    }

    /// The first panel, or the first, the middle and the last one.
    pub fn panels(&self) -> impl Iterator<Item = usize> + use<> {
        let last = self.count - 1;
        let all = [0, last / 2, last];
        let used = if last == 0 { 1 } else { 3 };
        all.into_iter().take(used)
    }

    /// The source in panel `i`.
    #[inline(always)]
    pub fn between(&self, at: &[[[f32; LANES]; 2]; 3], i: usize) -> [[f32; LANES]; 2] {
        if self.count == 1 {
            return at[0];
        }
        let t = i as f32 / (self.count - 1) as f32;
        let weight = [
            (1.0 - t) * (1.0 - 2.0 * t),
            4.0 * t * (1.0 - t),
            t * (2.0 * t - 1.0),
        ];
        let mut out = [[0.0; LANES]; 2];
        for (class, out) in out.iter_mut().enumerate() {
            for i in 0..LANES {
                let value = weight[0] * at[0][class][i]
                    + weight[1] * at[1][class][i]
                    + weight[2] * at[2][class][i];
                out[i] = value.max(0.0);
            }
        }
        out
    }
}

/// A point on a line at a distance from its tangent point: altitude (m) and cosine of the local zenith angle of the line.
#[inline(always)]
pub(crate) fn point(layers: &Layers, line: Line, s: f64) -> (f64, f64) {
    let radius = layers.planet().radius;
    let w = line.lowest + s * s / (2.0 * radius);
    let h = 2.0 * w / (1.0 + (1.0 + 2.0 * w / radius).max(0.0).sqrt());
    (h, (s / (radius + h)).clamp(-1.0, 1.0))
}

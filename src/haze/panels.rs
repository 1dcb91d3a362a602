//! Where along a segment light is evaluated.
//!
//! The variable of integration is what can be seen of the segment: 1 − T at a typical wavelength, weighted by the light that
//! is roughly there. Panels hold equal shares of it. Their columns are exact; sunlight is known at their ends, and the diffuse source
//! at a few stations.

use super::marks::{Heaven, Marks};
use super::stations::Stations;
use crate::air::{Amounts, Layers, Segment};

/// Most panels of a segment; even.
pub(crate) const MOST_PANELS: usize = 12;

/// The panels of a segment.
pub(crate) struct Panels {
    pub count: usize,
    /// Distances of the ends from the tangent point, m.
    pub ends: [f64; MOST_PANELS + 1],
    /// Columns in each panel, m.
    pub columns: [Amounts; MOST_PANELS],
    pub stations: Stations,
}

impl Panels {
    #[inline(always)]
    pub fn place(layers: &Layers, segment: &Segment, grey: &[[f32; 3]], sky: &Heaven) -> Self {
        let count = count(layers, segment, sky);
        let (line, from, to) = (segment.line, segment.from, segment.to());
        let mut out = Self {
            count,
            ends: [to; MOST_PANELS + 1],
            columns: [Amounts::default(); MOST_PANELS],
            stations: Stations::of(count),
        };
        out.ends[0] = from;
        if count == 1 {
            out.columns[0] = layers.columns(line, from, to);
            out.stations.at[0] = from + 0.5 * segment.length;
            return out;
        }
        let marks = Marks::new(layers, segment, grey, sky);
        let mut piece = 1;
        for (at, share) in out.stations.at.iter_mut().zip(out.stations.shares) {
            *at = marks.distance(*share, &mut piece);
        }
        let mut piece = 1;
        for i in 0..count {
            let start = out.ends[i];
            if i + 1 < count {
                let share = (i + 1) as f32 / count as f32;
                out.ends[i + 1] = marks.distance(share, &mut piece).clamp(start, to);
            }
            out.columns[i] = layers.columns(line, start, out.ends[i + 1]);
        }
        out
    }
}

/// How many panels a segment needs. Light changes with altitude above all; near the shadow of the planet it changes
/// along level lines, too.
fn count(layers: &Layers, segment: &Segment, sky: &Heaven) -> usize {
    let diameter = 2.0 * layers.planet().radius;
    let squared = |s: f64| s * s / diameter;
    let rise = (squared(segment.from) - squared(segment.to())).abs();
    let [step, stride] = if sky.low { LOW } else { HIGH };
    match rise / step + segment.length / stride {
        change if change < 0.25 => 1,
        change if change < 2.0 => 2,
        change if change < 5.0 || (change < 10.0 && !sky.low) => 4,
        change if change < 10.0 => 6,
        change if change < 30.0 => 8,
        _ => MOST_PANELS,
    }
}

/// Rise and length (m) over which light changes much: where the sun is low, and elsewhere.
const LOW: [f64; 2] = [300.0, 4e3];
const HIGH: [f64; 2] = [2500.0, 7.5e4];

//! Where along a segment light is evaluated.
//!
//! The variable of integration is what can be seen of the segment: 1 − T at a typical wavelength, weighted by the light
//! that is roughly there. Panels hold equal shares of it. Their columns are exact; sunlight is known at their ends, and
//! the diffuse source at a few stations.

use super::light_estimate::{CumulativeLight, SunEstimate};
use super::quadrature_limits::{MOST_PANELS, MOST_PATH_POINTS};
use super::source_nodes::SourceNodes;
use super::sun_transmittance::Two;
use crate::kernel::lanes::Lanes;
use crate::transmittance::{Amounts, Layers, Line, QUADS, Segment};

/// The panels of a segment.
pub(crate) struct Panels {
    pub count: usize,
    /// Distances from the tangent point, m: of the ends, then of the stations, then that of the last end.
    pub places: [f64; MOST_PATH_POINTS],
    /// Columns in each panel, m; two panels at a time.
    pub columns: [Two; MOST_PANELS / 2],
    pub stations: &'static SourceNodes,
}

impl Panels {
    #[inline(always)]
    pub fn place(layers: &Layers, segment: &Segment, grey: &[[f32; 3]], sky: &SunEstimate) -> Self {
        let (from, to) = (segment.from, segment.to());
        let count = count(layers, [from, to], sky);
        let mut out = Self::empty(count, [from, to]);
        let stations = out.stations;
        if count == 1 {
            out.places[2] = from + 0.5 * segment.length;
        } else {
            let mut shares = [1.0; MOST_PATH_POINTS];
            for (i, share) in shares[..count].iter_mut().enumerate() {
                *share = i as f32 / count as f32;
            }
            let stations = stations.shares;
            shares[count + 1..][..stations.len()].copy_from_slice(stations);
            let places = count + 1 + stations.len();
            let mut marks = CumulativeLight::default();
            marks.fill(layers, segment, grey, sky);
            marks.distances(&shares[..places], &mut out.places);
            out.places[0] = from;
            out.places[count] = to;
        }
        out.fill(layers, segment.line);
        out
    }

    /// Between given distances from the tangent point (m), of which there are at most [`MOST_PANELS`] after the first.
    #[inline(always)]
    pub fn between(layers: &Layers, line: Line, ends: &[f64]) -> Self {
        let last = ends.len() - 1;
        // Panels come in twos; the last may have no length.
        let count = if last > 1 {
            last.next_multiple_of(2)
        } else {
            1
        };
        let mut out = Self::empty(count, [ends[0], ends[last]]);
        out.places[..=last].copy_from_slice(ends);
        for (i, share) in out.stations.shares.iter().enumerate() {
            let place = f64::from(*share) * count as f64;
            let panel = (place as usize).min(count - 1);
            let (start, end) = (out.places[panel], out.places[panel + 1]);
            out.places[count + 1 + i] = start + (place - panel as f64) * (end - start);
        }
        out.fill(layers, line);
        out
    }

    #[inline(always)]
    fn empty(count: usize, [from, to]: [f64; 2]) -> Self {
        let mut places = [to; MOST_PATH_POINTS];
        places[0] = from;
        Self {
            count,
            places,
            columns: [[Lanes::splat(0.0); QUADS]; MOST_PANELS / 2],
            stations: SourceNodes::of(count),
        }
    }

    /// Columns between the places.
    #[inline(always)]
    fn fill(&mut self, layers: &Layers, line: Line) {
        let mut walker = layers.enter(line, self.places[0]);
        let mut columns = Amounts::default();
        for i in 0..self.count {
            walker.columns(self.places[i + 1], &mut columns);
            let quads = columns.0.iter().take(layers.quads);
            for (two, quad) in self.columns[i / 2].iter_mut().zip(quads) {
                two.0[4 * (i % 2)..][..4].copy_from_slice(quad);
            }
        }
    }
}

/// How many panels a segment needs, between two distances from the tangent point. Light changes with altitude above all; near the shadow of the planet it changes
/// along level lines, too.
#[inline(always)]
pub(super) fn count(layers: &Layers, [from, to]: [f64; 2], sky: &SunEstimate) -> usize {
    let diameter = 2.0 * layers.planet().radius;
    let squared = |s: f64| s * s / diameter;
    let rise = (squared(from) - squared(to)).abs();
    let [step, stride] = if sky.low { LOW } else { HIGH };
    match rise / step + (to - from) / stride {
        change if change < 0.12 => 1,
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

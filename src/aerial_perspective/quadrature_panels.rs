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
use crate::transmittance::{Amounts, Layers, QUADS, Segment};

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
        let count = count(layers, segment, sky);
        let stations = SourceNodes::of(count);
        let (from, to) = (segment.from, segment.to());
        let mut out = Self {
            count,
            places: [to; MOST_PATH_POINTS],
            columns: [[Lanes::splat(0.0); QUADS]; MOST_PANELS / 2],
            stations,
        };
        out.places[0] = from;
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
        let mut walker = layers.enter(segment.line, from);
        let mut columns = Amounts::default();
        for i in 0..count {
            walker.columns(out.places[i + 1], &mut columns);
            let quads = columns.0.iter().take(layers.quads);
            for (two, quad) in out.columns[i / 2].iter_mut().zip(quads) {
                two.0[4 * (i % 2)..][..4].copy_from_slice(quad);
            }
        }
        out
    }
}

/// How many panels a segment needs. Light changes with altitude above all; near the shadow of the planet it changes
/// along level lines, too.
fn count(layers: &Layers, segment: &Segment, sky: &SunEstimate) -> usize {
    let diameter = 2.0 * layers.planet().radius;
    let squared = |s: f64| s * s / diameter;
    let rise = (squared(segment.from) - squared(segment.to())).abs();
    let [step, stride] = if sky.low { LOW } else { HIGH };
    match rise / step + segment.length / stride {
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

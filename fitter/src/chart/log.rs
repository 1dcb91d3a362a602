//! The log domain: ln of the radiance relative to the diffuse estimate, over a black and over a white ground as sums of components. Any albedo
//! follows from the two; positive everywhere, and small values are fitted as well as large ones. Phase functions cannot
//! be taken out.

use super::chunk_axes::{Frame, Place};
use crate::dataset::Axis;
use crate::decompose::{Chunk, Dense, Options, Tucker, decompose, row_major, splines};
use crate::successive_orders::NW;
use welkin::axis::Taps;

const CHANNELS: usize = 2 * NW;
/// Below this share of the diffuse estimate a value is raised to it: logarithms have no bottom.
const FLOOR: f32 = 1e-6;

/// Factors of one chunk, of its own.
pub struct Logarithmic {
    rank: usize,
    /// Spline coefficients, `[view][rank]`, `[phi][rank]`, `[elevation][rank]`.
    modes: [Vec<f32>; 3],
    /// `[channel][rank]`.
    channel: Vec<f32>,
    /// A / (1 − A s) at albedo 1.
    white: [f32; NW],
}

impl Logarithmic {
    /// Decomposes the logarithm of `chunk`.
    pub fn new(chunk: &Chunk, frame: &Frame, options: Options) -> Self {
        let sites = chunk.sites.iter().product::<usize>();
        let value = |site: usize, c: usize| {
            let albedo = (c / NW) as f32;
            let relative = 1.0 / chunk.diffuse_share(site, c % NW, albedo);
            f64::from(relative.max(FLOOR)).ln()
        };
        let cells = (0..sites).flat_map(|site| (0..CHANNELS).map(move |c| (site, c)));
        let [views, phis, elevations] = chunk.sites;
        let mut tucker = Tucker::new(Dense {
            shape: [views, phis, elevations, CHANNELS],
            values: cells.map(|(site, c)| value(site, c)).collect(),
        });
        (0..4).for_each(|mode| tucker.compress(mode, 1e-9));
        let cpd = decompose(
            std::slice::from_ref(&tucker.core),
            [false; 4],
            options,
            &|_, _| (),
        );
        let sites = |m: usize| row_major(&(&tucker.bases[m] * &cpd.factors.0[0][m]));
        let [up, down, phi, elevation] = frame.axes();
        let rank = options.rank;
        let coefficients = |axis: Axis, sites: &[f32]| row_major(&splines(axis, sites, rank));
        let view = sites(0);
        let (above, below) = view.split_at(up.len() * rank);
        Self {
            rank,
            modes: [
                [coefficients(up, above), coefficients(down, below)].concat(),
                coefficients(phi, &sites(1)),
                coefficients(elevation, &sites(2)),
            ],
            channel: sites(3),
            white: std::array::from_fn(|w| chunk.interreflection(w, 1.0)),
        }
    }

    /// Bytes in half precision, with a weight of single precision per component.
    pub fn bytes(&self) -> usize {
        let values = self.modes.iter().map(Vec::len).sum::<usize>() + self.channel.len();
        2 * values + 4 * self.rank
    }

    /// Radiance relative to the diffuse estimate, given A / (1 − A s).
    pub fn radiance(&self, place: &Place, ground: &[f32; NW]) -> [f32; NW] {
        let taps: [&Taps; 3] = [&place.view, &place.phi, &place.elevation];
        let mut z = vec![1.0f32; self.rank];
        for (taps, mode) in taps.into_iter().zip(&self.modes) {
            super::cost::multiply(taps, mode, self.rank, &mut z);
        }
        let value = |c: usize| -> f32 {
            let row = &self.channel[c * self.rank..][..self.rank];
            super::cost::dot(row, &z).exp()
        };
        std::array::from_fn(|w| {
            let (black, white) = (value(w), value(NW + w));
            black + ground[w] / self.white[w] * (white - black)
        })
    }
}

//! What one query costs: radiance at all wavelengths in a random direction under a random sun and albedo, at one
//! altitude and visibility. Plain loops for every scheme; finding angles and taps is not counted, nor are exponentials
//! of the normalisation.

use super::chunk_axes::Place;
use crate::successive_orders::{FIELDS, NW};
use std::hint::black_box;
use std::time::Instant;
use welkin::axis::Taps;

/// Rounds, of which the fastest counts.
const ROUNDS: usize = 15;

/// Nanoseconds per query, the least of several rounds.
pub fn nanoseconds<Q>(queries: &[Q], mut run: impl FnMut(&Q) -> [f32; NW]) -> f64 {
    let mut round = || {
        let start = Instant::now();
        for query in queries {
            black_box(run(query));
        }
        start.elapsed().as_secs_f64() * 1e9 / queries.len() as f64
    };
    (0..ROUNDS).map(|_| round()).fold(f64::INFINITY, f64::min)
}

/// Factor matrices of a chunk in single precision, as spline coefficients.
pub struct Components {
    /// Number of components.
    pub rank: usize,
    /// `[view][rank]`, `[phi][rank]`, `[elevation][rank]`.
    pub modes: [Vec<f32>; 3],
    /// `[field][wavelength][rank]`.
    pub channel: Vec<f32>,
}

impl Components {
    /// The normalised radiance: four taps in three modes, then all channels.
    pub fn radiance(&self, place: &Place, share: &[[f32; NW]; FIELDS]) -> [f32; NW] {
        let taps: [&Taps; 3] = [&place.view, &place.phi, &place.elevation];
        let mut z = [1.0f32; 512];
        let z = &mut z[..self.rank];
        for (taps, mode) in taps.into_iter().zip(&self.modes) {
            multiply(taps, mode, self.rank, z);
        }
        let mut out = [0.0; NW];
        for (f, share) in share.iter().enumerate() {
            for w in 0..NW {
                let row = &self.channel[(f * NW + w) * self.rank..][..self.rank];
                out[w] += share[w] * dot(row, z);
            }
        }
        out
    }
}

/// Multiplies `z` by a factor matrix at the taps.
pub fn multiply(taps: &Taps, mode: &[f32], rank: usize, z: &mut [f32]) {
    let row = |k: usize| &mode[taps.index[k] * rank..][..rank];
    let (a, b, c, d) = (row(0), row(1), row(2), row(3));
    let [wa, wb, wc, wd] = taps.weight;
    for (r, z) in z.iter_mut().enumerate() {
        *z *= wa * a[r] + wb * b[r] + wc * c[r] + wd * d[r];
    }
}

/// Eight partial sums, which compilers turn into vector instructions; lengths are multiples of eight.
pub fn dot(a: &[f32], b: &[f32]) -> f32 {
    let mut lanes = [0.0; 8];
    for (a, b) in a.as_chunks::<8>().0.iter().zip(b.as_chunks::<8>().0) {
        (0..8).for_each(|i| lanes[i] += a[i] * b[i]);
    }
    lanes.iter().sum()
}

//! Refinement of coupled factors in the measure that counts: relative radiance.
//!
//! The decomposition treats the fields one by one and all sites alike. Here each factor matrix in turn is moved, by
//! linear least squares on a random selection of sites, to where the *sum* of the fields times their phase functions is
//! right relative to the traced radiance. Steps are damped towards the present factors, so that the fields stay what
//! they stand for.

mod equation;
mod normal;
mod own;
mod shared;

use super::chunk::Chunk;
use crate::successive_orders::{FIELDS, NW};
use equation::{ALBEDOS, Equation};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;

/// Factor matrices at the sites of one chunk, row-major with the rank contiguous.
#[derive(Clone)]
pub struct Own {
    /// `[view][rank]`.
    pub view: Vec<f32>,
    /// `[elevation][rank]`.
    pub elevation: Vec<f32>,
}

/// Factor matrices that all chunks share.
#[derive(Clone)]
pub struct Basis {
    /// Number of components.
    pub rank: usize,
    /// `[phi][rank]`.
    pub phi: Vec<f32>,
    /// `[field][wavelength][rank]`.
    pub channel: Vec<f32>,
}

/// One pass over all factor matrices. `seed` selects the sites.
pub fn sweep(chunks: &[Chunk], own: &mut [Own], basis: &mut Basis, seed: u64, shared: bool) {
    if shared {
        shared::channels(chunks, own, basis, seed);
        shared::azimuths(chunks, own, basis, seed);
    }
    own.par_iter_mut().zip(chunks).for_each(|(own, chunk)| {
        own::elevations(chunk, own, basis, seed);
        own::views(chunk, own, basis, seed);
    });
}

fn row(matrix: &[f32], i: usize, rank: usize) -> &[f32] {
    &matrix[i * rank..][..rank]
}

fn add(matrix: &mut [f32], i: usize, rank: usize, step: &[f32]) {
    for (x, s) in matrix[i * rank..][..rank].iter_mut().zip(step) {
        *x += s;
    }
}

fn random(seed: u64, chunk: &Chunk, what: u64) -> Pcg64Mcg {
    Pcg64Mcg::seed_from_u64(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ chunk.seed() ^ what << 48)
}

/// Radiance relative to the traced one at random sites (albedo 0.3), unweighted.
pub fn relative_radiance(chunk: &Chunk, own: &Own, basis: &Basis, count: usize) -> Vec<f32> {
    let rank = basis.rank;
    let [views, phis, elevations] = chunk.sites;
    let mut rng = random(0, chunk, 99);
    let mut mixed = vec![0.0; rank];
    (0..count)
        .map(|_| {
            let draw = rng.next_u64() as usize;
            let (v, p, e) = (draw % views, (draw >> 16) % phis, (draw >> 32) % elevations);
            let w = (draw >> 50) % NW;
            let equation = Equation::radiance(chunk, chunk.site(v, p, e), w, ALBEDOS[1]);
            equation.mix(basis, &mut mixed);
            let (view, elevation) = (row(&own.view, v, rank), row(&own.elevation, e, rank));
            let phi = row(&basis.phi, p, rank);
            (0..rank)
                .map(|r| mixed[r] * view[r] * elevation[r] * phi[r])
                .sum()
        })
        .collect()
}

/// What the factors leave of a chunk.
pub fn residual(chunk: &Chunk, own: &Own, basis: &Basis) -> Chunk {
    let rank = basis.rank;
    let [_, phis, elevations] = chunk.sites;
    let mut z = vec![0.0; rank];
    let mut values = chunk.values().to_vec();
    for (site, cell) in values.chunks_exact_mut(FIELDS * NW).enumerate() {
        let view = row(&own.view, site / (phis * elevations), rank);
        let phi = row(&basis.phi, site / elevations % phis, rank);
        let elevation = row(&own.elevation, site % elevations, rank);
        for r in 0..rank {
            z[r] = view[r] * phi[r] * elevation[r];
        }
        for (c, value) in cell.iter_mut().enumerate() {
            let channel = row(&basis.channel, c, rank);
            *value -= channel.iter().zip(&z).map(|(c, z)| c * z).sum::<f32>();
        }
    }
    chunk.with_values(values)
}

//! Refinement of coupled factors in the measure that counts: relative radiance.
//!
//! The decomposition treats the fields one by one and all sites alike. Here each factor matrix in turn is moved, by
//! linear least squares on a random selection of sites, to where the *sum* of the fields times their phase functions is
//! right relative to the traced radiance. Steps are damped towards the present factors, so that the fields stay what
//! they stand for.

mod equation;
mod factors;
mod normal;
mod own;
mod shared;

use super::chunk::Chunk;
use crate::successive_orders::{FIELDS, NW};
use equation::{ALBEDOS, Equation};
pub use factors::{Basis, Own, Pass};
use factors::{random, row};
pub(crate) use normal::Normal;
use rand_pcg::rand_core::Rng;
use rayon::prelude::*;

/// One pass over all factor matrices for some nodes.
pub fn sweep(chunks: &[Chunk], nodes: &[usize], own: &mut [Own], basis: &mut Basis, pass: Pass) {
    if pass.shared {
        shared::channels(chunks, nodes, own, basis, pass);
        shared::azimuths(chunks, nodes, own, basis, pass);
    }
    own.par_iter_mut().zip(chunks).for_each(|(own, chunk)| {
        own::elevations(chunk, nodes, own, basis, pass);
        own::views(chunk, nodes, own, basis, pass);
    });
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

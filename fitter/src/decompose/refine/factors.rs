//! The factor matrices that are refined, and steps of them.

use crate::decompose::chunk::Chunk;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::SeedableRng;

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

pub(super) fn row(matrix: &[f32], i: usize, rank: usize) -> &[f32] {
    &matrix[i * rank..][..rank]
}

pub(super) fn add(matrix: &mut [f32], i: usize, rank: usize, step: &[f32]) {
    for (x, s) in matrix[i * rank..][..rank].iter_mut().zip(step) {
        *x += s;
    }
}

pub(super) fn random(seed: u64, chunk: &Chunk, what: u64) -> Pcg64Mcg {
    Pcg64Mcg::seed_from_u64(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ chunk.seed() ^ what << 48)
}

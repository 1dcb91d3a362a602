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

/// What one pass over the matrices does.
#[derive(Clone, Copy, Debug)]
pub struct Pass {
    /// Selects the sites.
    pub seed: u64,
    /// Share of each step that is taken.
    pub step: f32,
    /// Whether the shared matrices move, too.
    pub shared: bool,
}

impl Pass {
    /// Pass `index` of `count`. Each sees another random part of the equations, so that whole steps never settle: after a
    /// third of the passes they become shorter, which averages over what the passes see. The shared matrices settle
    /// first; then the chunks adapt to them.
    pub fn new(index: usize, count: usize) -> Self {
        let whole = count as f32 / 3.0;
        Self {
            seed: 1 + index as u64,
            step: (whole / (index as f32 + 1.0)).min(1.0),
            shared: index + 2 < count,
        }
    }
}

pub(super) fn row(matrix: &[f32], i: usize, rank: usize) -> &[f32] {
    &matrix[i * rank..][..rank]
}

/// Moves a row by a share of a step.
pub(super) fn add(matrix: &mut [f32], i: usize, rank: usize, step: &[f32], share: f32) {
    for (x, s) in matrix[i * rank..][..rank].iter_mut().zip(step) {
        *x += share * s;
    }
}

pub(super) fn random(seed: u64, chunk: &Chunk, what: u64) -> Pcg64Mcg {
    Pcg64Mcg::seed_from_u64(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ chunk.seed() ^ what << 48)
}

//! Random numbers: one counter-seeded stream per batch, and a shifted lattice for the first dimensions of each walk.

use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// Dimensions that [`Lattice`] covers.
pub const LATTICE_DIMENSIONS: usize = 6;

/// The stream of one (seed, query, batch).
pub struct Stream(Pcg64Mcg);

impl Stream {
    /// The stream that belongs to these counters, wherever and whenever it is run.
    pub fn new(seed: u64, query: u64, batch: u64) -> Self {
        let hash = mix(mix(mix(seed) ^ query) ^ batch);
        let high = mix(hash ^ 0x9e37_79b9_7f4a_7c15);
        let state = (u128::from(high) << 64) | u128::from(hash);
        Self(Pcg64Mcg::from_seed((state | 1).to_le_bytes()))
    }

    /// Uniform in [0, 1).
    pub fn uniform(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }
}

/// The finaliser of splitmix64.
fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// A Kronecker sequence with the generalised golden ratios, shifted at random: every point is uniform, so every batch
/// is unbiased, and the points of a batch fill the cube evenly.
pub struct Lattice {
    shift: [f64; LATTICE_DIMENSIONS],
    step: [f64; LATTICE_DIMENSIONS],
}

impl Lattice {
    /// A lattice with a random shift.
    pub fn new(stream: &mut Stream) -> Self {
        // The root of x^(d+1) = x + 1.
        let d = LATTICE_DIMENSIONS as f64;
        let ratio = (0..64).fold(2.0_f64, |x, _| (1.0 + x).powf(1.0 / (d + 1.0)));
        Self {
            shift: std::array::from_fn(|_| stream.uniform()),
            step: std::array::from_fn(|i| ratio.powi(-(i as i32) - 1)),
        }
    }

    /// Point `i`.
    pub fn point(&self, i: usize) -> [f64; LATTICE_DIMENSIONS] {
        std::array::from_fn(|d| (self.shift[d] + self.step[d] * i as f64).fract())
    }
}

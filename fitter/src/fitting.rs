//! How traced tensors are fitted.

use crate::decompose::Options;

/// How the traced tensors are fitted.
#[derive(Clone, Copy, Debug)]
pub struct Fitting {
    /// Components, sweeps, seed of the decomposition.
    pub options: Options,
    /// Passes of the refinement.
    pub refinements: usize,
    /// The same for the polarisation; without components there is none.
    pub polarisation: Options,
}

impl Default for Fitting {
    fn default() -> Self {
        Self {
            options: Options {
                rank: 160,
                sweeps: 150,
                seed: 1,
            },
            refinements: 12,
            polarisation: Options {
                rank: 48,
                sweeps: 400,
                seed: 1,
            },
        }
    }
}

//! How traced tensors are fitted.

use crate::dataset::Grid;
use crate::decompose::Options;

/// Changes whenever what is fitted or how it is does.
const VERSION: u32 = 6;

/// Name of the unit that holds the fit of some nodes.
pub(crate) fn unit_name(
    what: &str,
    grid: &Grid,
    nodes: &[usize],
    options: Options,
    refinements: usize,
) -> String {
    let places = (&grid.altitudes, &grid.visibilities);
    let settings = format!("{VERSION} {options:?} {refinements} {places:?} {nodes:?}");
    let key = crc32fast::hash(settings.as_bytes());
    format!("{what}-{}-{key:08x}", options.rank)
}

/// How the traced tensors are fitted.
#[derive(Clone, Copy, Debug)]
pub struct Fitting {
    /// Components, sweeps, seed of the decomposition.
    pub options: Options,
    /// Passes of the refinement.
    pub refinements: usize,
    /// The same for the polarisation; without components there is none.
    pub polarisation: Options,
    /// Components more for nodes that gases absorb strongly, per component of the others.
    pub strong: f64,
}

impl Fitting {
    /// For nodes that gases absorb strongly.
    pub fn strong(&self) -> Options {
        self.share(self.options)
    }

    /// The same for the polarisation.
    pub fn strong_polarisation(&self) -> Options {
        self.share(self.polarisation)
    }

    fn share(&self, options: Options) -> Options {
        let rank = (self.strong * options.rank as f64).ceil() as usize;
        Options { rank, ..options }
    }
}

impl Default for Fitting {
    fn default() -> Self {
        Self {
            options: Options {
                rank: 128,
                sweeps: 100,
                seed: 1,
            },
            refinements: 36,
            polarisation: Options {
                rank: 48,
                sweeps: 400,
                seed: 1,
            },
            strong: 0.25,
        }
    }
}

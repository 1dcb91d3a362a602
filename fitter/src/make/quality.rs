//! How good a model is, and what that costs.

use super::judge::Extent;
use crate::air::Air;
use crate::dataset::Grid;
use crate::decompose::Options;
use crate::fitting::Fitting;
use crate::spectrum::training::Training;
use crate::successive_orders::Settings;
use crate::units::{Between, HeldOut, Plan};

/// Presets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// The light is solved coarsely and fitted loosely: to see what a recipe looks like.
    Draft,
    /// Traced and fitted as finely as the default model; what lies between the nodes of the wavelengths is taken from
    /// it.
    #[default]
    Good,
    /// What lies between them is learned from spectra in the same air.
    Best,
}

impl Quality {
    /// The plan and the fit of a model of `air`, made of recipes.
    pub fn plan(self, air: Air) -> (Plan, Fitting) {
        let visibilities = air.visibilities();
        let (mut plan, fitting) = match self {
            Self::Draft => (coarse(), draft()),
            Self::Good | Self::Best => (Plan::default(), good()),
        };
        plan.between = match self {
            Self::Best => Between::Learned(Training {
                visibilities: visibilities.clone(),
                ..Training::default()
            }),
            _ => Between::Default,
        };
        plan.grid.visibilities = visibilities;
        plan.air = air;
        (plan, fitting)
    }

    /// Core-seconds that a model takes, measured with the desert's.
    pub fn core_seconds(self, plan: &Plan, fitting: Fitting) -> f64 {
        let Grid {
            altitudes,
            visibilities,
            ..
        } = &plan.grid;
        let chunks = (altitudes.len() * visibilities.len()) as f64;
        let suns = plan.grid.elevation_sites().len() as f64 / 54.0;
        let [light, tensor, learned] = match self {
            Self::Draft => [35.0, 4.0, 0.0],
            Self::Good => [380.0, 6.0, 0.0],
            Self::Best => [380.0, 6.0, 800.0],
        };
        let rank = fitting.options.rank as f64 / 128.0;
        let fit =
            0.3 * suns * rank.powi(2) * (fitting.refinements + fitting.options.sweeps / 5) as f64;
        visibilities.len() as f64 * (light + learned)
            + chunks * (tensor * suns + fit)
            + 6e-4 * (self.judged().lines * self.judged().walks) as f64
    }

    /// What the model is judged by.
    pub fn judged(self) -> Extent {
        let [lines, walks] = match self {
            Self::Draft => [24, 1_000],
            Self::Good => [48, 2_500],
            Self::Best => [300, 8_000],
        };
        Extent { lines, walks }
    }
}

fn coarse() -> Plan {
    Plan {
        settings: Settings::COARSE,
        held_out: HeldOut {
            views: 48,
            suns: 12,
        },
        ..Plan::default()
    }
}

fn good() -> Fitting {
    fitted([64, 60, 24], [32, 150])
}

fn draft() -> Fitting {
    fitted([48, 40, 10], [24, 100])
}

/// Components, sweeps and refinements of the radiance, components and sweeps of the polarisation.
fn fitted([rank, sweeps, refinements]: [usize; 3], polarised: [usize; 2]) -> Fitting {
    let seed = 1;
    let [polarised_rank, polarised_sweeps] = polarised;
    Fitting {
        options: Options { rank, sweeps, seed },
        refinements,
        polarisation: Options {
            rank: polarised_rank,
            sweeps: polarised_sweeps,
            seed,
        },
        ..Fitting::default()
    }
}

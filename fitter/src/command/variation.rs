//! Options of commands that may change the air.

use clap::{Args as ClapArgs, ValueEnum};
use welkin_fitter::atmosphere::{AerosolProfile, Variation};

/// Departures from the air of the model.
#[derive(ClapArgs)]
pub struct VariationArgs {
    /// Column of ozone, Dobson units: 0 for none, about 100 for an ozone hole; 345 if absent.
    #[arg(long)]
    ozone: Option<f64>,
    /// Altitude profile of the particles: the model's, OPAC's with its sharp inversion, or an exponential of the same
    /// visibility and vertical optical depth.
    #[arg(long, value_enum, default_value = "smooth")]
    aerosol_profile: ProfileArg,
}

#[derive(Clone, Copy, ValueEnum)]
enum ProfileArg {
    Smooth,
    Sharp,
    Exponential,
}

impl VariationArgs {
    /// What they say.
    pub fn variation(&self) -> Variation {
        Variation {
            ozone: self.ozone,
            aerosol: match self.aerosol_profile {
                ProfileArg::Smooth => AerosolProfile::Smooth,
                ProfileArg::Sharp => AerosolProfile::Sharp,
                ProfileArg::Exponential => AerosolProfile::Exponential,
            },
        }
    }
}

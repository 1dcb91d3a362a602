//! Air that differs from that of the model, to show what the difference does.

use anyhow::{Result, ensure};
use std::fmt;

/// Departures from the air of the model; none by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Variation {
    /// Column of ozone, Dobson units, in the shape of the US standard profile, whose own column is about 345.
    pub ozone: Option<f64>,
    /// How the particles are spread over the altitude.
    pub aerosol: AerosolProfile,
}

/// How the particles are spread over the altitude. All have the same visibility on the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AerosolProfile {
    /// Two layers with a smooth transition, and a smooth end.
    #[default]
    Smooth,
    /// The two layers of OPAC, which end within a metre.
    Sharp,
    /// One exponential with the vertical optical depth of the smooth one at 550 nm.
    Exponential,
}

impl AerosolProfile {
    /// Where the layers end, m.
    pub const EDGES: [f64; 2] = [2000.0, 12_000.0];
}

impl Variation {
    /// Says which field is wrong.
    pub fn check(&self) -> Result<()> {
        let dobson = self.ozone.unwrap_or(0.0);
        ensure!(
            (0.0..=2000.0).contains(&dobson),
            "ozone {dobson:?} DU is outside 0..2000"
        );
        Ok(())
    }
}

impl fmt::Display for Variation {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if let Some(dobson) = self.ozone {
            write!(f, ", ozone {dobson} DU")?;
        }
        match self.aerosol {
            AerosolProfile::Smooth => Ok(()),
            AerosolProfile::Sharp => f.write_str(", sharp aerosol layers"),
            AerosolProfile::Exponential => f.write_str(", exponential aerosol"),
        }
    }
}

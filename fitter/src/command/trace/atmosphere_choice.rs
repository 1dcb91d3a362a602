//! The atmosphere of a run: from a JSON file, or the real one.

use anyhow::{Context, Result, ensure};
use clap::Args as ClapArgs;
use std::path::PathBuf;
use welkin_fitter::atmosphere::json::Case;
use welkin_fitter::atmosphere::{Atmosphere, Particles, real_with};

/// Treatment of aerosols.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum AerosolArg {
    Depolarising,
    Preserving,
    Mie,
}

/// Arguments that choose it.
#[derive(ClapArgs)]
pub struct SourceArgs {
    /// JSON atmosphere.
    #[arg(
        long,
        required_unless_present = "visibility",
        conflicts_with = "visibility"
    )]
    pub atmosphere: Option<PathBuf>,
    /// The real atmosphere with this visibility, km (20..131.8), instead of a file.
    #[arg(long)]
    pub visibility: Option<f64>,
    /// Wavelengths in the real atmosphere, nm, separated by commas.
    #[arg(
        long,
        value_delimiter = ',',
        default_value = "550",
        conflicts_with = "atmosphere"
    )]
    pub wavelengths: Vec<f64>,
    /// Sun elevation where the rows have none, degrees.
    #[arg(long)]
    pub solar_elevation: Option<f64>,
    /// Ground albedo where the rows have none.
    #[arg(long)]
    pub albedo: Option<f64>,
}

/// An atmosphere and what goes with it.
pub struct Source {
    /// The air.
    pub atmosphere: Atmosphere,
    /// Sun elevation, degrees, for rows without.
    pub solar_elevation: Option<f64>,
    /// Albedo for rows without.
    pub albedo: Option<f64>,
    /// The file it came from.
    pub case: Option<Case>,
}

impl SourceArgs {
    /// Reads or builds the atmosphere.
    pub fn load(&self, aerosol: AerosolArg) -> Result<Source> {
        if let Some(path) = &self.atmosphere {
            ensure!(
                aerosol != AerosolArg::Mie,
                "--aerosol mie needs the real atmosphere (--visibility): the JSON atmosphere knows Henyey-Greenstein particles only"
            );
            let case = Case::read(path)?;
            return Ok(Source {
                atmosphere: case.atmosphere.clone(),
                solar_elevation: self.solar_elevation.or(Some(case.sun_elevation_deg)),
                albedo: self.albedo.or(Some(case.albedo)),
                case: Some(case),
            });
        }
        let visibility = self.visibility.context("--visibility is missing")?;
        let particles = match aerosol {
            AerosolArg::Mie => Particles::Mie,
            _ => Particles::HenyeyGreenstein,
        };
        Ok(Source {
            atmosphere: real_with(1000.0 * visibility, &self.wavelengths, particles)?,
            solar_elevation: self.solar_elevation,
            albedo: self.albedo,
            case: None,
        })
    }
}

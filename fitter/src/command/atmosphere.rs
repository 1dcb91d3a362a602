//! `welkin-fit atmosphere`: the real air as a file, for other codes and for `trace`.

use super::variation::VariationArgs;
use anyhow::Result;
use clap::Args as ClapArgs;
use std::path::PathBuf;
use welkin::output::{Target, write};
use welkin_fitter::atmosphere::json::Case;
use welkin_fitter::atmosphere::{Particles, real_varied};

/// Arguments of `atmosphere`.
#[derive(ClapArgs)]
pub struct Args {
    /// Visibility, km (20..131.8).
    #[arg(long)]
    visibility: f64,
    /// Wavelengths, nm (300..2500), separated by commas.
    #[arg(long, value_delimiter = ',', default_value = "550")]
    wavelengths: Vec<f64>,
    #[command(flatten)]
    variation: VariationArgs,
    /// Albedo of the ground that goes into the file.
    #[arg(long, default_value_t = 0.2)]
    albedo: f64,
    /// Sun elevation that goes into the file, degrees.
    #[arg(long, default_value_t = 20.0)]
    solar_elevation: f64,
    /// Output JSON; `-` or nothing for standard output.
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let variation = args.variation.variation();
    let id = format!("real air, visibility {} km{variation}", args.visibility);
    let case = Case {
        id,
        atmosphere: real_varied(
            1000.0 * args.visibility,
            &args.wavelengths,
            Particles::HenyeyGreenstein,
            variation,
        )?,
        sun_elevation_deg: args.solar_elevation,
        albedo: args.albedo,
        columns: vec![],
        rows: vec![],
    };
    let text = case.to_json()? + "\n";
    let target = Target::new(args.out.as_deref().unwrap_or("-".as_ref()));
    Ok(write(&[(&target, text.as_bytes())])?)
}

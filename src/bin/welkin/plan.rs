//! `welkin plan`.

use std::io::Write;

use serde_json::json;
use welkin::output::printable_json;
use welkin::{Budget, Channels};

use crate::failure::{Result, fixed};
use crate::subset::{percent, range};

#[derive(clap::Args)]
pub struct Options {
    #[command(flatten)]
    source: crate::Source,
    /// Lowest and highest altitude of observers, m.
    #[arg(long, value_name = "LOW..HIGH", value_parser = range, allow_hyphen_values = true, default_value = "0")]
    altitudes: [f64; 2],
    /// Lowest and highest visibility, km.
    #[arg(long, value_name = "LOW..HIGH", value_parser = range, allow_hyphen_values = true, default_value = "59.4")]
    visibilities: [f64; 2],
    /// Lowest and highest elevation of the sun, degrees.
    #[arg(long, value_name = "LOW..HIGH", value_parser = range, allow_hyphen_values = true, default_value = "0..90")]
    sun_elevations: [f64; 2],
    /// What baking may add to the error at 95 % of directions and channels.
    #[arg(long, value_name = "PERCENT", value_parser = percent, allow_hyphen_values = true, default_value = "0.25%")]
    tolerance: f64,
    /// Colours instead of spectra.
    #[arg(long)]
    rgb: bool,
    /// Stokes vectors instead of radiance.
    #[arg(long, conflicts_with = "rgb")]
    stokes: bool,
    /// Write JSON.
    #[arg(long)]
    json: bool,
}

pub fn run(options: &Options) -> Result<()> {
    let model = options.source.open()?;
    let plan = model.plan(&Budget {
        altitude: options.altitudes,
        visibility: options.visibilities.map(|km| km * 1e3),
        solar_elevation: options.sun_elevations.map(f64::to_radians),
        tolerance: options.tolerance,
        channels: match (options.rgb, options.stokes) {
            (true, _) => Channels::Colour,
            (_, true) => Channels::Stokes,
            _ => Channels::Spectral,
        },
    })?;
    let report = json!({
        "model": options.source.name(),
        "model_bytes": model.file_bytes(),
        "file_bytes": plan.file_bytes,
        "chunks": plan.chunk_count,
        "sky_bytes": plan.sky_bytes,
        "error_median": plan.error_median,
        "error_p99": plan.error_p99,
        "degree_error": plan.degree_error.map(|[median, p99]| json!({"median": median, "p99": p99})),
        "bake_p95": plan.bake_p95,
    });
    let mut out = std::io::stdout().lock();
    if options.json {
        writeln!(out, "{}", printable_json(&format!("{report:#}")))?;
        return Ok(());
    }
    writeln!(
        out,
        "read from file   {} of {} bytes, in {} chunks",
        plan.file_bytes,
        model.file_bytes(),
        plan.chunk_count
    )?;
    writeln!(out, "per baked sky    at most {} bytes", plan.sky_bytes)?;
    writeln!(
        out,
        "error of the fit median {} %, p99 {} % at altitudes and visibilities of the model",
        fixed(100.0 * f64::from(plan.error_median), 2),
        fixed(100.0 * f64::from(plan.error_p99), 2)
    )?;
    if let Some([median, p99]) = plan.degree_error {
        writeln!(
            out,
            "of the degree    median {}, p99 {} of linear polarisation",
            fixed(median.into(), 4),
            fixed(p99.into(), 4)
        )?;
    }
    writeln!(
        out,
        "added by baking  p95 at most {:.2} %",
        100.0 * plan.bake_p95
    )?;
    Ok(())
}

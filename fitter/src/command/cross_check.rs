//! `welkin-fit cross-check`: the traced data before the unbiased tracer.

use anyhow::Result;
use indicatif::ProgressBar;
use std::path::PathBuf;
use welkin_fitter::cross_check::{cross_check, table};
use welkin_fitter::units::Plan;

/// Compares traced data with the unbiased tracer at random points of an atmosphere.
#[derive(clap::Args)]
pub struct Args {
    /// Visibility, km.
    #[arg(long, default_value_t = 59.4)]
    visibility: f64,
    /// Altitudes of the observers, m.
    #[arg(long, value_delimiter = ',', default_value = "0,500,2000,8000")]
    altitudes: Vec<f64>,
    /// View directions per altitude, each under two suns.
    #[arg(long, default_value_t = 8)]
    directions: usize,
    /// Relative standard error of the reference tracer.
    #[arg(long, default_value_t = 0.005)]
    target_error: f64,
    /// Folder for finished work units.
    #[arg(long, default_value = "work")]
    work: PathBuf,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let visibility = 1e3 * args.visibility;
    let (air, samples) = Plan::default().cross_check_samples(
        &args.work,
        visibility,
        &args.altitudes,
        args.directions,
    )?;
    let progress = ProgressBar::new(samples.len() as u64).with_message("cross-checking");
    let differences = cross_check(&air, &samples, args.target_error, &|| progress.inc(1))?;
    progress.finish();
    println!(
        "visibility {} km, {} samples\n{}",
        args.visibility,
        samples.len(),
        table(&differences)
    );
    Ok(())
}

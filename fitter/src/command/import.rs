//! `welkin-fit import`: other models as welkin files.

use anyhow::{Result, ensure};
use clap::Subcommand;
use std::io::Write;
use std::path::PathBuf;
use welkin::output::{Target, write};
use welkin_fitter::official::import::{Settings, import};

/// Turns a file of another model into a welkin file.
#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    model: Source,
}

#[derive(Subcommand)]
enum Source {
    /// A dataset (.dat) of the official code of Wilkie et al. 2021.
    Prague(Prague),
}

#[derive(clap::Args)]
struct Prague {
    /// The dataset.
    file: PathBuf,
    /// Where the model goes; - for standard output.
    #[arg(long)]
    out: PathBuf,
    /// Components of the radiance.
    #[arg(long)]
    rank: Option<usize>,
    /// Sweeps of the decomposition.
    #[arg(long)]
    sweeps: Option<usize>,
    /// Passes of the refinement in relative radiance.
    #[arg(long)]
    refinements: Option<usize>,
    /// Folder for finished parts of the fit: an import that is broken off goes on from them.
    #[arg(long)]
    work: Option<PathBuf>,
    /// Intervals above the horizon.
    #[arg(long)]
    up_intervals: Option<usize>,
    /// Intervals over azimuth.
    #[arg(long)]
    azimuth_intervals: Option<usize>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let Source::Prague(args) = &args.model;
    let mut settings = Settings::default();
    if let Some(rank) = args.rank {
        ensure!((1..=4096).contains(&rank), "--rank must be 1..=4096");
        settings.options.rank = rank;
    }
    if let Some(azimuth) = args.azimuth_intervals {
        let sound = (1..=1024).contains(&azimuth);
        ensure!(sound, "--azimuth-intervals must be 1..=1024");
        settings.intervals.azimuth = azimuth;
    }
    if let Some(up) = args.up_intervals {
        ensure!((1..=1024).contains(&up), "--up-intervals must be 1..=1024");
        settings.intervals.up = up;
    }
    settings.options.sweeps = args.sweeps.unwrap_or(settings.options.sweeps);
    ensure!(settings.options.sweeps > 0, "--sweeps must be at least 1");
    settings.work.clone_from(&args.work);
    settings.refinements = args.refinements.unwrap_or(settings.refinements);
    let target = Target::new(&args.out);
    target.check()?;
    let data = super::official::open(&args.file)?;
    for note in data.notes() {
        eprintln!("note: {note}");
    }
    let imported = import(&data, &settings)?;
    write(&[(&target, &imported.bytes)])?;
    Ok(write!(target.report(), "{}", imported.report)?)
}

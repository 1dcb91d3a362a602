//! `welkin-fit build`: traces and fits a model file.

use anyhow::Result;
use std::path::PathBuf;
use welkin_fitter::build::{Plan, build};

/// Traces and fits a model file. Without arguments it rebuilds the embedded default model.
#[derive(clap::Args)]
pub struct Args {
    /// Where the model goes.
    #[arg(long, default_value = "models/default.welkin")]
    out: PathBuf,
    /// Folder for finished work units; an interrupted build goes on from them.
    #[arg(long, default_value = "work")]
    work: PathBuf,
    /// Only these altitudes, m.
    #[arg(long, value_delimiter = ',')]
    altitudes: Option<Vec<f64>>,
    /// Only these visibilities, km.
    #[arg(long, value_delimiter = ',')]
    visibilities: Option<Vec<f64>>,
    /// Components per chunk.
    #[arg(long)]
    rank: Option<usize>,
    /// Sweeps of the decomposition.
    #[arg(long)]
    sweeps: Option<usize>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let mut plan = Plan::default();
    if let Some(altitudes) = &args.altitudes {
        plan.grid.altitudes = altitudes.clone();
    }
    if let Some(visibilities) = &args.visibilities {
        plan.grid.visibilities = visibilities.iter().map(|v| 1e3 * v).collect();
    }
    plan.grid.check()?;
    if let Some(rank) = args.rank {
        anyhow::ensure!((1..=4096).contains(&rank), "--rank must be 1..=4096");
        plan.options.rank = rank;
    }
    plan.options.sweeps = args.sweeps.unwrap_or(plan.options.sweeps);
    print!("{}", build(&plan, &args.work, &args.out)?);
    Ok(())
}

//! `welkin-fit build`: traces and fits a model file.

use super::plan::PlanArgs;
use anyhow::Result;
use std::io::Write;
use std::path::PathBuf;
use welkin::output::Target;
use welkin_fitter::build::build;
use welkin_fitter::fitting::Fitting;

/// Traces and fits a model file. Without arguments it rebuilds the embedded default model.
#[derive(clap::Args)]
pub struct Args {
    /// Where the model goes; - for standard output.
    #[arg(long, default_value = "models/default.welkin")]
    out: PathBuf,
    #[command(flatten)]
    plan: PlanArgs,
    /// Components per chunk.
    #[arg(long)]
    rank: Option<usize>,
    /// Sweeps of the decomposition.
    #[arg(long)]
    sweeps: Option<usize>,
    /// Passes of the refinement in relative radiance.
    #[arg(long)]
    refinements: Option<usize>,
    /// Components of the polarisation; 0 leaves it out.
    #[arg(long)]
    polarisation_rank: Option<usize>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let (plan, mut fitting) = (args.plan.plan()?, Fitting::default());
    if let Some(rank) = args.rank {
        anyhow::ensure!((1..=4096).contains(&rank), "--rank must be 1..=4096");
        fitting.options.rank = rank;
    }
    fitting.options.sweeps = args.sweeps.unwrap_or(fitting.options.sweeps);
    if let Some(rank) = args.polarisation_rank {
        anyhow::ensure!(rank <= 4096, "--polarisation-rank must be 0..=4096");
        fitting.polarisation.rank = rank;
    }
    fitting.refinements = args.refinements.unwrap_or(fitting.refinements);
    let target = Target::new(&args.out);
    let report = build(&plan, fitting, &args.plan.work, &target)?;
    Ok(write!(target.report(), "{report}")?)
}

//! `welkin-fit chart`: representations of the same traced chunks against each other.

use anyhow::{Context, Result};
use std::path::PathBuf;
use welkin::Model;
use welkin::output::{check, replace_files};
use welkin_fitter::chart::{Ranks, chart, csv, svg};
use welkin_fitter::fitting::Fitting;
use welkin_fitter::units::Plan;

/// Charts bytes and evaluation time against held-out error for ways to represent a sky.
#[derive(clap::Args)]
pub struct Args {
    /// Base name of the SVG and the CSV.
    #[arg(long, default_value = "docs/figures/representations")]
    out: PathBuf,
    /// Folder for finished work units; an interrupted run goes on from them.
    #[arg(long, default_value = "work")]
    work: PathBuf,
    /// A model to show at the same samples.
    #[arg(long)]
    model: Option<PathBuf>,
    /// Altitudes of the chunks, m.
    #[arg(long, value_delimiter = ',', default_value = "0,5700")]
    altitudes: Vec<f64>,
    /// Visibilities of the chunks, km.
    #[arg(long, value_delimiter = ',', default_value = "20,131.8")]
    visibilities: Vec<f64>,
    /// Sweeps of each decomposition.
    #[arg(long, default_value_t = 150)]
    sweeps: usize,
    /// Passes of the refinement where there is one.
    #[arg(long, default_value_t = 6)]
    refinements: usize,
    /// Ranks of fits whose chunks have all factors of their own.
    #[arg(long, value_delimiter = ',', default_value = "48,64,96")]
    own: Vec<usize>,
    /// Ranks of fits with shared factors.
    #[arg(long, value_delimiter = ',', default_value = "64,96,128,160")]
    shared: Vec<usize>,
    /// Ranks of fits of logarithms.
    #[arg(long, value_delimiter = ',', default_value = "48,96")]
    log: Vec<usize>,
    /// Nested tiers, as 64+32.
    #[arg(long, value_delimiter = ',', default_value = "64+32,64+32+32")]
    nested: Vec<String>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let [table_file, svg_file] = ["csv", "svg"].map(|e| args.out.with_extension(e));
    for file in [&table_file, &svg_file] {
        check(file)?;
    }
    let (mut plan, mut fitting) = (Plan::default(), Fitting::default());
    plan.grid.altitudes = args.altitudes.clone();
    plan.grid.visibilities = args.visibilities.iter().map(|v| 1e3 * v).collect();
    plan.grid.check()?;
    fitting.options.sweeps = args.sweeps;
    fitting.refinements = args.refinements;
    let ranks = Ranks {
        own: checked(&args.own)?,
        shared: checked(&args.shared)?,
        log: checked(&args.log)?,
        nested: args
            .nested
            .iter()
            .map(|t| tiers(t))
            .collect::<Result<_>>()?,
    };
    let open = |path: &PathBuf| Model::open(path).with_context(|| format!("{}", path.display()));
    let model = args.model.as_ref().map(open).transpose()?;
    let points = chart(&plan, fitting, &ranks, &args.work, model.as_ref())?;
    let command: Vec<String> = std::env::args().skip(1).collect();
    let mut table = format!("# welkin-fit {}\n", command.join(" ")).into_bytes();
    table.extend(csv(&points)?);
    print!("{}", String::from_utf8_lossy(&table));
    let svg = svg(&points)?;
    Ok(replace_files(&[
        (&table_file, &table),
        (&svg_file, svg.as_bytes()),
    ])?)
}

fn tiers(text: &str) -> Result<Vec<usize>> {
    let parts: Result<Vec<usize>, _> = text.split('+').map(str::parse).collect();
    checked(&parts.with_context(|| format!("--nested: {text} is not of the form 64+32"))?)
}

fn checked(ranks: &[usize]) -> Result<Vec<usize>> {
    anyhow::ensure!(
        ranks
            .iter()
            .all(|r| r.is_multiple_of(8) && (8..=512).contains(r)),
        "ranks must be multiples of 8 in 8..=512"
    );
    Ok(ranks.to_vec())
}

//! `welkin-fit validate`: the tracer, or the successive-orders solver, against outside references.

use anyhow::{Context, Result, bail, ensure};
use clap::Args as ClapArgs;
use std::path::{Path, PathBuf};
use welkin_fitter::atmosphere::json::Case;
use welkin_fitter::reference::traced_lines::{Effort, trace};
use welkin_fitter::reference::{Verdict, sky, slab, successive_orders, transmittance};
use welkin_fitter::successive_orders::Settings;
use welkin_fitter::tracer::{Aerosol, Options, Orders, VisibleGround};

/// Arguments of `validate`.
#[derive(ClapArgs)]
pub struct Args {
    /// Directory with sky_*.json, transmittance_*.json, pp_rayleigh_*.json, pp_hg_*.json.
    #[arg(default_value = "fitter/tests/reference")]
    directory: PathBuf,
    /// Standard error of I to aim at, relative to I.
    #[arg(long, default_value_t = 0.005)]
    target_error: f64,
    /// Only files whose name contains this.
    #[arg(long, default_value = "")]
    only: String,
    /// Print every comparison, too.
    #[arg(long)]
    rows: bool,
    /// Judge the noise-free successive-orders solver at production resolution (skies only) instead of the tracer.
    #[arg(long)]
    successive_orders: bool,
    /// Seed of the random numbers.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    ensure!(
        args.target_error > 0.0 && args.target_error < 1.0,
        "--target-error must lie between 0 and 1"
    );
    let mut failures = 0;
    println!("{}", Verdict::header());
    for path in files(args)? {
        for verdict in judge(&path, args)? {
            if args.rows {
                verdict.rows().for_each(|row| println!("{row}"));
            }
            println!("{verdict}");
            failures += usize::from(!verdict.passed());
        }
    }
    if failures > 0 {
        bail!("{failures} comparisons failed");
    }
    Ok(())
}

fn files(args: &Args) -> Result<Vec<PathBuf>> {
    let directory = &args.directory;
    let entries = std::fs::read_dir(directory)
        .with_context(|| format!("cannot read {}", directory.display()))?;
    let mut files = entries
        .map(|entry| Ok(entry?.path()))
        .collect::<Result<Vec<_>>>()?;
    let kinds: &[&str] = match args.successive_orders {
        true => &["sky_"],
        false => &["sky_", "transmittance", "pp_rayleigh", "pp_hg"],
    };
    files.retain(|path| {
        let name = name(path);
        name.ends_with(".json")
            && name.contains(&args.only)
            && kinds.iter().any(|start| name.starts_with(start))
    });
    files.sort();
    ensure!(
        !files.is_empty(),
        "no reference files in {}",
        directory.display()
    );
    Ok(files)
}

fn name(path: &Path) -> String {
    path.file_name()
        .map(|name| name.to_string_lossy().into_owned())
        .unwrap_or_default()
}

fn judge(path: &Path, args: &Args) -> Result<Vec<Verdict>> {
    let effort = Effort {
        target_error: args.target_error,
        seed: args.seed,
    };
    match name(path) {
        _ if args.successive_orders => successive_orders(path),
        n if n.starts_with("sky_") => skies(path, effort),
        n if n.starts_with("transmittance") => Ok(vec![transmittance::judge(path)?]),
        n if n.starts_with("pp_rayleigh") => slab::rayleigh(path, 1, effort),
        _ => slab::henyey_greenstein(path, 1, effort),
    }
}

/// What the air alone scatters.
fn successive_orders(path: &Path) -> Result<Vec<Verdict>> {
    let case = Case::read(path)?;
    let results = successive_orders::gather(&case, Settings::default())?;
    sky::judge(&case, &results, sky::Columns::Path)
}

/// All sets of columns that a sky file has.
fn skies(path: &Path, effort: Effort) -> Result<Vec<Verdict>> {
    let case = Case::read(path)?;
    let lit = Options {
        visible_ground: VisibleGround::Lit,
        ..Options::default()
    };
    let single = Options {
        orders: Orders::Single,
        ..Options::default()
    };
    let preserving = Options {
        aerosol: Aerosol::Preserving,
        ..lit
    };
    let mut verdicts = vec![];
    for (columns, options) in [
        (sky::Columns::Single, single),
        (sky::Columns::Total, lit),
        (sky::Columns::Path, Options::default()),
        (sky::Columns::Preserving, preserving),
    ] {
        if columns.exist(&case) {
            let results = trace(&case, options, effort)?;
            verdicts.extend(sky::judge(&case, &results, columns)?);
        }
    }
    Ok(verdicts)
}

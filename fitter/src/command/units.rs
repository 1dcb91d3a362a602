//! `welkin-fit units`: the work units of a plan, for schedulers that spread them over many machines.

use super::plan::PlanArgs;
use anyhow::{Result, ensure};
use clap::Subcommand;
use std::io::Write;
use welkin::output::replace_file;
use welkin_fitter::dataset::State;
use welkin_fitter::manifest::manifest;
use welkin_fitter::progress::bar;
use welkin_fitter::units::{Kind, Plan, Unit};

/// Lists work units, does some of them, or describes them.
#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    action: Action,
}

#[derive(Subcommand)]
enum Action {
    /// Print the name of every unit, a tab, and whether it is done, missing or damaged (length and checksum of the
    /// whole file are compared). Damaged ones are done again by `run`.
    List {
        #[command(flatten)]
        plan: UnitsArgs,
    },
    /// Do units that are not done. Units of a kind share nothing but their light fields, which come first in the list.
    Run {
        #[command(flatten)]
        plan: UnitsArgs,
        /// A name, a place in the list (from 0), or a kind (light, tensor, truth, check) for all units of it.
        #[arg(required = true)]
        which: Vec<String>,
    },
    /// Check every unit and write manifest.json into the work folder: origin, checksum, core-seconds, difference to the
    /// tracer.
    Manifest {
        #[command(flatten)]
        plan: UnitsArgs,
    },
}

#[derive(clap::Args)]
struct UnitsArgs {
    #[command(flatten)]
    plan: PlanArgs,
    /// Held-out samples that are cross-checked per visibility and altitude.
    #[arg(long)]
    checked: Option<usize>,
    /// Relative standard error of the reference tracer.
    #[arg(long)]
    target_error: Option<f64>,
}

impl UnitsArgs {
    fn plan(&self) -> Result<Plan> {
        let mut plan = self.plan.plan()?;
        let cross_check = &mut plan.cross_check;
        cross_check.samples = self.checked.unwrap_or(cross_check.samples);
        cross_check.target_error = self.target_error.unwrap_or(cross_check.target_error);
        ensure!(cross_check.samples > 0, "--checked must be positive");
        ensure!(
            cross_check.target_error > 0.0 && cross_check.target_error.is_finite(),
            "--target-error must be positive"
        );
        Ok(plan)
    }
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    match &args.action {
        Action::List { plan } => list(plan),
        Action::Run { plan, which } => work(plan, which),
        Action::Manifest { plan } => {
            let text = serde_json::to_string_pretty(&manifest(&plan.plan()?, &plan.plan.work)?)?;
            let file = plan.plan.work.join("manifest.json");
            Ok(replace_file(file, text.as_bytes())?)
        }
    }
}

fn list(args: &UnitsArgs) -> Result<()> {
    let plan = args.plan()?;
    let mut out = std::io::stdout().lock();
    for unit in plan.units() {
        let name = plan.name(unit);
        let store = plan.store_of(&args.plan.work, unit.kind)?;
        let state = match store.state(&name)? {
            State::Done => "done",
            State::Missing => "missing",
            State::Damaged => "damaged",
        };
        writeln!(out, "{name}\t{state}")?;
    }
    Ok(())
}

fn work(args: &UnitsArgs, which: &[String]) -> Result<()> {
    let plan = args.plan()?;
    let mut units: Vec<Unit> = vec![];
    for which in which {
        match Kind::ALL.into_iter().find(|kind| kind.name() == which) {
            Some(kind) => units.extend(plan.units().into_iter().filter(|u| u.kind == kind)),
            None => units.push(plan.find(which)?),
        }
    }
    let progress = bar(units.len(), "units");
    for unit in units {
        progress.set_message(plan.name(unit));
        plan.run(&args.plan.work, unit, &|_| ())?;
        progress.inc(1);
    }
    progress.finish();
    Ok(())
}

//! `welkin-fit spectrum`: what lies between the nodes, learned and judged.

use super::plan::PlanArgs;
use anyhow::{Context, Result};
use clap::Subcommand;
use std::path::PathBuf;
use welkin::Model;
use welkin_fitter::dataset::Store;
use welkin_fitter::spectrum::g173;
use welkin_fitter::spectrum::judge::{bands, csv, judge, summary};
use welkin_fitter::spectrum::walk::Walk;
use welkin_fitter::spectrum::{Lesson, held_out_table, lesson, quantiles};
use welkin_fitter::successive_orders::NW;

/// Learns what lies between the nodes, or judges a model there.
#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    action: Action,
}

#[derive(Subcommand)]
enum Action {
    /// Learn the weights of the nodes from traced spectra, and print how far spectra are off that were held out.
    Learn {
        #[command(flatten)]
        plan: PlanArgs,
    },
    /// Leave out the nodes that are used least, one after the other, and print what that costs: CSV.
    Nodes {
        #[command(flatten)]
        plan: PlanArgs,
        /// Where to stop.
        #[arg(long, default_value_t = 10)]
        fewest: usize,
    },
    /// Compare direct and global irradiance with ASTM G173 in bands of 40 nm, 300..2500 nm; prints CSV.
    G173 {
        /// Folder for finished work units.
        #[arg(long, default_value = "work")]
        work: PathBuf,
    },
    /// Walk over wavelengths with the solver and compare a model: radiance, polarisation, colour, light and
    /// transmittance of segments; quantiles as CSV.
    Judge(JudgeArgs),
}

#[derive(clap::Args)]
struct JudgeArgs {
    /// The model file.
    #[arg(long, default_value = "models/default.welkin")]
    model: PathBuf,
    /// Folder for finished work units.
    #[arg(long, default_value = "work")]
    work: PathBuf,
    /// Visibility, km.
    #[arg(long, default_value_t = 33.0)]
    visibility: f64,
    /// Altitudes, m.
    #[arg(long, value_delimiter = ',', default_value = "2,480,2220,6300,14000")]
    altitudes: Vec<f64>,
    /// Shortest wavelength, nm.
    #[arg(long, default_value_t = 302.5)]
    from: f64,
    /// Longest wavelength, nm.
    #[arg(long, default_value_t = 1097.5)]
    to: f64,
    /// Step, nm.
    #[arg(long, default_value_t = 5.0)]
    step: f64,
    /// View directions per altitude.
    #[arg(long, default_value_t = 40)]
    views: usize,
    /// Suns per altitude.
    #[arg(long, default_value_t = 16)]
    suns: usize,
    /// Finite segments.
    #[arg(long, default_value_t = 300)]
    segments: usize,
    /// What is printed.
    #[arg(long, value_enum, default_value_t = Table::All)]
    table: Table,
}

/// Tables of a judgement, all CSV.
#[derive(Clone, Copy, clap::ValueEnum)]
enum Table {
    /// Every quantity by sun and 20 nm.
    All,
    /// Radiance by 20 nm.
    Bands,
    /// Every quantity over all wavelengths.
    Summary,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    match &args.action {
        Action::Learn { plan } => {
            let all: Vec<usize> = (0..NW).collect();
            print!(
                "{}",
                held_out_table(&lesson(&plan.plan()?, &plan.work)?.errors(&all))
            );
        }
        Action::Nodes { plan, fewest } => {
            let lesson = lesson(&plan.plan()?, &plan.work)?;
            print!("{}", fewer_nodes(&lesson, *fewest));
        }
        Action::G173 { work } => {
            let store = Store::open(work, "g173 1")?;
            print!("{}", g173::csv(&g173::compare(&store)?));
        }
        Action::Judge(args) => return args.run(),
    }
    Ok(())
}

/// Quantiles of held-out errors for fewer and fewer nodes.
fn fewer_nodes(lesson: &Lesson, fewest: usize) -> String {
    let mut out = String::from(
        "nodes,from_nm,to_nm,day_median,day_p95,day_p99,twilight_median,twilight_p95,twilight_p99\n",
    );
    let mut nodes: Vec<usize> = (0..NW).collect();
    loop {
        let errors = lesson.errors(&nodes);
        for [from, to] in [
            [300.0, 345.0],
            [345.0, 680.0],
            [680.0, 760.1],
            [760.1, 1101.0],
        ] {
            let cells = quantiles(&errors, [from, to]).map(|v| format!("{v:.5}"));
            out += &format!("{},{from},{to},{}\n", nodes.len(), cells.join(","));
        }
        if nodes.len() <= fewest.max(2) {
            return out;
        }
        nodes = lesson.without_least(&nodes);
    }
}

impl JudgeArgs {
    fn run(&self) -> Result<()> {
        let model =
            Model::open(&self.model).with_context(|| format!("{}", self.model.display()))?;
        let count = ((self.to - self.from) / self.step).floor() as usize + 1;
        let walk = Walk {
            visibility: 1e3 * self.visibility,
            altitudes: self.altitudes.clone(),
            counts: [self.views, self.suns],
            segments: self.segments,
            wavelengths: (0..count)
                .map(|i| self.from + self.step * i as f64)
                .collect(),
        };
        let store = Store::open(&self.work, format!("{walk:?}"))?;
        let judgement = judge(&model, &walk, &walk.trace(&store)?)?;
        let table = match self.table {
            Table::All => csv(&judgement),
            Table::Bands => bands(&judgement),
            Table::Summary => summary(&judgement),
        };
        print!("{table}");
        Ok(())
    }
}

//! `welkin-fit spectrum`: what lies between the nodes, learned and judged.

use super::plan::PlanArgs;
use anyhow::{Context, Result};
use clap::Subcommand;
use std::path::PathBuf;
use welkin::Model;
use welkin::output::replace_file;
use welkin_fitter::air::Air;
use welkin_fitter::dataset::Store;
use welkin_fitter::spectrum::judge::judge;
use welkin_fitter::spectrum::judgement_tables::{bands, csv, luminance, summary};
use welkin_fitter::spectrum::walk::Walk;
use welkin_fitter::spectrum::{Lesson, held_out_table, lesson, quantiles};
use welkin_fitter::spectrum::{draw, g173};
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
        /// Where a chart goes.
        #[arg(long)]
        svg: Option<PathBuf>,
    },
    /// Compare direct and global irradiance with ASTM G173 in bands of 40 nm from 300 nm; prints CSV.
    G173 {
        /// Longest wavelength, nm, at most 2500.
        #[arg(long, default_value_t = 2500.0)]
        to: f64,
        /// Folder for finished work units.
        #[arg(long, default_value = "work")]
        work: PathBuf,
        /// Where a chart goes.
        #[arg(long)]
        svg: Option<PathBuf>,
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
    /// Luminance by sun: relative, absolute, and before a night sky.
    Luminance,
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
        Action::Nodes { plan, fewest, svg } => {
            let rows = fewer_nodes(&lesson(&plan.plan()?, &plan.work)?, *fewest);
            print!("{}", table(&rows));
            if let Some(path) = svg {
                replace_file(path, draw::nodes(&lines(&rows))?.as_bytes())?;
            }
        }
        Action::G173 { to, work, svg } => {
            let bands = g173::compare(&Store::open(work, "g173 3")?, *to)?;
            print!("{}", g173::csv(&bands));
            if let Some(path) = svg {
                replace_file(path, draw::g173(&bands)?.as_bytes())?;
            }
        }
        Action::Judge(args) => return args.run(),
    }
    Ok(())
}

/// Ranges of wavelengths (nm) that are told apart.
const RANGES: [[f64; 2]; 4] = [
    [300.0, 345.0],
    [345.0, 680.0],
    [680.0, 760.1],
    [760.1, 1101.0],
];

/// Number of nodes, and quantiles of held-out errors in each of the ranges.
type Row = (usize, [[f64; 6]; RANGES.len()]);

/// Fewer and fewer nodes.
fn fewer_nodes(lesson: &Lesson, fewest: usize) -> Vec<Row> {
    let mut rows = vec![];
    let mut nodes: Vec<usize> = (0..NW).collect();
    loop {
        let errors = lesson.errors(&nodes);
        rows.push((nodes.len(), RANGES.map(|range| quantiles(&errors, range))));
        if nodes.len() <= fewest.max(2) {
            return rows;
        }
        nodes = lesson.without_least(&nodes);
    }
}

fn table(rows: &[Row]) -> String {
    let names = RANGES.map(|[from, to]| format!("{from:.0}..{to:.0} nm: day p95,… twilight p95"));
    let mut out = format!("nodes,{}\n", names.join(","));
    for (count, ranges) in rows {
        let cells = ranges.map(|[_, day, _, _, twilight, _]| {
            format!("{:.2} %,{:.2} %", 100.0 * day, 100.0 * twilight)
        });
        out += &format!("{count},{}\n", cells.join(","));
    }
    out
}

fn lines(rows: &[Row]) -> Vec<draw::Line> {
    let line = |(r, [from, to]): (usize, [f64; 2])| {
        let points = rows.iter().map(|row| (row.0 as f64, 100.0 * row.1[r][1]));
        (format!("{from:.0}..{to:.0} nm"), points.collect())
    };
    RANGES.into_iter().enumerate().map(line).collect()
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
        let store = Store::open(&self.work, format!("2 {walk:?}"))?;
        let judgement = judge(&model, &walk, &walk.trace(&store, &Air::Continental)?)?;
        let table = match self.table {
            Table::All => csv(&judgement),
            Table::Bands => bands(&judgement),
            Table::Summary => summary(&judgement),
            Table::Luminance => luminance(&judgement),
        };
        print!("{table}");
        Ok(())
    }
}

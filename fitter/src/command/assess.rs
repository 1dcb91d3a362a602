//! `welkin-fit assess`: a model file against freshly traced radiance at conditions between its nodes.

use anyhow::{Context, Result};
use std::path::PathBuf;
use welkin::Model;
use welkin_fitter::assess::{self, Error, band_table, table};
use welkin_fitter::units::Plan;

/// Compares a model with freshly traced radiance at visibilities and altitudes between its nodes.
#[derive(clap::Args)]
pub struct Args {
    /// The model file.
    #[arg(long, default_value = "models/default.welkin")]
    model: PathBuf,
    /// Folder for finished work units.
    #[arg(long, default_value = "work")]
    work: PathBuf,
    /// Visibilities, km.
    #[arg(long, value_delimiter = ',', default_value = "22,25.5,33,49,75,110")]
    visibilities: Vec<f64>,
    /// Altitudes, m; those beyond the model are left out.
    #[arg(
        long,
        value_delimiter = ',',
        default_value = "8,70,210,480,800,1250,1760,2220,2800,4100,6300,9200,11900,14000"
    )]
    altitudes: Vec<f64>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let model = Model::open(&args.model).with_context(|| format!("{}", args.model.display()))?;
    let [lowest, highest] = model.altitude_range();
    let altitudes: Vec<f64> = args
        .altitudes
        .iter()
        .copied()
        .filter(|h| (lowest..=highest).contains(h))
        .collect();
    let mut rows = vec![];
    let plan = Plan::default();
    let store = plan.store(&args.work)?;
    for visibility in args.visibilities.iter().map(|v| 1e3 * v) {
        let solved = plan.solve(&args.work, visibility, &|_| {})?;
        for &altitude in &altitudes {
            let samples = plan.held_out(&store, &solved, altitude)?;
            let errors = assess::errors(&model, visibility, &samples)?;
            rows.push((visibility, altitude, errors));
        }
    }
    println!("{}", band_table(&rows));
    let all: Vec<Error> = rows.into_iter().flat_map(|(_, _, errors)| errors).collect();
    println!("all conditions\n{}", table(&all));
    Ok(())
}

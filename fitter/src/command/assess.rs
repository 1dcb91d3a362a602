//! `welkin-fit assess`: a model file against freshly traced light at conditions between its nodes.

use anyhow::{Context, Result};
use std::path::PathBuf;
use welkin::Model;
use welkin_fitter::assess::{self, Error, band_table, table};
use welkin_fitter::polarimetry;
use welkin_fitter::units::Plan;

/// Compares a model with freshly traced radiance and polarisation at visibilities and altitudes between its nodes.
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
    /// Judge about the edge of the Earth's shadow instead: suns −12..−0.5°, directions away from them, as CSV.
    #[arg(long)]
    shadow_edge: bool,
    /// Print radiance by altitude, sun and wavelength as CSV.
    #[arg(long, conflicts_with = "shadow_edge")]
    by_altitude: bool,
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
    let (mut polarised, mut without_u) = (vec![], vec![]);
    let mut edges = vec![];
    let plan = Plan::default();
    let store = plan.store(&args.work)?;
    for visibility in args.visibilities.iter().map(|v| 1e3 * v) {
        let solved = plan.solve(&args.work, visibility, &|_| {})?;
        for &altitude in &altitudes {
            if args.shadow_edge {
                let samples = plan.shadow_edge(&store, &solved, altitude)?;
                edges.push((altitude, assess::errors(&model, visibility, &samples)?));
                continue;
            }
            let samples = plan.held_out(&store, &solved, altitude)?;
            let errors = assess::errors(&model, visibility, &samples)?;
            rows.push((visibility, altitude, errors));
            if model.is_polarised() {
                polarised.extend(polarimetry::errors(&model, visibility, &samples)?);
                without_u.extend(polarimetry::without_u(&model, visibility, &samples));
            }
        }
    }
    if args.shadow_edge {
        print!("{}", assess::place_table(&edges, &assess::EDGE_SUNS));
        return Ok(());
    }
    if args.by_altitude {
        let rows: Vec<(f64, Vec<Error>)> = rows.into_iter().map(|(_, h, e)| (h, e)).collect();
        print!("{}", assess::place_table(&rows, &assess::SUNS));
        return Ok(());
    }
    println!("{}", band_table(&rows));
    let all: Vec<Error> = rows.into_iter().flat_map(|(_, _, errors)| errors).collect();
    println!("all conditions\n{}", table(&all));
    if model.is_polarised() {
        println!("degree of polarisation\n{}", polarimetry::table(&polarised));
        println!(
            "traced polarisation without U in the sun-aligned frame\n{}",
            polarimetry::table(&without_u)
        );
    }
    Ok(())
}

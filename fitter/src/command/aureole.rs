//! `welkin-fit aureole`: models beside the tracer with full scattering matrices.

use super::atmosphere::draw::{Panel, Series, svg};
use super::make::find;
use anyhow::{Context, Result, bail, ensure};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use welkin::Model;
use welkin::output::{Target, write};
use welkin_fitter::aureole::cost::Cost;
use welkin_fitter::aureole::lines::{Line, Place, all, vertical};
use welkin_fitter::aureole::{Traced, judge, nodes, trace};

/// Traces the sky on the ground with particles as spheres (Lorenz-Mie) and says how far models are from it.
#[derive(clap::Args)]
pub struct Args {
    /// The recipe of the air: a TOML file or a name.
    recipe: PathBuf,
    /// Model files made of it.
    #[arg(required = true)]
    models: Vec<PathBuf>,
    /// Elevations of the sun, degrees.
    #[arg(long, value_delimiter = ',', default_value = "5,20,60")]
    suns: Vec<f64>,
    /// Wavelengths among the nodes of models, nm.
    #[arg(long, value_delimiter = ',', default_value = "343,430,550,650,870")]
    wavelengths: Vec<f64>,
    /// Relative standard error of the tracer to aim at.
    #[arg(long, default_value_t = 0.005)]
    noise: f64,
    /// Most walks of the tracer per batch.
    #[arg(long, default_value_t = 4000)]
    walks: usize,
    /// Write the errors as CSV, too.
    #[arg(long, value_name = "CSV")]
    csv: Option<PathBuf>,
    /// Draw the vertical through the sun of this elevation, degrees, as SVG.
    #[arg(long, value_names = ["SVG", "ELEVATION"], num_args = 2)]
    plot: Option<Vec<String>>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let recipe = find(&args.recipe)?.with_mie()?;
    let nodes = nodes(&args.wavelengths)?;
    let models: Vec<(String, Model)> = args.models.iter().map(open).collect::<Result<_>>()?;
    let suns = above_horizon(&args.suns)?;
    let plot = args.plot.as_deref().map(parse_plot).transpose()?;
    let plotted = plot.iter().map(|(_, sun)| sun.to_radians());
    let all_suns: Vec<f64> = suns.iter().copied().chain(plotted).collect();
    for ((_, model), path) in models.iter().zip(&args.models) {
        let outcome = judge::check(model, &args.wavelengths, &all_suns);
        outcome.with_context(|| path.display().to_string())?;
    }
    let effort = (args.noise, args.walks);
    let traced = trace(&recipe, (&nodes, &all(&suns)), effort)?;
    let rows = judge::rows(&models, &traced, &args.wavelengths)?;
    println!("{}", judge::table(&rows)?);
    let mut costs = String::new();
    for (name, model) in &models {
        writeln!(costs, "{name}: {}", Cost::of(model)?)?;
    }
    print!("{costs}");
    if let Some(path) = &args.csv {
        let comments: String = costs.lines().map(|line| format!("# {line}\n")).collect();
        let text = [comments.as_bytes(), &judge::csv(&rows)?].concat();
        write(&[(&Target::new(path), &text)])?;
    }
    if let Some((path, sun)) = plot {
        let lines = vertical(sun.to_radians());
        let traced = trace(&recipe, (&nodes, &lines), effort)?;
        let panels = panels(&models, &traced, &args.wavelengths)?;
        let title = format!("{}, sun at {sun}°, along its vertical", recipe.name());
        let text = svg(&title, &panels)?;
        write(&[(&Target::new(path), text.as_bytes())])?;
    }
    Ok(())
}

/// Elevations in degrees as radians.
fn above_horizon(degrees: &[f64]) -> Result<Vec<f64>> {
    for sun in degrees {
        ensure!(
            *sun > 0.0 && *sun <= 90.0,
            "suns must stand above the horizon, at up to 90 degrees, got {sun}"
        );
    }
    Ok(degrees.iter().map(|sun| sun.to_radians()).collect())
}

/// Where the plot goes and the elevation of its sun, degrees.
fn parse_plot(values: &[String]) -> Result<(&Path, f64)> {
    let [path, sun] = values else {
        bail!("--plot: expected a file and an elevation");
    };
    let what = || format!("--plot: the elevation {sun:?} is no number");
    let sun: f64 = sun.parse().with_context(what)?;
    above_horizon(&[sun]).context("--plot")?;
    Ok((Path::new(path), sun))
}

fn open(path: &PathBuf) -> Result<(String, Model)> {
    let bytes = std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
    let model = Model::from_bytes(bytes).with_context(|| path.display().to_string())?;
    let name = path.file_stem().unwrap_or(path.as_os_str());
    Ok((name.to_string_lossy().into_owned(), model))
}

/// Radiance and degree of polarisation at the middle one of the wavelengths, and the radiance near the sun.
fn panels(
    models: &[(String, Model)],
    traced: &[Traced],
    wavelengths: &[f64],
) -> Result<Vec<Panel>> {
    let lane = wavelengths.len() / 2;
    let mut curves: Vec<(String, Vec<[f64; 2]>)> = vec![];
    let truth = |t: &Traced| {
        let stokes = t.light[lane].stokes;
        [stokes[0], judge::degree(stokes)]
    };
    let name = format!("traced, {} nm", wavelengths[lane]);
    curves.push((name, traced.iter().map(truth).collect()));
    for (name, model) in models {
        let own = traced
            .iter()
            .map(|t| Ok(judge::evaluate(model, &t.line, wavelengths)?[lane]))
            .collect::<Result<_>>()?;
        curves.push((name.clone(), own));
    }
    let series = |x: &dyn Fn(&Line) -> Option<f64>, of: usize| -> Vec<Series> {
        let one = |(name, values): &(String, Vec<[f64; 2]>)| {
            let points = traced.iter().zip(values);
            let points = points.filter_map(|(t, v)| Some((x(&t.line)?, v[of])));
            let mut points: Vec<(f64, f64)> = points.collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            Series::new(name, points)
        };
        curves.iter().map(one).collect()
    };
    let around = |line: &Line| match line.place {
        Place::Vertical(angle) => Some(angle.to_degrees()),
        _ => None,
    };
    let above = |line: &Line| match line.place {
        Place::Vertical(angle) if angle > line.sun => Some((angle - line.sun).to_degrees()),
        _ => None,
    };
    let values = curves[0].1.iter().map(|v| v[0]);
    let low = values.clone().fold(f64::INFINITY, f64::min);
    let high = values.fold(0.0, f64::max);
    let panel = |title, below, x, y, log, series| Panel {
        title,
        below,
        beside: "",
        x,
        y,
        log,
        series,
    };
    Ok(vec![
        panel(
            "radiance over irradiance of the sun, 1/sr",
            "degrees from the horizon below the sun",
            (0.0, 180.0),
            (0.5 * low, 2.0 * high),
            (false, true),
            series(&around, 0),
        ),
        panel(
            "the same above the sun",
            "degrees from the sun",
            (0.0, 12.0),
            (low, 1.5 * high),
            (false, true),
            series(&above, 0),
        ),
        panel(
            "degree of linear polarisation",
            "degrees from the horizon below the sun",
            (0.0, 180.0),
            (0.0, 1.0),
            (false, false),
            series(&around, 1),
        ),
    ])
}

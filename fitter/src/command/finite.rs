//! `welkin-fit finite`: light of finite segments, by every method, against exact integrals.

use anyhow::{Context, Result, ensure};
use rayon::prelude::*;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;
use welkin::Model;
use welkin::output::{Target, replace_file, write};
use welkin_fitter::finite::{self, study};
use welkin_fitter::picture::image;
use welkin_fitter::successive_orders::NW;
use welkin_fitter::units::{Plan, Solved};

/// Compares methods for the light of finite segments, or puts what they need into a model file.
#[derive(clap::Args)]
pub struct Args {
    /// Model file.
    #[arg(long, default_value = "models/default.welkin")]
    model: PathBuf,
    /// Folder for finished work units.
    #[arg(long, default_value = "work")]
    work: PathBuf,
    /// Only fit transmittance and source, and write the model with them to this file; - for standard output.
    #[arg(long)]
    extend: Option<PathBuf>,
    /// Folder for tables and pictures.
    #[arg(long, default_value = "finite")]
    out: PathBuf,
    /// Segments per visibility.
    #[arg(long, default_value_t = 400)]
    segments: usize,
    /// Highest observer, m.
    #[arg(long, default_value_t = 15_000.0)]
    highest: f64,
    /// Visibilities, km; those of the model if absent.
    #[arg(long, value_delimiter = ',')]
    visibilities: Vec<f64>,
    /// Width of each picture of the towers, pixels; 0 for none.
    #[arg(long, default_value_t = 80)]
    width: usize,
    /// Walks per pixel of the path-traced picture.
    #[arg(long, default_value_t = 64)]
    walks: usize,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    ensure!(args.segments >= 1, "--segments is not positive");
    ensure!(
        args.highest >= 0.0 && args.highest.is_finite(),
        "--highest must be an altitude, m"
    );
    let path = || args.model.display().to_string();
    let bytes = std::fs::read(&args.model).with_context(path)?;
    let model = Model::from_bytes(bytes.clone()).with_context(path)?;
    let nodes: Vec<f64> = model.head().visibilities.clone();
    let solve = |v: &f64| Plan::default().solve(&args.work, *v, &|_| {});
    if let Some(out) = &args.extend {
        let target = Target::new(out);
        target.check()?;
        let solved = nodes.iter().map(solve).collect::<Result<Vec<_>>>()?;
        let started = Instant::now();
        let extended = welkin::format::extend(&bytes, &finite::chunks(&solved)?)?;
        let time = started.elapsed().as_secs_f64();
        write(&[(&target, &extended)])?;
        let (new, old) = (extended.len(), bytes.len());
        let text = format!("{new} bytes, {old} before, {time:.0} s\n");
        return Ok(std::io::Write::write_all(
            &mut target.report(),
            text.as_bytes(),
        )?);
    }
    let visibilities: Vec<f64> = match args.visibilities.is_empty() {
        true => nodes,
        false => args.visibilities.iter().map(|km| 1e3 * km).collect(),
    };
    let solved = visibilities.iter().map(solve).collect::<Result<Vec<_>>>()?;
    std::fs::create_dir_all(&args.out).with_context(|| args.out.display().to_string())?;
    let report = study(args, &model, &solved)?;
    let report = format!("{report}\n{}", pictures(args, &model, &solved)?);
    save(&args.out, "report.md", report.as_bytes())?;
    println!("{report}");
    Ok(())
}

fn save(folder: &Path, name: &str, bytes: &[u8]) -> Result<()> {
    Ok(replace_file(folder.join(name), bytes)?)
}

fn study(args: &Args, model: &Model, solved: &[Solved]) -> Result<String> {
    let methods = study::Methods::new(model, solved);
    let cases = study::cases(solved, args.segments, args.highest, 1)?;
    let truth: Vec<_> = cases
        .par_iter()
        .map(|c| c.truth(&solved[c.visibility]))
        .collect();
    let light = study::all(&methods, &cases)?;
    let rows = study::rows(&cases, &truth, &light);
    save(&args.out, "errors.csv", study::csv(&rows).as_bytes())?;
    let mut report = study::table(&rows);
    let polarised = study::polarised_rows(&methods, &cases, &truth)?;
    let _ = writeln!(report, "\n{}", study::polarised_table(&polarised));
    let names = study::METHODS.map(study::Method::name).join(" | ");
    let rule = "--- | ".repeat(study::METHODS.len());
    let _ = writeln!(
        report,
        "\nLargest jump of the ratio to the exact light between pixels 0.02° apart, 560 nm:\n\n| scan | {names} |\n| --- | {rule}"
    );
    for scan in study::scans(&methods, solved, solved.len() / 2, args.highest)? {
        let cells =
            study::jumps(&scan).map(|j| j.map_or("–".into(), |j| format!("{:.2} %", 100.0 * j)));
        let _ = writeln!(report, "| {} | {} |", scan.name, cells.join(" | "));
    }
    let _ = writeln!(report, "\n{}", speed(&methods, &cases)?);
    Ok(report)
}

/// Times of both schemes at the same random parameters, one thread.
fn speed(methods: &study::Methods, cases: &[study::Case]) -> Result<String> {
    let some: Vec<_> = cases.iter().step_by(cases.len().div_ceil(200)).collect();
    let mut total = [0.0f64; 2];
    for case in some.iter().copied() {
        let aerial = methods.aerial(case)?;
        let [from, to] = case.ends();
        let (mut light, mut through) = ([0.0; NW], [0.0; NW]);
        let started = Instant::now();
        for _ in 0..20 {
            aerial.in_scattering(from, to, &mut light, &mut through)?;
            std::hint::black_box(&light);
        }
        total[0] += started.elapsed().as_secs_f64() / 20.0;
        let started = Instant::now();
        std::hint::black_box(methods.light(study::Method::Difference, case)?);
        total[1] += started.elapsed().as_secs_f64();
    }
    let [source, difference] = total.map(|t| 1e6 * t / some.len() as f64);
    Ok(format!(
        "Source quadrature of a prepared scene: {source:.1} µs per segment; Eq. 2 at random parameters (two skies prepared): {difference:.0} µs, {:.0} times as long.",
        difference / source
    ))
}

fn pictures(args: &Args, model: &Model, solved: &[Solved]) -> Result<String> {
    if args.width == 0 {
        return Ok(String::new());
    }
    let methods = study::Methods::new(model, solved);
    let visibility = solved.len() / 2;
    let mut out = String::new();
    for (altitude, pitch) in [(args.highest.min(8000.0), -0.03), (2.0, 0.1)] {
        let view = study::View {
            visibility,
            altitude,
            pitch,
            size: [args.width, args.width * 2 / 3],
            walks: args.walks,
        };
        let views = study::towers(&methods, &solved[visibility], &model.head().xyz, &view)?;
        let name = format!("towers-{altitude}.png");
        save(&args.out, &name, &image::png(&views.sheet, 1.0)?)?;
        let _ = writeln!(
            out,
            "{name}: {}; below each its error, ±10 %",
            views.names.join(", ")
        );
    }
    Ok(out)
}

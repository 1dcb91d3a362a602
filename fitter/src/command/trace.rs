//! `welkin-fit trace`: a CSV of lines of sight in, the same with radiances out.

use anyhow::{Context, Result, bail, ensure};
use clap::{Args as ClapArgs, ValueEnum};
use indicatif::{ParallelProgressIterator, ProgressBar, ProgressStyle};
use rayon::prelude::*;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;
use welkin_fitter::atmosphere::json::Case;
use welkin_fitter::tracer::{self, Aerosol, Estimate, Options, Query, Tracer};

/// Arguments of `trace`.
#[derive(ClapArgs)]
pub struct Args {
    /// JSON atmosphere.
    #[arg(long)]
    atmosphere: PathBuf,
    /// CSV with altitude_m, view_zenith_deg, view_azimuth_deg and optionally distance_m, solar_elevation_deg, albedo.
    /// Without it the atmosphere file's own lines of sight are used.
    #[arg(long)]
    queries: Option<PathBuf>,
    /// Standard error of I to aim at, relative to I: 0.5% or 0.005.
    #[arg(long, default_value = "0.5%", value_parser = fraction)]
    target_error: f64,
    /// Spend no more than about this many seconds; errors may then be larger.
    #[arg(long)]
    max_seconds: Option<f64>,
    /// Orders of scattering.
    #[arg(long, value_enum, default_value = "all")]
    orders: Orders,
    /// Whether ground shines where it is seen directly.
    #[arg(long, value_enum, default_value = "lit")]
    visible_ground: Ground,
    /// What aerosols do to polarised light.
    #[arg(long, value_enum, default_value = "depolarising")]
    aerosol: AerosolArg,
    /// Angular radius of the sun, degrees (0.2667 for the real one); 0 for a parallel beam.
    #[arg(long, default_value_t = 0.0)]
    sun_radius: f64,
    /// Seed of the random numbers.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Output CSV; standard output if absent.
    #[arg(long)]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Orders {
    Single,
    All,
}

#[derive(Clone, Copy, ValueEnum)]
enum Ground {
    Black,
    Lit,
}

#[derive(Clone, Copy, ValueEnum)]
enum AerosolArg {
    Depolarising,
    Preserving,
}

fn fraction(text: &str) -> Result<f64> {
    let (number, scale) = match text.strip_suffix('%') {
        Some(number) => (number, 0.01),
        None => (text, 1.0),
    };
    let value: f64 = number.trim().parse::<f64>()? * scale;
    ensure!(
        value.is_finite() && value > 0.0 && value < 1.0,
        "must lie between 0 and 100 %"
    );
    Ok(value)
}

/// A query with the ground under it, as read from a file.
struct Row {
    query: Query,
    albedo: f64,
    /// The row as it stood in the file.
    cells: Vec<String>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let case = Case::read(&args.atmosphere)?;
    let (header, rows) = match &args.queries {
        Some(path) => from_csv(path, &case)?,
        None => from_case(&case).with_context(|| args.atmosphere.display().to_string())?,
    };
    let tracer = Tracer::new(&case.atmosphere, args.options())?;
    let samples = plan(&tracer, &rows, args)?;
    let estimates = trace(&tracer, &rows, &samples, args.seed)?;
    let text = table(&header, &rows, &estimates)?;
    match &args.out {
        Some(path) => write_whole(path, &text),
        None => Ok(std::io::stdout().write_all(&text)?),
    }
}

impl Args {
    fn options(&self) -> Options {
        Options {
            orders: match self.orders {
                Orders::Single => tracer::Orders::Single,
                Orders::All => tracer::Orders::All,
            },
            visible_ground: match self.visible_ground {
                Ground::Black => tracer::VisibleGround::Black,
                Ground::Lit => tracer::VisibleGround::Lit,
            },
            aerosol: match self.aerosol {
                AerosolArg::Depolarising => Aerosol::Depolarising,
                AerosolArg::Preserving => Aerosol::Preserving,
            },
            sun_radius: self.sun_radius.to_radians(),
            ..Options::default()
        }
    }
}

fn row(
    case: &Case,
    cells: Vec<String>,
    field: impl Fn(&str) -> Result<Option<f64>>,
) -> Result<Row> {
    let need = |name: &str| field(name)?.with_context(|| format!("{name} is missing"));
    let query = Query {
        altitude: need("altitude_m")?,
        view_zenith: need("view_zenith_deg")?.to_radians(),
        view_azimuth: need("view_azimuth_deg")?.to_radians(),
        sun_elevation: field("solar_elevation_deg")?
            .unwrap_or(case.sun_elevation_deg)
            .to_radians(),
        distance: field("distance_m")?,
    };
    query.check(case.atmosphere.top())?;
    let albedo = field("albedo")?.unwrap_or(case.albedo);
    ensure!(
        (0.0..=1.0).contains(&albedo),
        "albedo {albedo} is outside 0..1"
    );
    Ok(Row {
        query,
        albedo,
        cells,
    })
}

fn from_csv(path: &Path, case: &Case) -> Result<(Vec<String>, Vec<Row>)> {
    let name = path.display().to_string();
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .from_path(path)
        .with_context(|| name.clone())?;
    let header: Vec<String> = reader.headers()?.iter().map(str::to_owned).collect();
    for column in ["altitude_m", "view_zenith_deg", "view_azimuth_deg"] {
        ensure!(
            header.iter().any(|h| h == column),
            "{name}: no column {column}"
        );
    }
    let mut rows = vec![];
    for (i, record) in reader.records().enumerate() {
        let context = || format!("{name}, row {}", i + 1);
        let cells: Vec<String> = record
            .with_context(context)?
            .iter()
            .map(str::to_owned)
            .collect();
        let field = |column: &str| -> Result<Option<f64>> {
            let cell = header.iter().position(|h| h == column).map(|c| &cells[c]);
            match cell.map(|text| text.trim()) {
                None | Some("") => Ok(None),
                Some(text) => match text.parse::<f64>() {
                    Ok(value) if value.is_finite() => Ok(Some(value)),
                    _ => bail!("{column} \"{text}\" is not a number"),
                },
            }
        };
        rows.push(row(case, cells.clone(), field).with_context(context)?);
    }
    ensure!(!rows.is_empty(), "{name} has no rows");
    Ok((header, rows))
}

/// The lines of sight of the atmosphere file itself.
fn from_case(case: &Case) -> Result<(Vec<String>, Vec<Row>)> {
    const NAMES: [&str; 3] = ["altitude_m", "view_zenith_deg", "view_azimuth_deg"];
    ensure!(
        !case.rows.is_empty(),
        "no rows with lines of sight; give --queries"
    );
    let altitude = if case.column("obs_alt_m").is_some() {
        "obs_alt_m"
    } else {
        "altitude_m"
    };
    let rows = (0..case.rows.len()).map(|i| {
        let field = |name: &str| match name {
            "altitude_m" => case.value(i, altitude).map(Some),
            name if NAMES.contains(&name) => case.value(i, name).map(Some),
            _ => Ok(None),
        };
        let cells = NAMES
            .iter()
            .map(|name| Ok(field(name)?.map_or(String::new(), |v| v.to_string())))
            .collect::<Result<_>>()?;
        row(case, cells, field).with_context(|| format!("rows[{i}]"))
    });
    let rows = rows.collect::<Result<_>>()?;
    Ok((NAMES.map(str::to_owned).to_vec(), rows))
}

fn bar(length: usize, what: &'static str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg} {bar:40} {pos}/{len} {eta}");
    ProgressBar::new(length as u64)
        .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
        .with_message(what)
}

/// Samples per batch of each query, cut down in proportion if they would take too long.
fn plan(tracer: &Tracer, rows: &[Row], args: &Args) -> Result<Vec<usize>> {
    let start = Instant::now();
    let mut samples: Vec<usize> = rows
        .par_iter()
        .enumerate()
        .progress_with(bar(rows.len(), "pilot"))
        .map(|(i, row)| {
            let seed = args.seed.wrapping_add(i as u64);
            tracer.samples_for(&row.query, args.target_error, row.albedo, seed)
        })
        .collect::<Result<_>>()?;
    if let Some(limit) = args.max_seconds {
        ensure!(
            limit.is_finite() && limit > 0.0,
            "--max-seconds {limit} is not positive"
        );
        let pilot = start.elapsed().as_secs_f64();
        let per_sample = pilot / (rows.len() * tracer::PILOT) as f64;
        let needed = per_sample * samples.iter().sum::<usize>() as f64;
        let cut = ((limit - pilot).max(0.05 * limit) / needed).min(1.0);
        for n in &mut samples {
            *n = ((*n as f64 * cut) as usize).max(1);
        }
    }
    Ok(samples)
}

fn trace(tracer: &Tracer, rows: &[Row], samples: &[usize], seed: u64) -> Result<Vec<Estimate>> {
    rows.par_iter()
        .zip(samples)
        .enumerate()
        .progress_with(bar(rows.len(), "trace"))
        .map(|(i, (row, &n))| tracer.estimate(&row.query, n, seed.wrapping_add(i as u64)))
        .collect()
}

fn table(header: &[String], rows: &[Row], estimates: &[Estimate]) -> Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(vec![]);
    let added = ["I", "Q", "U", "I_se", "Q_se", "U_se", "transmittance"];
    writer.write_record(header.iter().map(String::as_str).chain(added))?;
    for (row, estimate) in rows.iter().zip(estimates) {
        let r = estimate.radiance(row.albedo, 0);
        let numbers = r.stokes.into_iter().chain(r.error);
        let numbers = numbers.chain([estimate.transmittance(0)]);
        let text = numbers.map(|x| format!("{x:.9e}"));
        writer.write_record(row.cells.iter().cloned().chain(text))?;
    }
    writer.into_inner().context("CSV output")
}

/// Writes beside `path` and renames, so that nobody ever sees half a file.
fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    let directory = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let context = || format!("cannot write {}", path.display());
    let mut file = tempfile::NamedTempFile::new_in(directory).with_context(context)?;
    file.write_all(bytes).with_context(context)?;
    file.persist(path).with_context(context)?;
    Ok(())
}

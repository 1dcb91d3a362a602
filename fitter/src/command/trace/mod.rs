//! `welkin-fit trace`: a CSV of lines of sight in, the same with radiances out.

mod atmosphere_choice;
mod resumable_rows;
mod rows;

pub use atmosphere_choice::AerosolArg;

use anyhow::{Context, Result, ensure};
use clap::{Args as ClapArgs, ValueEnum};
use resumable_rows::{Answer, Work};
use rows::Row;
use std::path::PathBuf;
use welkin::output::{Target, write};
use welkin_fitter::atmosphere::Atmosphere;
use welkin_fitter::dataset::Store;
use welkin_fitter::tracer::{self, Aerosol, BATCHES, Options, Tracer};

/// Arguments of `trace`.
#[derive(ClapArgs)]
pub struct Args {
    #[command(flatten)]
    source: atmosphere_choice::SourceArgs,
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
    /// Walks per line of sight, a multiple of 32, whatever error comes of them: for pictures, which have many lines of
    /// sight and can bear some noise.
    #[arg(long, conflicts_with_all = ["target_error", "max_seconds"], value_parser = batches)]
    walks: Option<usize>,
    /// Orders of scattering.
    #[arg(long, value_enum, default_value = "all")]
    orders: Orders,
    /// Whether ground shines where it is seen directly.
    #[arg(long, value_enum, default_value = "lit")]
    visible_ground: Ground,
    /// Aerosols: Henyey-Greenstein ones that depolarise or preserve polarisation, or full Mie matrices (real atmosphere
    /// only).
    #[arg(long, value_enum, default_value = "depolarising")]
    aerosol: AerosolArg,
    /// Angular radius of the sun, degrees (0.2667 for the real one); 0 for a parallel beam.
    #[arg(long, default_value_t = 0.0)]
    sun_radius: f64,
    /// Seed of the random numbers.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Output CSV; standard output if absent or -. Rows that are done are kept in FILE.unfinished until all are, and
    /// the same command goes on from there after an interruption.
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

/// Walks per batch of a number of walks.
fn batches(text: &str) -> Result<usize> {
    let walks: usize = text.parse()?;
    ensure!(
        walks > 0 && walks.is_multiple_of(BATCHES),
        "must be a multiple of {BATCHES}"
    );
    Ok(walks / BATCHES)
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let target = Target::new(args.out.as_deref().unwrap_or("-".as_ref()));
    if target != Target::Standard {
        target.check()?;
    }
    let source = args.source.load(args.aerosol)?;
    let (header, rows) = match &args.queries {
        Some(path) => rows::from_csv(path, &source)?,
        None => rows::from_case(&source)?,
    };
    let air = &source.atmosphere;
    let tracer = Tracer::new(air, args.options())?;
    let work = Work {
        tracer: &tracer,
        rows: &rows,
        target_error: args.target_error,
        max_seconds: args.max_seconds,
        samples: args.walks,
        seed: args.seed,
        store: args.store(&target, air, &rows)?,
    };
    let text = table(&header, &rows, air, &work.answers()?)?;
    write(&[(&target, &text)])?;
    work.store.map_or(Ok(()), Store::clear)
}

impl Args {
    /// Where finished rows are kept: beside the output if that is a file, under all that decides about them.
    fn store(&self, target: &Target, air: &Atmosphere, rows: &[Row]) -> Result<Option<Store>> {
        let Target::Path(out) = target else {
            return Ok(None);
        };
        if target.is_stream() {
            return Ok(None);
        }
        let mut folder = out.clone().into_os_string();
        folder.push(".unfinished");
        let key = format!(
            "{} {:?} {} {:?} {:?} {} {rows:?} {air:?}",
            env!("CARGO_PKG_VERSION"),
            self.options(),
            self.target_error,
            self.max_seconds,
            self.walks,
            self.seed,
        );
        Store::open(PathBuf::from(folder), key).map(Some)
    }

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
                AerosolArg::Depolarising | AerosolArg::Mie => Aerosol::Depolarising,
                AerosolArg::Preserving => Aerosol::Preserving,
            },
            sun_radius: self.sun_radius.to_radians(),
            ..Options::default()
        }
    }
}

/// One line per row and wavelength; the wavelength is named where there are several.
fn table(
    header: &[String],
    rows: &[Row],
    air: &Atmosphere,
    answers: &[Vec<Answer>],
) -> Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(vec![]);
    let several = air.wavelengths.len() > 1;
    let wavelength = several.then_some("wavelength_nm");
    let added = ["I", "Q", "U", "I_se", "Q_se", "U_se", "transmittance"];
    let names = header.iter().map(String::as_str);
    writer.write_record(names.chain(wavelength).chain(added))?;
    for (row, answers) in rows.iter().zip(answers) {
        for (nm, answer) in air.wavelengths.iter().zip(answers) {
            let numbers = answer.map(|x| format!("{x:.9e}"));
            let nm = several.then(|| nm.to_string());
            writer.write_record(row.cells.iter().cloned().chain(nm).chain(numbers))?;
        }
    }
    writer.into_inner().context("CSV output")
}

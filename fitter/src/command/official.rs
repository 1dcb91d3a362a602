//! `welkin-fit official`: looks into files of the official model and evaluates them exactly.

use super::rows::numbers;
use anyhow::{Context, Result, ensure};
use clap::Subcommand;
use std::fs::File;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use welkin::output::printable;
use welkin_fitter::official::evaluate::OfficialSky;
use welkin_fitter::official::transmittance::Transmittance;
use welkin_fitter::official::{Observer, OfficialData, SAFETY_ALTITUDE, angles::Frame};

/// Looks into a file of the official model, or evaluates it exactly.
#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Print axes, breaks, and what the file lacks.
    Info {
        /// The file (.dat).
        file: PathBuf,
    },
    /// Print radiance, degree of polarisation and transmittance for rows of conditions.
    Evaluate(Evaluate),
}

/// Evaluates the official formulas as they are, 50 m above the observer included.
#[derive(clap::Args)]
struct Evaluate {
    /// The file (.dat).
    file: PathBuf,
    /// CSV with the columns x,y,z (m), dx,dy,dz, solar_elevation, solar_azimuth (degrees), visibility (km), albedo,
    /// wavelength (nm), distance (m, inf for none), named so in the first line; - for standard input.
    #[arg(long)]
    at: PathBuf,
    /// What observers are raised by, m.
    #[arg(long, default_value_t = SAFETY_ALTITUDE)]
    raised: f64,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    match &args.command {
        Command::Info { file } => info(file),
        Command::Evaluate(args) => evaluate(args),
    }
}

/// Opens a file; errors name it.
pub fn open(file: &Path) -> Result<OfficialData> {
    let name = || printable(&file.display().to_string()).to_string();
    OfficialData::open(file).with_context(name)
}

fn info(file: &Path) -> Result<()> {
    let data = open(file)?;
    let header = data.header();
    let (axes, channels, breaks) = (&header.axes, header.channels, &header.breaks);
    let mut out = io::stdout().lock();
    writeln!(out, "visibilities (km)   {:?}", axes.visibilities)?;
    writeln!(out, "albedos             {:?}", axes.albedos)?;
    writeln!(out, "altitudes (m)       {:?}", axes.altitudes)?;
    writeln!(out, "elevations (deg)    {:?}", axes.elevations)?;
    let ends = [
        channels.start,
        channels.start + channels.count as f64 * channels.width,
    ];
    writeln!(
        out,
        "channels            {} of {} nm, {} to {} nm",
        channels.count, channels.width, ends[0], ends[1]
    )?;
    writeln!(
        out,
        "radiance            {} tables of rank {}, breaks {} sun, {} zenith, {} emphasis",
        header.configurations(),
        breaks.rank,
        breaks.sun.len(),
        breaks.zenith.len(),
        breaks.emphasis.len()
    )?;
    if let Some(shape) = data.transmittance_shape() {
        writeln!(
            out,
            "transmittance       rank {}, {} arcs, {} heights, {} altitudes, {} visibilities",
            shape.rank, shape.arcs, shape.heights, shape.altitudes, shape.visibilities
        )?;
    }
    if let Some(breaks) = data.polarisation() {
        writeln!(
            out,
            "polarisation        rank {}, breaks {} sun, {} zenith",
            breaks.rank,
            breaks.sun.len(),
            breaks.zenith.len()
        )?;
    }
    for note in data.notes() {
        writeln!(out, "note                {note}")?;
    }
    Ok(writeln!(out, "bytes               {}", data.bytes())?)
}

/// A file, or standard input.
fn input(path: &Path) -> Result<Box<dyn Read>> {
    match path.as_os_str() == "-" {
        true => Ok(Box::new(io::stdin())),
        false => {
            let name = || printable(&path.display().to_string()).to_string();
            Ok(Box::new(File::open(path).with_context(name)?))
        }
    }
}

const COLUMNS: usize = 12;
const NAMES: [&str; COLUMNS] = [
    "x",
    "y",
    "z",
    "dx",
    "dy",
    "dz",
    "solar_elevation",
    "solar_azimuth",
    "visibility",
    "albedo",
    "wavelength",
    "distance",
];

fn evaluate(args: &Evaluate) -> Result<()> {
    let data = open(&args.file)?;
    let transmittance = match data.transmittance_shape() {
        Some(_) => Some(data.transmittance()?),
        None => None,
    };
    let name = || printable(&args.at.display().to_string()).to_string();
    let rows = numbers(input(&args.at)?, NAMES).with_context(name)?;
    let mut out = io::BufWriter::new(io::stdout().lock());
    writeln!(out, "radiance,polarisation,transmittance")?;
    for (i, row) in rows.into_iter().enumerate() {
        let answers = answer(&data, transmittance.as_ref(), args.raised, row)
            .with_context(|| format!("row {}", i + 1))?;
        let text = answers.map(|a| a.map_or(String::new(), |a| format!("{a:e}")));
        writeln!(out, "{}", text.join(","))?;
    }
    Ok(out.flush()?)
}

fn answer(
    data: &OfficialData,
    transmittance: Option<&Transmittance>,
    raised: f64,
    row: [f64; COLUMNS],
) -> Result<[Option<f64>; 3]> {
    let [
        x,
        y,
        z,
        dx,
        dy,
        dz,
        elevation,
        azimuth,
        visibility,
        albedo,
        wavelength,
        distance,
    ] = row;
    ensure!(
        wavelength.is_finite(),
        "the wavelength is not a finite number"
    );
    let observer = Observer {
        viewpoint: [x, y, z],
        raised,
        solar_elevation: elevation.to_radians(),
        solar_azimuth: azimuth.to_radians(),
    };
    let (direction, visibility) = ([dx, dy, dz], 1e3 * visibility);
    // Beyond its channels the official code answers 0.
    let Some(channel) = data.header().channels.of(wavelength) else {
        return Ok([Some(0.0), None, None]);
    };
    let radiance = OfficialSky::radiance(&data.sky(&observer, visibility, albedo)?, direction)?;
    let degree = match data.polarisation() {
        Some(_) => Some(
            data.polarised(&observer, visibility, albedo)?
                .degree(direction)?[channel],
        ),
        None => None,
    };
    let through = match transmittance {
        Some(table) => {
            let frame = Frame::new(&observer)?;
            let theta = frame.angles(direction)?.theta;
            Some(table.at(frame.altitude, theta, distance, visibility)?[channel])
        }
        None => None,
    };
    Ok([Some(radiance[channel]), degree, through])
}

//! `welkin-fit import`: other models as welkin files.

use anyhow::{Context, Result, ensure};
use clap::Subcommand;
use std::io::Write;
use std::path::PathBuf;
use welkin::Model;
use welkin::output::{Target, write};
use welkin_fitter::official::import::{Settings, import, left_out};
use welkin_fitter::official::{OfficialData, Selection};

/// Channels that are seen, nm.
const VISIBLE: [f64; 2] = [380.0, 760.0];

/// Turns a file of another model into a welkin file.
#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    model: Source,
}

#[derive(Subcommand)]
enum Source {
    /// A dataset (.dat) of the official code of Wilkie et al. 2021.
    Prague(Prague),
}

#[derive(clap::Args)]
struct Prague {
    /// The dataset.
    file: PathBuf,
    /// Where the model goes; - for standard output.
    #[arg(long)]
    out: PathBuf,
    /// Only channels with centres in this range, nm.
    #[arg(long, value_name = "LOW..HIGH", value_parser = range, conflicts_with = "visible")]
    wavelengths: Option<[f64; 2]>,
    /// As --wavelengths 380..760.
    #[arg(long)]
    visible: bool,
    /// Leave out every second solar elevation, and say how far the model is from the file there.
    #[arg(long)]
    leave_out_elevations: bool,
    /// Components of the radiance.
    #[arg(long)]
    rank: Option<usize>,
    /// Sweeps of the decomposition.
    #[arg(long)]
    sweeps: Option<usize>,
    /// Passes of the refinement in relative radiance.
    #[arg(long)]
    refinements: Option<usize>,
    /// Folder for finished parts of the fit: an import that is broken off goes on from them.
    #[arg(long)]
    work: Option<PathBuf>,
    /// Intervals above the horizon.
    #[arg(long)]
    up_intervals: Option<usize>,
    /// Intervals over azimuth.
    #[arg(long)]
    azimuth_intervals: Option<usize>,
    /// Intervals over solar elevation.
    #[arg(long)]
    elevation_intervals: Option<usize>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let Source::Prague(args) = &args.model;
    let mut settings = Settings::default();
    if let Some(rank) = args.rank {
        ensure!((1..=4096).contains(&rank), "--rank must be 1..=4096");
        settings.options.rank = rank;
    }
    if let Some(azimuth) = args.azimuth_intervals {
        let sound = (1..=1024).contains(&azimuth);
        ensure!(sound, "--azimuth-intervals must be 1..=1024");
        settings.intervals.azimuth = azimuth;
    }
    if let Some(up) = args.up_intervals {
        ensure!((1..=1024).contains(&up), "--up-intervals must be 1..=1024");
        settings.intervals.up = up;
    }
    if let Some(elevation) = args.elevation_intervals {
        let sound = (4..=1024).contains(&elevation);
        ensure!(sound, "--elevation-intervals must be 4..=1024");
        settings.intervals.elevation = Some(elevation);
    }
    settings.options.sweeps = args.sweeps.unwrap_or(settings.options.sweeps);
    ensure!(settings.options.sweeps > 0, "--sweeps must be at least 1");
    settings.work.clone_from(&args.work);
    settings.refinements = args.refinements.unwrap_or(settings.refinements);
    let target = Target::new(&args.out);
    target.check()?;
    let whole = args.channels(super::official::open(&args.file)?)?;
    let part = args.part(&whole)?;
    for note in whole.notes() {
        eprintln!("note: {note}");
    }
    let imported = import(part.as_ref().unwrap_or(&whole), &settings)?;
    write(&[(&target, &imported.bytes)])?;
    let mut report = imported.report;
    if let Some(part) = &part {
        let model = Model::from_bytes(imported.bytes)?;
        report += &left_out::compare(&whole, part, &model, settings.directions)?.report;
    }
    Ok(write!(target.report(), "{report}")?)
}

impl Prague {
    /// The channels that are wanted.
    fn channels(&self, data: OfficialData) -> Result<OfficialData> {
        let wanted = self.wavelengths.or(self.visible.then_some(VISIBLE));
        let Some(range) = wanted else {
            return Ok(data);
        };
        let selection = Selection::all(data.header()).within(data.header(), range);
        let all = data.header().channels;
        data.select(selection).with_context(|| {
            let [first, last] = [all.centre(0), all.centre(all.count - 1)];
            format!("no channel has its centre there, they are from {first} to {last} nm")
        })
    }

    /// Without every second elevation, if that is wanted.
    fn part(&self, whole: &OfficialData) -> Result<Option<OfficialData>> {
        if !self.leave_out_elevations {
            return Ok(None);
        }
        let elevations = whole.header().axes.elevations.len();
        ensure!(
            elevations > 2,
            "--leave-out-elevations: the file has {elevations} of them"
        );
        let selection = whole.selection().clone().every_second_elevation();
        let again = super::official::open(&self.file)?;
        Ok(Some(again.select(selection)?))
    }
}

/// `LOW..HIGH`.
fn range(text: &str) -> Result<[f64; 2], String> {
    let ends = text.split_once("..").and_then(|(low, high)| {
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|v| v.is_finite());
        Some([number(low)?, number(high)?])
    });
    match ends {
        Some([low, high]) if low <= high => Ok([low, high]),
        _ => Err("expected LOW..HIGH, such as 380..760".into()),
    }
}

//! `welkin-fit export`: welkin's sky as files of other models.

use anyhow::{Context, Result, ensure};
use clap::Subcommand;
use std::io::Write;
use std::path::{Path, PathBuf};
use welkin::Model;
use welkin::output::{Target, printable};
use welkin_fitter::official::export::{Plan, export};

/// Turns a welkin file into one of another model.
#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    model: Sink,
}

#[derive(Subcommand)]
enum Sink {
    /// A dataset (.dat) that the official code of Wilkie et al. 2021 and its ports read.
    Prague(Prague),
}

/// Without options the published ground-level grid.
#[derive(clap::Args)]
struct Prague {
    /// The welkin file.
    #[arg(default_value = "models/default.welkin")]
    file: PathBuf,
    /// Where the dataset goes: a file, as it is read back before it appears.
    #[arg(long)]
    out: PathBuf,
    /// Observer altitudes, m, separated by commas.
    #[arg(long, value_delimiter = ',')]
    altitudes: Option<Vec<f64>>,
    /// Visibilities, km.
    #[arg(long, value_delimiter = ',')]
    visibilities: Option<Vec<f64>>,
    /// Ground albedos.
    #[arg(long, value_delimiter = ',')]
    albedos: Option<Vec<f64>>,
    /// Solar elevations, degrees.
    #[arg(long, value_delimiter = ',')]
    elevations: Option<Vec<f64>>,
    /// Lower edge of the first channel, nm.
    #[arg(long)]
    first_wavelength: Option<f64>,
    /// Width of the channels, nm.
    #[arg(long)]
    channel_width: Option<f64>,
    /// Number of channels.
    #[arg(long)]
    channels: Option<usize>,
    /// Components of the radiance.
    #[arg(long)]
    rank: Option<usize>,
    /// Components of the polarisation (5 in the published data); 0 leaves it out.
    #[arg(long, default_value_t = 0)]
    polarisation_rank: usize,
    /// Altitudes of the transmittance, m.
    #[arg(long, value_delimiter = ',')]
    transmittance_altitudes: Option<Vec<f64>>,
    /// What the reader raises observers by, m: 50 in the official code. The sky at an altitude of the file is then that
    /// of the model so much below; with 0 it is that at the altitude itself, as in the published data.
    #[arg(long, default_value_t = 0.0)]
    raised: f64,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let Sink::Prague(args) = &args.model;
    let mut plan = Plan::default();
    let axes = &mut plan.axes;
    let lists = [
        (&mut axes.altitudes, &args.altitudes),
        (&mut axes.visibilities, &args.visibilities),
        (&mut axes.albedos, &args.albedos),
        (&mut axes.elevations, &args.elevations),
        (
            &mut plan.transmittance_altitudes,
            &args.transmittance_altitudes,
        ),
    ];
    for (axis, list) in lists {
        if let Some(list) = list {
            axis.clone_from(list);
        }
    }
    let channels = &mut plan.channels;
    channels.start = args.first_wavelength.unwrap_or(channels.start);
    channels.width = args.channel_width.unwrap_or(channels.width);
    channels.count = args.channels.unwrap_or(channels.count);
    plan.rank = args.rank.unwrap_or(plan.rank);
    plan.polarisation_rank = args.polarisation_rank;
    ensure!(
        (0.0..=1000.0).contains(&args.raised),
        "--raised must be 0..=1000 m"
    );
    plan.raised = args.raised;
    check_target(&args.out, &args.file)?;
    let name = printable(&args.file.display().to_string()).to_string();
    let model = Model::open(&args.file).context(name)?;
    let report = export(&model, &plan, &args.out)?;
    Ok(write!(std::io::stdout(), "{report}")?)
}

/// Refuses what keeps no bytes, and the model itself.
fn check_target(out: &Path, model: &Path) -> Result<()> {
    ensure!(
        !Target::new(out).is_stream(),
        "--out must be a file: a dataset is written in parts and read back before it appears"
    );
    let same = match (out.canonicalize(), model.canonicalize()) {
        (Ok(out), Ok(model)) => out == model,
        // What is not there yet is no model.
        _ => false,
    };
    ensure!(!same, "--out is the model that is read");
    Ok(())
}

//! `welkin-fit make`: a model of one's own air.

use anyhow::{Context, Result, ensure};
use std::io::Write;
use std::path::{Path, PathBuf};
use welkin::output::{Target, printable};
use welkin_fitter::make::{Axis, Bands, Quality, Request, Scene};
use welkin_fitter::recipe::Recipe;

/// Makes a model file from a recipe, traces the air of the scene, and says how far the file is from it.
#[derive(clap::Args)]
pub struct Args {
    /// A TOML file, or the name of a recipe that comes along (see `atmosphere --list`).
    recipe: PathBuf,
    /// The model file; - for standard output.
    #[arg(long)]
    out: PathBuf,
    /// A number of the recipe that the model keeps as an axis, with its values at the nodes: ozone=100,200,300,400,500.
    /// What can be changed: see `atmosphere --help`.
    #[arg(long, value_name = "NAME=VALUE,…")]
    axis: Option<String>,
    /// Lowest and highest observer, m.
    #[arg(long, value_name = "LOW..HIGH", value_parser = range, allow_hyphen_values = true, default_value = "0..99000")]
    altitudes: [f64; 2],
    /// Lowest and highest sun, degrees.
    #[arg(long, value_name = "LOW..HIGH", value_parser = range, allow_hyphen_values = true, default_value = "-12..90")]
    elevations: [f64; 2],
    /// All wavelengths from 300 to 1100 nm, or those that colours are made of.
    #[arg(long, value_enum, default_value = "all")]
    bands: BandsArg,
    /// How finely the air is traced and fitted.
    #[arg(long, value_enum, default_value = "good")]
    quality: QualityArg,
    /// Phase functions of OPAC's particles: as the recipe says, or of spheres, by Lorenz-Mie theory.
    #[arg(long, value_enum, default_value = "recipe")]
    phase: PhaseArg,
    /// Folder for finished work units, from which an interrupted run goes on; without it one named after the recipe, in
    /// `work`.
    #[arg(long)]
    work: Option<PathBuf>,
}

/// First and last wavelength that is solved for every model, nm.
const WAVELENGTHS: [f64; 2] = [300.0, 1100.0];

#[derive(Clone, Copy, clap::ValueEnum)]
enum BandsArg {
    All,
    Rgb,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum PhaseArg {
    Recipe,
    Mie,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum QualityArg {
    Draft,
    Good,
    Best,
}

fn range(text: &str) -> Result<[f64; 2]> {
    let (low, high) = match text.split_once("..") {
        Some(ends) => ends,
        None => (text, text),
    };
    let number = |end: &str| -> Result<f64> {
        let value: f64 = end
            .trim()
            .parse()
            .with_context(|| format!("{end:?} is not a number"))?;
        ensure!(value.is_finite(), "{end:?} is not a number");
        Ok(value)
    };
    Ok([number(low)?, number(high)?])
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let recipe = find(&args.recipe)?;
    let reaches = recipe.reaches(&WAVELENGTHS);
    reaches.with_context(|| args.recipe.display().to_string())?;
    let recipe = match args.phase {
        PhaseArg::Recipe => recipe,
        PhaseArg::Mie => recipe.with_mie()?,
    };
    let work = match &args.work {
        Some(work) => work.clone(),
        None => Path::new("work").join(args.recipe.file_stem().unwrap_or("recipe".as_ref())),
    };
    let axis = args.axis.as_deref();
    let axis = axis.map(|text| Axis::parse(&recipe, text)).transpose()?;
    let request = Request {
        recipe,
        axis,
        scene: Scene {
            altitudes: args.altitudes,
            elevations: args.elevations.map(f64::to_radians),
            bands: match args.bands {
                BandsArg::All => Bands::All,
                BandsArg::Rgb => Bands::Rgb,
            },
        },
        quality: match args.quality {
            QualityArg::Draft => Quality::Draft,
            QualityArg::Good => Quality::Good,
            QualityArg::Best => Quality::Best,
        },
    };
    for caution in request.recipe.cautions()? {
        eprintln!("mind: {}", printable(&caution));
    }
    let target = Target::new(&args.out);
    eprintln!("{}", request.estimate()?);
    let report = request.make(&work, &target)?;
    Ok(write!(target.report(), "{report}")?)
}

/// The recipe of a file or of that name.
pub fn find(path: &Path) -> Result<Recipe> {
    let named = path.to_str().and_then(Recipe::named);
    match named {
        Some(recipe) if !path.exists() => Ok(recipe),
        _ => Recipe::read(path),
    }
}

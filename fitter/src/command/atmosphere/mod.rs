//! `welkin-fit atmosphere`: air as a file, for other codes and for `trace`; and what a recipe makes of it.

mod curves;
pub mod draw;
mod summary;

use super::variation::VariationArgs;
use anyhow::{Context, Result, bail, ensure};
use clap::Args as ClapArgs;
use std::path::{Path, PathBuf};
use welkin::output::{Target, check, write};
use welkin_fitter::atmosphere::json::Case;
use welkin_fitter::atmosphere::{Monochromatic, Particles, Variation, real_varied};
use welkin_fitter::recipe::Recipe;

/// Arguments of `atmosphere`.
#[derive(ClapArgs)]
pub struct Args {
    /// A recipe: a TOML file, or the name of one that comes with the program; says what is in it.
    recipe: Option<String>,
    /// The recipes that come with the program, with what they make; as CSV with --out.
    #[arg(long, conflicts_with_all = ["recipe", "visibility"])]
    list: bool,
    /// Print the recipe of that name itself, to start an own one from.
    #[arg(long, requires = "recipe", conflicts_with_all = ["plot", "out", "set"])]
    toml: bool,
    /// Change one number of the recipe, as ozone=100 or layers.dust.optical_depth=0.3.
    #[arg(long, value_name = "PARAMETER=VALUE", requires = "recipe")]
    set: Vec<String>,
    /// Draw profiles, optical depths and phase functions of the recipe; an SVG.
    #[arg(long, value_name = "FILE.svg", requires = "recipe")]
    plot: Option<PathBuf>,
    /// Visibility of the model's own air, km (20..131.8).
    #[arg(long, required_unless_present_any = ["recipe", "list"], conflicts_with = "recipe")]
    visibility: Option<f64>,
    /// Wavelengths, nm (300..2500), separated by commas.
    #[arg(long, value_delimiter = ',', default_value = "550")]
    wavelengths: Vec<f64>,
    #[command(flatten)]
    variation: VariationArgs,
    /// Albedo of the ground that goes into the file; that of the recipe, or 0.2.
    #[arg(long)]
    albedo: Option<f64>,
    /// Sun elevation that goes into the file, degrees.
    #[arg(long, default_value_t = 20.0)]
    solar_elevation: f64,
    /// Output JSON; `-` for standard output, which is where it goes without a recipe.
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    if args.list {
        return match &args.out {
            Some(out) => Ok(write(&[(&Target::new(out), &summary::csv()?)])?),
            None => say(&summary::list()?),
        };
    }
    match &args.recipe {
        Some(name) if args.toml => {
            let text = Recipe::text(name);
            say(text.with_context(|| format!("no recipe {name:?} comes with the program"))?)
        }
        Some(name) => of_recipe(args, name),
        None => of_the_model(args),
    }
}

/// The model's own air.
fn of_the_model(args: &Args) -> Result<()> {
    let variation = args.variation.variation();
    let visibility = args
        .visibility
        .context("--visibility or a recipe is needed")?;
    let case = Case {
        id: format!("real air, visibility {visibility} km{variation}"),
        atmosphere: real_varied(
            1000.0 * visibility,
            &args.wavelengths,
            Particles::HenyeyGreenstein,
            variation,
        )?,
        sun_elevation_deg: args.solar_elevation,
        albedo: args.albedo.unwrap_or(0.2),
        columns: vec![],
        rows: vec![],
    };
    let target = args.out.as_deref().unwrap_or("-".as_ref());
    write_case(&case, target)
}

fn of_recipe(args: &Args, name: &str) -> Result<()> {
    ensure!(
        args.variation.variation() == Variation::default(),
        "--ozone and --aerosol-profile change the model's own air; of a recipe, --set ozone=DU does"
    );
    if let Some(plot) = &args.plot {
        ensure!(
            plot.extension().is_some_and(|e| e == "svg"),
            "{}: plots are SVG files",
            plot.display()
        );
        check(plot)?;
    }
    let mut recipe = named_or_read(name)?;
    for set in &args.set {
        let parts = set
            .split_once('=')
            .with_context(|| format!("--set {set}: no ="))?;
        let value = parts
            .1
            .parse()
            .with_context(|| format!("--set {set}: no number"))?;
        recipe = recipe.with(parts.0, value)?;
    }
    if let Some(plot) = &args.plot {
        let svg = draw::svg(recipe.name(), &curves::panels(&recipe)?)?;
        write(&[(&Target::new(plot), svg.as_bytes())])?;
    }
    match &args.out {
        Some(out) => write_case(&case_of(args, &recipe).context(name.to_owned())?, out),
        None => say(&summary::of(&recipe).context(name.to_owned())?),
    }
}

fn named_or_read(name: &str) -> Result<Recipe> {
    if let Some(recipe) = Recipe::named(name) {
        return Ok(recipe);
    }
    let path = Path::new(name);
    if !path.exists() && path.extension().is_none() {
        let names: Vec<&str> = Recipe::names().collect();
        bail!(
            "no recipe {name:?}, neither a file nor one of {}",
            names.join(", ")
        );
    }
    Recipe::read(path)
}

fn case_of(args: &Args, recipe: &Recipe) -> Result<Case> {
    let mut wavelengths = args.wavelengths.clone();
    wavelengths.dedup();
    ensure!(
        wavelengths.len() == args.wavelengths.len() && wavelengths.is_sorted(),
        "wavelengths must increase"
    );
    let lights: Vec<_> = wavelengths
        .iter()
        .map(|&w| Monochromatic::beside_lines(w))
        .collect();
    let surface = recipe.surface()?;
    let mean = |albedo: &dyn Fn(f64) -> f64| {
        wavelengths.iter().map(|&w| albedo(w)).sum::<f64>() / wavelengths.len() as f64
    };
    let albedo = surface.map_or(0.2, |surface| mean(&|w| surface.at(w)));
    Ok(Case {
        id: recipe.name().to_owned(),
        atmosphere: recipe.air(&lights)?,
        sun_elevation_deg: args.solar_elevation,
        albedo: args.albedo.unwrap_or(albedo),
        columns: vec![],
        rows: vec![],
    })
}

fn write_case(case: &Case, out: &Path) -> Result<()> {
    let text = case.to_json()? + "\n";
    Ok(write(&[(&Target::new(out), text.as_bytes())])?)
}

/// To standard output.
fn say(text: &str) -> Result<()> {
    Ok(write(&[(&Target::Standard, text.as_bytes())])?)
}

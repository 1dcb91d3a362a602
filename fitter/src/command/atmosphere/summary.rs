//! What a recipe makes, in a few lines.

use anyhow::Result;
use std::fmt::Write;
use welkin_fitter::atmosphere::Monochromatic;
use welkin_fitter::recipe::Recipe;

const WAVELENGTHS: [f64; 4] = [400.0, 550.0, 700.0, 1000.0];
const GREEN: usize = 1;

/// Text about one.
pub fn of(recipe: &Recipe) -> Result<String> {
    let mut out = String::new();
    writeln!(out, "{}", recipe.name())?;
    if !recipe.description().is_empty() {
        writeln!(out, "{}", recipe.description())?;
    }
    writeln!(
        out,
        "\nvisibility {:.1} km, ozone {:.0} DU, water {:.2} cm, planet {:.0} km, sun {} AU",
        recipe.visibility()? / 1000.0,
        recipe.ozone()?,
        recipe.water()?,
        recipe.planet_radius() / 1000.0,
        recipe.sun_distance()
    )?;
    if let Some(surface) = recipe.surface()? {
        let at = WAVELENGTHS.map(|w| format!("{:.2}", surface.at(w)));
        writeln!(out, "ground albedo {} at 400, 550, 700 and 1000 nm", at.join(", "))?;
    }
    depths(recipe, &mut out)?;
    for caution in recipe.cautions()? {
        writeln!(out, "\nmind: {caution}")?;
    }
    Ok(out)
}

fn depths(recipe: &Recipe, out: &mut String) -> Result<()> {
    let names = WAVELENGTHS.map(|w| format!("{w:>8} nm"));
    writeln!(out, "\n{:<24}{}", "vertical optical depth", names.join(""))?;
    let mut line = |name: &str, depths: &[f64]| {
        let depths: String = depths.iter().map(|d| format!("{d:>11.4}")).collect();
        writeln!(out, "{name:<24}{depths}")
    };
    let air = recipe.air(&WAVELENGTHS.map(Monochromatic::beside_lines))?;
    let gas = |k: usize| -> Vec<f64> {
        (0..WAVELENGTHS.len()).map(|w| air.vertical_optical_depth(k, w)).collect()
    };
    line("molecules", &gas(0))?;
    let mut ozone = vec![0.0; WAVELENGTHS.len()];
    for (k, constituent) in air.constituents.iter().enumerate() {
        if constituent.name.starts_with("ozone") {
            ozone.iter_mut().zip(gas(k)).for_each(|(sum, depth)| *sum += depth);
        }
    }
    line("ozone", &ozone)?;
    let layers = recipe.layers(&WAVELENGTHS)?;
    let mut all = vec![0.0; WAVELENGTHS.len()];
    for layer in &layers {
        line(&layer.name, &layer.optical_depth)?;
        all.iter_mut().zip(&layer.optical_depth).for_each(|(sum, depth)| *sum += depth);
    }
    line("all particles", &all)?;
    Ok(())
}

/// A table of those that come with the program.
pub fn list() -> Result<String> {
    let mut out = String::new();
    writeln!(
        out,
        "{:<22}{:>14}{:>22}{:>13}{:>10}{:>10}",
        "recipe", "visibility, km", "extinction, 1/km", "depth", "ozone, DU", "water, cm"
    )?;
    for name in Recipe::names() {
        let recipe = Recipe::named(name).expect("a name of the list");
        let layers = recipe.layers(&WAVELENGTHS)?;
        let depth: f64 = layers.iter().map(|layer| layer.optical_depth[GREEN]).sum();
        let (nodes, particles) = recipe.particles(&[WAVELENGTHS[GREEN]])?;
        debug_assert_eq!(nodes[0], 0.0);
        let ground: f64 = particles.iter().map(|c| c.profile[0] * c.extinction[0]).sum();
        writeln!(
            out,
            "{name:<22}{:>14.1}{:>22.4}{depth:>13.4}{:>10.0}{:>10.2}",
            recipe.visibility()? / 1000.0,
            ground * 1000.0,
            recipe.ozone()?,
            recipe.water()?
        )?;
    }
    writeln!(out, "\nExtinction at the ground and vertical optical depth are those of particles at 550 nm.")?;
    Ok(out)
}

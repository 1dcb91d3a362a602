//! What a recipe makes, in a few lines.

use anyhow::Result;
use std::fmt::Write;
use welkin::output::printable;
use welkin_fitter::atmosphere::Monochromatic;
use welkin_fitter::recipe::{OPAC, OPAC_HUMIDITY, Published, Recipe};

const WAVELENGTHS: [f64; 4] = [400.0, 550.0, 700.0, 1000.0];
const GREEN: usize = 1;

/// Text about one.
pub fn of(recipe: &Recipe) -> Result<String> {
    let mut out = String::new();
    writeln!(out, "{}", printable(recipe.name()))?;
    if !recipe.description().is_empty() {
        writeln!(out, "{}", printable(recipe.description()))?;
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
        writeln!(
            out,
            "ground albedo {} at 400, 550, 700 and 1000 nm",
            at.join(", ")
        )?;
    }
    depths(recipe, &mut out)?;
    for caution in recipe.cautions()? {
        writeln!(out, "\nmind: {}", printable(&caution))?;
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
        (0..WAVELENGTHS.len())
            .map(|w| air.vertical_optical_depth(k, w))
            .collect()
    };
    line("molecules", &gas(0))?;
    let mut ozone = vec![0.0; WAVELENGTHS.len()];
    for (k, constituent) in air.constituents.iter().enumerate() {
        if constituent.name.starts_with("ozone") {
            ozone
                .iter_mut()
                .zip(gas(k))
                .for_each(|(sum, depth)| *sum += depth);
        }
    }
    line("ozone", &ozone)?;
    let layers = recipe.layers(&WAVELENGTHS)?;
    let mut all = vec![0.0; WAVELENGTHS.len()];
    for layer in &layers {
        line(&printable(&layer.name), &layer.optical_depth)?;
        all.iter_mut()
            .zip(&layer.optical_depth)
            .for_each(|(sum, depth)| *sum += depth);
    }
    line("all particles", &all)?;
    Ok(())
}

/// A row for each recipe that comes with the program, after the names of the columns.
pub fn rows() -> Result<Vec<[String; 8]>> {
    let names = [
        "recipe",
        "visibility, km",
        "ozone, DU",
        "water, cm",
        "extinction, 1/km",
        "OPAC",
        "optical depth",
        "OPAC",
    ];
    let mut out = vec![names.map(str::to_owned)];
    for name in Recipe::names() {
        let recipe = Recipe::named(name).expect("a name of the list");
        let opac = OPAC.iter().find(|opac| opac.name == name);
        let as_opac = match opac {
            Some(_) => recipe.with("humidity", OPAC_HUMIDITY)?,
            None => recipe.clone(),
        };
        let [ground, depth] = green(&as_opac)?;
        let published = |of: fn(&Published) -> f64| {
            opac.map_or(String::new(), |opac| format!("{:.3}", of(opac)))
        };
        out.push([
            name.to_owned(),
            format!("{:.1}", recipe.visibility()? / 1000.0),
            format!("{:.0}", recipe.ozone()?),
            format!("{:.2}", recipe.water()?),
            format!("{ground:.4}"),
            published(|opac| opac.extinction),
            format!("{depth:.4}"),
            published(|opac| opac.optical_depth),
        ]);
    }
    Ok(out)
}

/// Extinction at the ground, 1/km, and optical depth of the particles.
fn green(recipe: &Recipe) -> Result<[f64; 2]> {
    let green = WAVELENGTHS[GREEN];
    let depth = recipe
        .layers(&[green])?
        .iter()
        .map(|layer| layer.optical_depth[0])
        .sum();
    let (_, particles) = recipe.particles(&[green])?;
    let ground: f64 = particles
        .iter()
        .map(|c| c.profile[0] * c.extinction[0])
        .sum();
    Ok([1000.0 * ground, depth])
}

/// What the columns are.
const NOTES: [&str; 3] = [
    "Printed by `welkin-fit atmosphere --list`: extinction at the ground and vertical optical depth are those of",
    "particles at 550 nm, after OPAC at 80 % humidity beside what Hess et al. 1998 publish (Tables 4 and 5); visibility,",
    "ozone and water as the recipes have them.",
];

/// The table for people.
pub fn list() -> Result<String> {
    let mut out = String::new();
    for row in rows()? {
        let cells: String = row[1..].iter().map(|cell| format!("{cell:>18}")).collect();
        writeln!(out, "{:<22}{}", row[0], cells)?;
    }
    writeln!(out, "\n{}", NOTES.join("\n"))?;
    Ok(out)
}

/// The table as CSV.
pub fn csv() -> Result<Vec<u8>> {
    let mut out: Vec<u8> = NOTES
        .map(|note| format!("# {note}\n"))
        .concat()
        .into_bytes();
    let mut writer = csv::Writer::from_writer(&mut out);
    for row in rows()? {
        writer.write_record(row)?;
    }
    writer.flush()?;
    drop(writer);
    Ok(out)
}

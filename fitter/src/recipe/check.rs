//! Numbers within the ranges that make sense, and fields that go together.

use super::error::{RecipeError, field};
use super::file::{Aerosol, File, Gases, Ground, Layer, Planet, Sun};

type Checked = Result<(), RecipeError>;

/// Optical depths and extinctions beyond this are a wall, not air.
const MOST_DEPTH: f64 = 20.0;
/// Visibilities, km: of the thickest fog that is still lit through, and beyond that of air without particles.
const VISIBILITIES: [f64; 2] = [0.2, 400.0];
/// Top of the atmosphere, km.
const TOP: f64 = 100.0;
/// Narrowest edge of a layer, km.
const SHARPEST: f64 = 0.01;

/// Says which field is wrong.
pub fn check(file: &File) -> Checked {
    planet(&file.planet)?;
    gases(&file.gases)?;
    aerosol(&file.aerosol)?;
    for (name, layer) in &file.layers {
        layer_fields(&format!("layers.{name}"), layer)?;
    }
    one_visibility(file)?;
    ground(&file.ground)?;
    sun(&file.sun)
}

fn within(place: &str, value: f64, least: f64, most: f64) -> Checked {
    if !(least..=most).contains(&value) {
        return Err(field(
            place,
            format!("{value:?} is outside {least}..{most}"),
        ));
    }
    Ok(())
}

fn maybe(place: &str, value: Option<f64>, least: f64, most: f64) -> Checked {
    value.map_or(Ok(()), |value| within(place, value, least, most))
}

/// At most one of the fields is given.
fn at_most_one(place: &str, given: &[(&str, bool)]) -> Checked {
    let names: Vec<&str> = given.iter().filter(|g| g.1).map(|g| g.0).collect();
    if names.len() > 1 {
        return Err(field(
            place,
            format!("{} exclude each other", names.join(" and ")),
        ));
    }
    Ok(())
}

fn planet(planet: &Planet) -> Checked {
    within("planet.radius_km", planet.radius_km, 500.0, 100_000.0)?;
    within("planet.gravity_m_s2", planet.gravity_m_s2, 0.1, 100.0)
}

fn gases(gases: &Gases) -> Checked {
    let given = [
        ("standard", gases.standard.is_some()),
        ("table", gases.table.is_some()),
        ("isothermal", gases.isothermal.is_some()),
    ];
    at_most_one("gases", &given)?;
    maybe(
        "gases.surface_pressure_hpa",
        gases.surface_pressure_hpa,
        0.01,
        2000.0,
    )?;
    maybe("gases.ozone_du", gases.ozone_du, 0.0, 2000.0)?;
    maybe("gases.water_cm", gases.water_cm, 0.0, 20.0)?;
    if let Some(isothermal) = &gases.isothermal {
        within(
            "gases.isothermal.temperature_k",
            isothermal.temperature_k,
            50.0,
            1000.0,
        )?;
        if gases.surface_pressure_hpa.is_none() {
            return Err(field("gases.isothermal", "surface_pressure_hpa is missing"));
        }
        for (name, given) in [("ozone_du", gases.ozone_du), ("water_cm", gases.water_cm)] {
            if given.is_some_and(|value| value > 0.0) {
                return Err(field(
                    format!("gases.{name}"),
                    "an isothermal gas has no profile of it",
                ));
            }
        }
    }
    Ok(())
}

fn aerosol(aerosol: &Aerosol) -> Checked {
    maybe(
        "aerosol.humidity_percent",
        aerosol.humidity_percent,
        0.0,
        99.0,
    )?;
    maybe(
        "aerosol.optical_depth_550",
        aerosol.optical_depth_550,
        0.0,
        MOST_DEPTH,
    )?;
    let [least, most] = VISIBILITIES;
    maybe("aerosol.visibility_km", aerosol.visibility_km, least, most)?;
    let given = [
        ("optical_depth_550", aerosol.optical_depth_550.is_some()),
        ("visibility_km", aerosol.visibility_km.is_some()),
    ];
    at_most_one("aerosol", &given)
}

fn layer_fields(place: &str, layer: &Layer) -> Checked {
    shape(place, layer)?;
    content(place, layer)?;
    amount(place, layer)
}

fn shape(place: &str, layer: &Layer) -> Checked {
    let name = |field: &str| format!("{place}.{field}");
    let bottom = layer.bottom_km.unwrap_or(0.0);
    within(&name("bottom_km"), bottom, 0.0, TOP)?;
    let top = layer.top_km.unwrap_or(TOP);
    within(&name("top_km"), top, 0.0, TOP)?;
    if bottom >= top {
        return Err(field(
            name("top_km"),
            format!("{top:?} is not above bottom_km = {bottom:?}"),
        ));
    }
    maybe(
        &name("scale_height_km"),
        layer.scale_height_km,
        0.05,
        1000.0,
    )?;
    let thickness = top - bottom;
    maybe(
        &name("bottom_edge_km"),
        layer.bottom_edge_km,
        SHARPEST,
        thickness,
    )?;
    maybe(&name("top_edge_km"), layer.top_edge_km, SHARPEST, thickness)?;
    let given = [
        ("profile", layer.profile.is_some()),
        ("scale_height_km", layer.scale_height_km.is_some()),
    ];
    at_most_one(place, &given)
}

fn content(place: &str, layer: &Layer) -> Checked {
    let given = [
        ("mixture", layer.mixture.is_some()),
        ("particles_per_cm3", layer.particles_per_cm3.is_some()),
        ("optics", layer.optics.is_some()),
    ];
    at_most_one(place, &given)?;
    if !given.iter().any(|g| g.1) {
        let what = "one of mixture, particles_per_cm3 and optics is needed";
        return Err(field(place, what));
    }
    maybe(
        &format!("{place}.humidity_percent"),
        layer.humidity_percent,
        0.0,
        99.0,
    )?;
    if layer
        .particles_per_cm3
        .as_ref()
        .is_some_and(|all| all.is_empty())
    {
        let what = "names no particles, such as { waso = 7000 }";
        return Err(field(format!("{place}.particles_per_cm3"), what));
    }
    for (component, number) in layer.particles_per_cm3.iter().flatten() {
        let name = format!("{place}.particles_per_cm3.{component}");
        within(&name, *number, 0.0, 1e9)?;
    }
    if layer.optics.is_none() && layer.phase.is_some() {
        return Err(field(format!("{place}.phase"), "goes with optics only"));
    }
    if layer.optics.is_some() && layer.humidity_percent.is_some() {
        return Err(field(
            format!("{place}.humidity_percent"),
            "own optics have none",
        ));
    }
    Ok(())
}

fn amount(place: &str, layer: &Layer) -> Checked {
    let name = |field: &str| format!("{place}.{field}");
    maybe(
        &name("optical_depth_550"),
        layer.optical_depth_550,
        0.0,
        MOST_DEPTH,
    )?;
    maybe(
        &name("extinction_550_per_km"),
        layer.extinction_550_per_km,
        0.0,
        MOST_DEPTH,
    )?;
    let [least, most] = VISIBILITIES;
    maybe(&name("visibility_km"), layer.visibility_km, least, most)?;
    let given = [
        ("optical_depth_550", layer.optical_depth_550.is_some()),
        (
            "extinction_550_per_km",
            layer.extinction_550_per_km.is_some(),
        ),
        ("visibility_km", layer.visibility_km.is_some()),
    ];
    at_most_one(place, &given)?;
    if layer.optics.is_some() && !given.iter().any(|g| g.1) {
        let what =
            "own optics need one of optical_depth_550, extinction_550_per_km and visibility_km";
        return Err(field(place, what));
    }
    Ok(())
}

/// One number cannot fix two amounts.
fn one_visibility(file: &File) -> Checked {
    let with = file
        .layers
        .iter()
        .filter(|(_, layer)| layer.visibility_km.is_some());
    let names: Vec<&String> = with.map(|(name, _)| name).collect();
    let scaled = file.aerosol.visibility_km.is_some() || file.aerosol.optical_depth_550.is_some();
    match names[..] {
        [first, ..] if names.len() > 1 || scaled => Err(field(
            format!("layers.{first}.visibility_km"),
            "another field fixes the amount at the ground, too",
        )),
        _ => Ok(()),
    }
}

fn ground(ground: &Ground) -> Checked {
    let given = [
        ("surface", ground.surface.is_some()),
        ("albedo", ground.albedo.is_some()),
        ("table", ground.table.is_some()),
    ];
    at_most_one("ground", &given)?;
    maybe("ground.albedo", ground.albedo, 0.0, 1.0)
}

fn sun(sun: &Sun) -> Checked {
    within("sun.distance_au", sun.distance_au, 0.05, 100.0)
}

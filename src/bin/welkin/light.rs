//! `welkin light`: what sun and sky give a renderer besides the picture of the sky.

use std::io::{self, Write};

use serde_json::{Value, json};
use welkin::Model;

use crate::Source;
use crate::failure::Result;
use crate::irradiance::{Light, Spectrum};
use crate::parameter;
use crate::scene::Scene;

#[derive(clap::Args)]
pub struct Options {
    #[command(flatten)]
    source: Source,
    #[command(flatten)]
    scene: Scene,
    /// Write JSON.
    #[arg(long)]
    json: bool,
}

pub fn run(options: &Options) -> Result<()> {
    let model = options.scene.over_ground(options.source.open()?);
    parameter::required(&model, options.scene.has_visibility())?;
    let conditions = options.scene.conditions(&model)?;
    let light = Light::new(&model, &conditions)?;
    let mut out = io::stdout().lock();
    match options.json {
        true => writeln!(out, "{:#}", describe(&model, &light)?)?,
        false => table(&mut out, options, &model, &light)?,
    }
    Ok(())
}

/// Name, spectrum, unit of its colours and of the spectrum.
type Row<'a> = (&'static str, &'a Spectrum, [&'static str; 2]);

const IRRADIANCE: [&str; 2] = ["lx", "W m^-2 nm^-1"];
const RADIANCE: [&str; 2] = ["cd m^-2", "W m^-2 sr^-1 nm^-1"];

fn rows(light: &Light) -> [Row<'_>; 6] {
    [
        ("direct_normal", &light.direct_normal, IRRADIANCE),
        ("direct_horizontal", &light.direct_horizontal, IRRADIANCE),
        ("diffuse_horizontal", &light.diffuse_horizontal, IRRADIANCE),
        ("global_horizontal", &light.global_horizontal, IRRADIANCE),
        ("sun_disc_mean", &light.disc_mean, RADIANCE),
        ("sun_disc_centre", &light.disc_centre, RADIANCE),
    ]
}

fn table(out: &mut impl Write, options: &Options, model: &Model, light: &Light) -> Result<()> {
    let conditions = &light.conditions;
    writeln!(out, "model               {}", options.source.name())?;
    writeln!(
        out,
        "sun                 elevation {:.2}°, azimuth {:.2}°; its disc {:.4}° wide, {:.4e} sr",
        conditions.solar_elevation.to_degrees(),
        conditions.solar_azimuth.to_degrees(),
        2.0 * welkin::SOLAR_ANGULAR_RADIUS.to_degrees(),
        light.solid_angle,
    )?;
    writeln!(
        out,
        "conditions          {}, albedo {}, altitude {} m",
        parameter::air(model, conditions.visibility)?,
        parameter::rounded(conditions.albedo),
        conditions.altitude,
    )?;
    for (name, spectrum, [unit, _]) in rows(light) {
        let (luminous, [r, g, b]) = (spectrum.luminous(model), spectrum.linear_srgb(model));
        let name = name.replace('_', " ");
        writeln!(
            out,
            "{name:19} {luminous:.5e} {unit:7}  linear sRGB {r:.5e} {g:.5e} {b:.5e} {unit}"
        )?;
    }
    writeln!(
        out,
        "for watts           divide by 683 (lumens per watt), see docs/environment-maps.md"
    )?;
    Ok(())
}

fn describe(model: &Model, light: &Light) -> Result<Value> {
    let conditions = &light.conditions;
    let mut out = json!({
        "conditions": {
            "solar_elevation_deg": conditions.solar_elevation.to_degrees(),
            "solar_azimuth_deg": conditions.solar_azimuth.to_degrees(),
            "visibility_km": conditions.visibility / 1e3,
            "albedo": conditions.albedo,
            "altitude_m": conditions.altitude,
        },
        "sun": {
            "direction": conditions.sun_direction(),
            "angular_diameter_deg": 2.0 * welkin::SOLAR_ANGULAR_RADIUS.to_degrees(),
            "solid_angle_sr": light.solid_angle,
        },
        "wavelengths_nm": model.wavelengths(),
    });
    for (name, spectrum, [unit, spectral_unit]) in rows(light) {
        out[name] = json!({
            "luminous": spectrum.luminous(model),
            "linear_srgb": spectrum.linear_srgb(model),
            "unit": unit,
            "spectral": spectrum.0,
            "spectral_unit": spectral_unit,
        });
    }
    if let Some((axis, value)) = parameter::value(model, conditions.visibility)? {
        out["conditions"]["parameter"] = json!({
            "name": axis.name(),
            "value": value,
            "unit": axis.unit(),
        });
    }
    Ok(out)
}

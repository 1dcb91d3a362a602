//! The two lights of a scene: the map of the sky around it and the sun.

use std::f64::consts::PI;
use std::fmt::Write;

use welkin::{ColourSpace, Conditions, Model, SOLAR_ANGULAR_RADIUS};

use crate::exposure;
use crate::failure::{Result, plain};
use crate::irradiance::Light;
use crate::parameter;

use super::axes::Up;

/// What a scene says.
pub struct Lights {
    /// Name of the file of the map, in the folder of the scene.
    pub picture: String,
    /// Height of the map, pixels.
    pub size: usize,
    pub up: Up,
    /// Of the colours.
    pub space: ColourSpace,
    /// Its name at the Color Interop Forum.
    pub space_id: &'static str,
    /// None where it is in the map or has set.
    pub sun: Option<Sun>,
    /// Exposure value at ISO 100 of which white is 1; without, values are cd m⁻² and lx.
    pub exposure: Option<f64>,
    /// What is shown, for people.
    pub about: Vec<String>,
}

/// The sun as a light of its own.
pub struct Sun {
    pub conditions: Conditions,
    /// On a plane that faces it, lx.
    pub illuminance: f32,
    /// Linear, of luminance 1 unless out of the gamut.
    pub colour: [f32; 3],
}

impl Lights {
    /// The factor of all light.
    pub fn scale(&self) -> f64 {
        self.exposure
            .map_or(1.0, |value| 1.0 / exposure::white(value))
    }

    /// The same in stops.
    pub fn stops(&self) -> f64 {
        self.scale().log2()
    }

    /// Comment lines for the top of a scene; all formats begin them with `#`.
    pub fn comments(&self) -> String {
        let mut text = String::new();
        for line in &self.about {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "# {line}");
        }
        let unit = match self.exposure {
            None => "# radiance in cd/m^2, irradiance in lx".to_owned(),
            Some(value) => format!(
                "# 1 is {} cd/m^2, white at EV {value}",
                exposure::white(value)
            ),
        };
        text + &unit + "\n"
    }
}

impl Sun {
    /// None if it does not shine.
    pub fn new(model: &Model, conditions: &Conditions, space: ColourSpace) -> Result<Option<Self>> {
        let light = Light::new(model, conditions)?;
        let irradiance = &light.direct_normal;
        let illuminance = irradiance.luminous(model);
        let rgb = irradiance.linear_srgb(model).map(|v| v / illuminance);
        let sun = Self {
            conditions: light.conditions,
            illuminance,
            // Renderers take no negative light, which a setting sun has some of outside the gamut.
            colour: space.from_linear_srgb(rgb).map(|v| v.max(0.0)),
        };
        Ok((illuminance > 0.0).then_some(sun))
    }

    /// Unit vector to it.
    pub fn direction(&self, up: Up) -> [f64; 3] {
        let c = &self.conditions;
        let ((z, level), (y, x)) = (c.solar_elevation.sin_cos(), c.solar_azimuth.sin_cos());
        up.turned([level * x, level * y, z])
    }

    /// Diameter of the disc, degrees.
    pub fn angle() -> f64 {
        2.0 * SOLAR_ANGULAR_RADIUS.to_degrees()
    }

    /// Luminance (cd m⁻²) of a uniform disc that gives the illuminance: of a plane that faces it, each part counts with
    /// its cosine.
    pub fn luminance(&self) -> f32 {
        let sine = SOLAR_ANGULAR_RADIUS.sin();
        let luminance = f64::from(self.illuminance) / (PI * sine * sine);
        // Absurd files overflow.
        luminance.min(f32::MAX.into()) as f32
    }
}

/// What a sky is of, for people.
pub fn about(model: &Model, conditions: &Conditions, name: &str) -> Result<Vec<String>> {
    let line = format!(
        "welkin {}: sun at elevation {}, azimuth {} degrees; {}, albedo {}, altitude {} m",
        env!("CARGO_PKG_VERSION"),
        rounded(conditions.solar_elevation.to_degrees()),
        rounded(conditions.solar_azimuth.to_degrees()),
        parameter::air(model, conditions.visibility)?,
        plain(parameter::rounded(conditions.albedo)),
        plain(conditions.altitude),
    );
    Ok(vec![line, format!("model: {name}")])
}

/// Without the digits that the conversion of units makes up.
fn rounded(value: f64) -> String {
    plain((value * 1e9).round() / 1e9)
}

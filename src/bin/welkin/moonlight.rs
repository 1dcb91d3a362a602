//! The moon, as arguments: a second light beside the sun, or the only one.

use welkin::{Conditions, Model, Moon};

use crate::about::About;
use crate::failure::{Failure, Result};

#[derive(clap::Args)]
#[group(skip)]
pub struct Options {
    /// Geometric elevation of the moon's centre, degrees: adds moonlight. The sun may then be below the range of the
    /// model, where it adds nothing.
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, conflicts_with_all = ["stokes", "terrain", "sensor"])]
    moon_elevation: Option<f64>,
    /// Azimuth of the moon, degrees, counter-clockwise from +x seen from above.
    #[arg(
        long,
        default_value_t = 0.0,
        value_name = "DEG",
        allow_hyphen_values = true,
        requires = "moon_elevation"
    )]
    moon_azimuth: f64,
    /// Phase angle of the moon, degrees: 0 is full, 90 half, 180 new; 1.55, as full as without an
    /// eclipse, if absent.
    #[arg(
        long,
        default_value_t = 1.55,
        value_name = "DEG",
        requires = "moon_elevation"
    )]
    moon_phase: f64,
}

/// A model under one of the lights, and its conditions.
pub struct Lit {
    pub model: Model,
    pub conditions: Conditions,
}

impl Options {
    /// The moon, if there is any.
    pub fn moon(&self) -> Option<Moon> {
        let elevation = self.moon_elevation?;
        Some(Moon {
            elevation: elevation.to_radians(),
            azimuth: self.moon_azimuth.to_radians(),
            phase_angle: self.moon_phase.to_radians(),
            ..Moon::default()
        })
    }

    /// Where it stands, for the picture to say.
    pub fn describe(&self, about: &mut About) {
        if let Some(elevation) = self.moon_elevation {
            about.number("moonElevationDeg", elevation);
            about.number("moonAzimuthDeg", self.moon_azimuth);
            about.number("moonPhaseDeg", self.moon_phase);
        }
    }

    /// The air that the moon lights, if it is up far enough.
    pub fn lit(&self, model: &Model, conditions: &Conditions) -> Result<Option<Lit>> {
        let Some(moon) = self.moon() else {
            return Ok(None);
        };
        let lit = Lit {
            model: model.moonlit(&moon)?,
            conditions: moon.conditions(conditions),
        };
        Ok(is_up(model, &lit.conditions).then_some(lit))
    }

    /// An error where a moon is wanted and neither it nor the sun is up far enough.
    pub fn check(&self, model: &Model, conditions: &Conditions) -> Result<()> {
        match self.moon() {
            Some(moon)
                if !is_up(model, &moon.conditions(conditions)) && !is_up(model, conditions) =>
            {
                let text = "sun and moon are both below the range of the model: the sky is dark";
                Err(Failure::message(text))
            }
            _ => Ok(()),
        }
    }
}

/// Whether a light is not below the range of the model.
pub fn is_up(model: &Model, conditions: &Conditions) -> bool {
    let [lowest, _] = model.solar_elevation_range();
    conditions.solar_elevation >= lowest
}

//! Conditions within the ranges of a model.

use super::opened::Model;
use crate::conditions::{Conditions, grounded};
use crate::error::{Error, Result};
use crate::ground::Albedo;

impl Conditions {
    /// Moves every parameter into the range of `model`. What that means beyond the ends: a sun that is lower stands for
    /// the lowest (in the default model at −12°: 0.0008 cd m⁻² at the zenith, four times what airglow and stars give);
    /// an observer who is higher sees what the highest does, and one beyond the air wants
    /// [`Place::entry`](crate::Place::entry) instead; haze and clear air end at the nearest visibility.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a parameter is not finite.
    pub fn clamped(&self, model: &Model) -> Result<Self> {
        let mut moved = Self {
            albedo: over(model, self.albedo),
            ..*self
        };
        for (parameter, value, [min, max]) in moved.ranges(model) {
            if !value.is_finite() {
                return Err(parameter.error(*value, min, max));
            }
            *value = value.clamp(min, max);
        }
        Ok(moved)
    }

    /// Checks every parameter against the range of `model`; a relative excess of 1e-9 is rounding and gets clamped.
    /// Where the model has a ground of its own ([`Model::over`]), its albedo at 550 nm takes the place of that given.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for the first parameter that the model does not reach.
    pub fn checked(&self, model: &Model) -> Result<Self> {
        let mut checked = Self {
            altitude: grounded(self.altitude),
            albedo: over(model, self.albedo),
            ..*self
        };
        for (parameter, value, range) in checked.ranges(model) {
            *value = parameter.checked(*value, range)?;
        }
        Ok(checked)
    }

    fn ranges(&mut self, model: &Model) -> [(Parameter, &mut f64, [f64; 2]); 5] {
        let parameter = |name, unit| Parameter { name, unit };
        [
            (
                parameter("solar_elevation", "rad"),
                &mut self.solar_elevation,
                model.solar_elevation_range(),
            ),
            (
                parameter("solar_azimuth", "rad"),
                &mut self.solar_azimuth,
                [f64::MIN, f64::MAX],
            ),
            (
                parameter("visibility", "m"),
                &mut self.visibility,
                model.visibility_range(),
            ),
            (parameter("albedo", ""), &mut self.albedo, [0.0, 1.0]),
            (
                parameter("altitude", "m"),
                &mut self.altitude,
                model.altitude_range(),
            ),
        ]
    }
}

/// Where albedos are said that depend on wavelength, nm.
const TYPICAL: f64 = 550.0;

/// The albedo that conditions have over the ground of a model.
fn over(model: &Model, albedo: f64) -> f64 {
    model.ground().map_or(albedo, |ground| ground.at(TYPICAL))
}

impl Model {
    /// The ground, where its albedo depends on wavelength.
    pub(crate) fn spectral_ground(&self) -> Option<&Albedo> {
        self.ground().filter(|ground| ground.as_grey().is_none())
    }

    /// What is asked under conditions that differ from query to query has the albedo that these say.
    pub(crate) fn refuse_ground(&self) -> Result<()> {
        match self.ground() {
            None => Ok(()),
            Some(_) => Err(Error::invalid(
                "model",
                "has a ground of its own: where each query has conditions, they say the albedo",
            )),
        }
    }

    /// The albedos at all nodes under checked conditions.
    pub(crate) fn albedos_at_nodes(&self, conditions: &Conditions) -> Vec<f64> {
        let at = |&l: &f64| match self.spectral_ground() {
            Some(ground) => ground.at(l),
            None => conditions.albedo,
        };
        self.wavelengths().iter().map(at).collect()
    }
}

/// A visibility, m, within its range; a relative excess of 1e-9 is rounding and gets clamped.
pub(crate) fn checked_visibility(visibility: f64, range: [f64; 2]) -> Result<f64> {
    let parameter = Parameter {
        name: "visibility",
        unit: "m",
    };
    parameter.checked(visibility, range)
}

struct Parameter {
    name: &'static str,
    unit: &'static str,
}

impl Parameter {
    fn checked(&self, value: f64, [min, max]: [f64; 2]) -> Result<f64> {
        let slack = 1e-9 * min.abs().max(max.abs()).min(1e12);
        match value.is_finite() && value >= min - slack && value <= max + slack {
            true => Ok(value.clamp(min, max)),
            false => Err(self.error(value, min, max)),
        }
    }

    fn error(&self, value: f64, min: f64, max: f64) -> Error {
        Error::OutOfRange {
            parameter: self.name,
            value,
            min,
            max,
            unit: self.unit,
        }
    }
}

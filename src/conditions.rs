//! Where the observer is, where the sun stands and what the air and the ground are like.

use crate::error::{Error, Result};
#[cfg(feature = "std")]
use crate::model::Model;
#[cfg(not(feature = "std"))]
use crate::real::Real;

/// The conditions of a sky. Angles in radians, lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// Geometric elevation of the sun's centre above the observer's horizontal plane, rad.
    pub solar_elevation: f64,
    /// Azimuth of the sun, rad, counter-clockwise from +x seen from above. Any finite angle.
    pub solar_azimuth: f64,
    /// Horizontal meteorological range at the ground, m.
    pub visibility: f64,
    /// Albedo of the ground, 0..=1, the same at all wavelengths.
    pub albedo: f64,
    /// Altitude of the observer above the ground, m.
    pub altitude: f64,
}

impl Default for Conditions {
    /// Sun 20° high towards +x, visibility 59.4 km, albedo 0.2, observer on the ground.
    fn default() -> Self {
        Self {
            solar_elevation: 20f64.to_radians(),
            solar_azimuth: 0.0,
            visibility: 59.4e3,
            albedo: 0.2,
            altitude: 0.0,
        }
    }
}

impl Conditions {
    #[cfg(feature = "std")]
    /// Moves every parameter into the range of `model`.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a parameter is not finite.
    pub fn clamped(&self, model: &Model) -> Result<Self> {
        let mut moved = *self;
        for (parameter, value, [min, max]) in moved.ranges(model) {
            if !value.is_finite() {
                return Err(parameter.error(*value, min, max));
            }
            *value = value.clamp(min, max);
        }
        Ok(moved)
    }

    /// Unit vector towards the sun's centre.
    pub fn sun_direction(&self) -> [f64; 3] {
        direction(self.solar_elevation, self.solar_azimuth)
    }

    /// The same with another azimuth of the sun.
    pub(crate) fn with_solar_azimuth(&self, azimuth: f64) -> Result<Self> {
        if !azimuth.is_finite() {
            return Err(Error::OutOfRange {
                parameter: "solar_azimuth",
                value: azimuth,
                min: f64::MIN,
                max: f64::MAX,
                unit: "rad",
            });
        }
        Ok(Self {
            solar_azimuth: azimuth,
            ..*self
        })
    }

    #[cfg(feature = "std")]
    /// Checks every parameter against the range of `model`; a relative excess of 1e-9 is rounding and gets clamped.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for the first parameter that the model does not reach.
    pub fn checked(&self, model: &Model) -> Result<Self> {
        let mut checked = *self;
        for (parameter, value, range) in checked.ranges(model) {
            *value = parameter.checked(*value, range)?;
        }
        Ok(checked)
    }

    #[cfg(feature = "std")]
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

/// A visibility, m, within its range; a relative excess of 1e-9 is rounding and gets clamped.
#[cfg(feature = "std")]
pub(crate) fn checked_visibility(visibility: f64, range: [f64; 2]) -> Result<f64> {
    let parameter = Parameter {
        name: "visibility",
        unit: "m",
    };
    parameter.checked(visibility, range)
}

/// Unit vector at an elevation and an azimuth, rad.
pub(crate) fn direction(elevation: f64, azimuth: f64) -> [f64; 3] {
    let (sine, cosine) = elevation.sin_cos();
    let (y, x) = azimuth.sin_cos();
    [cosine * x, cosine * y, sine]
}

#[cfg(feature = "std")]
struct Parameter {
    name: &'static str,
    unit: &'static str,
}

#[cfg(feature = "std")]
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

//! Where the observer is, where the sun stands and what the air and the ground are like.

use crate::error::{Error, Result};
#[cfg(not(feature = "std"))]
use crate::kernel::real::Real;

/// The conditions of a sky. Angles in radians, lengths in metres.
///
/// ```
/// use welkin::{Conditions, Model};
///
/// let conditions = Conditions {
///     solar_elevation: 5f64.to_radians(),
///     visibility: 40e3,
///     ..Conditions::default()
/// };
/// assert!((conditions.sun_direction()[2] - 5f64.to_radians().sin()).abs() < 1e-15);
/// // What the model does not cover is refused, not extrapolated.
/// let model = Model::default_model()?;
/// let night = Conditions { solar_elevation: -0.5, ..conditions };
/// assert_eq!(model.sky(&night).unwrap_err().class(), "range");
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// Geometric elevation of the sun's centre above the observer's horizontal plane, rad.
    pub solar_elevation: f64,
    /// Azimuth of the sun, rad, counter-clockwise from +x seen from above. Any finite angle.
    pub solar_azimuth: f64,
    /// Horizontal meteorological range at the ground, m.
    pub visibility: f64,
    /// Albedo of the ground, 0..=1, the same at all wavelengths. A ground with a spectrum is one of the model's:
    /// `Model::over`.
    pub albedo: f64,
    /// Altitude of the observer above the ground, m. Down to [`Conditions::LOWEST_ALTITUDE`] an observer under the
    /// sphere, in a polder or by rounding, stands on the ground: the altitude counts as 0, and so does that of the
    /// checked conditions.
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
    /// Altitude below which no land lies, m.
    pub const LOWEST_ALTITUDE: f64 = -500.0;

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
}

/// The altitude (m) of an observer, on the ground if not far under it.
#[inline]
pub(crate) fn grounded(altitude: f64) -> f64 {
    match (Conditions::LOWEST_ALTITUDE..0.0).contains(&altitude) {
        true => 0.0,
        false => altitude,
    }
}

/// Unit vector at an elevation and an azimuth, rad.
pub(crate) fn direction(elevation: f64, azimuth: f64) -> [f64; 3] {
    let (sine, cosine) = elevation.sin_cos();
    let (y, x) = azimuth.sin_cos();
    [cosine * x, cosine * y, sine]
}

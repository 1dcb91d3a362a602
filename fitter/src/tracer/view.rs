//! A camera and what it sees.

use super::solids::Solids;

/// A camera in front of a scene.
pub struct View<'a> {
    /// Altitude of the camera, m.
    pub altitude: f64,
    /// Elevation of the sun above the camera's horizontal plane, radians.
    pub sun_elevation: f64,
    /// Azimuth of the sun, counter-clockwise from x, radians.
    pub sun_azimuth: f64,
    /// What stands on the ground, and the ground itself.
    pub solids: &'a dyn Solids,
}

/// A pixel's radiance per unit solar irradiance (sr⁻¹), per wavelength.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pixel {
    /// Means over the samples.
    pub radiance: Vec<f64>,
    /// Their standard errors; samples are spread evenly, so these are rather too large.
    pub error: Vec<f64>,
}

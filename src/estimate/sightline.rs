//! A view ray and the sun.

use crate::geometry::Side;

/// A view ray and the sun.
///
/// ```
/// use welkin::estimate::Sightline;
/// use welkin::geometry::Side;
///
/// let zenith = Sightline {
///     altitude: 0.0,
///     ray: [1.0, 0.0],
///     side: Side::Up,
///     sun: 10f64.to_radians().sin_cos().into(),
///     azimuth: 1.0,
/// };
/// assert!(zenith.sun[1] > zenith.sun[0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sightline {
    /// Of the observer, m.
    pub altitude: f64,
    /// Sine and cosine of the elevation of the ray.
    pub ray: [f64; 2],
    /// Where the ray ends.
    pub side: Side,
    /// Sine and cosine of the solar elevation.
    pub sun: [f64; 2],
    /// Cosine of the azimuth between ray and sun.
    pub azimuth: f64,
}

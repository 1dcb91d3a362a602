//! What the air along a ray sends by single scattering of sunlight, and by scattering of a mean diffuse light: rough
//! estimates, to which the fields of a model are relative. Format specification, section 7.2.
//!
//! They know what is hard to fit: the edge of the Earth's shadow, the horizon, the thinning of the air. What a model has
//! to say beyond them is smooth.

mod path;
mod points;
#[cfg(feature = "std")]
mod prepared;
mod sums;

use crate::format::{EstimateView, MAX_ESTIMATE_WAVELENGTHS, MAX_ESTIMATES};
use crate::geometry::{Planet, Side};
use crate::kernel::lanes::Lanes;
use path::Stops;
#[cfg(feature = "std")]
pub use prepared::Estimates;

/// Wavelengths that are computed together.
pub(crate) const WIDTH: usize = 8;

/// Most blocks of wavelengths.
pub(crate) const MOST_BLOCKS: usize = MAX_ESTIMATE_WAVELENGTHS / WIDTH;

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

/// The estimates of a block of wavelengths, sr⁻¹.
pub(crate) type Block = [Lanes<WIDTH>; MAX_ESTIMATES];
/// The estimates of all wavelengths.
pub(crate) type Blocks = [Block; MOST_BLOCKS];
/// None yet.
pub(crate) const NOTHING: Blocks = [[Lanes([0.0; WIDTH]); MAX_ESTIMATES]; MOST_BLOCKS];

/// All that estimates depend on.
#[derive(Clone, Copy)]
pub(crate) struct Estimator<'a> {
    pub planet: Planet,
    pub tables: EstimateView<'a>,
    /// Extinction where the profile is 1, m⁻¹, `[constituent][block]`.
    pub extinction: &'a [[f32; WIDTH]],
}

impl Estimator<'_> {
    /// The estimates along a ray.
    #[inline(always)]
    pub fn along(&self, line: &Sightline) -> Blocks {
        sums::along(self, &Stops::new(&self.planet, &self.tables, line))
    }
}

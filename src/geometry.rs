//! The observer above a spherical planet: horizon, ray lengths. Format specification, sections 7.1 and 7.2.

use core::f64::consts::FRAC_PI_2;

#[cfg(not(feature = "std"))]
use crate::kernel::real::Real;

/// Angular radius of the sun, rad: 0.2667°, as in the published model.
pub const SOLAR_ANGULAR_RADIUS: f64 = 0.004_654_793;

/// A sphere of radius `radius` with an atmosphere up to `top` above it (m).
///
/// ```
/// use welkin::geometry::Planet;
///
/// let earth = Planet { radius: 6.378e6, top: 100e3 };
/// // From an airliner the horizon is three degrees below the horizontal.
/// let dip = earth.dip(10e3).to_degrees();
/// assert!((dip - 3.2).abs() < 0.1);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planet {
    /// Radius, m.
    pub radius: f64,
    /// Altitude of the top of the atmosphere, m.
    pub top: f64,
}

/// Which side of the geometric horizon a ray leaves to.
///
/// ```
/// use welkin::geometry::{Planet, Side};
///
/// let earth = Planet { radius: 6.378e6, top: 100e3 };
/// // Below the horizontal and still above the horizon, which lies 1.4° lower at 2 km.
/// assert_eq!(earth.ray(2000.0, -0.02).side, Side::Up);
/// assert_eq!(earth.ray(2000.0, -0.03).side, Side::Down);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The ray ends in space.
    Up,
    /// The ray ends on the ground.
    Down,
}

/// A view ray in terms of the geometric horizon.
///
/// ```
/// use welkin::geometry::{Planet, Side};
///
/// let earth = Planet { radius: 6.378e6, top: 100e3 };
/// let ray = earth.ray(2000.0, -0.1); // altitude in m, elevation in rad
/// assert_eq!(ray.side, Side::Down);
/// // About 20 km along a slope of 1 : 10 to the ground.
/// assert!((ray.length - 20.3e3).abs() < 1e3);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where the ray ends.
    pub side: Side,
    /// Angle from the geometric horizon, rad, ≥ 0 on both sides.
    pub angle: f64,
    /// Largest `angle` on this side, rad.
    pub range: f64,
    /// Length to the ground or to the top of the atmosphere, m.
    pub length: f64,
}

impl Planet {
    /// Angle of the geometric horizon below the local horizontal, rad.
    pub fn dip(&self, altitude: f64) -> f64 {
        // acos(R/r) without its cancellation near the ground.
        let r = self.radius + altitude;
        ((altitude * (self.radius + r)).max(0.0).sqrt() / self.radius).atan()
    }

    /// `h + h²/2R`: the altitude in which straight lines are parabolas.
    #[inline]
    pub fn squared_altitude(&self, altitude: f64) -> f64 {
        altitude + altitude * altitude / (2.0 * self.radius)
    }

    /// Describes the ray that leaves `altitude` at `elevation` (rad) above the local horizontal.
    pub fn ray(&self, altitude: f64, elevation: f64) -> Ray {
        self.ray_with_dip(altitude, self.dip(altitude), elevation, elevation.sin())
    }

    /// The ray at `angle` (rad, ≥ 0) from the geometric horizon on the given side of it.
    pub fn ray_beside_horizon(&self, altitude: f64, side: Side, angle: f64) -> Ray {
        let dip = self.dip(altitude);
        let (sign, range) = match side {
            Side::Up => (1.0, FRAC_PI_2 + dip),
            Side::Down => (-1.0, FRAC_PI_2 - dip),
        };
        let angle = angle.clamp(0.0, range);
        Ray {
            side,
            angle,
            range,
            length: self.length(altitude, (sign * angle - dip).sin(), side),
        }
    }

    /// [`Planet::ray`] for callers who know the dip of the horizon and the sine of the elevation.
    #[inline]
    pub fn ray_with_dip(&self, altitude: f64, dip: f64, elevation: f64, sine: f64) -> Ray {
        let delta = elevation + dip;
        let (side, range) = if delta >= 0.0 {
            (Side::Up, FRAC_PI_2 + dip)
        } else {
            (Side::Down, FRAC_PI_2 - dip)
        };
        Ray {
            side,
            angle: delta.abs().min(range),
            range,
            length: self.length(altitude, sine, side),
        }
    }

    #[inline]
    fn length(&self, altitude: f64, mu: f64, side: Side) -> f64 {
        let r = self.radius + altitude;
        let b = r * mu;
        match side {
            Side::Up => {
                let c = (self.top - altitude) * (2.0 * self.radius + self.top + altitude);
                let root = (b * b + c).max(0.0).sqrt();
                if b > 0.0 { c / (root + b) } else { root - b }
            }
            Side::Down => {
                let c = altitude * (2.0 * self.radius + altitude);
                let root = (b * b - c).max(0.0).sqrt();
                c / (root - b)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EARTH: Planet = Planet {
        radius: 6_378_000.0,
        top: 100_000.0,
    };

    #[test]
    fn lengths_at_zenith_nadir_and_horizon() {
        assert!((EARTH.ray(2000.0, FRAC_PI_2).length - 98_000.0).abs() < 1e-6);
        assert!((EARTH.ray(2000.0, -FRAC_PI_2).length - 2000.0).abs() < 1e-6);
        let dip = EARTH.dip(2000.0);
        let tangent = (2000.0f64 * (2.0 * EARTH.radius + 2000.0)).sqrt();
        let below = EARTH.ray(2000.0, -dip - 1e-9);
        assert_eq!(below.side, Side::Down);
        assert!((below.length / tangent - 1.0).abs() < 1e-3);
    }

    #[test]
    fn on_the_ground_rays_down_have_no_length() {
        assert_eq!(EARTH.dip(0.0), 0.0);
        assert_eq!(EARTH.ray(0.0, -0.3).length, 0.0);
        assert_eq!(EARTH.ray(0.0, 0.0).side, Side::Up);
    }
}

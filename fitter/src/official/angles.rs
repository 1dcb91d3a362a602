//! The angles that the official model is asked by.

use super::error::{OfficialError, Result};
use std::f64::consts::FRAC_PI_2;

/// Radius of the planet, m.
pub const PLANET_RADIUS: f64 = 6_378_000.0;
/// What the official code raises every observer by, m: to it, one on the ground is at this altitude.
pub const SAFETY_ALTITUDE: f64 = 50.0;

/// A point or direction in the frame whose origin is on the ground and whose z axis points up there, m.
pub type Vector = [f64; 3];

/// An observer under a sun. Azimuths are counter-clockwise from +x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observer {
    /// Where the observer is, m.
    pub viewpoint: Vector,
    /// What the observer is raised by, m: [`SAFETY_ALTITUDE`] as in the official code, or nothing, which takes the
    /// stored altitudes by their word.
    pub raised: f64,
    /// Solar elevation at the origin, rad.
    pub solar_elevation: f64,
    /// Solar azimuth at the origin, rad.
    pub solar_azimuth: f64,
}

/// What of an observer does not depend on the view direction.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    normal: Vector,
    sun: Vector,
    shadow: Vector,
    dip_sine: f64,
    /// Solar elevation at the observer, rad.
    pub solar_elevation: f64,
    /// Altitude, m, raised.
    pub altitude: f64,
}

/// The angles of a view direction, rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angles {
    /// To the zenith.
    pub theta: f64,
    /// To the sun.
    pub gamma: f64,
    /// To the zenith, with the geometric horizon at 90°.
    pub zero: f64,
    /// To the axis that is perpendicular to the sun and in its vertical plane, likewise.
    pub shadow: f64,
}

impl Angles {
    /// What zenith factors of the radiance are looked up by.
    pub fn alpha(&self, solar_elevation: f64) -> f64 {
        match solar_elevation < 0.0 {
            true => self.shadow,
            false => self.zero,
        }
    }
}

impl Frame {
    /// # Errors
    /// [`OfficialError::Condition`] for what is not finite.
    pub fn new(observer: &Observer) -> Result<Self> {
        let Observer {
            viewpoint,
            raised,
            solar_elevation,
            solar_azimuth,
        } = *observer;
        let conditions = [
            ("the solar elevation", solar_elevation),
            ("the solar azimuth", solar_azimuth),
            ("what the observer is raised by", raised),
            ("the viewpoint", viewpoint.iter().sum()),
        ];
        if let Some((what, _)) = conditions.iter().find(|(_, v)| !v.is_finite()) {
            return Err(OfficialError::Condition(what));
        }
        let from_centre = [viewpoint[0], viewpoint[1], viewpoint[2] + PLANET_RADIUS];
        let normal = unit(from_centre).ok_or(OfficialError::Condition("the viewpoint"))?;
        let distance = length(from_centre) + raised;
        let ((se, ce), (sa, ca)) = (solar_elevation.sin_cos(), solar_azimuth.sin_cos());
        let sun = [ce * ca, ce * sa, se];
        let ratio = (PLANET_RADIUS / distance).min(1.0);
        Ok(Self {
            normal,
            sun,
            shadow: [-se * ca, -se * sa, ce],
            dip_sine: (1.0 - ratio * ratio).sqrt(),
            solar_elevation: FRAC_PI_2 - angle(normal, sun),
            altitude: (distance - PLANET_RADIUS).max(0.0),
        })
    }

    /// # Errors
    /// [`OfficialError::Direction`].
    pub fn angles(&self, direction: Vector) -> Result<Angles> {
        let view = unit(direction).ok_or(OfficialError::Direction)?;
        // The direction of the geometric horizon becomes horizontal; zenith and nadir stay.
        let lifted = std::array::from_fn(|i| view[i] + self.normal[i] * self.dip_sine);
        let corrected = unit(lifted).ok_or(OfficialError::Direction)?;
        Ok(Angles {
            theta: angle(view, self.normal),
            gamma: angle(view, self.sun),
            zero: angle(corrected, self.normal),
            shadow: angle(corrected, self.shadow),
        })
    }
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

fn unit(a: Vector) -> Option<Vector> {
    let length = length(a);
    (length.is_finite() && length > 1e-150).then(|| a.map(|v| v / length))
}

/// Between unit vectors.
fn angle(a: Vector, b: Vector) -> f64 {
    dot(a, b).clamp(-1.0, 1.0).acos()
}

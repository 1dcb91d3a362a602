//! Straight lines through spherical shells.
//!
//! `s` is the distance along the line from its point of closest approach to the centre, so r² = tangent² + s².

use glam::DVec3;

/// A ray from `origin` along the unit vector `direction` (planet-centred coordinates, m).
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// Where it starts.
    pub origin: DVec3,
    /// Where it goes.
    pub direction: DVec3,
    /// `s` of the origin.
    pub start: f64,
    /// Square of the distance of closest approach.
    pub tangent2: f64,
}

impl Line {
    /// The ray from `origin` along `direction`.
    pub fn new(origin: DVec3, direction: DVec3) -> Self {
        let start = origin.dot(direction);
        // The cross product keeps the digits that r² − s² would lose.
        let tangent2 = origin.cross(direction).length_squared();
        Self {
            origin,
            direction,
            start,
            tangent2,
        }
    }

    /// The point at distance `t` from the origin.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }

    /// Radius at `s`.
    pub fn radius(&self, s: f64) -> f64 {
        (self.tangent2 + s * s).sqrt()
    }

    /// |s| where the line meets radius `r`, if it does.
    pub fn crossing(&self, r: f64) -> Option<f64> {
        let q = r * r - self.tangent2;
        (q >= 0.0).then(|| q.sqrt())
    }

    /// Distance to the ground of a planet of radius `r`, if the ray goes there.
    pub fn ground_distance(&self, r: f64) -> Option<f64> {
        if self.start >= 0.0 {
            return None;
        }
        self.crossing(r).map(|s| (-s - self.start).max(0.0))
    }

    /// Distance to where the ray leaves a sphere of radius `r` that contains its origin.
    pub fn space_distance(&self, r: f64) -> f64 {
        (self.crossing(r).unwrap_or(0.0) - self.start).max(0.0)
    }

    /// Distances at which the ray enters and leaves the shadow of a planet of radius `r` lit from `sun`.
    pub fn shadow_edges(&self, sun: DVec3, r: f64) -> Vec<f64> {
        let (o, d) = (self.origin, self.direction);
        let (os, ds) = (o.dot(sun), d.dot(sun));
        let (a, b) = (1.0 - ds * ds, o.dot(d) - os * ds);
        let c = o.cross(sun).length_squared() - r * r;
        let q = b * b - a * c;
        if a < 1e-14 || q < 0.0 {
            return vec![];
        }
        let far = -(b + b.signum() * q.sqrt());
        [far / a, c / far]
            .into_iter()
            .filter(|t| t.is_finite() && os + t * ds < 0.0)
            .collect()
    }
}

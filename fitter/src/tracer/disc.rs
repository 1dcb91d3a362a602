//! The sun's disc: uniformly bright, of unit irradiance. A radius of 0 makes it a point.
//!
//! Walks sample the disc. The lobes of all phase functions are far wider than it, so sampling phase functions to find
//! it would add nothing (its weight in a balance heuristic would be below 1e-4).

use super::stokes::Frame;
use glam::DVec3;
use std::f64::consts::TAU;

/// Points that stand for the disc in quadratures.
const POINTS: u32 = 32;

/// The sun as seen from everywhere.
pub struct Disc {
    frame: Frame,
    radius: f64,
}

impl Disc {
    /// The sun at `elevation` over x, both angles in radians.
    pub fn new(elevation: f64, radius: f64) -> Self {
        Self::towards(elevation, 0.0, radius)
    }

    /// The sun at `elevation` and `azimuth` (counter-clockwise from x).
    pub fn towards(elevation: f64, azimuth: f64, radius: f64) -> Self {
        let ((sin, cos), (side, ahead)) = (elevation.sin_cos(), azimuth.sin_cos());
        Self {
            frame: Frame::around(DVec3::new(cos * ahead, cos * side, sin)),
            radius,
        }
    }

    /// Whether it is a point.
    pub fn is_point(&self) -> bool {
        self.radius == 0.0
    }

    /// Its middle.
    pub fn middle(&self) -> DVec3 {
        self.frame.w
    }

    /// The direction with the part `u` of the disc's solid angle inside its ring, at the part `v` of the turn.
    pub fn direction(&self, u: f64, v: f64) -> DVec3 {
        let height = 2.0 * (0.5 * self.radius).sin().powi(2);
        let turn = TAU * v;
        let frame = self.frame.turned((turn.cos(), turn.sin()));
        frame.bent(1.0 - u * height).w
    }

    /// Directions of equal weight that represent the disc: one, or a spiral of them.
    pub fn directions(&self) -> Vec<DVec3> {
        if self.is_point() {
            return vec![self.middle()];
        }
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        (0..POINTS)
            .map(f64::from)
            .map(|i| self.direction((i + 0.5) / f64::from(POINTS), i * golden))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_fill_the_disc_evenly() {
        let radius = 0.3_f64.to_radians();
        let disc = Disc::new(0.4, radius);
        let all = disc.directions();
        let mean: DVec3 = all.iter().sum::<DVec3>() / all.len() as f64;
        assert!(mean.normalize().angle_between(disc.middle()) < 0.05 * radius);
        let squares = all.iter().map(|d| d.angle_between(disc.middle()).powi(2));
        let mean_square = squares.sum::<f64>() / all.len() as f64;
        assert!((mean_square / (0.5 * radius * radius) - 1.0).abs() < 0.01);
    }
}

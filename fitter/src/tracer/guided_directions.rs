//! A second density for directions: a lobe around the brightest part of the sky, mixed with the phase function.
//!
//! Under a low sun most light comes from a small part of the sky, which phase functions as broad as Rayleigh's rarely
//! hit.

use super::phase::{henyey_greenstein, sample_henyey_greenstein};
use super::stokes::Frame;
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, TAU};

/// Width of the lobe, as the asymmetry of a Henyey-Greenstein function.
const WIDTH: f64 = 0.75;
/// Lowest elevation of the lobe's middle as a sine.
const LOWEST: f64 = 0.05;

/// The lobe at one point.
pub struct Glow {
    middle: DVec3,
    /// Share of directions that come from the lobe.
    pub share: f64,
}

impl Glow {
    /// The lobe at `point` under `sun` for a walk that was scattered `scatterings` times before.
    pub fn new(point: DVec3, sun: DVec3, scatterings: usize) -> Self {
        let up = point.normalize();
        let sine = up.dot(sun);
        let share = share(sine, scatterings);
        if sine >= LOWEST {
            return Self { middle: sun, share };
        }
        let level = (sun - sine * up).normalize_or(up.any_orthonormal_vector());
        Self {
            middle: level * (1.0 - LOWEST * LOWEST).sqrt() + up * LOWEST,
            share,
        }
    }

    /// A direction from the lobe.
    pub fn sample(&self, u: f64, v: f64) -> DVec3 {
        let turn = TAU * v;
        let cosine = sample_henyey_greenstein(WIDTH, u).clamp(-1.0, 1.0);
        let frame = Frame::around(self.middle).turned((turn.cos(), turn.sin()));
        frame.bent(cosine).w
    }

    /// The lobe's density per solid angle.
    pub fn density(&self, direction: DVec3) -> f64 {
        0.25 * FRAC_1_PI * henyey_greenstein(WIDTH, self.middle.dot(direction))
    }
}

/// Weights multiply from one scattering to the next, so by day, when the lobe is of little use, only the first two get
/// it.
fn share(sine: f64, scatterings: usize) -> f64 {
    match scatterings {
        _ if sine < -0.02 => 0.5,
        0 | 1 if sine < 0.1 => 0.3,
        0 | 1 => 0.1,
        _ => 0.0,
    }
}

//! One chunk's axes, and what its fields are multiplied by.

use crate::dataset::{Axis, Grid};
use crate::estimate::{ESTIMATES, OF_FIELD};
use crate::successive_orders::{FIELDS, NW, Spectrum};
use crate::units::Solved;
use std::f64::consts::PI;
use welkin::axis::{Ends, Taps, alpha_coordinate, spline};
use welkin::estimate::{Estimates, Sightline};
use welkin::geometry::{Planet, Side};

/// A view direction under a sun, relative to the sun's azimuth (rad).
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// Elevation of the view direction.
    pub view: f64,
    /// Azimuth from the sun, 0..π.
    pub azimuth: f64,
    /// Elevation of the sun.
    pub sun: f64,
}

/// Spline taps of a direction and a sun; view sites of both sides of the horizon stand in one axis.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// View direction.
    pub view: Taps,
    /// Azimuth.
    pub phi: Taps,
    /// Solar elevation.
    pub elevation: Taps,
}

/// Axes of a chunk, and what its fields are relative to.
pub struct Frame {
    planet: Planet,
    altitude: f64,
    grid: Grid,
    estimates: Estimates,
}

impl Frame {
    /// Of the chunk at altitude `a` of the grid.
    pub fn new(solved: &Solved, estimates: &Estimates, grid: &Grid, a: usize) -> Self {
        Self {
            planet: solved.gatherer().planet(),
            altitude: grid.traced_altitude(a),
            grid: grid.clone(),
            estimates: estimates.clone(),
        }
    }

    /// Where a direction falls on the axes.
    pub fn place(&self, look: &Look) -> Place {
        let ray = self.planet.ray(self.altitude, look.view);
        let ((axis, exponent), offset) = match ray.side {
            Side::Up => (self.grid.up, 0),
            Side::Down => (self.grid.down, self.grid.up.0.len()),
        };
        let u = alpha_coordinate(ray.angle, ray.range, axis.intervals, exponent);
        let mut view = spline(u, axis.intervals, axis.ends);
        view.index = view.index.map(|i| i + offset);
        let n = self.grid.phi.intervals;
        let elevation = self.grid.elevation;
        Place {
            view,
            phi: spline(n as f64 * look.azimuth / PI, n, Ends::Mirrored),
            elevation: spline(
                elevation.coordinate(look.sun),
                elevation.intervals,
                Ends::Free,
            ),
        }
    }

    /// What the fields are relative to.
    pub fn scale(&self, look: &Look) -> [Spectrum; FIELDS] {
        let mut estimates = [0.0; ESTIMATES * NW];
        let line = Sightline {
            altitude: self.altitude,
            ray: look.view.sin_cos().into(),
            side: self.planet.ray(self.altitude, look.view).side,
            sun: look.sun.sin_cos().into(),
            azimuth: look.azimuth.cos(),
        };
        self.estimates.along(&line, &mut estimates);
        let (rows, _) = estimates.as_chunks::<NW>();
        OF_FIELD.map(|q| rows[q])
    }

    /// Axes of the view directions (above, below), of azimuth and of solar elevation.
    pub fn axes(&self) -> [Axis; 4] {
        let grid = &self.grid;
        [grid.up.0, grid.down.0, grid.phi, grid.elevation_axis()]
    }
}

/// Cosine of the angle between a direction and its sun.
pub fn cosine(look: &Look) -> f32 {
    let ((sv, cv), (ss, cs)) = (look.view.sin_cos(), look.sun.sin_cos());
    (cv * cs * look.azimuth.cos() + sv * ss).clamp(-1.0, 1.0) as f32
}

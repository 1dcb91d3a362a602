//! One chunk's axes, and what its normalised fields are multiplied by.

use crate::dataset::{Axis, Grid};
use crate::decompose::{Chunk, chunk_geometry};
use crate::successive_orders::{NW, Spectrum};
use crate::units::Solved;
use std::f64::consts::PI;
use welkin::axis::{Ends, Taps, alpha_coordinate, spline};
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

/// Axes and normalisation of a chunk.
pub struct Frame {
    planet: Planet,
    altitude: f64,
    grid: Grid,
    extinction: Vec<Spectrum>,
    /// Spline coefficients of ln n̄, `[view][constituent]`.
    density: Vec<f32>,
    /// Spline coefficients of ln S, `[elevation][wavelength]`.
    level: Vec<f32>,
}

impl Frame {
    /// Of the chunk at altitude `a` of the grid.
    pub fn new(solved: &Solved, grid: &Grid, a: usize, chunk: &Chunk) -> Self {
        let planet = solved.gatherer().planet();
        let geometry = chunk_geometry(&solved.medium, planet, grid, a);
        Self {
            planet,
            altitude: grid.traced_altitude(a),
            grid: grid.clone(),
            extinction: solved.medium.parts.iter().map(|p| p.extinction).collect(),
            density: geometry.coefficients(grid.up.0, grid.down.0),
            level: chunk.level.clone(),
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

    /// (1 − T)·S at every wavelength.
    pub fn scale(&self, look: &Look, place: &Place) -> [f64; NW] {
        let length = self.planet.ray(self.altitude, look.view).length;
        let density: Vec<f64> = (0..self.extinction.len())
            .map(|k| at(&place.view, &self.density, self.extinction.len(), k).exp())
            .collect();
        std::array::from_fn(|w| {
            let pairs = self.extinction.iter().zip(&density);
            let tau: f64 = pairs.map(|(e, n)| f64::from(e[w]) * n).sum();
            -(-tau * length).exp_m1() * at(&place.elevation, &self.level, NW, w).exp()
        })
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

/// Column `k` of a row-major table at the taps.
fn at(taps: &Taps, table: &[f32], columns: usize, k: usize) -> f64 {
    let pairs = taps.index.iter().zip(taps.weight);
    pairs
        .map(|(&i, w)| f64::from(w) * f64::from(table[i * columns + k]))
        .sum()
}

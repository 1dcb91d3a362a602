//! Where baked skies are compared with those they were made from: at places that keep to the horizon and the sun, so
//! that what is measured is as continuous in the conditions as the sky.

use core::f64::consts::TAU;

use super::coordinates::{LocalFrame, Points, row_at_share, share_at_row};
use super::grid_nodes::GridNodes;
use crate::geometry::{Ray, Side};
use crate::kernel::lanes::Lanes;

/// Directions of a row.
pub(super) const WIDTH: usize = 8;

/// Rows above and below the horizon, as evenly as those of the tables and in step with none of them.
const ROWS: [u32; 2] = [41, 21];

/// A row at the very horizon, 0.0005° from it.
const LOWEST: f64 = 0.006;

/// Rows where layers of the air are seen, between 0.2° and 4° above the horizon: under a low sun errors peak there at
/// its azimuth.
const LAYERS: [f64; 10] = [
    0.13, 0.155, 0.18, 0.205, 0.23, 0.255, 0.28, 0.31, 0.34, 0.38,
];

/// Rows beside the sun: distances from its own, and the azimuths in them as in [`Points::azimuth`].
const BESIDE_SUN: [f64; 8] = [-0.07, -0.045, -0.025, -0.01, 0.004, 0.019, 0.037, 0.06];
const NEAR_SUN: [f64; WIDTH] = [0.0, 0.006, 0.012, 0.02, 0.034, 0.05, 0.08, 0.12];

/// Some directions at one height.
pub(super) struct Site {
    pub ray: Ray,
    /// Azimuths from the sun, 0..=π.
    pub azimuths: [f64; WIDTH],
    pub points: Points<WIDTH>,
    /// The part of the sphere that each stands for; none where it is looked for the largest errors alone.
    pub parts: [f32; WIDTH],
}

/// The sites of one side of the horizon; none where there is nothing.
pub(super) fn sites(lattice: GridNodes, frame: &LocalFrame) -> Vec<Site> {
    if lattice.is_empty() {
        return Vec::new();
    }
    let count = ROWS[usize::from(lattice.side == Side::Down)];
    let even = (0..count).map(|i| even(lattice, frame, f64::from(i), f64::from(count)));
    let mut sites: Vec<Site> = even.collect();
    let columns = core::array::from_fn(|k| k as f64 / WIDTH as f64);
    sites.push(site(lattice, frame, LOWEST, columns, [0.0; WIDTH]));
    if lattice.side == Side::Up {
        let row = sun_row(lattice);
        let near = BESIDE_SUN.map(|offset| (row + offset).clamp(0.01, 0.99));
        let rows = LAYERS.into_iter().chain(near);
        sites.extend(rows.map(|row| site(lattice, frame, row, NEAR_SUN, [0.0; WIDTH])));
    }
    sites
}

/// A row of those that cover the side.
fn even(lattice: GridNodes, frame: &LocalFrame, i: f64, count: f64) -> Site {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let [low, high] = [i, i + 1.0].map(|edge| share_at_row(lattice.side, edge / count));
    let horizon = lattice.sky.dip().sin();
    let whole = match lattice.side {
        Side::Up => 1.0 + horizon,
        Side::Down => 1.0 - horizon,
    };
    let offset = ((i + 1.0) * GOLDEN).fract();
    let columns: [f64; WIDTH] = core::array::from_fn(|k| (k as f64 + offset) / WIDTH as f64);
    let edge = |k: usize| 2.0 * (k as f64 / WIDTH as f64).asin() / TAU;
    let part = |k| (high - low) * whole * (edge(k + 1) - edge(k));
    let parts = core::array::from_fn(|k| part(k) as f32);
    site(lattice, frame, (i + 0.5) / count, columns, parts)
}

/// The row that the sun is in, or the horizon.
fn sun_row(lattice: GridNodes) -> f64 {
    let horizon = -lattice.sky.dip().sin();
    let sun = lattice.sky.conditions().solar_elevation.sin();
    let share = ((sun - horizon) / (1.0 - horizon)).clamp(0.0, 1.0);
    row_at_share(Side::Up, share)
}

fn site(
    lattice: GridNodes,
    frame: &LocalFrame,
    row: f64,
    columns: [f64; WIDTH],
    parts: [f32; WIDTH],
) -> Site {
    let ray = lattice.ray(row);
    let azimuths = columns.map(|column| 2.0 * column.asin());
    let (r, z) = lattice.sky.cylinder(&ray);
    let sun = lattice.sky.conditions().solar_azimuth;
    let vectors = azimuths.map(|azimuth| {
        let (y, x) = (azimuth + sun).sin_cos();
        [r * x, r * y, z].map(|v| v as f32)
    });
    let component = |c: usize| Lanes(core::array::from_fn(|k| vectors[k][c]));
    Site {
        ray,
        azimuths,
        points: frame.locate([component(0), component(1), component(2)]),
        parts,
    }
}

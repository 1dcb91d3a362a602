//! Makes the tables of a baked sky from a prepared one.

use super::frame::{opaque_length, share};
use super::spline::{Start, coefficients, taps};
use super::table::{Grid, Table};
use crate::conditions::direction;
use crate::geometry::{Ray, Side};
use crate::lanes::Lanes;
use crate::phase::SunAngle;
use crate::simd::{Instructions, Kernel};
use crate::sky::Sky;

/// What a table holds: positive linear functions of the spectrum of relative radiance.
pub(crate) trait Channels<const N: usize> {
    /// Blocks of `N` channels.
    fn blocks(&self) -> usize;
    /// Channels in all blocks that exist.
    fn count(&self) -> usize;
    /// Channels of a block; those that do not exist are 1.
    fn project(&self, radiance: &[f32], block: usize) -> Lanes<N>;
}

/// Radiance is not less than this share of the envelope: logarithms need an end where a fit has gone below zero.
const FLOOR: f32 = 1e-4;

/// Makes a table.
pub(crate) struct Bake<'a, C, const N: usize> {
    pub sky: &'a Sky,
    pub channels: &'a C,
    pub grid: Grid,
}

/// Values at the nodes of one side, `[row][column]`.
type Nodes<const N: usize> = Vec<Vec<Lanes<N>>>;

impl<const N: usize, C: Channels<N>> Kernel for Bake<'_, C, N> {
    type Output = Table<N>;

    #[inline(always)]
    fn run<I: Instructions>(self, _: I) -> Table<N> {
        let mut table = Table {
            grid: self.grid,
            cells: Vec::with_capacity(self.channels.blocks() * self.grid.cells()),
            envelope: self.envelope(),
        };
        let up = self.nodes(&table, Side::Up);
        let down = self.nodes(&table, Side::Down);
        for (up, down) in up.iter().zip(&down) {
            self.interpolate(up, &mut table.cells);
            self.interpolate(down, &mut table.cells);
        }
        table
    }
}

impl<const N: usize, C: Channels<N>> Bake<'_, C, N> {
    /// What the phase functions make of the light that comes from beside the sun: smooth where the sky is not.
    #[inline(always)]
    fn envelope(&self) -> Vec<Lanes<N>> {
        let beside_sun = self.sky.row(&self.beside_sun());
        let mut radiance = vec![0.0; self.sky.wavelengths().len()];
        let mut values = vec![Vec::new(); self.channels.blocks()];
        for i in 0..=self.grid.sun {
            let half_sine = f64::from(i) / f64::from(self.grid.sun);
            let angle = SunAngle::from_versine(2.0 * half_sine * half_sine);
            self.sky.relative_in(&beside_sun, 0.0, angle, &mut radiance);
            for (block, values) in values.iter_mut().enumerate() {
                let value = self.channels.project(&radiance, block);
                values.push(value.max(Lanes::splat(f32::MIN_POSITIVE)).log2());
            }
        }
        let blocks = values.iter();
        blocks
            .flat_map(|values| coefficients(values, Start::Mirrored))
            .collect()
    }

    /// The ray towards the sun; above the horizon, where the sun is below it.
    fn beside_sun(&self) -> Ray {
        const LOWEST: f64 = 0.05;
        let altitude = self.sky.conditions().altitude;
        let above_horizon = self.sky.conditions().solar_elevation + self.sky.dip();
        let planet = self.sky.planet();
        planet.ray_beside_horizon(altitude, Side::Up, above_horizon.max(LOWEST))
    }

    /// log2 (radiance / opacity) without the envelope at the nodes, per block.
    #[inline(always)]
    fn nodes(&self, table: &Table<N>, side: Side) -> Vec<Nodes<N>> {
        let intervals = match side {
            Side::Up => self.grid.up,
            Side::Down => self.grid.down,
        };
        let azimuths: Vec<f64> = (0..=self.grid.azimuth).map(|i| self.azimuth(i)).collect();
        let sun = direction(self.sky.conditions().solar_elevation, 0.0);
        let mut radiance = vec![0.0; self.sky.wavelengths().len()];
        let mut nodes: Vec<Nodes<N>> = vec![Vec::new(); self.channels.blocks()];
        for i in 0..=intervals {
            let ray = self.ray(side, f64::from(i) / f64::from(intervals));
            let row = self.sky.row(&ray);
            let scale = 1.0 / self.opacity(&ray);
            let (r, z) = self.sky.cylinder(&ray);
            nodes.iter_mut().for_each(|rows| rows.push(Vec::new()));
            for &phi in &azimuths {
                // All azimuths meet at the poles.
                let phi = if i == intervals { 0.0 } else { phi };
                let (y, x) = phi.sin_cos();
                let angle = SunAngle::between([r * x, r * y, z], sun);
                self.sky.relative_in(&row, phi, angle, &mut radiance);
                let intervals = Lanes::splat(self.grid.sun as f32);
                let sun = taps(Lanes([angle.half_sine()]), intervals);
                for (block, rows) in nodes.iter_mut().enumerate() {
                    let value = self.channels.project(&radiance, block) * scale;
                    let least = Lanes::splat(f32::MIN_POSITIVE);
                    let ratio = value.max(least).log2() - table.envelope(&sun, 0, block);
                    rows[i as usize].push(ratio.max(Lanes::splat(FLOOR.log2())));
                }
            }
        }
        nodes
    }

    /// The inverse of the azimuth in [`super::frame`].
    fn azimuth(&self, column: u32) -> f64 {
        2.0 * (f64::from(column) / f64::from(self.grid.azimuth)).asin()
    }

    /// The inverse of the height in [`super::frame`].
    fn ray(&self, side: Side, height: f64) -> Ray {
        let dip = self.sky.dip();
        let (horizon, sign) = match side {
            Side::Up => (-dip.sin(), 1.0),
            Side::Down => (dip.sin(), -1.0),
        };
        let sine = (horizon + share(height) * (1.0 - horizon)).clamp(-1.0, 1.0);
        let angle = sine.asin() + sign * dip;
        let altitude = self.sky.conditions().altitude;
        self.sky.planet().ray_beside_horizon(altitude, side, angle)
    }

    /// As in [`super::frame`]; 1 where no air is, as nothing can be divided by 0.
    fn opacity(&self, ray: &Ray) -> f32 {
        let opaque = opaque_length(self.sky.conditions());
        match ray.side {
            Side::Down if ray.length > 0.0 => (ray.length / (ray.length + opaque)) as f32,
            _ => 1.0,
        }
    }

    /// Appends the coefficients of one side.
    #[inline(always)]
    fn interpolate(&self, nodes: &Nodes<N>, cells: &mut Vec<Lanes<N>>) {
        let across: Nodes<N> = nodes
            .iter()
            .map(|row| coefficients(row, Start::Mirrored))
            .collect();
        let first = cells.len();
        let (rows, columns) = (nodes.len() + 2, self.grid.columns());
        cells.resize(first + rows * columns, Lanes::splat(0.0));
        for column in 0..columns {
            let values: Vec<_> = across.iter().map(|row| row[column]).collect();
            for (row, c) in coefficients(&values, Start::Free).into_iter().enumerate() {
                cells[first + row * columns + column] = c;
            }
        }
    }
}

//! Makes the tables of a baked sky from a prepared one.

use super::frame::opaque_length;
use super::lattice::{Lattice, Nodes};
use super::spline::{Start, coefficients, taps};
use super::table::Table;
use crate::geometry::{Ray, Side};
use crate::lanes::Lanes;
use crate::phase::SunAngle;
use crate::simd::{Instructions, Kernel};

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
pub(super) struct Bake<'a, C, const N: usize> {
    pub lattice: Lattice<'a>,
    pub channels: &'a C,
}

impl<const N: usize, C: Channels<N>> Kernel for Bake<'_, C, N> {
    type Output = Table<N>;

    #[inline(always)]
    fn run<I: Instructions>(self, _: I) -> Table<N> {
        let grid = self.lattice.grid;
        let mut table = Table {
            grid,
            cells: Vec::with_capacity(self.channels.blocks() * grid.cells()),
            envelope: self.envelope(),
        };
        let up = self.nodes(&table, Side::Up);
        let down = self.nodes(&table, Side::Down);
        for (up, down) in up.iter().zip(&down) {
            self.lattice.interpolate(up, &mut table.cells);
            self.lattice.interpolate(down, &mut table.cells);
        }
        table
    }
}

impl<const N: usize, C: Channels<N>> Bake<'_, C, N> {
    /// What the phase functions make of the light that comes from beside the sun: smooth where the sky is not.
    #[inline(always)]
    fn envelope(&self) -> Vec<Lanes<N>> {
        let beside_sun = self.lattice.sky.row(&self.beside_sun());
        let mut radiance = vec![0.0; self.lattice.sky.wavelengths().len()];
        let mut values = vec![Vec::new(); self.channels.blocks()];
        for i in 0..=self.lattice.grid.sun {
            let half_sine = f64::from(i) / f64::from(self.lattice.grid.sun);
            let angle = SunAngle::from_versine(2.0 * half_sine * half_sine);
            self.lattice
                .sky
                .relative_in(&beside_sun, 0.0, angle, &mut radiance);
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
        let altitude = self.lattice.sky.conditions().altitude;
        let above_horizon = self.lattice.sky.conditions().solar_elevation + self.lattice.sky.dip();
        let planet = self.lattice.sky.planet();
        planet.ray_beside_horizon(altitude, Side::Up, above_horizon.max(LOWEST))
    }

    /// log2 (radiance / opacity) without the envelope at the nodes, per block.
    #[inline(always)]
    fn nodes(&self, table: &Table<N>, side: Side) -> Vec<Nodes<N>> {
        let azimuths: Vec<f64> = self.lattice.azimuths().collect();
        let mut radiance = vec![0.0; self.lattice.sky.wavelengths().len()];
        let mut nodes: Vec<Nodes<N>> = vec![Vec::new(); self.channels.blocks()];
        let rays: Vec<Ray> = self.lattice.rays(side).collect();
        for (i, ray) in rays.iter().enumerate() {
            let row = self.lattice.sky.row(ray);
            let scale = 1.0 / self.opacity(ray);
            nodes.iter_mut().for_each(|rows| rows.push(Vec::new()));
            // All azimuths meet at the poles.
            let same = vec![0.0; azimuths.len()];
            let azimuths = if i + 1 == rays.len() {
                &same
            } else {
                &azimuths
            };
            let angles = self.lattice.angles(ray, azimuths);
            for (&phi, angle) in azimuths.iter().zip(angles) {
                self.lattice
                    .sky
                    .relative_in(&row, phi, angle, &mut radiance);
                let intervals = Lanes::splat(self.lattice.grid.sun as f32);
                let sun = taps(Lanes([angle.half_sine()]), intervals);
                for (block, rows) in nodes.iter_mut().enumerate() {
                    let value = self.channels.project(&radiance, block) * scale;
                    let least = Lanes::splat(f32::MIN_POSITIVE);
                    let ratio = value.max(least).log2() - table.envelope(&sun, 0, block);
                    rows[i].push(ratio.max(Lanes::splat(FLOOR.log2())));
                }
            }
        }
        nodes
    }

    /// As in [`super::frame`]; 1 where no air is, as nothing can be divided by 0.
    fn opacity(&self, ray: &Ray) -> f32 {
        let opaque = opaque_length(self.lattice.sky.conditions());
        match ray.side {
            Side::Down if ray.length > 0.0 => (ray.length / (ray.length + opaque)) as f32,
            _ => 1.0,
        }
    }
}

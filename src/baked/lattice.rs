//! Where the nodes of baked tables stand, and coefficients from values there.

use super::frame::share;
use super::spline::{Start, coefficients};
use super::table::Grid;
use crate::conditions::direction;
use crate::geometry::{Ray, Side};
use crate::lanes::Lanes;
use crate::phase::SunAngle;
use crate::sky::Sky;

/// Values at the nodes of one side, `[row][column]`.
pub(super) type Nodes<const N: usize> = Vec<Vec<Lanes<N>>>;

/// The nodes of a grid over a sky.
#[derive(Clone, Copy)]
pub(super) struct Lattice<'a> {
    pub sky: &'a Sky,
    pub grid: Grid,
}

impl Lattice<'_> {
    /// Angles from the horizon at the rows of a side, from there to the pole.
    pub fn rays(&self, side: Side) -> impl Iterator<Item = Ray> {
        let intervals = match side {
            Side::Up => self.grid.up,
            Side::Down => self.grid.down,
        };
        (0..=intervals).map(move |i| self.ray(side, f64::from(i) / f64::from(intervals)))
    }

    /// Azimuths from the sun at the columns, 0..=π: the inverse of the azimuth in [`super::frame`].
    pub fn azimuths(&self) -> impl Iterator<Item = f64> {
        let intervals = self.grid.azimuth;
        (0..=intervals).map(move |i| 2.0 * (f64::from(i) / f64::from(intervals)).asin())
    }

    /// The angle from the sun at a node.
    pub fn angle(&self, ray: &Ray, phi: f64) -> SunAngle {
        self.angles(ray, &[phi])[0]
    }

    /// The angles from the sun at the nodes of a row.
    pub fn angles(&self, ray: &Ray, azimuths: &[f64]) -> Vec<SunAngle> {
        let (r, z) = self.sky.cylinder(ray);
        let [x, _, height] = direction(self.sky.conditions().solar_elevation, 0.0);
        // Half the squared chord, as in `SunAngle::between`; its part along the azimuth is (2 sin φ/2)².
        let same_azimuth = (r - x) * (r - x) + (z - height) * (z - height);
        let versine = |&phi: &f64| {
            let turn = 2.0 * (0.5 * phi).sin();
            SunAngle::from_versine(0.5 * (same_azimuth + r * x * turn * turn))
        };
        azimuths.iter().map(versine).collect()
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

    /// Appends the coefficients of one side.
    #[inline(always)]
    pub fn interpolate<const N: usize>(&self, nodes: &Nodes<N>, cells: &mut Vec<Lanes<N>>) {
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

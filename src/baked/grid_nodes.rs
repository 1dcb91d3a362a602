//! Where the nodes of baked tables stand, and coefficients from values there.

use super::coordinates::share_at_row;
use super::hemisphere_spline::Surface;
use super::spline::{Start, coefficients};
use super::spline_size::Size;
use crate::conditions::direction;
use crate::geometry::{Ray, Side};
use crate::kernel::lanes::Lanes;
use crate::phase_function::SunAngle;
use crate::sky::Sky;

/// Values at the nodes, `[row][column]`.
pub(super) type Nodes<const N: usize> = Vec<Vec<Lanes<N>>>;

/// One side of the horizon of a sky.
#[derive(Clone, Copy)]
pub(super) struct GridNodes<'a> {
    pub sky: &'a Sky,
    pub side: Side,
}

impl GridNodes<'_> {
    /// Whether there is anything on this side: below an observer on the ground there is not.
    pub fn is_empty(&self) -> bool {
        self.side == Side::Down && self.ray(1.0).length <= 0.0
    }

    /// The angles from the sun at azimuths on a ray.
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

    /// The ray at a height 0..=1 as in [`super::coordinates::Points::row`].
    pub fn ray(&self, row: f64) -> Ray {
        let dip = self.sky.dip();
        let (horizon, sign) = match self.side {
            Side::Up => (-dip.sin(), 1.0),
            Side::Down => (dip.sin(), -1.0),
        };
        let share = share_at_row(self.side, row);
        let sine = (horizon + share * (1.0 - horizon)).clamp(-1.0, 1.0);
        let angle = sine.asin() + sign * dip;
        let altitude = self.sky.conditions().altitude;
        self.sky
            .planet()
            .ray_beside_horizon(altitude, self.side, angle)
    }
}

/// Values at the nodes of one size after the other, `[block][row][column]`; those of the last size are not asked for
/// again.
pub(super) struct Known<const N: usize> {
    size: Size,
    blocks: Vec<Nodes<N>>,
}

impl<const N: usize> Known<N> {
    pub fn new(blocks: usize) -> Self {
        Self {
            size: Size {
                rows: 1,
                columns: 1,
            },
            blocks: vec![vec![Vec::new(); 2]; blocks],
        }
    }

    /// The surface through the values. `row` gives values in the row at a height, at azimuths and for all blocks:
    /// `[azimuth][block]`.
    #[inline(always)]
    pub fn surface(
        &mut self,
        size: Size,
        mut row: impl FnMut(f64, &[f64]) -> Vec<Lanes<N>>,
    ) -> Surface<N> {
        let blocks = self.blocks.len();
        let mut nodes: Vec<Nodes<N>> = vec![Vec::new(); blocks];
        for i in 0..=size.rows {
            let columns: Vec<u32> = (0..=size.columns).collect();
            let missing = |&&j: &&u32| self.place(size, i, j).is_none();
            let azimuths: Vec<f64> = columns
                .iter()
                .filter(missing)
                .map(|&j| azimuth(size, j))
                .collect();
            let values = match azimuths.is_empty() {
                true => Vec::new(),
                false => row(f64::from(i) / f64::from(size.rows), &azimuths),
            };
            let mut fresh = values.chunks(blocks);
            nodes.iter_mut().for_each(|rows| rows.push(Vec::new()));
            for j in columns {
                let known = self.place(size, i, j);
                let new = if known.is_none() { fresh.next() } else { None };
                for (block, rows) in nodes.iter_mut().enumerate() {
                    let value = match (known, new) {
                        (Some((i, j)), _) => self.blocks[block][i][j],
                        (None, new) => new.expect("a value for each azimuth")[block],
                    };
                    rows[i as usize].push(value);
                }
            }
        }
        let mut cells = Vec::with_capacity(blocks * size.cells());
        nodes
            .iter()
            .for_each(|nodes| interpolate(nodes, &mut cells));
        *self = Self {
            size,
            blocks: nodes,
        };
        Surface { size, cells }
    }

    /// Where the value of a node of a larger size stands.
    fn place(&self, size: Size, i: u32, j: u32) -> Option<(usize, usize)> {
        let (down, across) = (size.rows / self.size.rows, size.columns / self.size.columns);
        let (row, column) = ((i / down) as usize, (j / across) as usize);
        let there = i.is_multiple_of(down) && j.is_multiple_of(across);
        let known = self.blocks[0][row].get(column).is_some();
        (there && known).then_some((row, column))
    }
}

/// The azimuth from the sun, 0..=π, of a column: the inverse of the azimuth in [`super::coordinates`].
fn azimuth(size: Size, column: u32) -> f64 {
    2.0 * (f64::from(column) / f64::from(size.columns)).asin()
}

/// Appends the coefficients of a block.
#[inline(always)]
fn interpolate<const N: usize>(nodes: &Nodes<N>, cells: &mut Vec<Lanes<N>>) {
    let across: Nodes<N> = nodes
        .iter()
        .map(|row| coefficients(row, Start::Mirrored))
        .collect();
    let first = cells.len();
    let (rows, columns) = (nodes.len() + 2, across[0].len());
    cells.resize(first + rows * columns, Lanes::splat(0.0));
    for column in 0..columns {
        let values: Vec<_> = across.iter().map(|row| row[column]).collect();
        for (row, c) in coefficients(&values, Start::Free).into_iter().enumerate() {
            cells[first + row * columns + column] = c;
        }
    }
}

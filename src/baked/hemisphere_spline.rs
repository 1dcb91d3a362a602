//! One side of the horizon as bicubic B-splines: every size holds the splines of the smaller ones exactly, so that what
//! lies between two sizes can be had, too.

use super::spline::refined;
use super::spline_size::Size;
use super::spline_table::{Grid, Table};
use crate::kernel::lanes::Lanes;

/// Coefficients.
#[derive(Clone, Debug)]
pub(super) struct Surface<const N: usize> {
    pub size: Size,
    /// `[block][row][column]`.
    pub cells: Vec<Lanes<N>>,
}

impl<const N: usize> Surface<N> {
    /// The same surface with more coefficients: both numbers of intervals times powers of two.
    pub fn refined(mut self, size: Size) -> Self {
        while self.size.columns < size.columns {
            let rows = self.cells.chunks(self.size.stride());
            self.cells = rows.flat_map(refined).collect();
            self.size.columns *= 2;
        }
        while self.size.rows < size.rows {
            let blocks = self.cells.chunks(self.size.cells());
            let stride = self.size.stride();
            self.cells = blocks.flat_map(|block| taller(block, stride)).collect();
            self.size.rows *= 2;
        }
        debug_assert_eq!(self.size, size);
        self
    }

    /// A share of this surface and the rest of a finer one.
    pub fn blended(self, share: f32, finer: Self) -> Self {
        let mut blend = self.refined(finer.size);
        for (cell, finer) in blend.cells.iter_mut().zip(&finer.cells) {
            *cell = *cell * share + *finer * (1.0 - share);
        }
        blend
    }
}

/// A block with twice as many intervals over the height.
fn taller<const N: usize>(block: &[Lanes<N>], stride: usize) -> Vec<Lanes<N>> {
    let column = |k: usize| -> Vec<_> { block[k..].iter().step_by(stride).copied().collect() };
    let columns: Vec<_> = (0..stride).map(|k| refined(&column(k))).collect();
    let rows = 0..columns[0].len();
    rows.flat_map(|row| columns.iter().map(move |column| column[row]))
        .collect()
}

/// The size of the table that holds both sides.
pub(super) fn grid(up: Size, down: Size) -> Grid {
    Grid {
        up: up.rows,
        down: down.rows,
        azimuth: up.columns.max(down.columns),
    }
}

/// Coefficients of both sides as a table of this or a smaller size has them: `[block][up rows, then down
/// rows][azimuth]`.
pub(super) fn joined<const N: usize>(
    up: Surface<N>,
    down: Surface<N>,
    grid: Grid,
) -> Vec<Lanes<N>> {
    let [up, down] = [(up, grid.up), (down, grid.down)].map(|(surface, rows)| {
        surface.refined(Size {
            rows,
            columns: grid.azimuth,
        })
    });
    let blocks = up.cells.chunks(up.size.cells());
    let blocks = blocks.zip(down.cells.chunks(down.size.cells()));
    blocks.flat_map(|(up, down)| [up, down].concat()).collect()
}

/// The two sides of a table.
fn parted<const N: usize>(cells: &[Lanes<N>], grid: Grid) -> [Surface<N>; 2] {
    let columns = grid.azimuth;
    let [mut up, mut down] = [grid.up, grid.down].map(|rows| Surface {
        size: Size { rows, columns },
        cells: Vec::new(),
    });
    for block in cells.chunks(grid.cells()) {
        let (above, below) = block.split_at(up.size.cells());
        up.cells.extend_from_slice(above);
        down.cells.extend_from_slice(below);
    }
    [up, down]
}

impl<const N: usize> Table<N> {
    /// Takes a larger grid, without a change of what it holds.
    pub fn refine(&mut self, grid: Grid) {
        if grid != self.grid {
            let [up, down] = parted(&self.cells, self.grid);
            self.cells = joined(up, down, grid);
            self.grid = grid;
        }
    }
}

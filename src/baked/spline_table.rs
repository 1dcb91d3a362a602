//! The tables of a baked sky and the inner loops over them.
//!
//! log2 (radiance / opacity) = bicubic B-spline over (distance from the horizon, azimuth) on each side of the horizon
//! + cubic B-spline over the angle from the sun, which holds what the phase functions do.

use super::coordinates::Points;
use super::spline::{Taps, taps};
use super::spline_size::Size;
use crate::kernel::lanes::Lanes;

/// Intervals over the angle from the sun. More of them change nothing that matters.
pub(super) const SUN: u32 = 32;

/// Coefficients over the angle from the sun.
pub(super) const ENVELOPE: usize = SUN as usize + 3;

/// Channels that are handed out together.
pub(super) const GROUP: usize = 4;

/// Intervals of the other axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Grid {
    pub up: u32,
    pub down: u32,
    pub azimuth: u32,
}

impl Grid {
    #[inline(always)]
    pub fn columns(&self) -> usize {
        self.azimuth as usize + 3
    }

    /// Rows above and below the horizon.
    #[inline(always)]
    pub fn rows(&self) -> [usize; 2] {
        [self.up as usize + 3, self.down as usize + 3]
    }

    /// The larger number of each axis.
    pub fn or_larger(self, other: Self) -> Self {
        Self {
            up: self.up.max(other.up),
            down: self.down.max(other.down),
            azimuth: self.azimuth.max(other.azimuth),
        }
    }

    /// Cells of the two sides together.
    #[inline(always)]
    pub fn cells(&self) -> usize {
        let [up, down] = self.rows();
        (up + down) * self.columns()
    }
}

/// Tables of some blocks of `N` channels.
#[derive(Clone, Debug)]
pub(crate) struct Table<const N: usize> {
    pub grid: Grid,
    /// `[block][up rows, then down rows][azimuth]`.
    pub cells: Vec<Lanes<N>>,
    /// `[block][sun]`.
    pub envelope: Vec<Lanes<N>>,
}

/// Directions, looked up: what all channels share.
#[derive(Clone, Copy)]
pub(crate) struct Spots<const W: usize> {
    first: [u32; W],
    rows: [Lanes<W>; 4],
    columns: [Lanes<W>; 4],
    envelope: Taps<W>,
    pub opacity: Lanes<W>,
}

impl<const N: usize> Table<N> {
    #[inline(always)]
    pub fn spots<const W: usize>(&self, points: Points<W>) -> Spots<W> {
        let Grid { up, down, azimuth } = self.grid;
        let above = Lanes::splat(up as f32);
        let intervals = points.side.at_least(0.0, above, Lanes::splat(down as f32));
        let rows = taps(points.row, intervals);
        let columns = taps(points.azimuth, Lanes::splat(azimuth as f32));
        let mut first = [0; W];
        for i in 0..W {
            let skipped = if points.side.0[i] >= 0.0 { 0 } else { up + 3 };
            first[i] = (skipped + rows.first[i]) * (azimuth + 3) + columns.first[i];
        }
        Spots {
            first,
            rows: rows.weight,
            columns: columns.weight,
            envelope: taps(points.sun, Lanes::splat(SUN as f32)),
            opacity: points.opacity,
        }
    }

    /// Channels of a block for direction `i`.
    #[inline(always)]
    pub fn value<const W: usize>(&self, spots: &Spots<W>, i: usize, block: usize) -> Lanes<N> {
        self.logarithm(spots, i, block).exp2() * spots.opacity.0[i]
    }

    /// Logarithms of the channels of a block for direction `i`, without the opacity.
    #[inline(always)]
    pub fn logarithm<const W: usize>(&self, spots: &Spots<W>, i: usize, block: usize) -> Lanes<N> {
        let envelope = spots.envelope(&self.envelope, i, block);
        spots.surface(envelope, &self.grid, &self.cells, i, block)
    }

    #[inline(always)]
    pub fn blocks(&self) -> usize {
        self.envelope.len() / ENVELOPE
    }

    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        size_of_val(self.cells.as_slice()) + size_of_val(self.envelope.as_slice())
    }
}

/// What the envelope (`[block][sun]`) is at an angle from the sun.
#[inline(always)]
pub(super) fn envelope<const N: usize, const W: usize>(
    cells: &[Lanes<N>],
    taps: &Taps<W>,
    i: usize,
    block: usize,
) -> Lanes<N> {
    let first = block * ENVELOPE + taps.first[i] as usize;
    weighted(&cells[first..], &taps.weight, i)
}

impl<const W: usize> Spots<W> {
    /// For a table of one side alone, on which all the points are.
    #[inline(always)]
    pub fn on_side(points: &Points<W>, size: Size) -> Self {
        let rows = taps(points.row, Lanes::splat(size.rows as f32));
        let columns = taps(points.azimuth, Lanes::splat(size.columns as f32));
        let stride = size.stride() as u32;
        Self {
            first: core::array::from_fn(|i| rows.first[i] * stride + columns.first[i]),
            rows: rows.weight,
            columns: columns.weight,
            envelope: taps(points.sun, Lanes::splat(SUN as f32)),
            opacity: points.opacity,
        }
    }

    /// [`envelope`] for direction `i`.
    #[inline(always)]
    pub fn envelope<const N: usize>(&self, cells: &[Lanes<N>], i: usize, block: usize) -> Lanes<N> {
        envelope(cells, &self.envelope, i, block)
    }

    /// Adds the bicubic spline with these coefficients (`[block][up rows, then down rows][azimuth]`) for direction `i`.
    #[inline(always)]
    pub fn surface<const N: usize>(
        &self,
        sum: Lanes<N>,
        grid: &Grid,
        cells: &[Lanes<N>],
        i: usize,
        block: usize,
    ) -> Lanes<N> {
        let first = block * grid.cells();
        self.bicubic(sum, first, grid.columns(), cells, i)
    }

    /// Adds the bicubic spline whose coefficients start at `first`, in rows of `stride`.
    #[inline(always)]
    pub fn bicubic<const N: usize>(
        &self,
        mut sum: Lanes<N>,
        first: usize,
        stride: usize,
        cells: &[Lanes<N>],
        i: usize,
    ) -> Lanes<N> {
        let first = first + self.first[i] as usize;
        for (k, weight) in self.rows.iter().enumerate() {
            let row = weighted(&cells[first + k * stride..], &self.columns, i);
            sum = sum + row * weight.0[i];
        }
        sum
    }
}

/// Sum of the first four cells, weighted for direction `i`.
#[inline(always)]
fn weighted<const N: usize, const W: usize>(
    cells: &[Lanes<N>],
    weight: &[Lanes<W>; 4],
    i: usize,
) -> Lanes<N> {
    let cells = &cells[..4];
    let term = |k: usize| cells[k] * weight[k].0[i];
    (term(0) + term(1)) + (term(2) + term(3))
}

/// From `[block][length]` with so many channels in a block to `[group of four][length]`; lanes before `first` are left
/// out.
pub(super) fn regrouped<const N: usize>(
    cells: &[Lanes<N>],
    length: usize,
    groups: usize,
    [first, channels]: [usize; 2],
) -> Vec<[f32; 4]> {
    let mut out = Vec::with_capacity(groups * length);
    for channel in (0..groups).map(|group| group * GROUP) {
        let (block, lane) = (channel / channels, first + channel % channels);
        let block = &cells[block * length..][..length];
        let group = |cell: &Lanes<N>| core::array::from_fn(|i| cell.0[lane + i]);
        out.extend(block.iter().map(group));
    }
    out
}

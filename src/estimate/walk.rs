//! A walk along the stops of a ray, eight at a time: the columns of air to the observer and on to the sun, and where
//! the tables tell of diffuse light.
//!
//! No closures in the loops: they would be compiled without the instructions of the kernel.
#![allow(clippy::needless_range_loop)]

use core::f32::consts::{FRAC_PI_2, LOG2_E};

use zerocopy::little_endian::F32;

use super::blocks::WIDTH;
use super::path::Stops;
use super::points::{Axes, BATCH, Numbers, Points, SUN};
use crate::format::{EstimateView, MAX_LEVELS};
use crate::kernel::lanes::Lanes;
use crate::kernel::simd::{Instructions, Kernel};
use crate::visible_disc::mean_share;

/// Over which the density of the air falls by e, m: what counts more within a panel where the sun rises.
const FALL: f32 = 8000.0;
/// Angles from the horizon are dense below this, rad.
const BEND: f32 = 0.1;
/// Most levels.
const MOST_LEVELS: usize = MAX_LEVELS.next_multiple_of(BATCH);

/// One number per constituent.
type Row = Lanes<WIDTH>;

/// What is at a stop.
#[derive(Clone, Copy)]
pub(super) struct Stop<const S: usize> {
    /// Columns of air to the observer, m, and from the sun by the stop to the observer.
    pub to_observer: Row,
    pub by_sun: Row,
    /// Columns since the stop before of what scatters, m.
    pub panel: [f32; S],
    /// Where four rows of diffuse light begin, in blocks, and their weights in halvings.
    pub light: [usize; 4],
    pub weight: [f32; 4],
    /// Mean visible share of the sun's disc since the stop before.
    pub share: f32,
}

impl<const S: usize> Stop<S> {
    pub const NONE: Self = Self {
        to_observer: Lanes([0.0; WIDTH]),
        by_sun: Lanes([0.0; WIDTH]),
        panel: [0.0; S],
        light: [0; 4],
        weight: [0.0; 4],
        share: 0.0,
    };
}

/// Where along the ray it is, and what lies behind.
pub(super) struct Walk<'a> {
    tables: &'a EstimateView<'a>,
    density_rows: &'a [[F32; WIDTH]],
    column_rows: &'a [[F32; WIDTH]],
    /// Altitudes of the levels, m, and the dips of their horizons, rad.
    levels: [f32; MOST_LEVELS],
    dips: [f32; MOST_LEVELS],
    columns: Row,
    density: Row,
    distance: f64,
    altitude: f32,
    rise: f32,
}

/// Where stops are on an axis: cell and rest.
struct Cell {
    index: [u32; BATCH],
    rest: Numbers,
}

impl Cell {
    #[inline(always)]
    fn new(coordinate: Numbers, intervals: usize) -> Self {
        let last = Numbers::splat(intervals as f32);
        let coordinate = coordinate.max(Numbers::splat(0.0)).min(last);
        let (cell, index) = coordinate.round_down(Numbers::splat((intervals - 1) as f32));
        let rest = coordinate - cell;
        Self { index, rest }
    }
}

/// Where stops are in the tables.
pub(super) struct Cells {
    density: Cell,
    halfway: Cell,
    sun: Cell,
    /// Levels below, and how far the next is.
    level: [u32; BATCH],
    up: Numbers,
    /// On the axis of angles, at the level below and at the next.
    angle: [Cell; 2],
}

/// A walk goes on to the next stops.
pub(super) struct Steps<'a, 'b, const S: usize> {
    pub walk: &'a mut Walk<'b>,
    pub axes: &'a Axes,
    pub stops: &'a Stops,
    pub first: usize,
    pub scatterers: &'a [usize; S],
    pub out: &'a mut [Stop<S>],
}

impl<const S: usize> Kernel for Steps<'_, '_, S> {
    type Output = ();

    #[inline(always)]
    fn run<I: Instructions>(self, _: I) {
        let points = self.axes.points(self.stops, self.first);
        let cells = self.walk.cells(&points);
        for (i, out) in self.out.iter_mut().enumerate() {
            let distance = self.stops.distance[self.first + i];
            *out = self
                .walk
                .step(&points, &cells, i, distance, self.scatterers);
        }
    }
}

impl<'a> Walk<'a> {
    #[inline(always)]
    pub fn new(axes: &Axes, tables: &'a EstimateView<'a>) -> Self {
        let mut levels = [0.0; MOST_LEVELS];
        for (to, from) in levels.iter_mut().zip(tables.level) {
            *to = from.get();
        }
        let mut dips = [0.0; MOST_LEVELS];
        let batches = levels.as_chunks::<BATCH>().0.iter();
        for (dips, levels) in dips.as_chunks_mut::<BATCH>().0.iter_mut().zip(batches) {
            *dips = axes.dip(Lanes(*levels)).0;
        }
        Self {
            tables,
            density_rows: tables.density.as_chunks().0,
            column_rows: tables.column.as_chunks().0,
            levels,
            dips,
            columns: Lanes::splat(0.0),
            density: Lanes::splat(0.0),
            distance: 0.0,
            altitude: 0.0,
            rise: 0.0,
        }
    }

    /// Where stops are in the tables.
    #[inline(always)]
    fn cells(&self, points: &Points) -> Cells {
        let tables = self.tables;
        let mut level = [0; BATCH];
        for l in 1..tables.level.len().min(MOST_LEVELS) - 1 {
            for i in 0..BATCH {
                level[i] += u32::from(points.altitude.0[i] >= self.levels[l]);
            }
        }
        let low = pick(&self.levels, &level, 0);
        let up = (points.altitude - low) / (pick(&self.levels, &level, 1) - low);
        let dips = [pick(&self.dips, &level, 0), pick(&self.dips, &level, 1)];
        Cells {
            density: Cell::new(points.density, tables.densities - 1),
            halfway: Cell::new(points.halfway, tables.densities - 1),
            sun: Cell::new(points.sun, tables.suns - 1),
            angle: [self.angle(points, dips[0]), self.angle(points, dips[1])],
            up: up.max(Lanes::splat(0.0)).min(Lanes::splat(1.0)),
            level,
        }
    }

    /// What is seen of the sun on the axis of angles at levels with these dips: at the same elevation, but on the
    /// horizon where the sun is there.
    #[inline(always)]
    fn angle(&self, points: &Points, dip: Numbers) -> Cell {
        let intervals = self.tables.angles - 1;
        let seen = points.seen;
        let turned = (dip - points.dip) * (seen / (seen + Lanes::splat(1.0)));
        let angle = (seen * SUN + turned).max(Lanes::splat(0.0));
        let range = dip + Lanes::splat(FRAC_PI_2);
        let bend = Lanes::splat(BEND);
        let share = angle * (range + bend) / (range * (angle + bend));
        Cell::new(share * intervals as f32, intervals)
    }

    /// Goes on to stop `i` of a batch, at a distance from the observer.
    #[inline(always)]
    fn step<const S: usize>(
        &mut self,
        points: &Points,
        cells: &Cells,
        i: usize,
        distance: f64,
        scatterers: &[usize; S],
    ) -> Stop<S> {
        let here = between(self.density_rows, 0, &cells.density, i);
        let halfway = between(self.density_rows, 0, &cells.halfway, i);
        let step = (distance - self.distance) as f32;
        let panel = (self.density + halfway * 4.0 + here) * (step * (1.0 / 6.0));
        self.columns = self.columns + panel;
        (self.density, self.distance) = (here, distance);
        let mut scattering = [0.0; S];
        for k in 0..S {
            scattering[k] = panel.0[scatterers[k] % WIDTH];
        }
        let (light, weight) = self.light(cells, i);
        Stop {
            to_observer: self.columns,
            by_sun: self.columns + self.to_sun(cells, i),
            panel: scattering,
            light,
            weight,
            share: self.share(points.altitude.0[i], points.rise.0[i]),
        }
    }

    /// Mean visible share of the sun's disc on the way to an altitude at which it stands so high.
    #[inline(always)]
    fn share(&mut self, altitude: f32, rise: f32) -> f32 {
        let fall = (altitude - self.altitude) * (1.0 / FALL);
        let before = self.rise;
        (self.altitude, self.rise) = (altitude, rise);
        match (before.min(rise) >= 1.0, before.max(rise) <= -1.0) {
            (true, _) => 1.0,
            (_, true) => 0.0,
            _ => mean_share(before, rise, fall),
        }
    }

    /// Columns to what is seen of the sun.
    #[inline(always)]
    fn to_sun(&self, cells: &Cells, i: usize) -> Row {
        let angles = self.tables.angles;
        let below = cells.level[i] as usize * angles;
        let low = between(self.column_rows, below, &cells.angle[0], i);
        let high = between(self.column_rows, below + angles, &cells.angle[1], i);
        mix(low, high, cells.up.0[i]).exp()
    }

    /// Rows of diffuse light and their weights.
    #[inline(always)]
    fn light(&self, cells: &Cells, i: usize) -> ([usize; 4], [f32; 4]) {
        let (suns, blocks) = (self.tables.suns, self.tables.light_stride / WIDTH);
        let (up, t) = (cells.up.0[i], cells.sun.rest.0[i]);
        let low = (cells.level[i] as usize * suns + cells.sun.index[i] as usize) * blocks;
        let high = low + suns * blocks;
        let [low_share, high_share] = [(1.0 - up) * LOG2_E, up * LOG2_E];
        (
            [low, low + blocks, high, high + blocks],
            [
                low_share * (1.0 - t),
                low_share * t,
                high_share * (1.0 - t),
                high_share * t,
            ],
        )
    }
}

/// The constituents that scatter in any estimate; after the last 32, which no row has.
#[inline(always)]
pub(super) fn scatterers<const S: usize>(tables: &EstimateView) -> [usize; S] {
    let mut out = [0; S];
    let mut rest = tables.any_scatters();
    for k in 0..S {
        out[k] = rest.trailing_zeros() as usize;
        rest &= rest.wrapping_sub(1);
    }
    out
}

/// Numbers of levels, or of those above them.
#[inline(always)]
fn pick(values: &[f32; MOST_LEVELS], level: &[u32; BATCH], above: usize) -> Numbers {
    let mut out = Numbers::splat(0.0);
    for i in 0..BATCH {
        out.0[i] = values[(level[i] as usize + above).min(MOST_LEVELS - 1)];
    }
    out
}

/// A row between two, from `first` on.
#[inline(always)]
fn between(rows: &[[F32; WIDTH]], first: usize, cell: &Cell, i: usize) -> Row {
    let row = first + cell.index[i] as usize;
    mix(
        Lanes::read(&rows[row]),
        Lanes::read(&rows[row + 1]),
        cell.rest.0[i],
    )
}

#[inline(always)]
fn mix(a: Row, b: Row, t: f32) -> Row {
    a + (b - a) * t
}

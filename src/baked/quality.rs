//! How many nodes a baked sky needs: measured at directions between its nodes.

use super::bake::{Bake, Channels};
use super::frame::Frame;
use super::lattice::Lattice;
use super::table::{Grid, Table};
use crate::error::{Error, Result};
use crate::lanes::Lanes;
use crate::simd::dispatch;
use crate::sky::Sky;

/// What baking adds to the error of a sky: relative differences of all channels at directions that are not
/// nodes, each counted by the part of the sphere that it stands for, nothing excluded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BakeError {
    /// Median.
    pub median: f64,
    /// 95th percentile: the one that is bounded.
    pub p95: f64,
    /// 99th percentile.
    pub p99: f64,
    /// Largest.
    pub max: f64,
}

/// Errors of the compared directions, with the parts of the sphere that these stand for.
#[derive(Default)]
pub(super) struct Errors(Vec<(f64, f64)>);

impl Errors {
    pub fn add(&mut self, errors: impl Iterator<Item = f64>, part: f64) {
        self.0.extend(errors.map(|error| (error, part)));
    }

    /// From small to large.
    pub fn sorted(mut self) -> Self {
        self.0.sort_unstable_by(|(a, _), (b, _)| a.total_cmp(b));
        self
    }

    fn quantile(&self, q: f64) -> f64 {
        let mut above = (1.0 - q) * self.0.iter().map(|(_, part)| part).sum::<f64>();
        let mut largest = self.0.iter().rev();
        largest
            .find(|(_, part)| {
                above -= part;
                above < 0.0
            })
            .map_or(0.0, |&(error, _)| error)
    }

    /// What they take of the tolerance. Where the largest errors stand steeply above the rest, the 95th percentile of
    /// other directions may be among them: so the 97th may not be much larger, unless there is no larger grid.
    pub fn strain(&self, tolerance: f64, grid: Grid) -> f64 {
        let steep = match beyond(grid) {
            Some(_) => self.quantile(0.97) / STEEP,
            None => 0.0,
        };
        self.quantile(0.95).max(steep) / tolerance
    }

    pub fn summary(&self) -> BakeError {
        BakeError {
            median: self.quantile(0.5),
            p95: self.quantile(0.95),
            p99: self.quantile(0.99),
            max: self.quantile(1.0),
        }
    }
}

/// From small to large, with the 95th percentile of the error that four in five skies keep.
const GRIDS: [(f64, Grid); 8] = [
    (1e-2, grid(12, 8, 8, 24)),
    (3e-3, grid(16, 12, 12, 32)),
    (1.9e-3, grid(20, 14, 12, 32)),
    (1.5e-3, grid(24, 16, 16, 32)),
    (1.2e-3, grid(32, 24, 20, 32)),
    (8e-4, grid(40, 32, 24, 48)),
    (4.5e-4, grid(64, 48, 32, 64)),
    // For the stratosphere at dusk.
    (3e-4, grid(96, 64, 48, 96)),
];

/// The largest grid.
pub(super) const LARGEST: Grid = GRIDS[GRIDS.len() - 1].1;

/// Most bytes that the tables of a baked sky take, for `n` channels in vectors of `width`.
pub(super) fn largest_table(n: usize, width: usize) -> usize {
    let grid = LARGEST;
    n.div_ceil(width) * width * size_of::<f32>() * (grid.cells() + grid.envelope_cells())
}

const fn grid(up: u32, down: u32, azimuth: u32, sun: u32) -> Grid {
    Grid {
        up,
        down,
        azimuth,
        sun,
    }
}

/// Largest ratio of the 97th percentile to the tolerance.
const STEEP: f64 = 1.1;

/// What the 95th percentile mostly is of the tolerance where the 97th keeps that.
const USUAL: f64 = 0.85;

/// Directions that are compared.
const SAMPLES: u32 = 192;

/// The place of the next larger grid.
pub(super) fn beyond(grid: Grid) -> Option<usize> {
    let next = 1 + GRIDS.iter().position(|&(_, other)| other == grid)?;
    (next < GRIDS.len()).then_some(next)
}

/// The smallest table that keeps the tolerance on the 95th percentile, and its error; with the grid at `least` or a larger one.
pub(super) fn bake<const N: usize, C: Channels<N>>(
    sky: &Sky,
    channels: &C,
    frame: &Frame,
    tolerance: f64,
    least: usize,
) -> Result<(Table<N>, BakeError)> {
    let truth = Truth::new(sky, channels)?;
    let last = GRIDS.len() - 1;
    let fitting = |wanted: f64| {
        GRIDS
            .partition_point(|&(typical, _)| typical > wanted)
            .min(last)
    };
    let mut i = fitting(USUAL * tolerance).max(least);
    loop {
        let (typical, grid) = GRIDS[i];
        let table = dispatch(Bake {
            lattice: Lattice { sky, grid },
            channels,
        });
        let errors = truth.compare(&table, frame);
        let strain = errors.strain(tolerance, grid);
        if strain <= 1.0 {
            return Ok((table, errors.summary()));
        }
        if i == last {
            return Err(Error::Tolerance {
                expected: tolerance,
                got: strain * tolerance,
            });
        }
        // This sky is harder than others by as much as it strains the tolerance more.
        i = fitting(typical / strain).max(i + 1);
    }
}

/// What the tables are compared with.
struct Truth<const N: usize> {
    directions: Vec<([f32; 3], f64)>,
    /// `[direction][block]`.
    values: Vec<Lanes<N>>,
    blocks: usize,
    /// Channels that exist.
    channels: usize,
}

impl<const N: usize> Truth<N> {
    fn new<C: Channels<N>>(sky: &Sky, channels: &C) -> Result<Self> {
        let mut radiance = vec![0.0; sky.wavelengths().len()];
        let directions: Vec<_> = directions(sky).collect();
        let mut values = Vec::new();
        for &(direction, _) in &directions {
            sky.relative_radiance(direction, &mut radiance)?;
            values.extend((0..channels.blocks()).map(|block| channels.project(&radiance, block)));
        }
        Ok(Self {
            directions,
            values,
            blocks: channels.blocks(),
            channels: channels.count(),
        })
    }

    fn compare(&self, table: &Table<N>, frame: &Frame) -> Errors {
        let mut errors = Errors::default();
        for (&(direction, part), values) in
            self.directions.iter().zip(self.values.chunks(self.blocks))
        {
            let spot = table.spots(frame.locate(direction.map(|v| Lanes([v]))));
            for (block, value) in values.iter().enumerate() {
                let got = table.value(&spot, 0, block);
                let count = self.channels.min((block + 1) * N) - block * N;
                errors.add((0..count).map(|i| difference(got.0[i], value.0[i])), part);
            }
        }
        errors.sorted()
    }
}

/// Relative to the least that tables hold where there is less.
fn difference(got: f32, expected: f32) -> f64 {
    let (got, expected) = (f64::from(got), f64::from(expected));
    (got - expected).abs() / expected.abs().max(f64::from(f32::MIN_POSITIVE))
}

/// The directions that are compared, with the parts of the sphere that they stand for.
pub(super) fn directions(sky: &Sky) -> impl Iterator<Item = ([f32; 3], f64)> + use<> {
    let sun = sky.conditions().solar_azimuth;
    (0..SAMPLES).map(move |i| direction(i, sun))
}

/// A point of the golden spiral, drawn together towards the horizon, where most of the errors are.
fn direction(i: u32, sun: f64) -> ([f32; 3], f64) {
    const GOLDEN: f64 = 2.399_963_229_728_653;
    let v = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(SAMPLES);
    let z = v * v.abs();
    let (y, x) = (GOLDEN * f64::from(i) + sun).sin_cos();
    let r = (1.0 - z * z).sqrt();
    ([r * x, r * y, z].map(|c| c as f32), v.abs())
}

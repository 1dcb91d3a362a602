//! How many nodes a baked sky needs: measured at directions between its nodes.

use super::hemisphere_spline::{Surface, grid};
use super::spline_size::Size;
use super::spline_table::{ENVELOPE, Grid};
use crate::error::{Error, Result};
use crate::geometry::Side;

/// What baking adds to the error of a sky: relative differences of all channels at some 660 directions that are not
/// nodes, each counted by the part of the sphere that it stands for, nothing excluded but what is below an observer on
/// the ground. They are dense where errors are large: at the horizon, and beside the sun. Where a channel is darker than
/// 10⁻⁵ of its brightest direction, they are relative to that much light.
///
/// ```
/// use welkin::{BakedSky, Conditions, Model};
///
/// let sky = Model::default_model()?.sky(&Conditions::default())?;
/// let error = sky.bake(BakedSky::TOLERANCE)?.bake_error();
/// assert!(error.median <= error.p95 && error.p95 <= BakedSky::TOLERANCE);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BakeError {
    /// Median.
    pub median: f64,
    /// 95th percentile: at most the tolerance.
    pub p95: f64,
    /// 99th percentile.
    pub p99: f64,
    /// 99.9th percentile: at most [`BakedSky::TAIL`](crate::BakedSky::TAIL) times the tolerance, unless the largest
    /// table misses that.
    pub p999: f64,
    /// Largest of the compared directions: at most [`BakedSky::PEAK`](crate::BakedSky::PEAK) times the tolerance,
    /// unless the largest table misses that. Between them it is often twice as large, in twilight up to ten times.
    pub max: f64,
}

impl BakeError {
    /// The larger of each.
    pub(super) fn or_larger(self, other: Self) -> Self {
        Self {
            median: self.median.max(other.median),
            p95: self.p95.max(other.p95),
            p99: self.p99.max(other.p99),
            p999: self.p999.max(other.p999),
            max: self.max.max(other.max),
        }
    }
}

/// Errors of the compared directions, with the parts of the sphere that these stand for. As bits: those of the error,
/// which order like it, before those of the part, so that sorting takes integers.
#[derive(Clone, Default)]
pub(super) struct Errors(Vec<u64>);

impl Errors {
    /// For so many of them.
    pub fn with_capacity(count: usize) -> Self {
        Self(Vec::with_capacity(count))
    }

    /// Not less than 0.
    #[inline(always)]
    pub fn add(&mut self, errors: impl Iterator<Item = f32>, part: f32) {
        let part = u64::from(part.to_bits());
        self.0
            .extend(errors.map(|error| u64::from(error.abs().to_bits()) << 32 | part));
    }

    /// From small to large.
    pub fn sorted(mut self) -> Self {
        self.0.sort_unstable();
        self
    }

    /// Of two sides of the horizon.
    pub fn and(mut self, other: Self) -> Self {
        self.0.extend(other.0);
        // Finds the two runs and merges them.
        self.0.sort();
        self
    }

    fn quantile(&self, q: f64) -> f64 {
        let mut above = (1.0 - q) * self.0.iter().map(|&bits| part(bits)).sum::<f64>();
        let mut largest = self.0.iter().rev();
        largest
            .find(|&&bits| {
                above -= part(bits);
                above < 0.0
            })
            .map_or(0.0, |&bits| error(bits))
    }

    /// What they take of the tolerance. Where the largest errors stand steeply above the rest, the 95th percentile of
    /// other directions may be among them: so the 97th may not be much larger.
    fn strain(&self, tolerance: f64, level: usize) -> f64 {
        let most = self.quantile(0.95) / tolerance;
        if level >= PATIENT {
            return most;
        }
        let steep = self.quantile(0.97) / STEEP;
        let tail = self.quantile(0.999) / TAIL;
        let peak = self.largest() / PEAK;
        most.max(steep.max(tail).max(peak) / tolerance)
    }

    fn largest(&self) -> f64 {
        self.0.last().map_or(0.0, |&bits| error(bits))
    }

    pub fn summary(&self) -> BakeError {
        BakeError {
            median: self.quantile(0.5),
            p95: self.quantile(0.95),
            p99: self.quantile(0.99),
            p999: self.quantile(0.999),
            max: self.largest(),
        }
    }
}

fn error(bits: u64) -> f64 {
    f64::from(f32::from_bits((bits >> 32) as u32))
}

fn part(bits: u64) -> f64 {
    f64::from(f32::from_bits(bits as u32))
}

/// Sizes from small to large, with the 95th percentile of the error that four in five skies keep. Each holds the
/// splines of those before it.
const LEVELS: [(f64, Size); 9] = [
    (2e-2, size(12, 6)),
    (1e-2, size(24, 6)),
    (1.9e-3, size(24, 12)),
    (1.2e-3, size(48, 12)),
    (8e-4, size(48, 24)),
    (5e-4, size(96, 24)),
    // For the stratosphere at dusk.
    (3e-4, size(96, 48)),
    (2e-4, size(192, 48)),
    (1.5e-4, size(192, 96)),
];

const fn size(rows: u32, columns: u32) -> Size {
    Size { rows, columns }
}

/// From this level on a size gives way to a larger one for the 95th percentile only.
const PATIENT: usize = 6;

/// The part of a level on one side: below the horizon two thirds of the rows do.
fn on_side(side: Side, level: usize) -> Size {
    let (_, Size { rows, columns }) = LEVELS[level];
    match side {
        Side::Up => size(rows, columns),
        Side::Down => size(rows * 2 / 3, columns),
    }
}

/// The largest table.
pub(super) fn largest() -> Grid {
    let [up, down] = [Side::Up, Side::Down].map(|side| on_side(side, LEVELS.len() - 1));
    grid(up, down)
}

/// Most bytes that the tables of a baked sky take, for `n` channels in vectors of `width`.
pub(super) fn largest_table(n: usize, width: usize) -> usize {
    n.div_ceil(width) * width * size_of::<f32>() * (largest().cells() + ENVELOPE)
}

/// Largest ratio of the 97th percentile to the tolerance.
const STEEP: f64 = 1.1;

/// Largest ratio of the 99.9th percentile to the tolerance.
pub(super) const TAIL: f64 = 4.0;

/// Largest ratio of the largest error to the tolerance. What sizes that go over into each other differ by is as small.
pub(super) const PEAK: f64 = 20.0;

/// Where a size gives way to the next: from and to which strain.
const PASSAGE: [f64; 2] = [0.8, 0.95];

/// The share of a size with this strain in what is between it and the next: smooth.
fn share(strain: f64) -> f64 {
    let [from, to] = PASSAGE;
    let t = ((to - strain) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// One side of something that is baked.
pub(super) trait Refinable<const N: usize> {
    /// Its surface through nodes; sizes grow from call to call.
    fn surface(&mut self, size: Size) -> Surface<N>;
    /// How far a surface is off.
    fn errors(&self, surface: &Surface<N>) -> Errors;
}

/// The smallest surface that keeps the tolerance, and its errors. The tolerance alone says which size is the first;
/// where that or a larger one is about to miss the tolerance it goes over into the next by and by, so that the surface
/// is continuous in the conditions.
pub(super) fn bake<const N: usize>(
    part: &mut impl Refinable<N>,
    side: Side,
    tolerance: f64,
) -> Result<(Surface<N>, Errors)> {
    let last = LEVELS.len() - 1;
    let mut level = LEVELS
        .partition_point(|&(typical, _)| typical > tolerance)
        .min(last);
    let mut coarser = Vec::new();
    let (mut surface, mut errors) = loop {
        let surface = part.surface(on_side(side, level));
        let errors = part.errors(&surface);
        let share = share(errors.strain(tolerance, level));
        if share == 1.0 || level == last {
            break (surface, errors);
        }
        if share > 0.0 {
            coarser.push((share as f32, surface));
        }
        level += 1;
    };
    if !coarser.is_empty() {
        let blend = |finer, (share, surface): (f32, Surface<N>)| surface.blended(share, finer);
        surface = coarser.into_iter().rev().fold(surface, blend);
        errors = part.errors(&surface);
    }
    let got = errors.quantile(0.95);
    match got <= tolerance {
        true => Ok((surface, errors)),
        false => Err(Error::Tolerance {
            expected: tolerance,
            got,
        }),
    }
}

/// Relative to what is expected, or to the least that counts where there is less.
#[inline(always)]
pub(super) fn difference(got: f32, expected: f32, least: f32) -> f32 {
    let off = f64::from((got - expected).abs()) / f64::from(expected.max(least));
    off.min(f64::from(f32::MAX)) as f32
}

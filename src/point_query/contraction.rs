//! The inner loops of a point query: factor matrices in half precision, summed as they stand in the file.
//!
//! No closures: they would be compiled without the instructions of the kernel.
#![allow(clippy::needless_range_loop)]

use zerocopy::little_endian::U16;

use super::capacity::WAVELENGTH_BLOCKS;
use crate::azimuth_fade::mean_weight;
use crate::format::{BasisView, FactorsView};
use crate::kernel::axis::Taps;
use crate::kernel::half::widen;
use crate::kernel::lanes::Lanes;
use crate::kernel::simd::Instructions;

/// Largest ranks and numbers of channels, multiples of [`WIDTH`].
pub(super) const MOST_RANK: usize = 512;
pub(super) const MOST_CHANNELS: usize = 256;

/// Numbers that are widened together.
pub(super) const WIDTH: usize = 8;
/// Rows that count on an axis.
const TAPS: usize = 4;
/// Vectors of channels that are summed together.
const GROUP: usize = 8;

/// A number per component, padded with zeros.
pub(super) type Components = [Lanes<WIDTH>; MOST_RANK / WIDTH];
/// A number per channel.
pub(super) type Channels = [f32; MOST_CHANNELS];
/// Four rows of numbers per wavelength, without gaps.
pub(super) type LevelRows = [Lanes<WIDTH>; 4 * WAVELENGTH_BLOCKS];
/// A number per wavelength.
pub(super) type Spectrum = [Lanes<WIDTH>; WAVELENGTH_BLOCKS];

/// Rows of a factor matrix and their weights.
struct Rows<'a> {
    rows: [&'a [[U16; WIDTH]]; TAPS],
    weight: [f32; TAPS],
}

impl<'a> Rows<'a> {
    #[inline(always)]
    fn new(table: &'a [U16], stride: usize, taps: &Taps) -> Self {
        let mut rows = [[].as_slice(); TAPS];
        for k in 0..TAPS {
            rows[k] = &table[taps.index[k] * stride..][..stride].as_chunks().0[..stride / WIDTH];
        }
        Self {
            rows,
            weight: taps.weight,
        }
    }

    /// Their weighted sum in vector `b`.
    #[inline(always)]
    fn sum<I: Instructions>(&self, instructions: I, b: usize) -> Lanes<WIDTH> {
        let mut sum = instructions.widen(&self.rows[0][b]) * self.weight[0];
        for k in 1..TAPS {
            let row = instructions.widen(&self.rows[k][b]);
            sum = instructions.add_product(sum, row, self.weight[k]);
        }
        sum
    }
}

/// Asks for what [`add_chunk`] will read.
#[inline(always)]
pub(super) fn fetch_chunk<I: Instructions>(
    instructions: I,
    chunk: &FactorsView,
    heights: &[U16],
    [alpha, elevation]: &[Taps; 2],
) {
    // The rows stand together.
    let stride = chunk.stride;
    instructions.fetch(chunk.scale);
    instructions.fetch(&heights[alpha.index[0] * stride..][..TAPS * stride]);
    instructions.fetch(&chunk.elevation[elevation.index[0] * stride..][..TAPS * stride]);
}

/// Asks for what [`add_level`] will read.
#[inline(always)]
pub(super) fn fetch_level<I: Instructions>(
    instructions: I,
    chunk: &FactorsView,
    wavelengths: usize,
    elevation: &Taps,
) {
    instructions.fetch(&chunk.level[elevation.index[0] * wavelengths..][..4 * wavelengths]);
}

/// Adds the components of a chunk at the place of a query, times `weight`.
#[inline(always)]
pub(super) fn add_chunk<I: Instructions>(
    instructions: I,
    chunk: &FactorsView,
    heights: &[U16],
    [alpha, elevation]: &[Taps; 2],
    weight: f32,
    sum: &mut Components,
) {
    if chunk.is_padded() {
        return add_padded(chunk, heights, [alpha, elevation], weight, sum);
    }
    let heights = Rows::new(heights, chunk.stride, alpha);
    let suns = Rows::new(chunk.elevation, chunk.stride, elevation);
    let scales = chunk.scale[..chunk.stride].as_chunks::<WIDTH>().0;
    for (b, (sum, scale)) in sum.iter_mut().zip(scales).enumerate() {
        let value = heights.sum(instructions, b) * (Lanes::read(scale) * weight);
        *sum = *sum + value * suns.sum(instructions, b);
    }
}

/// The same of a chunk whose padding is not zero, one component after another: no writer makes such.
#[cold]
#[inline(never)]
fn add_padded(
    chunk: &FactorsView,
    heights: &[U16],
    [alpha, elevation]: [&Taps; 2],
    weight: f32,
    sum: &mut Components,
) {
    for i in 0..chunk.rank {
        let at = |table: &[U16], taps: &Taps| -> f32 {
            let taps = taps.index.iter().zip(taps.weight);
            taps.map(|(row, weight)| weight * widen(table[row * chunk.stride + i]))
                .sum()
        };
        let value = at(heights, alpha) * chunk.scale[i].get() * weight;
        sum[i / WIDTH].0[i % WIDTH] += value * at(chunk.elevation, elevation);
    }
}

/// Adds the four rows of ln S of a chunk around a solar elevation, times `weight`: all chunks share what follows.
#[inline(always)]
pub(super) fn add_level<I: Instructions>(
    instructions: I,
    chunk: &FactorsView,
    wavelengths: usize,
    elevation: &Taps,
    weight: f32,
    sum: &mut LevelRows,
) {
    let first = elevation.index[0] * wavelengths;
    let rows = &chunk.level[first..][..4 * wavelengths];
    let (whole, rest) = rows.as_chunks::<WIDTH>();
    let (sums, last) = sum.split_at_mut(whole.len());
    for (sum, halves) in sums.iter_mut().zip(whole) {
        *sum = instructions.add_product(*sum, instructions.widen(halves), weight);
    }
    for (i, &half) in rest.iter().enumerate() {
        last[0].0[i] += widen(half) * weight;
    }
}

/// ln S from the sums of its rows.
#[inline(always)]
pub(super) fn level(rows: &LevelRows, wavelengths: usize, elevation: &Taps) -> Spectrum {
    let mut level = [Lanes::splat(0.0); WAVELENGTH_BLOCKS];
    let at = |i: usize| rows[i / WIDTH].0[i % WIDTH];
    for w in 0..wavelengths {
        let rows = (0..4).map(|k| elevation.weight[k] * at(k * wavelengths + w));
        level[w / WIDTH].0[w % WIDTH] = rows.sum();
    }
    level
}

/// Multiplies the components with the factors of an azimuth.
#[inline(always)]
pub(super) fn turn<I: Instructions>(
    instructions: I,
    basis: &BasisView,
    phi: &Taps,
    sum: &mut Components,
) {
    let azimuths = Rows::new(basis.phi, basis.stride, phi);
    for b in 0..(basis.stride / WIDTH).min(sum.len()) {
        sum[b] = sum[b] * azimuths.sum(instructions, b);
    }
}

/// Factors of an azimuth under a sun near the zenith, where azimuths fade.
#[cold]
pub(super) fn faded(basis: &BasisView, phi: Taps, fade: f64) -> Components {
    let rows = basis.phi.chunks_exact(basis.stride);
    let intervals = rows.len() - 1;
    let mut factors = [Lanes::splat(0.0); MOST_RANK / WIDTH];
    for (i, row) in rows.enumerate() {
        let mut weight = (1.0 - fade) * mean_weight(i, intervals);
        for k in 0..phi.index.len() {
            if phi.index[k] == i {
                weight += fade * f64::from(phi.weight[k]);
            }
        }
        for (j, &half) in row.iter().enumerate() {
            factors[j / WIDTH].0[j % WIDTH] += weight as f32 * widen(half);
        }
    }
    factors
}

/// Multiplies the components with factors.
#[inline(always)]
pub(super) fn multiply(sum: &mut Components, factors: &Components) {
    for b in 0..sum.len() {
        sum[b] = sum[b] * factors[b];
    }
}

/// Sums the components in each channel.
#[inline(always)]
pub(super) fn project<I: Instructions>(
    instructions: I,
    basis: &BasisView,
    components: &Components,
    channels: &mut Channels,
) {
    let stride = basis.channel_stride / WIDTH;
    let table = basis.channel.as_chunks::<WIDTH>().0;
    let blocks = &mut channels.as_chunks_mut::<WIDTH>().0[..stride];
    let (groups, rest) = blocks.as_chunks_mut::<GROUP>();
    for (g, group) in groups.iter_mut().enumerate() {
        let sums: [_; GROUP] = add_columns(instructions, table, stride, g * GROUP, components);
        *group = sums.map(|sum| sum.0);
    }
    let first = groups.len() * GROUP;
    for (b, block) in rest.iter_mut().enumerate() {
        let [sum] = add_columns(instructions, table, stride, first + b, components);
        *block = sum.0;
    }
}

/// `N` columns of the channels; the sums stay in registers.
#[inline(always)]
fn add_columns<const N: usize, I: Instructions>(
    instructions: I,
    table: &[[U16; WIDTH]],
    stride: usize,
    first: usize,
    components: &Components,
) -> [Lanes<WIDTH>; N] {
    let mut sums = [Lanes::splat(0.0); N];
    for (lanes, rows) in components.iter().zip(table.chunks_exact(stride * WIDTH)) {
        for (&component, row) in lanes.0.iter().zip(rows.chunks_exact(stride)) {
            let Some(row) = row[first..].first_chunk::<N>() else {
                continue;
            };
            for k in 0..N {
                sums[k] = instructions.add_product(sums[k], instructions.widen(&row[k]), component);
            }
        }
    }
    sums
}

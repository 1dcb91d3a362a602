//! The inner loops of a general query: factor matrices in half precision, summed as they stand in the file.
//!
//! No closures: they would be compiled without the instructions of the kernel.
#![allow(clippy::needless_range_loop)]

use zerocopy::little_endian::{F32, U16};

use super::WAVELENGTH_BLOCKS;
use crate::axis::Taps;
use crate::format::{RadianceBasisView, RadianceView, widen};
use crate::lanes::Lanes;
use crate::simd::Instructions;

/// Largest ranks and numbers of channels, multiples of [`WIDTH`].
pub(super) const MOST_RANK: usize = 512;
pub(super) const MOST_CHANNELS: usize = 256;

/// Numbers that are widened together.
pub(super) const WIDTH: usize = 8;
/// Vectors of channels that are summed together.
const GROUP: usize = 4;

/// A number per component, padded with zeros.
pub(super) type Components = [Lanes<WIDTH>; MOST_RANK / WIDTH];
/// A number per channel.
pub(super) type Channels = [Lanes<WIDTH>; MOST_CHANNELS / WIDTH];
/// A number per wavelength.
pub(super) type Spectrum = [Lanes<WIDTH>; WAVELENGTH_BLOCKS];

/// Four rows of a factor matrix and their weights.
struct Rows<'a> {
    rows: [&'a [[U16; WIDTH]]; 4],
    weight: [f32; 4],
}

impl<'a> Rows<'a> {
    #[inline(always)]
    fn new(table: &'a [U16], stride: usize, taps: &Taps) -> Self {
        let mut rows = [[].as_slice(); 4];
        for k in 0..4 {
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
        let ([p, q, r, s], w) = (self.rows, self.weight);
        let first = instructions.widen(&p[b]) * w[0] + instructions.widen(&q[b]) * w[1];
        first + (instructions.widen(&r[b]) * w[2] + instructions.widen(&s[b]) * w[3])
    }
}

/// Asks for what [`add_chunk`] will read.
#[inline(always)]
pub(super) fn fetch_chunk<I: Instructions>(
    instructions: I,
    chunk: &RadianceView,
    heights: &[U16],
    [alpha, elevation]: [&Taps; 2],
) {
    // The four rows stand together.
    let stride = chunk.stride;
    instructions.fetch(&heights[alpha.index[0] * stride..][..4 * stride]);
    instructions.fetch(&chunk.elevation[elevation.index[0] * stride..][..4 * stride]);
}

/// Adds the components of a chunk at the place of a query, times `weight`.
#[inline(always)]
pub(super) fn add_chunk<I: Instructions>(
    instructions: I,
    chunk: &RadianceView,
    heights: &[U16],
    [alpha, elevation]: [&Taps; 2],
    weight: f32,
    sum: &mut Components,
) {
    let heights = Rows::new(heights, chunk.stride, alpha);
    let suns = Rows::new(chunk.elevation, chunk.stride, elevation);
    let scales = chunk.scale[..chunk.stride].as_chunks::<WIDTH>().0;
    for b in 0..scales.len().min(sum.len()) {
        let value = heights.sum(instructions, b) * suns.sum(instructions, b);
        sum[b] = sum[b] + value * (read(&scales[b]) * weight);
    }
}

/// Adds the spline of ln S of a chunk, times `weight`. The last vector of the spectrum is not the rest after whole
/// ones but the last eight wavelengths, see [`align`].
#[inline(always)]
pub(super) fn add_level<I: Instructions>(
    instructions: I,
    chunk: &RadianceView,
    wavelengths: usize,
    elevation: &Taps,
    weight: f32,
    sum: &mut Spectrum,
) {
    let whole = wavelengths / WIDTH;
    for k in 0..4 {
        let row = &chunk.level[elevation.index[k] * wavelengths..][..wavelengths];
        let tap = weight * elevation.weight[k];
        for b in 0..whole {
            if let Some(halves) = row[b * WIDTH..].first_chunk() {
                sum[b] = sum[b] + instructions.widen(halves) * tap;
            }
        }
        if wavelengths.is_multiple_of(WIDTH) {
            continue;
        }
        match row.last_chunk() {
            Some(halves) => sum[whole] = sum[whole] + instructions.widen(halves) * tap,
            None => {
                for i in 0..wavelengths {
                    sum[0].0[i] += widen(row[i]) * tap;
                }
            }
        }
    }
}

/// Moves the last vector of a spectrum to where it belongs.
#[inline(always)]
pub(super) fn align(wavelengths: usize, sum: &mut Spectrum) {
    let (whole, rest) = (wavelengths / WIDTH, wavelengths % WIDTH);
    if whole > 0 && rest > 0 {
        let last = sum[whole];
        for i in 0..rest {
            sum[whole].0[i] = last.0[WIDTH - rest + i];
        }
    }
}

/// Multiplies the components with the factors of an azimuth.
#[inline(always)]
pub(super) fn turn<I: Instructions>(
    instructions: I,
    basis: &RadianceBasisView,
    phi: &Taps,
    sum: &mut Components,
) {
    let azimuths = Rows::new(basis.phi, basis.stride, phi);
    for b in 0..(basis.stride / WIDTH).min(sum.len()) {
        sum[b] = sum[b] * azimuths.sum(instructions, b);
    }
}

/// Sums the components in each channel.
#[inline(always)]
pub(super) fn project<I: Instructions>(
    instructions: I,
    basis: &RadianceBasisView,
    components: &Components,
    channels: &mut Channels,
) {
    let stride = basis.channel_stride / WIDTH;
    let table = basis.channel.as_chunks::<WIDTH>().0;
    for first in (0..stride).step_by(GROUP) {
        let n = GROUP.min(stride - first);
        let mut sums = [Lanes::splat(0.0); GROUP];
        for r in 0..basis.stride {
            let c = components[r / WIDTH].0[r % WIDTH];
            let row = &table[r * stride + first..][..n];
            if n == GROUP {
                // The usual case, unrolled.
                for k in 0..GROUP {
                    sums[k] = sums[k] + instructions.widen(&row[k]) * c;
                }
            } else {
                for k in 0..n {
                    sums[k] = sums[k] + instructions.widen(&row[k]) * c;
                }
            }
        }
        channels[first..first + n].copy_from_slice(&sums[..n]);
    }
}

#[inline(always)]
fn read(numbers: &[F32; WIDTH]) -> Lanes<WIDTH> {
    let mut lanes = Lanes::splat(0.0);
    for i in 0..WIDTH {
        lanes.0[i] = numbers[i].get();
    }
    lanes
}

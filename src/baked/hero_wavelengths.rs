//! Radiance at a few wavelengths that differ from query to query, as hero wavelength sampling asks (Wilkie et al.
//! 2014). Format specification, section 7.3; of models without cells with the weights of each interval as polynomials.

use std::sync::Arc;

use super::batch::{Group, Sink};
use crate::kernel::axis::hermite;
use crate::kernel::lanes::Lanes;
use crate::sky::Sky;
use crate::spectrum::{CellTable, SpectralInterpolation};

/// Wavelengths of a table that are computed together.
const LANES: usize = 16;
/// Most blocks of wavelengths.
const BLOCKS: usize = 256 / LANES;
/// Light at a node counts as at least 2 to minus this power of the brightest.
const DARKEST: f32 = 27.0;

/// Wavelengths and solar spectrum, ready for interpolation.
#[derive(Clone, Debug)]
pub(super) struct WavelengthAxis {
    /// The wavelengths without the last, then infinity.
    nodes: Vec<[f32; LANES]>,
    intervals: Vec<Interval>,
    solar: Vec<f32>,
    /// First wavelength and samples per nanometre of the solar spectrum.
    solar_axis: [f32; 2],
    range: [f32; 2],
    /// What lies between the wavelengths, where that is more than a curve.
    cells: Option<Arc<SpectralInterpolation>>,
}

#[derive(Clone, Copy, Debug)]
struct Interval {
    start: f32,
    inverse: f32,
    /// First wavelength that counts.
    first: u32,
    /// Weight of each wavelength: coefficients of 1, t, t², t³.
    weight: [[f32; 4]; 4],
}

impl WavelengthAxis {
    /// Of what has no wavelengths, and gives no heroes.
    pub fn none() -> Self {
        Self {
            nodes: Vec::new(),
            intervals: Vec::new(),
            solar: Vec::new(),
            solar_axis: [0.0; 2],
            range: [0.0; 2],
            cells: None,
        }
    }

    pub fn new(sky: &Sky) -> Self {
        let wavelengths = sky.wavelengths();
        let inner = &wavelengths[..wavelengths.len() - 1];
        let (solar, [start, step]) = sky.solar_spectrum();
        let node = |block: &[f64], i: usize| block.get(i).map_or(f32::INFINITY, |&l| l as f32);
        Self {
            nodes: inner
                .chunks(LANES)
                .map(|block| core::array::from_fn(|i| node(block, i)))
                .collect(),
            intervals: (0..inner.len())
                .map(|i| Interval::new(wavelengths, i))
                .collect(),
            solar: solar.to_vec(),
            solar_axis: [start as f32, (1.0 / step) as f32],
            range: sky.interpolation().range().map(|l| l as f32),
            cells: (sky.interpolation().table()).map(|_| sky.interpolation().clone()),
        }
    }

    pub fn range(&self) -> [f32; 2] {
        self.range
    }

    pub fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice())
            + size_of_val(self.intervals.as_slice())
            + size_of_val(self.solar.as_slice())
    }

    #[inline(always)]
    fn irradiance(&self, wavelength: f32) -> f32 {
        let last = self.solar.len() - 2;
        let u = ((wavelength - self.solar_axis[0]) * self.solar_axis[1]).max(0.0);
        let i = (u as usize).min(last);
        let t = u - i as f32;
        let pair = &self.solar[i..i + 2];
        pair[0] + t.min(1.0) * (pair[1] - pair[0])
    }

    /// The interval of a wavelength and the place in it.
    #[inline(always)]
    fn locate(&self, wavelength: f32) -> (&Interval, f32) {
        let mut passed = 0;
        for block in &self.nodes {
            passed += block
                .iter()
                .map(|&node| u32::from(wavelength >= node))
                .sum::<u32>();
        }
        let interval = &self.intervals[(passed as usize).saturating_sub(1)];
        (interval, (wavelength - interval.start) * interval.inverse)
    }
}

impl Interval {
    fn new(wavelengths: &[f64], i: usize) -> Self {
        let (start, end) = (wavelengths[i], wavelengths[i + 1]);
        let first = i.saturating_sub(1).min(wavelengths.len().saturating_sub(4));
        let mut samples = [[0.0; 4]; 4];
        for (k, sample) in samples.iter_mut().enumerate() {
            let stencil = hermite(wavelengths, start + (end - start) * k as f64 / 3.0);
            stencil
                .taps()
                .for_each(|(node, w)| sample[node - first] = w);
        }
        Self {
            start: start as f32,
            inverse: (1.0 / (end - start)) as f32,
            first: first as u32,
            weight: core::array::from_fn(|tap| cubic(samples.map(|sample| sample[tap]))),
        }
    }

    /// Weights of the four wavelengths from `first` on.
    #[inline(always)]
    fn weights(&self, t: f32) -> [f32; 4] {
        core::array::from_fn(|k| {
            let [a, b, c, d] = self.weight[k];
            a + t * (b + t * (c + t * d))
        })
    }
}

/// Coefficients of the cubic through values at 0, 1/3, 2/3 and 1.
fn cubic([a, b, c, d]: [f64; 4]) -> [f32; 4] {
    let third = 4.5 * (d - a) + 13.5 * (b - c);
    let second = 9.0 * a - 22.5 * b + 18.0 * c - 4.5 * d;
    let first = d - a - second - third;
    [a, first, second, third].map(|v| v as f32)
}

/// Radiance at four wavelengths of each direction's own.
pub(super) struct Heroes<'a> {
    pub axis: &'a WavelengthAxis,
    pub wavelengths: &'a [[f32; 4]],
    pub out: &'a mut [[f32; 4]],
}

impl Sink<LANES> for Heroes<'_> {
    #[inline(always)]
    fn put<const W: usize>(&mut self, group: &Group<LANES, W>) {
        for i in 0..group.count {
            let wavelengths = &self.wavelengths[group.first + i];
            self.out[group.first + i] = self.axis.radiance(group, i, wavelengths).0;
        }
    }
}

impl WavelengthAxis {
    /// Spectral radiance at four wavelengths for direction `i`.
    #[inline(always)]
    pub fn radiance<const W: usize>(
        &self,
        group: &Group<LANES, W>,
        i: usize,
        wavelengths: &[f32; 4],
    ) -> Lanes<4> {
        if let Some(cells) = self.cells() {
            let logarithms = self.logarithms(group, i);
            return self.radiance_of_cells(
                cells,
                group.spots.opacity.0[i],
                wavelengths,
                &logarithms,
            );
        }
        let (table, spots) = (group.table, group.spots);
        let mixed = if table.blocks() == 1 {
            self.mix(wavelengths, &table.logarithm(spots, i, 0).0)
        } else {
            let mut logarithms = [[0.0; LANES]; BLOCKS];
            for (block, logarithms) in logarithms[..table.blocks()].iter_mut().enumerate() {
                *logarithms = table.logarithm(spots, i, block).0;
            }
            self.mix(wavelengths, logarithms.as_flattened())
        };
        let irradiance = Lanes(wavelengths.map(|wavelength| self.irradiance(wavelength)));
        let radiance = mixed.exp2() * irradiance * spots.opacity.0[i];
        radiance.min(Lanes::splat(f32::MAX))
    }

    /// What lies between the wavelengths, where that is more than a curve.
    #[inline(always)]
    pub fn cells(&self) -> Option<&CellTable> {
        self.cells.as_ref().and_then(|cells| cells.table())
    }

    /// Logarithms of relative radiance at the nodes for direction `i`, none far below the greatest.
    #[inline(always)]
    pub fn logarithms<const W: usize>(
        &self,
        group: &Group<LANES, W>,
        i: usize,
    ) -> [f32; BLOCKS * LANES] {
        let mut logarithms = [[0.0; LANES]; BLOCKS];
        for (block, out) in logarithms[..group.table.blocks()].iter_mut().enumerate() {
            *out = group.table.logarithm(group.spots, i, block).0;
        }
        let opacity = group.spots.opacity.0[i].max(f32::MIN_POSITIVE);
        let [opacity] = Lanes([opacity]).log2().0;
        let nodes = &mut logarithms.as_flattened_mut()[..self.intervals.len() + 1];
        let least = nodes.iter().copied().fold(f32::MIN, f32::max) - DARKEST;
        nodes.iter_mut().for_each(|l| *l = l.max(least) + opacity);
        core::array::from_fn(|n| logarithms[n / LANES][n % LANES])
    }

    /// Spectral radiance at four wavelengths from logarithms at the nodes; none where there is no air.
    #[inline(always)]
    pub fn radiance_of_cells(
        &self,
        cells: &CellTable,
        opacity: f32,
        wavelengths: &[f32; 4],
        logarithms: &[f32],
    ) -> Lanes<4> {
        if opacity == 0.0 {
            return Lanes::splat(0.0);
        }
        let mixed = Lanes(wavelengths.map(|wavelength| cells.logarithm(wavelength, logarithms)));
        let irradiance = Lanes(wavelengths.map(|wavelength| self.irradiance(wavelength)));
        (mixed.exp2() * irradiance).min(Lanes::splat(f32::MAX))
    }

    /// Values at the nodes, interpolated.
    #[inline(always)]
    pub fn mix(&self, wavelengths: &[f32; 4], values: &[f32]) -> Lanes<4> {
        let mut mixed = Lanes::splat(0.0);
        for (lane, &wavelength) in wavelengths.iter().enumerate() {
            let (interval, t) = self.locate(wavelength);
            let taps = &values[interval.first as usize..][..4];
            let [a, b, c, d] = interval.weights(t);
            mixed.0[lane] = (a * taps[0] + b * taps[1]) + (c * taps[2] + d * taps[3]);
        }
        mixed
    }
}

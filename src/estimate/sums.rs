//! Sums over the panels between stops, block by block of wavelengths.
//!
//! No closures in the loops: they would be compiled without the instructions of the kernel.
#![allow(clippy::needless_range_loop)]

use zerocopy::little_endian::F32;

use core::f32::consts::{LN_2, LOG2_E};

use super::blocks::{Block, Blocks, MOST_BLOCKS, NOTHING, WIDTH};
use super::path::Stops;
use super::points::{Axes, BATCH};
use super::sightline::Sightline;
use super::walk::{Steps, Stop, Walk, scatterers};
use crate::format::{EstimateView, MAX_ESTIMATES};
use crate::geometry::Planet;
use crate::kernel::lanes::Lanes;
use crate::kernel::simd::{Instructions, Kernel};

/// Of the diffuse estimate so much is added to those of sunlight, which can be nothing where it is not quite dark.
const REST: f32 = 1e-3;
/// Isotropic share of a phase function, per steradian.
const PER_SPHERE: f32 = 0.25 * core::f32::consts::FRAC_1_PI;
/// Constituents that scatter in all but unusual files.
const FEW: u32 = 3;

type Spectrum = Lanes<WIDTH>;

/// Light that reaches the observer from a stop: its optical depth, in halvings, and what is left.
#[derive(Clone, Copy)]
struct Ray {
    depth: Spectrum,
    through: Spectrum,
}

impl Ray {
    const START: Self = Self {
        depth: Lanes([0.0; WIDTH]),
        through: Lanes([1.0; WIDTH]),
    };

    #[inline(always)]
    fn new(depth: Spectrum) -> Self {
        let through = (-depth).exp2();
        Self { depth, through }
    }

    /// Mean between two stops, between which the depth is linear.
    #[inline(always)]
    fn mean(self, next: Self) -> Spectrum {
        /// Differences of thinner panels lose their digits.
        const THIN: f32 = 0.1;
        let step = (next.depth - self.depth) * LN_2;
        let size = step.abs();
        let mean = (self.through - next.through).abs() / size.max(Lanes::splat(THIN));
        let series = step.map(|x| 1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0))));
        size.at_least(THIN, mean, self.through * series)
    }
}

/// A block of wavelengths on the way along a ray.
#[derive(Clone, Copy)]
struct Band<const S: usize> {
    /// Light from the last stop: of the sun, and diffuse.
    rays: [Ray; 2],
    /// Columns of what scatters in such light, m.
    lit: [[Spectrum; S]; 2],
}

impl<const S: usize> Band<S> {
    const NONE: Self = Self {
        rays: [Ray::START; 2],
        lit: [[Lanes([0.0; WIDTH]); S]; 2],
    };

    /// What is scattered of it all.
    #[inline(always)]
    fn estimates(
        &self,
        tables: &EstimateView,
        scatterers: &[usize; S],
        extinction: &[Spectrum; WIDTH],
        block: usize,
    ) -> Block {
        let mut out = [Lanes::splat(0.0); MAX_ESTIMATES];
        let albedos = tables.albedo.as_chunks().0;
        let last = tables.scatters.len() - 1;
        for q in 0..(last + 1).min(MAX_ESTIMATES) {
            let scatters = tables.scatters[q].get();
            let lit = &self.lit[usize::from(q == last)];
            for (lit, &k) in lit.iter().zip(scatterers) {
                if k < tables.constituents && scatters >> k & 1 == 1 {
                    let row = (q * tables.constituents + k) * (tables.light_stride / WIDTH);
                    let albedo = albedos[row + block];
                    out[q] = out[q] + extinction[k] * Lanes::read(&albedo) * *lit;
                }
            }
        }
        out[last] = out[last] * LN_2;
        let rest = out[last] * REST;
        for q in 0..last.min(MAX_ESTIMATES) {
            out[q] = out[q] * (LN_2 * PER_SPHERE) + rest;
        }
        out
    }
}

/// A block of wavelengths goes on through panels to their stops.
struct Onwards<'a, F, const S: usize> {
    /// Products are fused where these are.
    products: F,
    band: &'a mut Band<S>,
    stops: &'a [Stop<S>],
    /// Of the constituents where their profile is 1, halvings per metre.
    extinction: &'a [Spectrum; WIDTH],
    /// Begins with the block.
    light: &'a [[F32; WIDTH]],
}

impl<F: Instructions, const S: usize> Kernel for Onwards<'_, F, S> {
    type Output = ();

    #[inline(always)]
    fn run<I: Instructions>(self, _: I) {
        let (products, extinction) = (self.products, self.extinction);
        let Band { mut rays, mut lit } = *self.band;
        for stop in self.stops {
            let (mut view, mut sun) = (Lanes::splat(0.0), Lanes::splat(0.0));
            for k in 0..WIDTH {
                view = products.add_product(view, extinction[k], stop.to_observer.0[k]);
                sun = products.add_product(sun, extinction[k], stop.by_sun.0[k]);
            }
            let mut bright = Lanes::splat(0.0);
            for t in 0..4 {
                let row = Lanes::read(&self.light[stop.light[t]]);
                bright = products.add_product(bright, row, stop.weight[t]);
            }
            let next = [Ray::new(sun), Ray::new(view - bright)];
            let once = rays[0].mean(next[0]) * stop.share;
            let again = rays[1].mean(next[1]);
            for k in 0..S {
                lit[0][k] = products.add_product(lit[0][k], once, stop.panel[k]);
                lit[1][k] = products.add_product(lit[1][k], again, stop.panel[k]);
            }
            rays = next;
        }
        *self.band = Band { rays, lit };
    }
}

/// All that estimates depend on.
#[derive(Clone, Copy)]
pub(crate) struct Estimator<'a> {
    pub planet: Planet,
    pub tables: EstimateView<'a>,
    /// Extinction where the profile is 1, m⁻¹, `[constituent][block]`.
    pub extinction: &'a [[f32; WIDTH]],
}

impl Estimator<'_> {
    /// The estimates along a ray; products are fused where those of `products` are.
    #[inline(always)]
    pub fn along<I: Instructions, F: Instructions>(
        &self,
        instructions: I,
        products: F,
        line: &Sightline,
    ) -> Blocks {
        let stops = Stops::new(&self.planet, &self.tables, line);
        let with = (instructions, products);
        // Arrays as large as they must be: to clear more would take as long as a stop.
        match (self.blocks(), self.tables.any_scatters().count_ones()) {
            (1, ..=FEW) => self.sum::<1, { FEW as usize }, _, _>(with, &stops),
            (2, ..=FEW) => self.sum::<2, { FEW as usize }, _, _>(with, &stops),
            (3, ..=FEW) => self.sum::<3, { FEW as usize }, _, _>(with, &stops),
            _ => self.sum::<MOST_BLOCKS, WIDTH, _, _>(with, &stops),
        }
    }

    /// Blocks of wavelengths.
    #[inline(always)]
    fn blocks(&self) -> usize {
        self.tables.light_stride / WIDTH
    }

    /// For up to `N` blocks and `S` constituents that scatter.
    #[inline(always)]
    fn sum<const N: usize, const S: usize, I: Instructions, F: Instructions>(
        &self,
        (instructions, products): (I, F),
        stops: &Stops,
    ) -> Blocks {
        let tables = &self.tables;
        let axes = Axes::new(&self.planet, tables);
        let scatterers = scatterers(tables);
        let blocks = self.blocks().min(N);
        let extinction = self.extinction::<N>(blocks);
        let light = tables.light.as_chunks().0;
        let mut bands = [Band::<S>::NONE; N];
        let mut walk = Walk::new(&axes, tables);
        let mut first = 0;
        while first < stops.count {
            let count = (stops.count - first).min(BATCH);
            let mut batch = [Stop::NONE; BATCH];
            let batch = &mut batch[..count];
            instructions.apart(Steps {
                walk: &mut walk,
                axes: &axes,
                stops,
                first,
                scatterers: &scatterers,
                out: batch,
            });
            for b in 0..blocks {
                instructions.apart(Onwards {
                    products,
                    band: &mut bands[b],
                    stops: batch,
                    extinction: &extinction[b],
                    light: &light[b..],
                });
            }
            first += count;
        }
        let mut out = NOTHING;
        for b in 0..blocks {
            out[b] = bands[b].estimates(tables, &scatterers, &extinction[b], b);
        }
        out
    }

    /// Extinction of the constituents where their profile is 1, halvings per metre.
    #[inline(always)]
    fn extinction<const N: usize>(&self, blocks: usize) -> [[Spectrum; WIDTH]; N] {
        let mut out = [[Lanes([0.0; WIDTH]); WIDTH]; N];
        for b in 0..blocks {
            for k in 0..self.tables.constituents.min(WIDTH) {
                out[b][k] = Lanes(self.extinction[k * blocks + b]) * LOG2_E;
            }
        }
        out
    }
}

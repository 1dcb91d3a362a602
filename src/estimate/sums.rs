//! Sums over the panels between stops, for a block of wavelengths.

use super::air::{Air, load};
use super::{Block, Estimator, MOST_ESTIMATES, WIDTH};
use crate::kernel::lanes::Lanes;

/// Of a diffuse estimate so much is added to one of sunlight, which can be nothing where the air is not quite dark.
const REST: f32 = 1e-3;

/// Isotropic share of a phase function, per steradian.
const PER_SPHERE: f32 = 0.25 * core::f32::consts::FRAC_1_PI;

type Spectrum = Lanes<WIDTH>;

/// Light that reaches the observer from a stop: its optical depth, and what is left.
#[derive(Clone, Copy)]
struct Ray {
    depth: Spectrum,
    through: Spectrum,
}

impl Ray {
    #[inline(always)]
    fn new(depth: Spectrum) -> Self {
        let through = (-depth).exp();
        Self { depth, through }
    }

    /// Mean between two stops, between which the depth is linear.
    #[inline(always)]
    fn mean(self, next: Self) -> Spectrum {
        /// Differences of thinner panels lose their digits.
        const THIN: f32 = 0.1;
        let step = next.depth - self.depth;
        let size = step.abs();
        let mean = (self.through - next.through).abs() / size.max(Lanes::splat(THIN));
        let series = step.map(|x| 1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0))));
        size.at_least(THIN, mean, self.through * series)
    }
}

#[inline(always)]
pub(super) fn blocks(of: &Estimator, air: &Air, mut emit: impl FnMut(usize, Block)) {
    let blocks = of.tables.light_stride / WIDTH;
    for block in 0..blocks {
        emit(block, sum(of, air, block, blocks));
    }
}

#[inline(always)]
fn sum(of: &Estimator, air: &Air, block: usize, blocks: usize) -> Block {
    let tables = &of.tables;
    let constituents = tables.constituents;
    let extinction = |k: usize| Lanes(of.extinction[k * blocks + block]);
    let rays = |i: usize| {
        let (mut view, mut sun) = (Lanes::splat(0.0), Lanes::splat(0.0));
        for k in 0..constituents {
            let extinction = extinction(k);
            view = view + extinction * air.to_observer[i].0[k];
            sun = sun + extinction * air.to_sun[i].0[k];
        }
        let mut light = Lanes::splat(0.0);
        for (row, weight) in air.light[i].iter().zip(air.weight[i]) {
            light = light + load(tables.light, row + block * WIDTH) * weight;
        }
        [Ray::new(view + sun), Ray::new(view - light)]
    };
    let last = tables.scatters.len() - 1;
    let mut out = [Lanes::splat(0.0); MOST_ESTIMATES];
    let [mut sunlit, mut diffuse] = rays(0);
    for i in 1..air.count {
        let [far_sunlit, far_diffuse] = rays(i);
        let once = sunlit.mean(far_sunlit) * air.share[i - 1];
        let again = diffuse.mean(far_diffuse);
        let panel = air.to_observer[i] - air.to_observer[i - 1];
        let mut row = block * WIDTH;
        for (q, scatters) in tables.scatters.iter().enumerate() {
            let mut scattered = Lanes::splat(0.0);
            for k in 0..constituents {
                if scatters.get() >> k & 1 == 1 {
                    let albedo = load(tables.albedo, row);
                    scattered = scattered + extinction(k) * albedo * panel.0[k];
                }
                row += tables.light_stride;
            }
            let light = if q == last { again } else { once };
            out[q] = out[q] + scattered * light;
        }
        (sunlit, diffuse) = (far_sunlit, far_diffuse);
    }
    let rest = out[last] * REST;
    for estimate in &mut out[..last] {
        *estimate = *estimate * PER_SPHERE + rest;
    }
    out
}

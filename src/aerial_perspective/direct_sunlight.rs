//! Sunlight along a segment, at the ends of its panels and between them.

use super::path_points::{BATCH, PathPoints};
use super::prepared::AerialPerspective;
use super::quadrature_limits::{MOST_PANELS, MOST_PATH_POINTS};
use super::sun_transmittance::Two;
use crate::kernel::lanes::Lanes;
use crate::kernel::math::LANES;
use crate::transmittance::QUADS;
use crate::visible_disc::mean_shares;

/// Over which the density of the air falls to 1/e, roughly, m.
const SCALE: f32 = 8e3;

/// Two panels, each for a block of wavelengths.
pub(crate) type Pair = Lanes<8>;

/// Sunlight along a segment.
pub(crate) struct Sunlight {
    /// Columns towards the sun at the ends of panels, two at a time.
    pub columns: [Two; MOST_PANELS / 2 + 1],
    /// Mean share of the sun's disc that is visible, two panels at a time.
    pub shares: [Pair; MOST_PANELS / 2],
}

impl Sunlight {
    #[inline(always)]
    pub fn new(aerial: &AerialPerspective, places: &[PathPoints], panels: usize) -> Self {
        const PAIRS: usize = BATCH / 2;
        let mut out = Self {
            columns: [[Pair::splat(0.0); QUADS]; MOST_PANELS / 2 + 1],
            shares: [Pair::splat(0.0); MOST_PANELS / 2],
        };
        let pairs = (panels + 1).div_ceil(2);
        let [mut rise, mut altitude] = [[0.0; MOST_PATH_POINTS + BATCH]; 2];
        for (i, columns) in out.columns.chunks_mut(PAIRS).enumerate() {
            let pairs = pairs.saturating_sub(i * PAIRS);
            if pairs > 0 {
                let heights = aerial
                    .beam
                    .at(&aerial.air.layers, &places[i], pairs, columns);
                heights.store(&mut rise, i * BATCH);
                places[i].altitude.store(&mut altitude, i * BATCH);
            }
        }
        for (i, shares) in out.shares.chunks_mut(PAIRS).enumerate() {
            if i * BATCH < panels {
                let [a, b] = [0, 1].map(|end| Lanes::load(&rise, i * BATCH + end));
                let [low, high] = [0, 1].map(|end| Lanes::load(&altitude, i * BATCH + end));
                let means = mean_shares(a, b, (high - low) * (1.0 / SCALE)).0;
                for (share, mean) in shares.iter_mut().zip(means.chunks_exact(2)) {
                    *share = Pair::pair(mean[0], mean[1]);
                }
            }
        }
        out
    }
}

/// Sunlight at two ends of panels, for a block of wavelengths.
#[derive(Clone, Copy)]
pub(crate) struct DirectSunlight {
    depth: Pair,
    through: Pair,
}

impl DirectSunlight {
    #[inline(always)]
    pub fn new(aerial: &AerialPerspective, block: usize, columns: &Two) -> Self {
        let mut depth = Pair::splat(0.0);
        for (q, columns) in columns.iter().enumerate().take(aerial.air.layers.quads) {
            for k in 0..LANES {
                let extinction = aerial.air.extinction.row(q * LANES + k, block);
                depth = depth + columns.spread(k) * Pair::twice(extinction);
            }
        }
        Self {
            depth,
            through: (-depth).exp(),
        }
    }

    /// At the second of these ends and the first of the `next` two.
    #[inline(always)]
    pub fn shift(&self, next: &Self) -> Self {
        let join = |a: Pair, b: Pair| Pair::join(a.halves()[1], b.halves()[0]);
        Self {
            depth: join(self.depth, next.depth),
            through: join(self.through, next.through),
        }
    }
}

/// Sunlight at the ends of two panels.
pub(crate) struct Sun {
    pub start: DirectSunlight,
    pub end: DirectSunlight,
    /// Mean share of the disc that is visible.
    pub share: Pair,
}

impl Sun {
    /// Mean of what is left of sunlight at the start of a panel when it gets there by way of a point of the panel.
    #[inline(always)]
    pub fn mean(&self, depth: Pair, through: Pair) -> Pair {
        /// Differences of thinner panels lose their digits.
        const THIN: f32 = 0.1;
        let far = self.end.through * through;
        let step = self.end.depth + depth - self.start.depth;
        let size = step.abs();
        let mean = (self.start.through - far).abs() / size.max(Pair::splat(THIN));
        let series = step.map(|x| 1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0))));
        size.at_least(THIN, mean, self.start.through * series) * self.share
    }
}

//! The estimates of one angle from the horizon at all azimuths, where the sun is high: no edge is near, and the azimuth
//! hardly counts.

use super::blocks::{Blocks, NOTHING, WIDTH};
use super::prepared::Estimates;
use super::sightline::Sightline;
use crate::kernel::lanes::Lanes;

/// Sine of the lowest sun that counts as high.
const HIGH: f64 = 0.2;

/// The base-2 logarithms as parabolas over the cosine of the azimuth.
#[derive(Clone, Debug)]
pub(crate) struct Around {
    /// Values towards the side, slopes, curvatures; `[block]`.
    terms: Vec<[[Lanes<WIDTH>; 3]; crate::format::MAX_ESTIMATES]>,
}

impl Around {
    /// Of a ray, whatever its azimuth; nothing where the sun is low.
    pub fn new(estimates: &Estimates, line: Sightline) -> Option<Self> {
        if line.sun[0] < HIGH {
            return None;
        }
        let at = |azimuth: f64| estimates.blocks(&Sightline { azimuth, ..line });
        let [back, side, front] = [-1.0, 0.0, 1.0].map(at);
        let terms = (0..estimates.block_count()).map(|b| {
            core::array::from_fn(|q| {
                let log =
                    |blocks: &Blocks| blocks[b][q].max(Lanes::splat(f32::MIN_POSITIVE)).log2();
                let [back, side, front] = [log(&back), log(&side), log(&front)];
                let slope = (front - back) * 0.5;
                [side, slope, (front + back) * 0.5 - side]
            })
        });
        Some(Self {
            terms: terms.collect(),
        })
    }

    /// The estimates at the cosine of an azimuth.
    #[inline(always)]
    pub fn at(&self, azimuth: f64) -> Blocks {
        let c = Lanes::splat(azimuth as f32);
        let mut out = NOTHING;
        for (block, terms) in out.iter_mut().zip(&self.terms) {
            for (lanes, [value, slope, bend]) in block.iter_mut().zip(terms) {
                *lanes = (*value + c * (*slope + c * *bend)).exp2();
            }
        }
        out
    }
}

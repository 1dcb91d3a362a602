//! CIE XYZ of what a segment does to light.

use super::local_scattering::attenuated;
use super::segment_integral::Block;
use crate::kernel::math::{LANES, bound, finite};

/// Sums over wavelengths: X, Y and Z of in-scattered light, and of sunlight behind the segment.
#[derive(Default)]
pub(crate) struct XyzSum([[[f32; LANES]; 3]; 2]);

impl XyzSum {
    /// Adds a block of wavelengths.
    #[inline(always)]
    pub fn add(&mut self, weights: &[[f32; LANES]; 3], result: &Block) {
        let through = attenuated(&result.depth);
        for (sums, light) in self.0.iter_mut().zip([&result.scattered, &through]) {
            for (sum, weight) in sums.iter_mut().zip(weights) {
                *sum = core::array::from_fn(|i| sum[i] + weight[i] * light[i]);
            }
        }
    }

    /// Light, and factors of things as `white` as the unattenuated sun.
    pub fn finish(&self, white: &[f32; 3]) -> ([f32; 3], [f32; 3]) {
        let total = |lanes: [f32; LANES]| lanes.iter().sum::<f32>();
        let [light, through] = self.0.map(|sums| sums.map(total));
        let factor = |c: usize| bound(through[c] / white[c], 0.0, 1.0);
        let light = light.map(finite);
        (light, core::array::from_fn(factor))
    }
}

//! What panels of a segment do to light.

use super::direct_sunlight::{Pair, Sun};
use super::prepared::AerialPerspective;
use super::sun_transmittance::Two;
use crate::kernel::lanes::Lanes;
use crate::kernel::math::LANES;
use crate::transmittance::Amounts;

/// Light alone: the source of molecules and that of particles.
pub(crate) const UNPOLARISED: usize = 2;

/// And Q and U of what molecules scatter.
pub(crate) const POLARISED: usize = 4;

/// What is in two panels, for a block of wavelengths.
pub(crate) struct PanelAir {
    depth: Pair,
    /// What it scatters of sunlight.
    direct: Pair,
    /// Scattering by molecules and by particles.
    diffuse: [Pair; 2],
    /// Polarised by molecules.
    dipole: Pair,
}

/// What two panels do to light.
pub(crate) struct Scattered {
    /// Light that each sends to its start.
    pub light: Pair,
    /// Its Q and U.
    pub linear: [Pair; 2],
    pub depth: Pair,
    pub through: Pair,
}

impl PanelAir {
    /// From columns, and `sunlit` and dipoles of each constituent.
    #[inline(always)]
    pub fn new<const M: usize>(
        aerial: &AerialPerspective,
        block: usize,
        columns: &Two,
        sunlit: &[[f32; LANES]],
        dipoles: &[[f32; LANES]],
    ) -> Self {
        let zero = Pair::splat(0.0);
        let mut out = Self {
            depth: zero,
            direct: zero,
            diffuse: [zero; 2],
            dipole: zero,
        };
        for (q, columns) in columns.iter().enumerate().take(aerial.air.layers.quads) {
            for lane in 0..LANES {
                let (k, column) = (q * LANES + lane, columns.spread(lane));
                out.depth = out.depth + column * Pair::twice(aerial.air.extinction.row(k, block));
                out.direct = out.direct + column * Pair::twice(&sunlit[k]);
                for (sum, total) in out.diffuse.iter_mut().zip(aerial.species.totals(k, block)) {
                    if let Some(total) = total {
                        *sum = *sum + column * Pair::twice(total);
                    }
                }
                if M == POLARISED {
                    out.dipole = out.dipole + column * Pair::twice(&dipoles[k]);
                }
            }
        }
        out
    }

    /// `single` is what Q and U of scattering once are per dipole; `diffuse` the source of molecules, of particles and
    /// of Q and U.
    #[inline(always)]
    pub fn scatter<const M: usize>(
        &self,
        sun: &Sun,
        single: [f32; 2],
        diffuse: &[Pair; M],
    ) -> Scattered {
        let absorbed = self.depth.one_minus_exp_neg();
        let through = Pair::splat(1.0) - absorbed;
        let sun = sun.mean(self.depth, through);
        let mean = mean_transmittance(self.depth, absorbed);
        let [molecules, particles] = self.diffuse;
        let mut linear = [Pair::splat(0.0); 2];
        if M == POLARISED {
            for (part, linear) in linear.iter_mut().enumerate() {
                *linear = self.dipole * sun * single[part] + molecules * diffuse[2 + part] * mean;
            }
        }
        let diffuse = molecules * diffuse[0] + particles * diffuse[1];
        Scattered {
            light: self.direct * sun + diffuse * mean,
            linear,
            depth: self.depth,
            through,
        }
    }
}

/// What air with these columns sends through this depth where all of it is in the sun.
#[inline(always)]
pub(crate) fn sunlit_beyond(
    aerial: &AerialPerspective,
    block: usize,
    columns: &Amounts,
    sunlit: &[[f32; LANES]],
    before: Lanes<LANES>,
) -> [f32; LANES] {
    let depth = Lanes(aerial.air.extinction.depth(columns, block));
    let mut light = Lanes::splat(0.0);
    for (k, sunlit) in sunlit.iter().enumerate() {
        light = light + Lanes(*sunlit) * columns.get(k);
    }
    let mean = mean_transmittance(depth, depth.one_minus_exp_neg());
    (light * mean * (-before).exp()).0
}

/// Mean transmittance of what has this optical depth and takes away this share.
#[inline(always)]
fn mean_transmittance<const N: usize>(depth: Lanes<N>, absorbed: Lanes<N>) -> Lanes<N> {
    // The limit is reached before the quotient loses its digits.
    const THIN: f32 = 1e-3;
    let thin = Lanes::splat(1.0) - depth * 0.5;
    depth.at_least(THIN, absorbed / depth.max(Lanes::splat(THIN)), thin)
}

/// What is left of light at these optical depths.
#[inline(always)]
pub(super) fn attenuated(depth: &[f32; LANES]) -> [f32; LANES] {
    (-Lanes(*depth)).exp().0
}

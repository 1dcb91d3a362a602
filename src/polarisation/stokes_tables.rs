//! Multiply scattered Q and U of one sky, and the inner loop that adds the singly scattered light.

use super::frame::{Aspect, PolarisationFrame};
use crate::error::Result;
use crate::kernel::math::{LANES, bound};
use crate::sky::tables::{Lookup, Polarisable, Tables};

/// One block of wavelengths of Q, and of U over sin φ. Aligned so that it stands in one cache line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Pair(pub [f32; 2 * LANES]);

impl Pair {
    pub const ZERO: Self = Self([0.0; 2 * LANES]);

    #[inline(always)]
    pub fn add(&mut self, weight: f32, other: &Pair) {
        self.0 = core::array::from_fn(|i| self.0[i] + weight * other.0[i]);
    }

    pub fn is_finite(&self) -> bool {
        self.0.iter().all(|v| v.is_finite())
    }
}

impl AsRef<[f32; 2 * LANES]> for Pair {
    #[inline(always)]
    fn as_ref(&self) -> &[f32; 2 * LANES] {
        &self.0
    }
}

/// Coefficients above and below the horizon, each beside the cell of the same index in the table of the radiance.
#[derive(Clone, Debug)]
pub(super) struct Polarisation {
    pub up: Vec<Pair>,
    pub down: Vec<Pair>,
}

/// One block of wavelengths: relative radiance (sr⁻¹), and Q and U over the radiance.
pub(super) struct Block {
    pub radiance: [f32; LANES],
    pub q: [f32; LANES],
    pub u: [f32; LANES],
}

/// What Q and U are made of in one direction: factors of singly scattered light, of the table's Q and of its U, in the
/// frame of the caller.
pub(super) struct Mix {
    pub single: [f32; 2],
    pub from_q: [f32; 2],
    pub from_u: [f32; 2],
}

impl Mix {
    /// In a direction seen from the sun.
    #[inline(always)]
    pub fn new(aspect: &Aspect, frame: PolarisationFrame) -> Result<Self> {
        let (c, s) = aspect.plane.turn(frame)?;
        let turn = |[q, u]: [f64; 2]| [c * q + s * u, c * u - s * q].map(|v| v as f32);
        Ok(Self {
            single: turn(aspect.plane.single()),
            from_q: turn([1.0, 0.0]),
            from_u: turn([0.0, aspect.sine]),
        })
    }

    /// Q or U, from what Rayleigh scattering polarises and the table's Q and U.
    #[inline(always)]
    pub fn part(
        &self,
        s: usize,
        dipole: &[f32; LANES],
        q: &[f32; LANES],
        u: &[f32; LANES],
    ) -> [f32; LANES] {
        core::array::from_fn(|i| {
            let scattered = self.from_q[s] * q[i] + self.from_u[s] * u[i];
            self.single[s] * dipole[i] + scattered
        })
    }
}

impl Polarisation {
    /// Hands the blocks of wavelengths to `emit`. All numbers are finite, and Q² + U² ≤ 1.
    #[inline(always)]
    pub fn evaluate(
        &self,
        tables: &Tables,
        lookup: &Lookup,
        mix: &Mix,
        mut emit: impl FnMut(usize, Block),
    ) {
        self.sums(tables, lookup, mix, |block, light, [q, u]| {
            let [q, u] = limit(light.sum, q, u);
            let radiance = light.radiance;
            emit(block, Block { radiance, q, u });
        });
    }

    /// Hands the radiance and the two sums that `mix` makes to `emit`, over that of the radiance, block by block of
    /// wavelengths. They are finite.
    pub fn ratios(
        &self,
        tables: &Tables,
        lookup: &Lookup,
        mix: &Mix,
        mut emit: impl FnMut(usize, [f32; LANES], [[f32; LANES]; 2]),
    ) {
        self.sums(tables, lookup, mix, |block, light, sums| {
            let ratios = sums.map(|sum| ratio(light.sum, sum));
            emit(block, light.radiance, ratios);
        });
    }

    /// Hands the radiance and the two sums that `mix` makes to `emit`.
    #[inline(always)]
    fn sums(
        &self,
        tables: &Tables,
        lookup: &Lookup,
        mix: &Mix,
        mut emit: impl FnMut(usize, Polarisable, [[f32; LANES]; 2]),
    ) {
        let table = if lookup.is_up() { &self.up } else { &self.down };
        for block in 0..tables.layout.blocks() {
            let light = tables.polarisable(lookup, block);
            let pair = Pair(lookup.gather_beside(table, tables.layout.cell(block)));
            let part = |s: usize| -> [f32; LANES] {
                core::array::from_fn(|i| {
                    let scattered = mix.from_q[s] * pair.0[i] + mix.from_u[s] * pair.0[LANES + i];
                    mix.single[s] * light.dipole[i] + scattered * light.diffuse[i]
                })
            };
            let sums = [part(0), part(1)];
            emit(block, light, sums);
        }
    }

    pub fn bytes(&self) -> usize {
        size_of_val(self.up.as_slice()) + size_of_val(self.down.as_slice())
    }
}

/// `q` and `u` over `i`, at most the whole light.
#[inline(always)]
pub(crate) fn limit(i: [f32; LANES], q: [f32; LANES], u: [f32; LANES]) -> [[f32; LANES]; 2] {
    let [mut q, mut u] = [ratio(i, q), ratio(i, u)];
    for (q, u) in q.iter_mut().zip(&mut u) {
        // A little more than the square, so that rounding does not undo the limit.
        let square = (*q * *q + *u * *u) * (1.0 + 4.0 * f32::EPSILON);
        let share = 1.0 / square.max(1.0).sqrt();
        *q *= share;
        *u *= share;
    }
    [q, u]
}

/// Q/I and U/(I sin φ), at most the whole light: elsewhere a fit that has gone below zero leaves almost none, and any
/// ratio. In the plane of the sun, where U says nothing, U/(I sin φ) is bounded to what light that was scattered once
/// cannot exceed.
pub(super) fn limit_even(mut q: [f32; LANES], mut u: [f32; LANES], sine: f32) -> [[f32; LANES]; 2] {
    const ONCE: f32 = 2.0;
    for (q, u) in q.iter_mut().zip(&mut u) {
        let share = 1.0 / q.hypot(*u * sine).max(1.0);
        *q *= share;
        *u = (*u * share).clamp(-ONCE, ONCE);
    }
    [q, u]
}

/// `part` over `whole`; finite.
#[inline(always)]
fn ratio(whole: [f32; LANES], part: [f32; LANES]) -> [f32; LANES] {
    /// Its square is finite.
    const MOST: f32 = 1e18;
    let mut out = [0.0; LANES];
    for lane in 0..LANES {
        let inverse = 1.0 / whole[lane].max(f32::MIN_POSITIVE);
        out[lane] = bound(part[lane] * inverse, -MOST, MOST);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn never_more_polarised_than_light() {
        let values = [
            0.0,
            1e-38,
            1e-3,
            1.0,
            -2.0,
            1e30,
            f32::MAX,
            f32::INFINITY,
            f32::NAN,
        ];
        for i in values {
            for q in values {
                for u in values {
                    let [q, u] = limit([i; LANES], [q; LANES], [u; LANES]);
                    assert!(q[0] * q[0] + u[0] * u[0] <= 1.0, "{i} {q:?} {u:?}");
                }
            }
        }
        let [q, u] = limit([2.0; LANES], [0.5; LANES], [-1.0; LANES]);
        assert_eq!((q[0], u[0]), (0.25, -0.5));
    }
}

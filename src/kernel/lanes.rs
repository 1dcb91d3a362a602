//! A few numbers that are computed together. Every operation is a plain loop over an array, of which the compiler
//! makes vectors as wide as the processor's; none is fused or reordered, so the width does not change the result.
#![allow(clippy::needless_range_loop)] // Chains of iterators over several arrays do not always vectorise.

use core::ops::{Add, Div, Mul, Neg, Sub};

use zerocopy::little_endian::F32;

use crate::kernel::math;

/// `N` numbers, lane by lane.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(16))]
pub(crate) struct Lanes<const N: usize>(pub [f32; N]);

impl<const N: usize> Lanes<N> {
    #[inline(always)]
    pub fn splat(value: f32) -> Self {
        Self([value; N])
    }

    #[inline(always)]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        let mut lanes = self.0;
        // A plain loop: `map` over an array is not always inlined, and then does not vectorise.
        for lane in &mut lanes {
            *lane = f(*lane);
        }
        Self(lanes)
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        let mut lanes = self.0;
        for i in 0..N {
            lanes[i] = f(self.0[i], other.0[i]);
        }
        Self(lanes)
    }

    #[inline(always)]
    pub fn sqrt(self) -> Self {
        self.map(math::sqrt)
    }

    #[inline(always)]
    pub fn abs(self) -> Self {
        self.map(f32::abs)
    }

    /// The larger one; `other` where a lane is NaN.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }

    /// The smaller one; `other` where a lane is NaN.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }

    /// `yes` where this is at least `limit`, otherwise `no`.
    #[inline(always)]
    pub fn at_least(self, limit: f32, yes: Self, no: Self) -> Self {
        let mut lanes = no.0;
        for i in 0..N {
            lanes[i] = if self.0[i] >= limit {
                yes.0[i]
            } else {
                no.0[i]
            };
        }
        Self(lanes)
    }

    /// See [`math::exp`].
    #[inline(always)]
    pub fn exp(self) -> Self {
        self.map(math::exp)
    }

    /// See [`math::one_minus_exp_neg`].
    #[inline(always)]
    pub fn one_minus_exp_neg(self) -> Self {
        self.map(math::one_minus_exp_neg)
    }

    /// See [`math::asin`].
    #[inline(always)]
    pub fn asin(self) -> Self {
        self.map(math::asin)
    }

    /// See [`math::log2`].
    #[inline(always)]
    pub fn log2(self) -> Self {
        self.map(math::log2)
    }

    /// See [`math::exp2`].
    #[inline(always)]
    pub fn exp2(self) -> Self {
        self.map(math::exp2)
    }

    /// The cell of coordinates ≥ 0, at most `last`, as a number and as an index. At a node it may be either neighbour.
    #[inline(always)]
    pub fn round_down(self, last: Self) -> (Self, [u32; N]) {
        // Adding 2^23 rounds and leaves the integer in the low bits; conversions saturate, which costs more.
        const ROUND: f32 = 8_388_608.0;
        let shift = Self::splat(ROUND);
        let cell = (self - Self::splat(0.5) + shift) - shift;
        let cell = cell.max(Self::splat(0.0)).min(last);
        let mut index = [0; N];
        for i in 0..N {
            index[i] = (cell.0[i] + ROUND).to_bits().wrapping_sub(ROUND.to_bits());
        }
        (cell, index)
    }
}

impl Lanes<8> {
    /// Eight numbers of a file.
    #[inline(always)]
    pub fn read(numbers: &[F32; 8]) -> Self {
        let mut lanes = [0.0; 8];
        for i in 0..8 {
            lanes[i] = numbers[i].get();
        }
        Self(lanes)
    }

    /// The same four numbers twice.
    #[inline(always)]
    pub fn twice(half: &[f32; 4]) -> Self {
        Self(core::array::from_fn(|i| half[i % 4]))
    }

    /// Each of two numbers four times.
    #[inline(always)]
    pub fn pair(low: f32, high: f32) -> Self {
        Self(core::array::from_fn(|i| if i < 4 { low } else { high }))
    }

    /// Number `k` of each half, four times.
    #[inline(always)]
    pub fn spread(self, k: usize) -> Self {
        Self(core::array::from_fn(|i| self.0[(i & 4) + k]))
    }

    /// Two halves.
    #[inline(always)]
    pub fn join(low: [f32; 4], high: [f32; 4]) -> Self {
        Self(core::array::from_fn(|i| {
            if i < 4 { low[i] } else { high[i - 4] }
        }))
    }

    /// Eight numbers from `first` on.
    #[inline(always)]
    pub fn load(values: &[f32], first: usize) -> Self {
        let mut lanes = [0.0; 8];
        lanes.copy_from_slice(&values[first..first + 8]);
        Self(lanes)
    }

    /// Puts the numbers from `first` on.
    #[inline(always)]
    pub fn store(self, values: &mut [f32], first: usize) {
        values[first..first + 8].copy_from_slice(&self.0);
    }

    #[inline(always)]
    pub fn halves(self) -> [[f32; 4]; 2] {
        let v = self.0;
        [[v[0], v[1], v[2], v[3]], [v[4], v[5], v[6], v[7]]]
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $f:expr) => {
        impl<const N: usize> $trait for Lanes<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, $f)
            }
        }

        impl<const N: usize> $trait<f32> for Lanes<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f32) -> Self {
                self.zip(Self::splat(other), $f)
            }
        }
    };
}

operator!(Add, add, |a, b| a + b);
operator!(Sub, sub, |a, b| a - b);
operator!(Mul, mul, |a, b| a * b);
operator!(Div, div, |a, b| a / b);

impl<const N: usize> Neg for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|a| -a)
    }
}

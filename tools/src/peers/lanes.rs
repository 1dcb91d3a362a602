//! Numbers at `K` wavelengths, side by side.

use std::ops::{Add, AddAssign, Div, Mul, Sub};

/// One number per wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes<const K: usize>(pub [f32; K]);

impl<const K: usize> Lanes<K> {
    /// The same number everywhere.
    pub const fn splat(value: f32) -> Self {
        Self([value; K])
    }

    /// A function of each.
    pub fn map(self, f: impl FnMut(f32) -> f32) -> Self {
        Self(self.0.map(f))
    }

    /// A function of each pair.
    pub fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Self(std::array::from_fn(|k| f(self.0[k], other.0[k])))
    }

    /// `e^-x`: what optical depths let through.
    pub fn attenuated(self) -> Self {
        self.map(|depth| (-depth).exp())
    }

    /// `self + share·(other - self)`.
    pub fn mixed(self, other: Self, share: f32) -> Self {
        self.zip(other, |a, b| a + share * (b - a))
    }
}

impl<const K: usize> Default for Lanes<K> {
    fn default() -> Self {
        Self::splat(0.0)
    }
}

impl<const K: usize> Add for Lanes<K> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl<const K: usize> AddAssign for Lanes<K> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const K: usize> Sub for Lanes<K> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl<const K: usize> Mul for Lanes<K> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

impl<const K: usize> Div for Lanes<K> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        self.zip(other, |a, b| a / b)
    }
}

impl<const K: usize> Mul<f32> for Lanes<K> {
    type Output = Self;
    fn mul(self, factor: f32) -> Self {
        self.map(|v| v * factor)
    }
}

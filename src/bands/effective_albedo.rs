//! The albedos that a ground has in sums over nodes.
//!
//! A colour or a band is an integral over wavelengths, of which a few nodes stand for all. Light over the ground is
//! linear in τ = A (1 − s) / (1 − A s), from 0 over a black ground to 1 over a white one: so each node takes a mean of
//! τ over the wavelengths that it stands for, and has the albedo of which that is.

use super::examples::examples;
use super::least_squares::Problem;
use super::powers::Power;
use super::spectral_axis::{SpectralAxis, power};
use crate::error::Result;
use crate::ground::Albedo;
use crate::kernel::axis::linear;
use crate::model::Model;

/// Examples are alike; more of them say nothing new.
const EXAMPLES: usize = 48;
/// How little the means around the nodes count beside what the examples say of each node.
const LOOSE: f64 = 0.05;

/// What a ground is to the wavelengths of a model.
pub(super) struct GroundSpectrum<'a> {
    albedo: &'a Albedo,
    nodes: &'a [f64],
    /// At the middle one of the visibilities: the mean depends little on it.
    spherical: &'a [f64],
}

impl<'a> GroundSpectrum<'a> {
    pub fn new(model: &'a Model, albedo: &'a Albedo) -> Self {
        let head = model.head();
        let n = head.wavelengths.len();
        let middle = head.visibilities.len() / 2;
        Self {
            albedo,
            nodes: &head.wavelengths,
            spherical: &head.spherical_albedo[middle * n..][..n],
        }
    }

    /// τ at a wavelength.
    pub fn tau(&self, wavelength: f64) -> f64 {
        let taps = linear(self.nodes, wavelength);
        let s: f64 = taps.taps().map(|(n, w)| w * self.spherical[n]).sum();
        white_share(self.albedo.at(wavelength), s)
    }

    /// The albedo at a wavelength.
    pub fn exact(&self, wavelength: f64) -> f64 {
        self.albedo.at(wavelength)
    }

    /// s at a node.
    pub fn spherical(&self, node: usize) -> f64 {
        self.spherical[node]
    }

    /// The albedo of which this is τ at a node.
    pub fn albedo(&self, node: usize, tau: f64) -> f64 {
        self.albedo_of(self.spherical[node], tau)
    }

    /// The same where s is known.
    pub fn albedo_of(&self, s: f64, tau: f64) -> f64 {
        let tau = tau.clamp(0.0, 1.0);
        (tau / (1.0 - s + tau * s)).clamp(0.0, 1.0)
    }
}

/// τ, given s.
pub(super) fn white_share(albedo: f64, s: f64) -> f64 {
    albedo * (1.0 - s) / (1.0 - albedo * s)
}

/// Typical light at some wavelengths and at the nodes.
pub(super) struct TypicalLight {
    /// ln L at the nodes.
    logarithms: Vec<Vec<f64>>,
}

impl TypicalLight {
    pub fn new(model: &Model) -> Result<Self> {
        let mut logarithms = examples(model)?;
        let step = logarithms.len().div_ceil(EXAMPLES).max(1);
        logarithms = logarithms.into_iter().step_by(step).collect();
        Ok(Self { logarithms })
    }

    /// At a node, one number per example.
    pub fn at_node(&self, node: usize) -> Vec<f64> {
        self.logarithms.iter().map(|row| row[node].exp()).collect()
    }

    /// Of a wavelength between nodes that is part of a band, one number per example.
    pub fn power(&self, of: &Power) -> Vec<f64> {
        let rows = self.logarithms.iter();
        rows.map(|row| of.factor * power(&of.taps, row)).collect()
    }

    pub fn examples(&self) -> usize {
        self.logarithms.len()
    }

    /// At a wavelength, one number per example.
    pub fn at(&self, axis: &SpectralAxis, wavelength: f64) -> Vec<f64> {
        let knots = axis.knots(wavelength);
        let at = |row: &Vec<f64>| {
            let terms = knots.iter().map(|&(knot, w)| w * axis.at_knot(knot, row));
            terms.sum::<f64>().exp()
        };
        self.logarithms.iter().map(at).collect()
    }
}

/// A sum over nodes that is to be an integral.
pub(super) struct Sum {
    /// What each node adds, `[node][example]`.
    pub parts: Vec<Vec<f64>>,
    /// The mean of τ over the integral, of each example.
    pub mean: Vec<f64>,
}

/// τ at the nodes of sums that share them, near `around`: the means of the sums are those of the integrals as well as can
/// be.
pub(super) fn fit(sums: &[Sum], around: &[f64]) -> Vec<f64> {
    let mut columns = vec![Vec::new(); around.len()];
    let mut right = Vec::new();
    for sum in sums {
        for (e, mean) in sum.mean.iter().enumerate() {
            let whole: f64 = sum.parts.iter().map(|part| part[e]).sum();
            if !(whole.is_normal() && mean.is_finite()) {
                continue;
            }
            let parts = columns.iter_mut().zip(&sum.parts);
            parts.for_each(|(column, part)| column.push(part[e] / whole));
            right.push(*mean);
        }
    }
    let loose = LOOSE * (right.len().max(1) as f64).sqrt();
    for (n, &tau) in around.iter().enumerate() {
        let rows = columns.iter_mut().enumerate();
        rows.for_each(|(k, column)| column.push(if k == n { loose } else { 0.0 }));
        right.push(loose * tau);
    }
    let mut out = vec![0.0; around.len()];
    let all: Vec<usize> = (0..around.len()).collect();
    for (n, tau) in Problem::new(columns, right).solve(&all) {
        out[n] = tau.min(1.0);
    }
    out
}

//! Spheres of one material whose radii are lognormally distributed.

use super::sphere::Sphere;
use crate::atmosphere::matrix::Elements;
use nalgebra::Complex;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Step of the logarithm of the radius: fine enough that resonances average out.
const STEP: f64 = 0.01;
/// Radii count whose number times the fourth power is at least this share of the most; that power is the forward peak's.
const FEWEST: f64 = 1e-8;

/// How many spheres of which radius there are, all lengths in one unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lognormal {
    /// Smallest and largest radius.
    pub range: [f64; 2],
    /// Median radius.
    pub median: f64,
    /// Geometric standard deviation.
    pub sigma: f64,
}

/// What they do to light.
pub struct Scattered {
    /// Mean scattering and extinction cross sections.
    pub cross_sections: [f64; 2],
    /// ln P11, P12/P11 and P33/P11 at each angle; P11 has mean 1.
    pub elements: Vec<Elements>,
}

impl Lognormal {
    /// Scattering at a wavelength by spheres of refractive index `index`, at angles in rad.
    pub fn scatter(&self, wavelength: f64, index: Complex<f64>, angles: &[f64]) -> Scattered {
        let cosines: Vec<f64> = angles.iter().map(|a| a.cos()).collect();
        let wave_number = 2.0 * PI / wavelength;
        let radii = self.radii();
        // Of all radii, as OPAC counts: its limits cut off without making the rest more.
        let total = (2.0 * PI).sqrt() * self.sigma.ln() / STEP;
        let nothing = || ([0.0; 2], vec![[0.0; 3]; angles.len()]);
        let one = |mut sum: ([f64; 2], Vec<Elements>), r: &f64| {
            let sphere = Sphere::new(wave_number * r, index);
            let number = self.density(*r) / total;
            let area = number * PI * r * r;
            for (sum, efficiency) in sum.0.iter_mut().zip(sphere.efficiencies()) {
                *sum += area * efficiency;
            }
            for (sum, cosine) in sum.1.iter_mut().zip(&cosines) {
                for (sum, s) in sum.iter_mut().zip(sphere.matrix(*cosine)) {
                    *sum += number * s;
                }
            }
            sum
        };
        // Chunks of one size and their order, so that sums are the same on any number of threads.
        let parts: Vec<_> = radii
            .par_chunks(16)
            .map(|chunk| chunk.iter().fold(nothing(), one))
            .collect();
        let (sections, sums) = parts.into_iter().fold(nothing(), joined);
        let mean = wave_number * wave_number * sections[0] / (4.0 * PI);
        let ratios = |[s11, s12, s33]: Elements| [(s11 / mean).ln(), s12 / s11, s33 / s11];
        Scattered {
            cross_sections: sections,
            elements: sums.into_iter().map(ratios).collect(),
        }
    }

    fn grid(&self) -> impl Iterator<Item = f64> {
        let [low, high] = self.range;
        let steps = ((high / low).ln() / STEP) as usize;
        (0..steps).map(move |i| low * (STEP * (i as f64 + 0.5)).exp())
    }

    /// Radii that matter.
    fn radii(&self) -> Vec<f64> {
        let weight = |r: f64| self.density(r) * r.powi(4);
        let most = self.grid().map(weight).fold(0.0, f64::max);
        self.grid().filter(|&r| weight(r) > FEWEST * most).collect()
    }

    /// Relative number per logarithm of the radius.
    fn density(&self, radius: f64) -> f64 {
        let x = (radius / self.median).ln() / self.sigma.ln();
        (-0.5 * x * x).exp()
    }
}

fn joined(a: ([f64; 2], Vec<Elements>), b: ([f64; 2], Vec<Elements>)) -> ([f64; 2], Vec<Elements>) {
    let sections = std::array::from_fn(|k| a.0[k] + b.0[k]);
    let pairs = a.1.into_iter().zip(b.1);
    let sums = pairs.map(|(a, b)| std::array::from_fn(|e| a[e] + b[e]));
    (sections, sums.collect())
}

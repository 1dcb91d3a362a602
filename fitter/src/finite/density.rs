//! Profiles as few quadratic layers.

use crate::atmosphere::Atmosphere;
use crate::column::planet;
use anyhow::{Result, ensure};
use welkin::format::DensityTable;

/// Largest relative error of the extinction coefficient near the ground, at any wavelength and visibility.
pub const TOLERANCE: f64 = 0.004;
/// Altitude (m) where twice the error is allowed: higher up there is little air.
const RELAXED: f64 = 20_000.0;
/// Points per layer of the atmosphere at which the error is measured.
const PROBES: usize = 4;

/// Fits the densities that `airs` share: the same profiles under different extinction coefficients.
pub fn fit(airs: &[Atmosphere], tolerance: f64) -> Result<DensityTable> {
    ensure!(!airs.is_empty(), "densities need an atmosphere");
    let profiles = |air: &Atmosphere| air.constituents.iter().map(|c| c.profile.clone()).collect();
    let first: Vec<Vec<f64>> = profiles(&airs[0]);
    ensure!(
        airs.iter()
            .all(|air| profiles(air) == first && air.altitudes == airs[0].altitudes),
        "profiles must not depend on the visibility"
    );
    let fitter = Fitter { airs };
    let nodes = &airs[0].altitudes;
    let mut table = DensityTable {
        edges: vec![nodes[0]],
        density: fitter.at(nodes[0]).iter().map(|&v| v as f32).collect(),
    };
    let mut low = 0;
    while low + 1 < nodes.len() {
        let mut high = low + 1;
        while high + 1 < nodes.len() && fitter.error(low, high + 1) <= tolerance {
            high += 1;
        }
        let [_, middle, end] = fitter.layer(low, high);
        table.edges.push(nodes[high]);
        table
            .density
            .extend(middle.iter().chain(&end).map(|&v| v as f32));
        low = high;
    }
    Ok(table)
}

struct Fitter<'a> {
    airs: &'a [Atmosphere],
}

impl Fitter<'_> {
    fn at(&self, altitude: f64) -> Vec<f64> {
        let air = &self.airs[0];
        (0..air.constituents.len())
            .map(|k| air.profile(k, altitude))
            .collect()
    }

    /// Bernstein coefficients between two nodes: exact at both, and with the right mean.
    fn layer(&self, low: usize, high: usize) -> [Vec<f64>; 3] {
        let nodes = &self.airs[0].altitudes[low..=high];
        let planet = planet(&self.airs[0]);
        let [start, end] = [nodes[0], nodes[nodes.len() - 1]].map(|h| self.at(h));
        let mut mean = vec![0.0; start.len()];
        let mut whole = 0.0;
        for pair in nodes.windows(2) {
            let thickness = planet.squared_altitude(pair[1]) - planet.squared_altitude(pair[0]);
            whole += thickness;
            for (k, (a, b)) in self
                .at(pair[0])
                .into_iter()
                .zip(self.at(pair[1]))
                .enumerate()
            {
                mean[k] += 0.5 * (a + b) * thickness;
            }
        }
        let middle = (0..mean.len()).map(|k| (3.0 * mean[k] / whole - start[k] - end[k]).max(0.0));
        [start.clone(), middle.collect(), end]
    }

    /// Largest relative error of the extinction coefficient, in terms of what is allowed at its altitude.
    fn error(&self, low: usize, high: usize) -> f64 {
        let nodes = &self.airs[0].altitudes[low..=high];
        let planet = planet(&self.airs[0]);
        let [a, b, c] = self.layer(low, high);
        let [bottom, top] = [nodes[0], nodes[nodes.len() - 1]].map(|h| planet.squared_altitude(h));
        let mut worst: f64 = 0.0;
        for pair in nodes.windows(2) {
            for i in 0..PROBES {
                let h = pair[0] + (pair[1] - pair[0]) * i as f64 / PROBES as f64;
                let t = (planet.squared_altitude(h) - bottom) / (top - bottom);
                let quadratic = |k: usize| {
                    (1.0 - t) * (1.0 - t) * a[k] + 2.0 * t * (1.0 - t) * b[k] + t * t * c[k]
                };
                let relaxed = 1.0 + (h / RELAXED).powi(2);
                worst = worst.max(self.compare(&self.at(h), &quadratic) / relaxed);
            }
        }
        worst
    }

    fn compare(&self, exact: &[f64], fitted: &dyn Fn(usize) -> f64) -> f64 {
        let mut worst: f64 = 0.0;
        for air in self.airs {
            for w in 0..air.wavelengths.len() {
                let total = |n: &dyn Fn(usize) -> f64| -> f64 {
                    let terms = air.constituents.iter().enumerate();
                    terms.map(|(k, c)| c.extinction[w] * n(k)).sum()
                };
                let truth = total(&|k| exact[k]);
                if truth > 0.0 {
                    worst = worst.max((total(fitted) / truth - 1.0).abs());
                }
            }
        }
        worst
    }
}

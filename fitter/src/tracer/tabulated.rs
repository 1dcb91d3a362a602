//! Scattering by tabulated matrices, prepared for N wavelengths.

use super::linear_density::linear;
use super::stokes::Scattering;
use crate::atmosphere::matrix::{Matrix, NODES, angle, interval};

/// F11, F12 and F33 per wavelength, and the distribution functions of F11.
pub struct Tabulated<const N: usize> {
    nodes: Vec<[[f64; N]; 3]>,
    cosines: Vec<f64>,
    /// By lane: the part of F11 between the angle 0 and each node.
    cumulative: Vec<Vec<f64>>,
}

impl<const N: usize> Tabulated<N> {
    /// Takes the wavelengths with the given indices (1 to N; the last is repeated).
    pub fn new(matrix: &Matrix, lanes: &[usize]) -> Self {
        let lane = |w: usize| lanes[w.min(lanes.len() - 1)];
        let node = |i| std::array::from_fn(|e| std::array::from_fn(|w| matrix.at(lane(w), i)[e]));
        let cosines: Vec<f64> = (0..NODES).map(|i| angle(i).cos()).collect();
        let distribution = |w: usize| {
            let mut sum = 0.0;
            let mut all = vec![0.0];
            for i in 1..NODES {
                let ends = matrix.at(lane(w), i - 1)[0] + matrix.at(lane(w), i)[0];
                sum += 0.25 * (cosines[i - 1] - cosines[i]) * ends;
                all.push(sum);
            }
            all
        };
        Self {
            nodes: (0..NODES).map(node).collect(),
            cumulative: (0..N).map(distribution).collect(),
            cosines,
        }
    }

    /// Adds `density` times the matrix at cosine `c`.
    pub fn add(&self, density: &[f64; N], c: f64, sum: &mut Scattering<N>) {
        let i = interval(c.acos());
        let t = (c - self.cosines[i]) / (self.cosines[i + 1] - self.cosines[i]);
        let (a, b) = (&self.nodes[i], &self.nodes[i + 1]);
        for w in 0..N {
            let at = |e: usize| density[w] * (a[e][w] + t * (b[e][w] - a[e][w]));
            let f11 = at(0);
            sum.f11[w] += f11;
            sum.f12[w] += at(1);
            sum.f22[w] += f11;
            sum.f33[w] += at(2);
        }
    }

    /// A cosine distributed as F11 at wavelength lane `w`.
    pub fn sample(&self, w: usize, u: f64) -> f64 {
        let cumulative = &self.cumulative[w];
        let x = u * cumulative[NODES - 1];
        let i = cumulative.partition_point(|&c| c <= x).clamp(1, NODES - 1) - 1;
        let share = cumulative[i + 1] - cumulative[i];
        let ends = (self.nodes[i][0][w], self.nodes[i + 1][0][w]);
        let inside = linear(
            ends.0,
            ends.1,
            ((x - cumulative[i]) / share).clamp(0.0, 1.0),
        );
        self.cosines[i] + inside * (self.cosines[i + 1] - self.cosines[i])
    }
}

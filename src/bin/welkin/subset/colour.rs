//! Colour from few wavelengths: which ones, and with which weights.
//!
//! The weights are the least-squares fit of the XYZ that all wavelengths give, in units of its luminance, over sample
//! skies: a quadrature rule for spectra that skies have.

use welkin::Model;

use super::samples::{Quantity, Samples};

/// Sums of products of relative radiances and colours over all samples, each sample divided by its luminance.
pub struct Quadrature {
    wavelengths: usize,
    /// `[wavelengths][wavelengths]`.
    gram: Vec<f64>,
    /// `[wavelengths][X, Y, Z]`.
    moment: Vec<[f64; 3]>,
    /// Σ |XYZ|².
    energy: f64,
}

impl Quadrature {
    pub fn measure(model: &Model, samples: &Samples) -> welkin::Result<Self> {
        let n = model.wavelengths().len();
        let all: Vec<usize> = (0..n).collect();
        let spectra = samples.values(model, Quantity::Spectrum, &all)?;
        let colours = samples.values(model, Quantity::Colour, &all)?;
        let mut sums = Self {
            wavelengths: n,
            gram: vec![0.0; n * n],
            moment: vec![[0.0; 3]; n],
            energy: 0.0,
        };
        for (spectrum, colour) in spectra.chunks_exact(n).zip(colours.chunks_exact(3)) {
            sums.add(spectrum, colour);
        }
        Ok(sums)
    }

    fn add(&mut self, spectrum: &[f32], colour: &[f32]) {
        let luminance = f64::from(colour[1]);
        if luminance <= 0.0 {
            return;
        }
        let scaled = |v: &f32| f64::from(*v) / luminance;
        let n = self.wavelengths;
        for (i, a) in spectrum.iter().map(scaled).enumerate() {
            for (j, b) in spectrum.iter().map(scaled).enumerate() {
                self.gram[i * n + j] += a * b;
            }
            for (sum, c) in self.moment[i].iter_mut().zip(colour.iter().map(scaled)) {
                *sum += a * c;
            }
        }
        self.energy += colour.iter().map(scaled).map(|c| c * c).sum::<f64>();
    }

    /// The `count` wavelengths from which colour follows best, found by exchange from an even spread.
    pub fn best(&self, count: usize) -> Vec<usize> {
        let n = self.wavelengths;
        let mut best: Vec<usize> = (0..count).map(|k| (2 * k + 1) * n / (2 * count)).collect();
        let mut residual = self.residual(&best);
        loop {
            let before = residual;
            for k in 0..count {
                for w in (0..n).filter(|w| !best.contains(w)).collect::<Vec<_>>() {
                    let mut other = best.clone();
                    other[k] = w;
                    other.sort_unstable();
                    let changed = self.residual(&other);
                    if changed < residual {
                        (best, residual) = (other, changed);
                        break;
                    }
                }
            }
            if residual >= before {
                return best;
            }
        }
    }

    fn residual(&self, kept: &[usize]) -> f64 {
        let weights = self.weights(kept);
        let explained: f64 = kept
            .iter()
            .zip(&weights)
            .map(|(&w, row)| {
                row.iter()
                    .zip(self.moment[w])
                    .map(|(a, b)| a * b)
                    .sum::<f64>()
            })
            .sum();
        self.energy - explained
    }

    /// XYZ per unit of relative radiance at each kept wavelength.
    pub fn weights(&self, kept: &[usize]) -> Vec<[f64; 3]> {
        let n = self.wavelengths;
        let gram = |i: usize, j: usize| {
            // A trace of a ridge, for skies that are all alike.
            let ridge = if i == j { 1.0 + 1e-12 } else { 1.0 };
            self.gram[kept[i] * n + kept[j]] * ridge
        };
        solve(
            kept.len(),
            gram,
            kept.iter().map(|&w| self.moment[w]).collect(),
        )
    }
}

/// Solves a symmetric positive definite system for three right-hand sides by Gauss-Jordan elimination.
fn solve(n: usize, matrix: impl Fn(usize, usize) -> f64, right: Vec<[f64; 3]>) -> Vec<[f64; 3]> {
    let left = |i: usize| (0..n).map(|j| matrix(i, j)).collect::<Vec<_>>();
    let augmented = |(i, right): (usize, &[f64; 3])| [&left(i), right.as_slice()].concat();
    let mut rows: Vec<Vec<f64>> = right.iter().enumerate().map(augmented).collect();
    for pivot in 0..n {
        let lead = rows[pivot].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != pivot) {
            let factor = row[pivot] / lead[pivot];
            for (value, lead) in row.iter_mut().zip(&lead) {
                *value -= factor * lead;
            }
        }
    }
    let solution = |(i, row): (usize, &Vec<f64>)| core::array::from_fn(|c| row[n + c] / row[i]);
    rows.iter().enumerate().map(solution).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_a_system() {
        let matrix = |i: usize, j: usize| [[4.0, 1.0], [1.0, 3.0]][i][j];
        let [a, b] = solve(2, matrix, vec![[1.0, 0.0, 5.0], [2.0, 0.0, 4.0]])[..] else {
            panic!("two rows");
        };
        assert!((a[0] - 1.0 / 11.0).abs() < 1e-15 && (b[0] - 7.0 / 11.0).abs() < 1e-15);
        assert!((a[2] - 1.0).abs() < 1e-15 && (b[2] - 1.0).abs() < 1e-15);
    }

    #[test]
    fn finds_the_wavelengths_that_carry_the_colour() {
        let mut sums = Quadrature {
            wavelengths: 6,
            gram: vec![0.0; 36],
            moment: vec![[0.0; 3]; 6],
            energy: 0.0,
        };
        for i in 0..200u32 {
            let spectrum: Vec<f32> = (0..6)
                .map(|w| 1.5 + ((i * (w + 3) * 7919) as f32).sin())
                .collect();
            let colour = [spectrum[1], 2.0 * spectrum[3], spectrum[4] + spectrum[1]];
            sums.add(&spectrum, &colour);
        }
        assert_eq!(sums.best(3), [1, 3, 4]);
        let weights = sums.weights(&[1, 3, 4]);
        assert!((weights[1][1] - 2.0).abs() < 1e-4 && weights[1][0].abs() < 1e-4);
    }
}

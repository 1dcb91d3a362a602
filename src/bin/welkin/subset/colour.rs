//! Colour from few wavelengths: which ones, and with which weights.
//!
//! The weights are the least-squares fit of the XYZ that all wavelengths give, in units of its luminance, over sample
//! skies: a quadrature rule for spectra that skies have.

use welkin::Model;

use super::samples::{Quantity, Samples};

/// Rounds of exchange. Most searches end after three; what is left to gain after so many does not count.
const ROUNDS: usize = 16;

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
        match sums.is_finite() {
            true => Ok(sums),
            false => Err(absurd(
                "the colours of its skies overflow: the file is not a sensible sky",
            )),
        }
    }

    fn is_finite(&self) -> bool {
        let sums = self.gram.iter().chain(self.moment.as_flattened());
        self.energy.is_finite() && sums.into_iter().all(|v| v.is_finite())
    }

    /// Refuses models of which no sky has a colour: there is nothing that wavelengths could be chosen by.
    pub fn check_light(&self) -> welkin::Result<()> {
        match self.energy > 0.0 {
            true => Ok(()),
            false => Err(absurd(
                "none of its skies has a luminance, so no wavelengths can be chosen for colour",
            )),
        }
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
        for _ in 0..ROUNDS {
            let before = residual;
            for k in 0..count {
                (best, residual) = self.exchanged(best, residual, k);
            }
            if residual >= before || residual.is_nan() {
                break;
            }
        }
        best
    }

    /// The wavelengths with the `k`-th exchanged for the first that is better, if one is.
    fn exchanged(&self, best: Vec<usize>, residual: f64, k: usize) -> (Vec<usize>, f64) {
        for w in (0..self.wavelengths).filter(|w| !best.contains(w)) {
            let mut other = best.clone();
            other[k] = w;
            other.sort_unstable();
            let changed = self.residual(&other);
            if changed < residual {
                return (other, changed);
            }
        }
        (best, residual)
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

/// Refuses weights that no file can hold.
pub fn check_weights(weights: &[f64]) -> welkin::Result<()> {
    const LARGEST: f64 = 1e30;
    match weights.iter().all(|w| w.abs() <= LARGEST) {
        true => Ok(()),
        false => Err(absurd(
            "the colours of its skies need weights beyond those of a file: it is not a sensible sky",
        )),
    }
}

fn absurd(detail: &str) -> welkin::Error {
    welkin::Error::Invalid {
        what: "model",
        detail: detail.to_owned(),
    }
}

/// Solves a symmetric positive semidefinite system for three right-hand sides by Gauss-Jordan elimination. Unknowns of
/// which nothing is known (no sky has light there) are 0.
fn solve(n: usize, matrix: impl Fn(usize, usize) -> f64, right: Vec<[f64; 3]>) -> Vec<[f64; 3]> {
    let left = |i: usize| (0..n).map(|j| matrix(i, j)).collect::<Vec<_>>();
    let augmented = |(i, right): (usize, &[f64; 3])| [&left(i), right.as_slice()].concat();
    let mut rows: Vec<Vec<f64>> = right.iter().enumerate().map(augmented).collect();
    for pivot in 0..n {
        let lead = rows[pivot].clone();
        if lead[pivot] <= 0.0 || lead[pivot].is_nan() {
            rows[pivot].fill(0.0);
            continue;
        }
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != pivot) {
            let factor = row[pivot] / lead[pivot];
            for (value, lead) in row.iter_mut().zip(&lead) {
                *value -= factor * lead;
            }
        }
    }
    let quotient = |value: f64, pivot: f64| if pivot > 0.0 { value / pivot } else { 0.0 };
    let solution =
        |(i, row): (usize, &Vec<f64>)| core::array::from_fn(|c| quotient(row[n + c], row[i]));
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
    fn what_nothing_is_known_of_is_zero() {
        let matrix = |i: usize, j: usize| [[4.0, 0.0], [0.0, 0.0]][i][j];
        let weights = solve(2, matrix, vec![[1.0; 3], [0.0; 3]]);
        assert_eq!(weights, [[0.25; 3], [0.0; 3]]);
    }

    #[test]
    fn a_search_without_numbers_ends() {
        let sums = |value: f64| Quadrature {
            wavelengths: 12,
            gram: vec![value; 144],
            moment: vec![[value; 3]; 12],
            energy: value,
        };
        for value in [0.0, f64::NAN, f64::INFINITY, 1e300] {
            assert_eq!(sums(value).best(4).len(), 4, "{value}");
        }
        assert!(!sums(f64::NAN).is_finite() && sums(0.0).check_light().is_err());
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

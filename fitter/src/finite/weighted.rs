//! Tucker decomposition of several tensors together, with weights.

use super::modes::{Tensor, expand, gram, leading, project};
use faer::Mat;
use rayon::prelude::*;

/// A tensor `[a][b][c][d]`, of which the errors of some cells `[a][b][·][d]` count less.
pub struct Weighted {
    /// What is decomposed.
    pub tensor: Tensor,
    /// Square roots, 0..=1, of the weights of square errors, `[a][b][d]`.
    pub weights: Vec<f64>,
}

/// Orthonormal bases that all tensors share, and the core of each.
///
/// What a cell lacks to a weight of 1 is filled with what the last pass made of it, so no pass enlarges the weighted
/// sum of squares. The first takes every value times its weight.
pub fn decompose(
    all: &[Weighted],
    ranks: [usize; 4],
    passes: usize,
) -> ([Mat<f64>; 4], Vec<Tensor>) {
    let dimmed = all.par_iter().map(Weighted::dimmed).collect();
    let mut last = decompose_alike(dimmed, ranks);
    for _ in 1..passes {
        let (bases, cores) = last;
        let made = cores.into_par_iter().map(|core| expand(core, &bases));
        let filled = all.par_iter().zip(made).map(|(one, made)| one.fill(made));
        last = decompose_alike(filled.collect(), ranks);
    }
    last
}

/// As all cells count alike.
fn decompose_alike(tensors: Vec<Tensor>, ranks: [usize; 4]) -> ([Mat<f64>; 4], Vec<Tensor>) {
    let bases = std::array::from_fn(|mode| {
        let grams: Vec<Mat<f64>> = tensors.par_iter().map(|t| gram(t, mode)).collect();
        let n = grams.first().map_or(0, Mat::nrows);
        let sum = grams.iter().fold(Mat::zeros(n, n), |sum, gram| sum + gram);
        leading(&sum, ranks[mode])
    });
    let cores = tensors.into_par_iter().map(|t| project(t, &bases));
    let cores = cores.collect();
    (bases, cores)
}

impl Weighted {
    fn dimmed(&self) -> Tensor {
        let zero = Tensor {
            shape: self.tensor.shape,
            values: vec![0.0; self.tensor.values.len()],
        };
        self.blend(zero, |weight| weight)
    }

    fn fill(&self, made: Tensor) -> Tensor {
        self.blend(made, |weight| weight * weight)
    }

    /// Between `made` and what is decomposed, which has the share that `share` makes of the weight.
    fn blend(&self, mut made: Tensor, share: impl Fn(f64) -> f64) -> Tensor {
        let [_, _, c, d] = made.shape;
        let cells = made.values.chunks_exact_mut(c * d);
        let cells = cells.zip(self.tensor.values.chunks_exact(c * d));
        for ((made, want), weights) in cells.zip(self.weights.chunks_exact(d)) {
            let rows = made.chunks_exact_mut(d).zip(want.chunks_exact(d));
            for (made, want) in rows {
                for ((made, want), &weight) in made.iter_mut().zip(want).zip(weights) {
                    *made += share(weight) * (want - *made);
                }
            }
        }
        made
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHAPE: [usize; 4] = [4, 3, 5, 2];

    /// Of rank one, but for one cell that outshines the rest.
    fn bright_cell() -> Weighted {
        let mut values = vec![];
        for i in 0..SHAPE[0] {
            for j in 0..SHAPE[1] {
                for k in 0..SHAPE[2] {
                    for l in 0..SHAPE[3] {
                        let smooth = (1.0 + i as f64) * (2.0 + j as f64) * (1.0 + k as f64);
                        let bright = if [i, j, l] == [3, 0, 1] { 1e3 } else { 0.0 };
                        values.push(smooth * (1.0 + l as f64) + bright);
                    }
                }
            }
        }
        let shape = SHAPE;
        let mut weights = vec![1.0; SHAPE[0] * SHAPE[1] * SHAPE[3]];
        weights[3 * SHAPE[1] * SHAPE[3] + 1] = 1e-3;
        Weighted {
            tensor: Tensor { shape, values },
            weights,
        }
    }

    /// Largest error where cells count.
    fn error(one: &Weighted, passes: usize) -> f64 {
        let (bases, mut cores) = decompose(std::slice::from_ref(one), [1; 4], passes);
        let made = expand(cores.remove(0), &bases);
        let bright = |k: usize| (90..100).contains(&k) && k % 2 == 1;
        let pairs = made.values.iter().zip(&one.tensor.values).enumerate();
        pairs
            .filter(|(k, _)| !bright(*k))
            .map(|(_, (got, want))| (got / want - 1.0).abs())
            .fold(0.0, f64::max)
    }

    #[test]
    fn a_cell_that_does_not_count_spoils_nothing() {
        let mut one = bright_cell();
        assert!(error(&one, 40) < 1e-3, "{}", error(&one, 40));
        assert!(error(&one, 40) < error(&one, 2));
        one.weights.fill(1.0);
        assert!(error(&one, 40) > 0.5);
    }
}

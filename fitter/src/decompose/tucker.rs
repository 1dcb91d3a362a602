//! Higher-order SVD: an orthogonal basis per mode and a small core, so that the decomposition works on little data.

use faer::{Mat, Side};
use rayon::prelude::*;

/// A dense tensor of four modes, row-major.
pub struct Dense {
    /// Lengths of the modes.
    pub shape: [usize; 4],
    /// Values.
    pub values: Vec<f64>,
}

/// Basis `[length][rank]` of each mode and the core in these bases.
pub struct Tucker {
    /// Orthonormal bases.
    pub bases: [Mat<f64>; 4],
    /// The core.
    pub core: Dense,
}

impl Tucker {
    /// A tensor in its own coordinates.
    pub fn new(core: Dense) -> Self {
        let bases = core.shape.map(|n| Mat::identity(n, n));
        Self { bases, core }
    }

    /// Compresses `mode`, leaving out at most the share `tolerance` of the energy.
    pub fn compress(&mut self, mode: usize, tolerance: f64) {
        let basis = principal_basis(&gram(&self.core, mode), tolerance);
        self.project(mode, &basis);
    }

    /// Replaces `mode` by its coordinates in an orthonormal basis.
    pub fn project(&mut self, mode: usize, basis: &Mat<f64>) {
        self.core = self.core.project(mode, basis);
        self.bases[mode] = &self.bases[mode] * basis;
    }
}

/// Compresses `mode` of all tensors with one basis, to which every tensor contributes alike.
pub fn compress_together(tensors: &mut [Tucker], mode: usize, tolerance: f64) {
    let grams = tensors.iter().map(|t| t.core.relative_gram(mode));
    let Some(sum) = grams.reduce(|a, b| a + b) else {
        return;
    };
    let basis = principal_basis(&sum, tolerance);
    tensors.par_iter_mut().for_each(|t| t.project(mode, &basis));
}

fn gram(tensor: &Dense, mode: usize) -> Mat<f64> {
    let matrix = tensor.unfold(mode);
    &matrix * matrix.transpose()
}

impl Dense {
    /// The Gram matrix of a mode over the energy.
    pub fn relative_gram(&self, mode: usize) -> Mat<f64> {
        let energy: f64 = self.values.iter().map(|v| v * v).sum();
        gram(self, mode) * faer::Scale(1.0 / energy.max(1e-300))
    }

    /// Matrix `[mode][all others]`.
    pub fn unfold(&self, mode: usize) -> Mat<f64> {
        let (outer, n, inner) = self.split(mode);
        Mat::from_fn(n, outer * inner, |i, j| {
            self.values[((j / inner) * n + i) * inner + j % inner]
        })
    }

    /// Replaces a mode by its coordinates in an orthonormal basis.
    fn project(&self, mode: usize, basis: &Mat<f64>) -> Self {
        let small = basis.transpose() * self.unfold(mode);
        let (outer, _, inner) = self.split(mode);
        let n = basis.ncols();
        let mut values = vec![0.0; outer * n * inner];
        for i in 0..n {
            for o in 0..outer {
                for k in 0..inner {
                    values[(o * n + i) * inner + k] = small[(i, o * inner + k)];
                }
            }
        }
        let mut shape = self.shape;
        shape[mode] = n;
        Self { shape, values }
    }

    fn split(&self, mode: usize) -> (usize, usize, usize) {
        let outer = self.shape[..mode].iter().product();
        let inner = self.shape[mode + 1..].iter().product();
        (outer, self.shape[mode], inner)
    }
}

/// Eigenvectors of a Gram matrix that hold all but `tolerance` of its trace.
pub fn principal_basis(gram: &Mat<f64>, tolerance: f64) -> Mat<f64> {
    let n = gram.nrows();
    let Ok(eigen) = gram.self_adjoint_eigen(Side::Lower) else {
        return Mat::identity(n, n);
    };
    let values: Vec<f64> = (0..n)
        .map(|i| eigen.S().column_vector()[i].max(0.0))
        .collect();
    let total: f64 = values.iter().sum();
    // Ascending order: drop from the front.
    let mut dropped = 0.0;
    let first = values.iter().position(|v| {
        dropped += v;
        dropped > tolerance * total
    });
    let first = first.unwrap_or(n - 1);
    Mat::from_fn(n, n - first, |i, j| eigen.U()[(i, n - 1 - j)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_low_rank_tensor_compresses_without_loss() {
        let shape = [5, 4, 6, 3];
        let f = |i: usize, j: usize, k: usize, l: usize| {
            ((i + 1) * (j + 2)) as f64 * (k as f64 - 2.0) + (i * i) as f64 * (l as f64 + 0.5)
        };
        let mut values = vec![];
        for i in 0..5 {
            for j in 0..4 {
                for k in 0..6 {
                    values.extend((0..3).map(|l| f(i, j, k, l)));
                }
            }
        }
        let energy: f64 = values.iter().map(|v| v * v).sum();
        let mut tucker = Tucker::new(Dense { shape, values });
        for mode in 0..4 {
            tucker.compress(mode, 1e-12);
        }
        assert_eq!(tucker.core.shape, [2, 2, 2, 2]);
        let kept: f64 = tucker.core.values.iter().map(|v| v * v).sum();
        assert!((kept / energy - 1.0).abs() < 1e-9);
    }
}

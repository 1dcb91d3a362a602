//! Higher-order SVD: an orthogonal basis per mode and a small core, so that the decomposition works on little data.

use faer::{Mat, Side};

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

/// Compresses `tensor`, leaving out at most the share `tolerance` of its energy per mode.
pub fn compress(tensor: Dense, tolerance: f64) -> Tucker {
    let mut core = tensor;
    let bases = std::array::from_fn(|mode| {
        let basis = principal_basis(&core.unfold(mode), tolerance);
        core = core.project(mode, &basis);
        basis
    });
    Tucker { bases, core }
}

impl Dense {
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

/// Eigenvectors of the Gram matrix that hold all but `tolerance` of its trace.
fn principal_basis(matrix: &Mat<f64>, tolerance: f64) -> Mat<f64> {
    let gram = matrix * matrix.transpose();
    let Ok(eigen) = gram.self_adjoint_eigen(Side::Lower) else {
        return Mat::identity(matrix.nrows(), matrix.nrows());
    };
    let n = gram.nrows();
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
        let tucker = compress(Dense { shape, values }, 1e-12);
        assert_eq!(tucker.core.shape, [2, 2, 2, 2]);
        let kept: f64 = tucker.core.values.iter().map(|v| v * v).sum();
        assert!((kept / energy - 1.0).abs() < 1e-9);
    }
}

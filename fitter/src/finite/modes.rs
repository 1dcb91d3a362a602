//! Dense tensors of four modes: Gram matrices, leading directions, projections.

use faer::{Mat, Side};

/// A dense tensor, row-major.
pub struct Tensor {
    /// Lengths of the modes.
    pub shape: [usize; 4],
    /// Values.
    pub values: Vec<f64>,
}

impl Tensor {
    /// Lengths before, of and after a mode.
    fn split(&self, mode: usize) -> (usize, usize, usize) {
        let outer = self.shape[..mode].iter().product();
        let inner = self.shape[mode + 1..].iter().product();
        (outer, self.shape[mode], inner)
    }

    /// Block `[mode][after]` at one index of the modes before.
    fn block(&self, mode: usize, outer: usize) -> Mat<f64> {
        let (_, n, inner) = self.split(mode);
        let start = outer * n * inner;
        Mat::from_fn(n, inner, |i, j| self.values[start + i * inner + j])
    }
}

/// Inner products of the slices along a mode.
pub fn gram(tensor: &Tensor, mode: usize) -> Mat<f64> {
    let (outer, n, inner) = tensor.split(mode);
    let mut sum = Mat::zeros(n, n);
    if inner == 1 {
        let all = Mat::from_fn(n, outer, |i, j| tensor.values[j * n + i]);
        return &all * all.transpose();
    }
    for o in 0..outer {
        let block = tensor.block(mode, o);
        sum += &block * block.transpose();
    }
    sum
}

/// The `rank` eigenvectors of a Gram matrix with the largest eigenvalues, largest first.
pub fn leading(gram: &Mat<f64>, rank: usize) -> Mat<f64> {
    let n = gram.nrows();
    match gram.self_adjoint_eigen(Side::Lower) {
        Ok(eigen) => Mat::from_fn(n, rank.min(n), |i, j| eigen.U()[(i, n - 1 - j)]),
        Err(_) => Mat::identity(n, rank.min(n)),
    }
}

/// Coordinates in orthonormal bases.
pub fn project(mut tensor: Tensor, bases: &[Mat<f64>; 4]) -> Tensor {
    for (mode, basis) in bases.iter().enumerate() {
        let (outer, _, _) = tensor.split(mode);
        let mut values = vec![];
        for o in 0..outer {
            let small = basis.transpose() * tensor.block(mode, o);
            for i in 0..small.nrows() {
                values.extend((0..small.ncols()).map(|j| small[(i, j)]));
            }
        }
        tensor.shape[mode] = basis.ncols();
        tensor.values = values;
    }
    tensor
}

/// The tensor of which `core` has the coordinates in orthonormal bases.
pub fn expand(core: Tensor, bases: &[Mat<f64>; 4]) -> Tensor {
    project(
        core,
        &bases.each_ref().map(|basis| basis.transpose().to_owned()),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tensor_of_low_rank_survives_its_projection() {
        let shape = [4, 3, 5, 2];
        let value = |i: usize, j: usize, k: usize, l: usize| {
            (i as f64 + 1.0) * (j as f64 - 0.5) * (k as f64 + 2.0).sqrt() * (l as f64 + 0.3)
                + (i * i) as f64 * (k as f64 - 1.0)
        };
        let mut values = vec![];
        for i in 0..4 {
            for j in 0..3 {
                for k in 0..5 {
                    values.extend((0..2).map(|l| value(i, j, k, l)));
                }
            }
        }
        let tensor = Tensor { shape, values };
        let energy: f64 = tensor.values.iter().map(|v| v * v).sum();
        let bases = std::array::from_fn(|mode| leading(&gram(&tensor, mode), 2));
        let core = project(tensor, &bases);
        assert_eq!(core.shape, [2; 4]);
        let kept: f64 = core.values.iter().map(|v| v * v).sum();
        assert!((kept / energy - 1.0).abs() < 1e-9, "{}", kept / energy);
    }
}

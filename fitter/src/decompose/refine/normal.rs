//! Normal equations: gathered in blocks, solved for a damped step.

use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::linalg::solvers::{Llt, Solve};
use faer::{Accum, Mat, Par, Side};

/// Damping of a step relative to the diagonal of its normal matrix.
const DAMPING: f64 = 2e-3;

/// Normal equations of one row of a factor matrix, gathered in blocks.
pub struct Normal {
    unknowns: usize,
    matrix: Mat<f32>,
    right: Vec<f32>,
    block: Mat<f32>,
    residuals: Vec<f32>,
    rows: usize,
}

const BLOCK: usize = 512;

impl Normal {
    pub fn new(unknowns: usize) -> Self {
        Self {
            unknowns,
            matrix: Mat::zeros(unknowns, unknowns),
            right: vec![0.0; unknowns],
            block: Mat::zeros(unknowns, BLOCK),
            residuals: vec![0.0; BLOCK],
            rows: 0,
        }
    }

    /// Adds a row: `fill` writes it, already times its root weight, and gives its residual.
    pub fn push(&mut self, fill: impl FnOnce(&mut [f32]) -> f32) {
        self.residuals[self.rows] = fill(self.block.col_as_slice_mut(self.rows));
        self.rows += 1;
        if self.rows == BLOCK {
            self.flush();
        }
    }

    fn flush(&mut self) {
        let block = self.block.subcols(0, self.rows);
        let lower = BlockStructure::TriangularLower;
        let full = BlockStructure::Rectangular;
        matmul(
            self.matrix.as_mut(),
            lower,
            Accum::Add,
            block,
            full,
            block.transpose(),
            full,
            1.0,
            Par::Seq,
        );
        for i in 0..self.rows {
            let residual = self.residuals[i];
            for (sum, x) in self.right.iter_mut().zip(self.block.col_as_slice(i)) {
                *sum += residual * x;
            }
        }
        self.rows = 0;
    }

    /// Both together.
    pub fn join(mut self, mut other: Self) -> Self {
        self.flush();
        other.flush();
        self.matrix += &other.matrix;
        self.right
            .iter_mut()
            .zip(other.right)
            .for_each(|(a, b)| *a += b);
        self
    }

    /// The damped step; none where nothing was gathered.
    pub fn step(mut self) -> Vec<f32> {
        self.flush();
        let n = self.unknowns;
        let floor = 1e-6 * (0..n).map(|i| f64::from(self.matrix[(i, i)])).sum::<f64>() / n as f64;
        let matrix = Mat::from_fn(n, n, |i, j| {
            let value = f64::from(self.matrix[(i.max(j), i.min(j))]);
            if i == j {
                value * (1.0 + DAMPING) + floor + 1e-30
            } else {
                value
            }
        });
        let right = Mat::from_fn(n, 1, |i, _| f64::from(self.right[i]));
        match Llt::new(matrix.as_ref(), Side::Lower) {
            Ok(llt) => {
                let x = llt.solve(&right);
                (0..n).map(|i| x[(i, 0)] as f32).collect()
            }
            Err(_) => vec![0.0; n],
        }
    }
}

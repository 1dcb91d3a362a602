//! Weights of the nodes, learned by least squares.
//!
//! For lines of sight in the training set, ln L of a cell is a sum of ln L of few nodes with weights that add up to 1:
//! radiance that is grey times another has a grey factor, too.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Nodes that a cell is made of.
pub const TAPS: usize = 8;
/// Relative to the variance of the differences: keeps nodes that say the same from leaning on each other.
const RIDGE: f64 = 1e-7;

/// One row of weights.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Nodes and their weights, of sum 1; at most [`TAPS`].
    pub taps: Vec<(usize, f64)>,
    /// Root mean square of what is left of ln L.
    pub rms: f64,
}

/// Weights of `nodes` (ln L per sample, `[sample][node]`) for `cells` (ln L per sample, `[sample][cell]`), one row per
/// cell. Samples count with `importance`.
pub fn learn(nodes: &DMatrix<f64>, cells: &DMatrix<f64>, importance: &[f64]) -> Vec<Row> {
    let scale = DVector::from_iterator(importance.len(), importance.iter().map(|v| v.sqrt()));
    let scaled = |m: &DMatrix<f64>| {
        let mut out = m.clone();
        for (mut row, s) in out.row_iter_mut().zip(&scale) {
            row *= *s;
        }
        out
    };
    let (x, y) = (scaled(nodes), scaled(cells));
    let total: f64 = importance.iter().sum();
    let moments = Moments {
        nodes: x.tr_mul(&x) / total,
        both: x.tr_mul(&y) / total,
        cells: y.column_iter().map(|c| c.norm_squared() / total).collect(),
    };
    (0..cells.ncols())
        .into_par_iter()
        .map(|c| moments.row(c))
        .collect()
}

/// Mean products of ln L.
struct Moments {
    nodes: DMatrix<f64>,
    both: DMatrix<f64>,
    cells: Vec<f64>,
}

impl Moments {
    /// Takes in the node that helps most, again and again.
    fn row(&self, cell: usize) -> Row {
        let n = self.nodes.nrows();
        let single = |j: usize| self.solve(cell, &[j]).1;
        let first = (0..n).min_by(|&a, &b| single(a).total_cmp(&single(b)));
        let mut chosen = vec![first.expect("a model has nodes")];
        let (mut weights, mut left) = self.solve(cell, &chosen);
        while chosen.len() < TAPS.min(n) && left > 1e-12 {
            let with = |j: usize| [&chosen[..], &[j]].concat();
            let free = (0..n).filter(|j| !chosen.contains(j));
            let tried = free.map(|j| (j, self.solve(cell, &with(j))));
            let Some((j, better)) = tried.min_by(|a, b| a.1.1.total_cmp(&b.1.1)) else {
                break;
            };
            if better.1 > 0.98 * left {
                break;
            }
            chosen.push(j);
            (weights, left) = better;
        }
        Row {
            taps: chosen.into_iter().zip(weights).collect(),
            rms: left.max(0.0).sqrt(),
        }
    }

    /// Weights of the `chosen` nodes that add up to 1, and the mean square of what is left.
    fn solve(&self, cell: usize, chosen: &[usize]) -> (Vec<f64>, f64) {
        let base = chosen[0];
        let rest = &chosen[1..];
        let m = &self.nodes;
        // Products of differences to the first node.
        let between =
            |i: usize, j: usize| m[(i, j)] - m[(i, base)] - m[(base, j)] + m[(base, base)];
        let towards = |i: usize| {
            self.both[(i, cell)] - self.both[(base, cell)] - m[(i, base)] + m[(base, base)]
        };
        let whole = self.cells[cell] - 2.0 * self.both[(base, cell)] + m[(base, base)];
        let normal = DMatrix::from_fn(rest.len(), rest.len(), |i, j| {
            let ridge = if i == j { 1.0 + RIDGE } else { 1.0 };
            between(rest[i], rest[j]) * ridge
        });
        let right = DVector::from_fn(rest.len(), |i, _| towards(rest[i]));
        let Some(solved) = normal.clone().cholesky().map(|c| c.solve(&right)) else {
            return (vec![1.0; chosen.len()], f64::INFINITY);
        };
        let left = whole - 2.0 * solved.dot(&right) + solved.dot(&(&normal * &solved));
        let first = 1.0 - solved.sum();
        (
            std::iter::once(first)
                .chain(solved.iter().copied())
                .collect(),
            left,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three nodes that are unlike each other, a cell that is a mixture of two of them, and one that is a node.
    #[test]
    fn mixtures_are_found() {
        let nodes = DMatrix::from_fn(50, 3, |i, j| -3.0 + ((i * (j + 2)) as f64 * 0.37).sin());
        let cells = DMatrix::from_fn(50, 2, |i, c| match c {
            0 => 1.4 * nodes[(i, 0)] - 0.4 * nodes[(i, 2)],
            _ => nodes[(i, 1)],
        });
        let rows = learn(&nodes, &cells, &vec![1.0; 50]);
        let mut taps = rows[0].taps.clone();
        taps.sort_by_key(|t| t.0);
        assert_eq!(taps.iter().map(|t| t.0).collect::<Vec<_>>(), [0, 2]);
        assert!((taps[0].1 - 1.4).abs() < 1e-5 && (taps[1].1 + 0.4).abs() < 1e-5);
        assert_eq!(rows[1].taps, [(1, 1.0)]);
        assert!(rows.iter().all(|r| r.rms < 1e-5));
    }
}

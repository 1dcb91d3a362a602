//! From values at the suns of a file to a spline over solar elevation that goes through them and is smooth between.

use crate::dataset::{Axis, Grid};
use faer::Mat;
use faer::linalg::solvers::{PartialPivLu, Solve};
use welkin::axis::{Ends, spline};

/// What roughness counts against a miss.
const SMOOTHNESS: f64 = 1e-9;

/// A linear map from values at suns to spline coefficients.
pub struct SunSplines {
    /// Splines at the suns, `[sun][coefficient]`.
    at_suns: Mat<f64>,
    /// Splines at the sites of the axis, `[site][coefficient]`.
    at_sites: Mat<f64>,
    /// `[coefficient][sun]`.
    coefficients: Mat<f64>,
}

impl SunSplines {
    /// For solar elevations (rad) on the axis of `grid`.
    pub fn new(grid: &Grid, suns: &[f64]) -> Self {
        let axis = grid.elevation_axis();
        let places: Vec<f64> = suns.iter().map(|e| grid.elevation.coordinate(*e)).collect();
        let at_suns = splines(axis, &places);
        let n = axis.len();
        let mut normal = at_suns.transpose() * &at_suns;
        // The third difference: what is left free is a parabola.
        for i in 0..n.saturating_sub(3) {
            let difference = [-1.0, 3.0, -3.0, 1.0];
            for (a, x) in difference.iter().enumerate() {
                for (b, y) in difference.iter().enumerate() {
                    normal[(i + a, i + b)] += SMOOTHNESS * x * y;
                }
            }
        }
        // With fewer suns than a parabola needs.
        for i in 0..n {
            normal[(i, i)] += 1e-4 * SMOOTHNESS;
        }
        let lu: PartialPivLu<f64> = normal.partial_piv_lu();
        Self {
            coefficients: lu.solve(at_suns.transpose()),
            at_sites: splines(axis, &axis.sites()),
            at_suns,
        }
    }

    /// Coefficients `[coefficient][column]` for values `[sun][column]`.
    pub fn coefficients(&self, values: &Mat<f64>) -> Mat<f64> {
        &self.coefficients * values
    }

    /// Values at the suns of splines with these coefficients.
    pub fn at_suns(&self, coefficients: &Mat<f64>) -> Mat<f64> {
        &self.at_suns * coefficients
    }

    /// Values at the sites of the axis for values at the suns, `[row][rank]` both.
    pub fn to_sites(&self, values: &[f32], rank: usize) -> Vec<f32> {
        let suns = values.len() / rank;
        let values = Mat::from_fn(suns, rank, |i, r| f64::from(values[i * rank + r]));
        let sites = &self.at_sites * self.coefficients(&values);
        crate::decompose::row_major(&sites)
    }
}

fn splines(axis: Axis, places: &[f64]) -> Mat<f64> {
    let mut matrix = Mat::zeros(places.len(), axis.len());
    for (row, u) in places.iter().enumerate() {
        let taps = spline(*u, axis.intervals, Ends::Free);
        for (i, w) in taps.index.into_iter().zip(taps.weight) {
            matrix[(row, i)] += f64::from(w);
        }
    }
    matrix
}

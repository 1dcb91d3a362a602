//! Spline coefficients from values at the sites of an axis.

use crate::dataset::Axis;
use faer::Mat;
use faer::linalg::solvers::{PartialPivLu, Solve};
use welkin::axis::spline;

/// The factorised collocation matrix of an axis.
pub struct Collocation {
    matrix: Mat<f64>,
    lu: PartialPivLu<f64>,
}

impl Collocation {
    /// For the sites of `axis`.
    pub fn new(axis: Axis) -> Self {
        let mut matrix = Mat::<f64>::zeros(axis.len(), axis.len());
        for (row, u) in axis.sites().into_iter().enumerate() {
            let taps = spline(u, axis.intervals, axis.ends);
            for (i, w) in taps.index.into_iter().zip(taps.weight) {
                matrix[(row, i)] += f64::from(w);
            }
        }
        Self {
            lu: matrix.partial_piv_lu(),
            matrix,
        }
    }

    /// Values `[site][column]` of the splines with these coefficients.
    pub fn values(&self, coefficients: &Mat<f64>) -> Mat<f64> {
        &self.matrix * coefficients
    }

    /// Coefficients `[coefficient][column]` whose splines take `values[site][column]` at the sites.
    pub fn solve(&self, values: &Mat<f64>) -> Mat<f64> {
        self.lu.solve(values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use welkin::axis::Ends;

    #[test]
    fn a_spline_goes_through_its_sites_and_follows_smooth_functions() {
        for ends in [Ends::Free, Ends::Mirrored] {
            let axis = Axis {
                intervals: 12,
                ends,
            };
            let f = |u: f64| (u * std::f64::consts::PI / 6.0).cos();
            let sites = axis.sites();
            let values = Mat::from_fn(sites.len(), 1, |i, _| f(sites[i]));
            let c = Collocation::new(axis).solve(&values);
            for k in 0..=120 {
                let u = k as f64 / 10.0;
                let taps = spline(u, 12, ends);
                let value: f64 = taps
                    .index
                    .iter()
                    .zip(taps.weight)
                    .map(|(&i, w)| c[(i, 0)] * f64::from(w))
                    .sum();
                assert!(
                    (value - f(u)).abs() < 2e-3,
                    "{ends:?} {u}: {value} {}",
                    f(u)
                );
            }
        }
    }
}

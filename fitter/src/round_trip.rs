//! Half precision: what rounding costs a chunk, before it is written.

use crate::assess::Quantiles;
use crate::dataset::{Axis, Grid};
use crate::decompose::{Basis, Chunk, Collocation, Own, relative_radiance, row_major};
use faer::Mat;
use std::fmt;
use welkin::format::{RadianceBasis, RadianceFactors};

/// A chunk that loses more by rounding than its fit left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundingExceedsFit {
    /// Median and 99th percentile of the change by rounding, relative to the traced radiance.
    pub rounding: [f64; 2],
    /// The same of the fit's own error at the same sites.
    pub fit: [f64; 2],
}

impl fmt::Display for RoundingExceedsFit {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [[a, b], [c, d]] = [self.rounding, self.fit].map(|pair| pair.map(|v| 100.0 * v));
        write!(
            f,
            "half precision changes the radiance by {a:.3} % (median) and {b:.3} % (p99), the fit states {c:.3} % and {d:.3} %"
        )
    }
}

impl std::error::Error for RoundingExceedsFit {}

/// Sites that are compared.
const SITES: usize = 4000;

/// Compares a fit with its factors as the file will have them, at random sites.
///
/// # Errors
/// [`RoundingExceedsFit`] if the median or the 99th percentile of the change is larger than that of the fit's own
/// error, or not a number.
pub fn check(
    grid: &Grid,
    chunk: &Chunk,
    (own, basis): (&Own, &Basis),
    (factors, shared): (&RadianceFactors, &RadianceBasis),
) -> Result<(), RoundingExceedsFit> {
    let exact = relative_radiance(chunk, own, basis, SITES);
    let (own, basis) = rounded(grid, factors, shared);
    let rough = relative_radiance(chunk, &own, &basis, SITES);
    let change = exact
        .iter()
        .zip(&rough)
        .map(|(a, b)| f64::from(b - a).abs());
    let error = exact.iter().map(|v| f64::from(v - 1.0).abs());
    let [rounding, fit] = [quantiles(change), quantiles(error)];
    if rounding.iter().zip(fit).all(|(r, f)| *r <= f) {
        Ok(())
    } else {
        Err(RoundingExceedsFit { rounding, fit })
    }
}

fn quantiles(values: impl Iterator<Item = f64>) -> [f64; 2] {
    Quantiles::of(values).map_or([0.0; 2], |q| [q.median, q.p99])
}

/// Factor matrices at the sites, from rounded splines.
fn rounded(grid: &Grid, factors: &RadianceFactors, shared: &RadianceBasis) -> (Own, Basis) {
    let rank = factors.rank;
    let sites = |axis: Axis, coefficients: &[f32]| {
        let matrix = Mat::from_fn(axis.len(), rank, |i, r| half(coefficients[i * rank + r]));
        Collocation::new(axis).values(&matrix)
    };
    let mut elevation = sites(grid.elevation_axis(), &factors.elevation);
    for (r, scale) in factors.scale.iter().enumerate() {
        for i in 0..elevation.nrows() {
            elevation[(i, r)] *= f64::from(*scale);
        }
    }
    let channels = shared.channel.len() / rank;
    let channel = Mat::from_fn(channels, rank, |c, r| {
        half(shared.channel[r * channels + c])
    });
    let up = row_major(&sites(grid.up.0, &factors.alpha_up));
    let down = row_major(&sites(grid.down.0, &factors.alpha_down));
    let own = Own {
        view: [up, down].concat(),
        elevation: row_major(&elevation),
    };
    let basis = Basis {
        rank,
        phi: row_major(&sites(grid.phi, &shared.phi)),
        channel: row_major(&channel),
    };
    (own, basis)
}

fn half(value: f32) -> f64 {
    f64::from(half::f16::from_f32(value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::decompose::residual;
    use crate::pack::PackedBasis;
    use crate::successive_orders::{FIELDS, NW};
    use welkin::axis::{ElevationAxis, Ends};

    const RANK: usize = 8;

    fn grid() -> Grid {
        let axis = |ends| Axis { intervals: 4, ends };
        Grid {
            up: (axis(Ends::Free), 3.0),
            down: (axis(Ends::Free), 3.0),
            phi: axis(Ends::Mirrored),
            elevation: ElevationAxis {
                intervals: 4,
                ..Grid::default().elevation
            },
            ..Grid::default()
        }
    }

    fn factors(grid: &Grid) -> (Own, Basis) {
        let table = |rows: usize, phase: f32| -> Vec<f32> {
            let cells = (0..rows).flat_map(|i| (0..RANK).map(move |r| (i as f32, r as f32)));
            cells
                .map(|(i, r)| 1.0 + 0.5 * (phase + 0.3 * i * (1.0 + 0.2 * r)).sin())
                .collect()
        };
        let own = Own {
            view: table(grid.up.0.len() + grid.down.0.len(), 0.1),
            elevation: table(grid.elevation_axis().len(), 0.7),
        };
        let basis = Basis {
            rank: RANK,
            phi: table(grid.phi.len(), 1.1),
            channel: table(FIELDS * NW, 2.3),
        };
        (own, basis)
    }

    /// A chunk that the factors fit up to a relative error of `noise`.
    fn chunk(grid: &Grid, own: &Own, basis: &Basis, noise: f32) -> Chunk {
        let views = grid.up.0.len() + grid.down.0.len();
        let sites = [views, grid.phi.len(), grid.elevation_axis().len()];
        let empty = Chunk::synthetic(sites);
        let sums = residual(&empty, own, basis);
        let noisy = sums.values().iter().enumerate();
        empty.with_values(
            noisy
                .map(|(i, v)| -v * (1.0 + noise * (i as f32 * 12.9898).sin()))
                .collect(),
        )
    }

    fn outcome(own: &Own, basis: &Basis, noise: f32) -> Result<(), RoundingExceedsFit> {
        let grid = grid();
        let chunk = chunk(&grid, own, basis, noise);
        let shared = PackedBasis::new(&grid, basis);
        let packed = shared.radiance_chunk(&grid, own);
        check(&grid, &chunk, (own, basis), (&packed, &shared.radiance()))
    }

    #[test]
    fn a_sound_fit_passes() {
        let (own, basis) = factors(&grid());
        outcome(&own, &basis, 0.01).unwrap();
    }

    #[test]
    fn components_that_cancel_are_refused() {
        let (mut own, basis) = factors(&grid());
        // The last two components become equal and opposite up to a part in a thousand, a thousand times as large as
        // the rest.
        for row in own.view.chunks_exact_mut(RANK) {
            row[7] = -row[6] * (1.0 + 1e-3 * row[5]);
        }
        for row in own.elevation.chunks_exact_mut(RANK) {
            (row[6], row[7]) = (1000.0 * row[6], 1000.0 * row[6]);
        }
        let mut basis = basis;
        for matrix in [&mut basis.phi, &mut basis.channel] {
            matrix
                .chunks_exact_mut(RANK)
                .for_each(|row| row[7] = row[6]);
        }
        let refusal = outcome(&own, &basis, 0.01).unwrap_err();
        assert!(refusal.rounding[0] > refusal.fit[0], "{refusal}");
        assert!(refusal.to_string().contains("half precision"));
    }

    /// Components of any size fit into half precision, because their sizes are kept apart.
    #[test]
    fn sizes_beyond_half_precision_pass() {
        let (mut own, mut basis) = factors(&grid());
        for (r, size) in [(0, 1e-9f32), (1, 1e9), (2, 3e-7)] {
            own.view
                .chunks_exact_mut(RANK)
                .for_each(|row| row[r] *= size);
            basis
                .phi
                .chunks_exact_mut(RANK)
                .for_each(|row| row[r] /= size);
        }
        outcome(&own, &basis, 0.01).unwrap();
    }

    /// A factor that falls to the subnormals of half precision, as on the night side: what is lost there is not seen in
    /// the sum.
    #[test]
    fn subnormals_pass_as_long_as_others_outweigh_them() {
        let (mut own, basis) = factors(&grid());
        for (i, row) in own.elevation.chunks_exact_mut(RANK).enumerate() {
            row[3] *= 10f32.powi(-(i as i32));
        }
        outcome(&own, &basis, 0.01).unwrap();
        // Where they are all there is, they are too rough.
        for (i, row) in own.elevation.chunks_exact_mut(RANK).enumerate() {
            row.iter_mut().for_each(|v| *v *= 10f32.powi(-2 * i as i32));
        }
        outcome(&own, &basis, 0.01).unwrap_err();
    }
}

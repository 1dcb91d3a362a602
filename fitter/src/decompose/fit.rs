//! The factors of one chunk.

use super::als::{Options, decompose};
use super::collocation::Collocation;
use super::normalise::{ChunkGeometry, ElevationScale, normalise, row_major};
use super::tucker::{Dense, compress};
use crate::dataset::{Axis, Grid, Tensor};
use crate::orders::Medium;
use faer::Mat;
use welkin::format::RadianceFactors;

/// Share of the energy that the compression before ALS may lose per mode.
const COMPRESSION: f64 = 1e-9;

/// A fitted chunk.
pub struct Fit {
    /// Factors for the file.
    pub factors: RadianceFactors,
    /// Relative error of the decomposition in the weighted norm.
    pub error: f64,
    /// Sum of the components' norms over the norm of the tensor: large when components cancel.
    pub condition: f64,
}

impl Fit {
    /// All numbers in a row, for a file.
    pub fn to_values(&self) -> Vec<f32> {
        let f = &self.factors;
        let mut out = vec![self.error as f32, self.condition as f32];
        for part in [
            &f.scale,
            &f.alpha_up,
            &f.alpha_down,
            &f.phi,
            &f.elevation,
            &f.channel,
        ] {
            out.extend(part);
        }
        out
    }

    /// The inverse of [`Fit::to_values`] for a grid and a rank; `None` for another number of values.
    pub fn from_values(values: &[f32], grid: &Grid, rank: usize, channels: usize) -> Option<Self> {
        let (&[error, condition], mut rest) = values.split_first_chunk::<2>()?;
        let rows = [
            1,
            grid.up.0.len(),
            grid.down.0.len(),
            grid.phi.len(),
            grid.elevation_axis().len(),
            channels,
        ];
        if rest.len() != rank * rows.iter().sum::<usize>() {
            return None;
        }
        let mut take = |rows: usize| {
            let (part, tail) = rest.split_at(rows * rank);
            rest = tail;
            part.to_vec()
        };
        let [scale, alpha_up, alpha_down, phi, elevation, channel] = rows.map(&mut take);
        Some(Self {
            factors: RadianceFactors {
                rank,
                scale,
                alpha_up,
                alpha_down,
                phi,
                elevation,
                channel,
            },
            error: f64::from(error),
            condition: f64::from(condition),
        })
    }
}

/// Fits the tensor of one (altitude, visibility). `weights` says how much each channel counts.
pub fn fit(
    tensor: &Tensor,
    geometry: &ChunkGeometry,
    medium: &Medium,
    grid: &Grid,
    scale: &ElevationScale,
    weights: &[f64],
    options: Options,
) -> Fit {
    let mut values = normalise(tensor, geometry, medium, scale);
    for cell in values.chunks_exact_mut(weights.len()) {
        for (value, weight) in cell.iter_mut().zip(weights) {
            *value *= weight;
        }
    }
    let norm = values.iter().map(|v| v * v).sum::<f64>().sqrt();
    let tucker = compress(
        Dense {
            shape: tensor.shape,
            values,
        },
        COMPRESSION,
    );
    let cpd = decompose(&tucker.core, options);
    let [mut view, phi, elevation, mut channel] =
        std::array::from_fn(|m| &tucker.bases[m] * &cpd.factors[m]);
    let condition = condition(&cpd.factors, norm);
    for (c, weight) in weights.iter().enumerate() {
        for r in 0..options.rank {
            channel[(c, r)] /= weight;
        }
    }
    let up = grid.up.0.len();
    let lower = view.split_off(up);
    let spline = |axis: Axis, values: &Mat<f64>| Collocation::new(axis).solve(values);
    let matrices = [
        spline(grid.up.0, &view),
        spline(grid.down.0, &lower),
        spline(grid.phi, &phi),
        spline(grid.elevation_axis(), &elevation),
        channel,
    ];
    Fit {
        factors: pack(matrices),
        error: cpd.error,
        condition,
    }
}

trait SplitOff {
    fn split_off(&mut self, row: usize) -> Self;
}

impl SplitOff for Mat<f64> {
    fn split_off(&mut self, row: usize) -> Self {
        let rest = self.subrows(row, self.nrows() - row).to_owned();
        *self = self.subrows(0, row).to_owned();
        rest
    }
}

/// Scales every column to a largest magnitude of 1 and collects the weights. The two view matrices share their scale.
fn pack(mut matrices: [Mat<f64>; 5]) -> RadianceFactors {
    let rank = matrices[0].ncols();
    let mut scale = vec![1.0f64; rank];
    for (r, scale) in scale.iter_mut().enumerate() {
        for group in [0..2, 2..3, 3..4, 4..5] {
            let max = matrices[group.clone()]
                .iter()
                .flat_map(|m| (0..m.nrows()).map(move |i| m[(i, r)].abs()))
                .fold(1e-300, f64::max);
            *scale *= max;
            for m in &mut matrices[group] {
                for i in 0..m.nrows() {
                    m[(i, r)] /= max;
                }
            }
        }
    }
    let [up, down, phi, elevation, channel] = matrices;
    RadianceFactors {
        rank,
        scale: scale.into_iter().map(|s| s as f32).collect(),
        alpha_up: row_major(&up),
        alpha_down: row_major(&down),
        phi: row_major(&phi),
        elevation: row_major(&elevation),
        channel: row_major(&channel.transpose().to_owned()),
    }
}

fn condition(factors: &[Mat<f64>; 4], norm: f64) -> f64 {
    let components = (0..factors[0].ncols())
        .map(|r| factors.iter().map(|f| f.col(r).norm_l2()).product::<f64>());
    components.sum::<f64>() / norm
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fit_survives_its_file() {
        let grid = Grid::default();
        let rank = 3;
        let part = |rows: usize, start: f32| -> Vec<f32> {
            (0..rows * rank).map(|i| start + i as f32).collect()
        };
        let factors = RadianceFactors {
            rank,
            scale: part(1, 0.5),
            alpha_up: part(grid.up.0.len(), 1.0),
            alpha_down: part(grid.down.0.len(), 2.0),
            phi: part(grid.phi.len(), 3.0),
            elevation: part(grid.elevation_axis().len(), 4.0),
            channel: part(60, 5.0),
        };
        let fit = Fit {
            factors,
            error: 0.25,
            condition: 8.0,
        };
        let values = fit.to_values();
        let read = Fit::from_values(&values, &grid, rank, 60).unwrap();
        assert_eq!(read.factors, fit.factors);
        assert_eq!((read.error, read.condition), (0.25, 8.0));
        assert!(Fit::from_values(&values[1..], &grid, rank, 60).is_none());
    }
}

//! From traced Q and U to factor matrices: normalise, weigh, compress, decompose together.

use super::chunk::Chunk;
use super::coupled::{Options, decompose};
use super::fit::{Fit, SHARED, assemble};
use super::normalise::{SiteEstimates, normalise};
use super::tucker::{Dense, Tucker, compress_together};
use crate::dataset::{Grid, Tensor};
use crate::successive_orders::{FIELDS, Gatherer, NW, POLARISED};
use std::f64::consts::PI;
use welkin::estimate::Estimates;

/// Channels of the polarisation: Q and U/sin φ over black ground, Q and U/sin φ of the light from the ground.
pub const POLARISED_CHANNELS: usize = POLARISED * NW;

/// Share of the energy that the compression before the decomposition may lose per mode.
const COMPRESSION: f64 = 1e-7;
/// Ground albedo at which errors are weighed against the radiance.
const ALBEDO: f32 = 0.2;
/// What an error of light from the ground counts against one of other light: typical A / (1 − A s).
const GROUND: f64 = 0.5;

/// Normalised Q and U of one (altitude, visibility), weighed and compressed.
pub struct PolarisedChunk {
    tucker: Tucker,
    /// Weights of the views and of the solar elevations.
    weights: [Vec<f64>; 2],
}

impl PolarisedChunk {
    /// From the traced tensor of altitude `a`, whose intensities are in `chunk`; only `nodes` count.
    pub fn new(
        tensor: &Tensor,
        (chunk, nodes): (&Chunk, &[usize]),
        (gatherer, estimates): (&Gatherer, &Estimates),
        grid: &Grid,
        a: usize,
    ) -> Self {
        let estimates = SiteEstimates::new(estimates, gatherer.planet(), grid, a);
        let whole = |site, _, w| estimates.diffuse(site, w);
        let values = normalise(tensor, FIELDS..FIELDS + POLARISED, whole);
        let [views, phis, elevations, _] = tensor.shape;
        let shape = [views, phis, elevations, POLARISED_CHANNELS];
        let mut values: Vec<f64> = values.into_iter().map(f64::from).collect();
        divide_by_sine(&mut values, shape);
        let weights = inverse_radiance(chunk, nodes);
        weigh(&mut values, shape, nodes, &weights);
        let mut tucker = Tucker::new(Dense { shape, values });
        tucker.compress(0, COMPRESSION);
        tucker.compress(2, COMPRESSION);
        Self { tucker, weights }
    }
}

/// Decomposes the polarisation of all chunks together. `progress` is told the sweep and the root mean square of the
/// relative errors.
pub fn polarise(
    chunks: Vec<PolarisedChunk>,
    nodes: &[usize],
    options: Options,
    progress: &dyn Fn(usize, f64),
) -> Fit {
    let (mut tuckers, weights): (Vec<_>, Vec<_>) =
        chunks.into_iter().map(|c| (c.tucker, c.weights)).unzip();
    compress_together(&mut tuckers, 1, COMPRESSION);
    compress_together(&mut tuckers, 3, COMPRESSION);
    let (bases, cores): (Vec<_>, Vec<_>) = tuckers.into_iter().map(|t| (t.bases, t.core)).unzip();
    let cpd = decompose(&cores, SHARED, options, progress);
    let mut fit = assemble(&bases, &cpd.factors, &channel_weights(nodes));
    for (own, [view, elevation]) in fit.own.iter_mut().zip(&weights) {
        divide_rows(&mut own.view, view, options.rank);
        divide_rows(&mut own.elevation, elevation, options.rank);
    }
    fit
}

fn channel_weights(nodes: &[usize]) -> [f64; POLARISED_CHANNELS] {
    std::array::from_fn(|c| match nodes.contains(&(c % NW)) {
        true if c < 2 * NW => 1.0,
        true => GROUND,
        false => 0.0,
    })
}

fn divide_rows(matrix: &mut [f32], weights: &[f64], rank: usize) {
    for (row, weight) in matrix.chunks_exact_mut(rank).zip(weights) {
        row.iter_mut()
            .for_each(|v| *v = (f64::from(*v) / weight) as f32);
    }
}

/// Whether a channel is U.
fn is_odd(channel: usize) -> bool {
    channel / NW % 2 == 1
}

/// Divides U, which is odd in the azimuth, by the azimuth's sine. Its sine series gives the limits towards the sun and
/// away from it.
fn divide_by_sine(values: &mut [f64], [_, phis, elevations, channels]: [usize; 4]) {
    let stride = elevations * channels;
    let divisor = SineDivision::new(phis);
    let mut column = vec![0.0; phis];
    for block in values.chunks_exact_mut(phis * stride) {
        for k in (0..stride).filter(|k| is_odd(k % channels)) {
            for (j, c) in column.iter_mut().enumerate() {
                *c = block[j * stride + k];
            }
            for (j, row) in divisor.0.iter().enumerate() {
                block[j * stride + k] = row.iter().zip(&column).map(|(m, c)| m * c).sum();
            }
        }
    }
}

/// A matrix from values of an odd function at azimuths 0..=π to values of its ratio to the sine.
struct SineDivision(Vec<Vec<f64>>);

impl SineDivision {
    fn new(phis: usize) -> Self {
        let n = phis - 1;
        let angle = |j: usize| PI * j as f64 / n as f64;
        // Σ_k k · b_k (±1)^(k+1), with b_k = 2/n Σ_j u_j sin(k φ_j).
        let limit = |sign: f64, j: usize| {
            let term = |k: usize| {
                let harmonic = (k as f64 * angle(j)).sin();
                k as f64 * harmonic * sign.powi(k as i32 + 1)
            };
            2.0 / n as f64 * (1..n).map(term).sum::<f64>()
        };
        let entry = |i: usize, j: usize| match i {
            _ if j == 0 || j == n => 0.0,
            0 => limit(1.0, j),
            i if i == n => limit(-1.0, j),
            i if i == j => 1.0 / angle(j).sin(),
            _ => 0.0,
        };
        let row = |i: usize| (0..phis).map(|j| entry(i, j)).collect();
        Self((0..phis).map(row).collect())
    }
}

/// Factors per view and per solar elevation that make an error count relative to the radiance: geometric means of its
/// inverse.
fn inverse_radiance(chunk: &Chunk, nodes: &[usize]) -> [Vec<f64>; 2] {
    let [views, phis, elevations] = chunk.sites;
    let mut weights = [vec![0.0; views], vec![0.0; elevations]];
    for site in 0..views * phis * elevations {
        let logarithm: f64 = nodes
            .iter()
            .map(|&w| f64::from(chunk.diffuse_share(site, w, ALBEDO)).ln())
            .sum();
        weights[0][site / (phis * elevations)] +=
            logarithm / (phis * elevations * nodes.len()) as f64;
        weights[1][site % elevations] += logarithm / (views * phis * nodes.len()) as f64;
    }
    weights.map(|w| w.into_iter().map(f64::exp).collect())
}

fn weigh(
    values: &mut [f64],
    [_, phis, elevations, channels]: [usize; 4],
    nodes: &[usize],
    [view, elevation]: &[Vec<f64>; 2],
) {
    let channel = channel_weights(nodes);
    for (site, cell) in values.chunks_exact_mut(channels).enumerate() {
        let weight = view[site / (phis * elevations)] * elevation[site % elevations];
        for (value, channel) in cell.iter_mut().zip(channel) {
            *value *= weight * channel;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_series_is_divided_exactly() {
        let phis = 19;
        let shape = [1, phis, 1, POLARISED_CHANNELS];
        let series = |phi: f64| 0.7 * phi.sin() - 0.3 * (2.0 * phi).sin() + 0.1 * (5.0 * phi).sin();
        let phi = |j: usize| PI * j as f64 / 18.0;
        let mut values = vec![0.0; phis * POLARISED_CHANNELS];
        for j in 0..phis {
            values[j * POLARISED_CHANNELS + NW] = series(phi(j));
            values[j * POLARISED_CHANNELS] = 1.0;
        }
        divide_by_sine(&mut values, shape);
        let at = |j: usize| values[j * POLARISED_CHANNELS + NW];
        for j in 1..18 {
            assert!((at(j) - series(phi(j)) / phi(j).sin()).abs() < 1e-12);
            assert_eq!(values[j * POLARISED_CHANNELS], 1.0);
        }
        assert!((at(0) - (0.7 - 0.6 + 0.5)).abs() < 1e-12);
        assert!((at(18) - (0.7 + 0.6 + 0.5)).abs() < 1e-12);
    }
}

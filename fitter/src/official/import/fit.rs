//! Fields to factors: weighed, compressed, decomposed together.

use super::fields::Fields;
use crate::decompose::{
    Basis, Dense, Fit, Options, Own, SHARED, Tucker, assemble, compress_together, decompose,
};
use rayon::prelude::*;

/// Share of the energy that the compression before the decomposition may lose per mode.
const COMPRESSION: f64 = 1e-8;

/// A tensor `[view][azimuth][sun][channel]`.
pub struct Tensor<'a> {
    /// Views, azimuths, suns.
    pub shape: [usize; 3],
    /// Its values.
    pub values: &'a [f32],
    /// Weights of views and of suns.
    pub weights: [Vec<f64>; 2],
}

impl<'a> From<&'a Fields> for Tensor<'a> {
    fn from(chunk: &'a Fields) -> Self {
        Self {
            shape: chunk.sites.shape(),
            values: &chunk.values,
            weights: row_weights(chunk),
        }
    }
}

/// Changes whenever what is fitted or how it is does.
const VERSION: u32 = 1;

/// What tells a fit of these fields from others.
pub fn key(chunks: &[Fields], options: Options) -> String {
    let mut hash = crc32fast::Hasher::new();
    for value in chunks
        .iter()
        .flat_map(|c| c.values.iter().chain(&c.radiance))
    {
        hash.update(&value.to_le_bytes());
    }
    format!("official {VERSION} {options:?} {:08x}", hash.finalize())
}

/// The inverse of [`Fit::to_values`]; `None` for another number of values.
pub fn restore(values: &[f32], chunks: &[Fields], rank: usize) -> Option<Fit> {
    let mut rest = values;
    let mut take = |rows: usize| {
        let (part, tail) = rest.split_at_checked(rows * rank)?;
        rest = tail;
        Some(part.to_vec())
    };
    let first = chunks.first()?;
    let basis = Basis {
        rank,
        phi: take(first.sites.azimuths.len())?,
        channel: take(first.width())?,
    };
    let own = chunks.iter().map(|chunk| {
        Some(Own {
            view: take(chunk.sites.views.len())?,
            elevation: take(chunk.sites.suns.len())?,
        })
    });
    let own = own.collect::<Option<Vec<_>>>()?;
    rest.is_empty().then_some(Fit { basis, own })
}

/// Decomposes tensors together, channels weighing `by_channel`. `progress` is told the sweep and the root mean square of
/// the relative errors.
pub fn decompose_all(
    tensors: &[Tensor],
    by_channel: &[f64],
    options: Options,
    progress: &dyn Fn(usize, f64),
) -> Fit {
    let weighed = |tensor: &Tensor| {
        let mut tucker = Tucker::new(weighed(tensor, by_channel));
        tucker.compress(0, COMPRESSION);
        tucker.compress(2, COMPRESSION);
        tucker
    };
    let mut tuckers: Vec<Tucker> = tensors.par_iter().map(weighed).collect();
    compress_together(&mut tuckers, 1, COMPRESSION);
    compress_together(&mut tuckers, 3, COMPRESSION);
    let (bases, cores): (Vec<_>, Vec<_>) = tuckers.into_iter().map(|t| (t.bases, t.core)).unzip();
    let cpd = decompose(&cores, SHARED, options, progress);
    let mut fit = assemble(&bases, &cpd.factors, by_channel);
    for (own, tensor) in fit.own.iter_mut().zip(tensors) {
        let [view, sun] = &tensor.weights;
        divide_rows(&mut own.view, view, options.rank);
        divide_rows(&mut own.elevation, sun, options.rank);
    }
    fit
}

fn divide_rows(matrix: &mut [f32], weights: &[f64], rank: usize) {
    for (row, weight) in matrix.chunks_exact_mut(rank).zip(weights) {
        row.iter_mut()
            .for_each(|v| *v = (f64::from(*v) / weight) as f32);
    }
}

/// Per view and per sun: geometric means of the inverse radiance, so that errors count relative to it.
pub fn row_weights(chunk: &Fields) -> [Vec<f64>; 2] {
    let [views, azimuths, suns] = chunk.sites.shape();
    let mut mean = [vec![0.0; views], vec![0.0; suns]];
    for site in 0..views * azimuths * suns {
        let inverse = -chunk.brightness(site).max(1e-3).ln();
        mean[0][site / (azimuths * suns)] += inverse / (azimuths * suns) as f64;
        mean[1][site % suns] += inverse / (views * azimuths) as f64;
    }
    mean.map(|m| m.into_iter().map(f64::exp).collect())
}

/// Root mean square share of every channel in the radiance.
pub fn channel_weights(chunks: &[Fields]) -> Vec<f64> {
    let Some(first) = chunks.first() else {
        return vec![];
    };
    let (width, channels) = (first.width(), first.channels);
    let one = |chunk: &Fields| {
        let sites = chunk.sites.shape().iter().product::<usize>();
        let middle = chunk.albedos / 2;
        let mut sums = vec![0.0; width];
        let mut share = vec![0.0; chunk.fields];
        for site in 0..sites {
            for c in 0..channels {
                let radiance = chunk.radiance(site, middle, c);
                if radiance <= 1e-3 {
                    continue;
                }
                chunk.shares(site, middle, c, &mut share);
                for (f, share) in share.iter().enumerate() {
                    let value = chunk.values[site * width + f * channels + c];
                    sums[f * channels + c] +=
                        f64::from(share * value / radiance).powi(2) / sites as f64;
                }
            }
        }
        sums
    };
    let parts: Vec<Vec<f64>> = chunks.par_iter().map(one).collect();
    let mean = |c: usize| parts.iter().map(|p| p[c]).sum::<f64>() / parts.len() as f64;
    (0..width).map(|c| mean(c).sqrt().max(1e-3)).collect()
}

fn weighed(tensor: &Tensor, by_channel: &[f64]) -> Dense {
    let [views, azimuths, suns] = tensor.shape;
    let [view, sun] = &tensor.weights;
    let cells = tensor.values.chunks_exact(by_channel.len()).enumerate();
    let values = cells.flat_map(|(site, cell)| {
        let weight = view[site / (azimuths * suns)] * sun[site % suns];
        let pairs = cell.iter().zip(by_channel);
        pairs.map(move |(v, c)| f64::from(*v) * weight * c)
    });
    Dense {
        shape: [views, azimuths, suns, by_channel.len()],
        values: values.collect(),
    }
}

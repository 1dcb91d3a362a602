//! From chunks to the factor matrices of the file: compress, decompose together, refine, turn node values into splines.

use super::chunk::Chunk;
use super::collocation::Collocation;
use super::coupled::{Factors, Options, decompose};
use super::refine::{self, Basis, Own, Pass};
use super::row_major::row_major;
use super::tucker::{Dense, Tucker, principal_basis};
use super::weights::channel_weights;
use crate::dataset::{Axis, Grid};
use faer::Mat;
use rayon::prelude::*;

/// Share of the energy that the compression before the decomposition may lose per mode.
const COMPRESSION: f64 = 1e-7;
/// Azimuth and channel are shared, view direction and solar elevation belong to a chunk.
pub const SHARED: [bool; 4] = [false, true, false, true];

/// Factor matrices of all chunks at the sites of their axes.
#[derive(Clone)]
pub struct Fit {
    /// Shared by all chunks.
    pub basis: Basis,
    /// One per chunk.
    pub own: Vec<Own>,
}

/// Decomposes all chunks together; nodes that are not among `nodes` count as dark. `progress` is told the sweep and the root mean square of the relative errors.
pub fn decompose_all(
    chunks: &[Chunk],
    nodes: &[usize],
    options: Options,
    progress: &dyn Fn(usize, f64),
) -> Fit {
    let weights = channel_weights(chunks, nodes);
    decompose_weighted(chunks, &weights, COMPRESSION, options, progress)
}

/// Decomposes in tiers: each tier fits what the tiers before it, which stay as they are, leave. Its first components
/// are a model of their own.
pub fn decompose_nested(
    chunks: &[Chunk],
    nodes: &[usize],
    tiers: &[usize],
    options: Options,
) -> Fit {
    let weights = channel_weights(chunks, nodes);
    let first = Options {
        rank: tiers[0],
        ..options
    };
    let mut fit = decompose_weighted(chunks, &weights, COMPRESSION, first, &|_, _| ());
    for &rank in &tiers[1..] {
        let pairs = chunks.par_iter().zip(&fit.own);
        let rest = pairs.map(|(chunk, own)| refine::residual(chunk, own, &fit.basis));
        let rest: Vec<Chunk> = rest.collect();
        // As much may be lost as in the first tier.
        let tolerance = COMPRESSION * energy(chunks) / energy(&rest).max(1e-300);
        let tier = Options { rank, ..options };
        let next = decompose_weighted(&rest, &weights, tolerance.min(1e-2), tier, &|_, _| ());
        fit = fit.join(&next);
    }
    fit
}

fn energy(chunks: &[Chunk]) -> f64 {
    let values = chunks.iter().flat_map(|c| c.values());
    values.map(|v| f64::from(*v).powi(2)).sum()
}

fn decompose_weighted(
    chunks: &[Chunk],
    weights: &[f64],
    tolerance: f64,
    options: Options,
    progress: &dyn Fn(usize, f64),
) -> Fit {
    let (bases, cores): (Vec<_>, Vec<_>) = compress(chunks, weights, tolerance)
        .into_iter()
        .map(|t| (t.bases, t.core))
        .unzip();
    let cpd = decompose(&cores, SHARED, options, progress);
    assemble(&bases, &cpd.factors, weights)
}

/// Refines the fit of some nodes in relative radiance by `sweeps` passes.
pub fn refine_all(
    chunks: &[Chunk],
    nodes: &[usize],
    fit: &mut Fit,
    sweeps: usize,
    progress: &dyn Fn(usize),
) {
    for sweep in 0..sweeps {
        let pass = Pass::new(sweep, sweeps);
        refine::sweep(chunks, nodes, &mut fit.own, &mut fit.basis, pass);
        progress(sweep + 1);
    }
}

/// The shared modes first, from all chunks one by one, so that no more than small cores are held at a time.
fn compress(chunks: &[Chunk], weights: &[f64], tolerance: f64) -> Vec<Tucker> {
    let shared = |mode: usize| {
        let grams = chunks
            .par_iter()
            .map(|c| weighted(c, weights).relative_gram(mode));
        grams
            .reduce_with(|a, b| a + b)
            .map(|sum| principal_basis(&sum, tolerance))
    };
    let (phi, channel) = (shared(1), shared(3));
    let one = |chunk: &Chunk| {
        let mut tucker = Tucker::new(weighted(chunk, weights));
        for (mode, basis) in [(3, &channel), (1, &phi)] {
            if let Some(basis) = basis {
                tucker.project(mode, basis);
            }
        }
        tucker.compress(0, tolerance);
        tucker.compress(2, tolerance);
        tucker
    };
    chunks.par_iter().map(one).collect()
}

/// The fields of a chunk, each channel times its weight.
fn weighted(chunk: &Chunk, weights: &[f64]) -> Dense {
    let cells = chunk.values().chunks_exact(weights.len());
    let values = cells.flat_map(|cell| {
        let pairs = cell.iter().zip(weights);
        pairs.map(|(v, w)| f64::from(*v) * w)
    });
    let [views, phis, elevations] = chunk.sites;
    Dense {
        shape: [views, phis, elevations, weights.len()],
        values: values.collect(),
    }
}

pub(crate) fn assemble(bases: &[[Mat<f64>; 4]], factors: &Factors, weights: &[f64]) -> Fit {
    let product = |k: usize, m: usize| &bases[k][m] * &factors.0[k][m];
    let mut channel = product(0, 3);
    for (c, weight) in weights.iter().enumerate() {
        for r in 0..channel.ncols() {
            channel[(c, r)] = if *weight > 0.0 {
                channel[(c, r)] / weight
            } else {
                0.0
            };
        }
    }
    Fit {
        basis: Basis {
            rank: channel.ncols(),
            phi: row_major(&product(0, 1)),
            channel: row_major(&channel),
        },
        own: (0..bases.len())
            .map(|k| Own {
                view: row_major(&product(k, 0)),
                elevation: row_major(&product(k, 2)),
            })
            .collect(),
    }
}

impl Fit {
    /// All numbers in a row, for a file.
    pub fn to_values(&self) -> Vec<f32> {
        let own = self.own.iter().flat_map(|o| [&o.view, &o.elevation]);
        let all = [&self.basis.phi, &self.basis.channel]
            .into_iter()
            .chain(own);
        all.flatten().copied().collect()
    }

    /// The inverse of [`Fit::to_values`] for a grid, a rank and numbers of chunks and channels; `None` for another
    /// number of values.
    pub fn from_values(
        values: &[f32],
        grid: &Grid,
        rank: usize,
        chunks: usize,
        channels: usize,
    ) -> Option<Self> {
        let mut rest = values;
        let mut take = |rows: usize| {
            let (part, tail) = rest.split_at_checked(rows * rank)?;
            rest = tail;
            Some(part.to_vec())
        };
        let basis = Basis {
            rank,
            phi: take(grid.phi.len())?,
            channel: take(channels)?,
        };
        let views = grid.up.0.len() + grid.down.0.len();
        let own = (0..chunks).map(|_| {
            Some(Own {
                view: take(views)?,
                elevation: take(grid.elevation_axis().len())?,
            })
        });
        let own = own.collect::<Option<Vec<_>>>()?;
        rest.is_empty().then_some(Self { basis, own })
    }

    /// The components of both.
    pub fn join(&self, other: &Self) -> Self {
        let ranks = [self.basis.rank, other.basis.rank];
        let beside = |a: &[f32], b: &[f32]| {
            let rows = a.chunks_exact(ranks[0]).zip(b.chunks_exact(ranks[1]));
            rows.flat_map(|(a, b)| [a, b].concat()).collect()
        };
        let own = |(a, b): (&Own, &Own)| Own {
            view: beside(&a.view, &b.view),
            elevation: beside(&a.elevation, &b.elevation),
        };
        Self {
            basis: Basis {
                rank: ranks[0] + ranks[1],
                phi: beside(&self.basis.phi, &other.basis.phi),
                channel: beside(&self.basis.channel, &other.basis.channel),
            },
            own: self.own.iter().zip(&other.own).map(own).collect(),
        }
    }

    /// Sum of the norms of a chunk's components over the norm of their sum, which is that of the chunk: large when
    /// components cancel.
    pub fn condition(&self, chunk: &Chunk, k: usize) -> f64 {
        let rank = self.basis.rank;
        let norm = |matrix: &[f32], r: usize| -> f64 {
            let column = matrix.iter().skip(r).step_by(rank);
            column.map(|v| f64::from(*v).powi(2)).sum::<f64>().sqrt()
        };
        let own = &self.own[k];
        let parts = [
            &own.view,
            &own.elevation,
            &self.basis.phi,
            &self.basis.channel,
        ];
        let components = (0..rank).map(|r| parts.iter().map(|m| norm(m, r)).product::<f64>());
        let square: f64 = chunk.values().iter().map(|v| f64::from(*v).powi(2)).sum();
        components.sum::<f64>() / square.sqrt()
    }
}

/// Spline coefficients `[coefficient][rank]` for node values `[site][rank]`.
pub fn splines(axis: Axis, sites: &[f32], rank: usize) -> Mat<f64> {
    let values = Mat::from_fn(axis.len(), rank, |i, r| f64::from(sites[i * rank + r]));
    Collocation::new(axis).solve(&values)
}

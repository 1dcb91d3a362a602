//! The polarisation of a model: from work units to chunks of the file.

use crate::dataset::Store;
use crate::decompose::{
    self, Chunk, Fit, Options, POLARISED_CHANNELS, PolarisedChunk, polarise as decompose_all,
};
use crate::fitting::unit_name;
use crate::pack::PackedBasis;
use crate::progress::stage;
use crate::units::{Plan, Solved};
use anyhow::{Context, Result};
use rayon::prelude::*;
use welkin::estimate::Estimates;
use welkin::format::{self, Payload};

/// Altitude and visibility of a chunk.
pub type Place = (usize, usize);

/// Fits the polarisation of all chunks, which stand at `places`, together, at some nodes.
pub fn fit(
    plan: &Plan,
    (nodes, options): (&[usize], Options),
    store: &Store,
    (solved, estimates): (&[Solved], &[Estimates]),
    chunks: &[Chunk],
    places: &[Place],
) -> Result<Fit> {
    let name = unit_name("polarisation", &plan.grid, nodes, options, 0);
    let values = store.unit(&name, || {
        let compressed = compress_all(plan, store, (solved, estimates), (chunks, nodes), places)?;
        let progress = stage(options.sweeps, "decomposing polarisation");
        let tell = |sweep: usize, rms: f64| {
            progress.set_position(sweep as u64 + 1);
            progress.set_message(format!("polarisation, rms {:.3} %", 100.0 * rms));
        };
        let fit = decompose_all(compressed, nodes, options, &tell);
        progress.finish();
        Ok(fit.to_values())
    })?;
    let channels = POLARISED_CHANNELS;
    let fit = Fit::from_values(&values, &plan.grid, options.rank, chunks.len(), channels);
    fit.context("a fit of another size")
}

fn compress_all(
    plan: &Plan,
    store: &Store,
    (solved, estimates): (&[Solved], &[Estimates]),
    (chunks, nodes): (&[Chunk], &[usize]),
    places: &[Place],
) -> Result<Vec<PolarisedChunk>> {
    let progress = stage(chunks.len(), "compressing polarisation");
    let compress = |(chunk, &(a, v)): (&Chunk, &Place)| {
        let tensor = plan.tensor(store, &solved[v], a)?;
        let gatherer = solved[v].gatherer();
        progress.inc(1);
        Ok(PolarisedChunk::new(
            &tensor,
            (chunk, nodes),
            (&gatherer, &estimates[v]),
            &plan.grid,
            a,
        ))
    };
    let out = chunks.par_iter().zip(places).map(compress).collect();
    progress.finish();
    out
}

/// The basis, then the chunk of every place.
pub fn file_chunks(plan: &Plan, fit: &decompose::Fit, places: &[Place]) -> Vec<format::Chunk> {
    let basis = PackedBasis::new(&plan.grid, &fit.basis);
    let shared = Payload::PolarisationBasis(basis.polarisation());
    let own = fit.own.iter().zip(places).map(|(own, &(a, v))| {
        let factors = basis.polarisation_chunk(&plan.grid, own);
        format::Chunk::new(Some(a), Some(v), Payload::Polarisation(factors))
    });
    [format::Chunk::new(None, None, shared)]
        .into_iter()
        .chain(own)
        .collect()
}

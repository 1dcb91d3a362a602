//! What the model file needs for finite distances: densities of the air and the source function of multiply scattered
//! light.

pub mod density;
mod modes;
pub mod source_tensor;
pub mod study;
mod weighted;

use crate::units::Solved;
use anyhow::Result;
use welkin::format::{Chunk, Payload, Ranks};

/// Components of the source along the modes altitude, sun, moment, channel.
pub const RANKS: Ranks = [12, 20, 16, 16];

/// The chunks for finite distances; `solved` has one entry per visibility of the model.
pub fn chunks(solved: &[Solved]) -> Result<Vec<Chunk>> {
    let airs: Vec<_> = solved.iter().map(|s| s.medium.atmosphere.clone()).collect();
    let densities = density::fit(&airs, density::TOLERANCE)?;
    let (basis, cores) = source_tensor::fit(solved, RANKS);
    let chunk = |visibility, payload| Chunk::new(None, visibility, payload);
    let shared = [
        Payload::Transmittance(densities),
        Payload::SourceBasis(basis),
    ];
    let cores = cores.into_iter().map(Payload::Source).enumerate();
    Ok(shared
        .map(|payload| chunk(None, payload))
        .into_iter()
        .chain(cores.map(|(v, payload)| chunk(Some(v), payload)))
        .collect())
}

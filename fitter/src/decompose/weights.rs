//! How much an error of each channel matters: its typical share of the radiance.

use super::chunk::Chunk;
use crate::successive_orders::{FIELDS, NW};
use rayon::prelude::*;

/// Ground albedo at which the shares are taken.
const ALBEDO: f32 = 0.4;

/// Root mean square share of each channel in the radiance over all sites of all chunks; 0 for those of nodes that are not
/// among `nodes`.
pub fn channel_weights(chunks: &[Chunk], nodes: &[usize]) -> Vec<f64> {
    let one = |chunk: &Chunk| {
        let sites = chunk.sites.iter().product::<usize>();
        let mut sums = vec![0.0; FIELDS * NW];
        for site in 0..sites {
            for w in 0..NW {
                let (_, share) = chunk.radiance_equation(site, w, ALBEDO);
                for (f, share) in share.iter().enumerate() {
                    sums[f * NW + w] +=
                        f64::from(share * chunk.value(site, f, w)).powi(2) / sites as f64;
                }
            }
        }
        sums
    };
    // In one order, whatever the number of threads.
    let parts: Vec<Vec<f64>> = chunks.par_iter().map(one).collect();
    let mean = |c: usize| parts.iter().map(|part| part[c]).sum::<f64>() / chunks.len() as f64;
    let weight = |c: usize| match nodes.contains(&(c % NW)) {
        true => mean(c).sqrt().max(1e-3),
        false => 0.0,
    };
    (0..FIELDS * NW).map(weight).collect()
}

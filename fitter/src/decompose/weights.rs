//! How much an error of each channel matters: its typical share of the radiance.

use crate::dataset::{Grid, Tensor};
use crate::orders::source::Sun;
use crate::orders::{Gatherer, NW, gather, rayleigh_phase};

/// Ground albedo at which the shares are taken.
const ALBEDO: f32 = 0.4;

/// Root mean square share of each channel in the radiance over all sites of altitude `a`.
pub fn channel_weights(tensor: &Tensor, gatherer: &Gatherer, grid: &Grid, a: usize) -> Vec<f64> {
    let [_, phis, elevations, channels] = tensor.shape;
    let views = grid.view_sites(gatherer.planet(), a);
    let (phi, elevation) = (grid.phi_sites(), grid.elevation_sites());
    let mut sums = vec![0.0; channels];
    for (i, cell) in tensor.values.chunks_exact(channels).enumerate() {
        let (e, p, v) = (
            i % elevations,
            i / elevations % phis,
            i / (elevations * phis),
        );
        let sun = Sun {
            elevation: (elevation[e].cos(), elevation[e].sin()),
            azimuth: (phi[p].cos(), phi[p].sin()),
        };
        let cosine = gather::scattering_cosine(views[v].1.sin(), &sun);
        let factors = [
            rayleigh_phase(gatherer.polarising(), cosine),
            gatherer.phase(0, cosine),
            gatherer.phase(1, cosine),
            [1.0; NW],
            [ALBEDO; NW],
        ];
        for w in 0..NW {
            let part = |f: usize| f64::from(cell[f * NW + w] * factors[f][w]);
            let total: f64 = (0..factors.len()).map(part).sum();
            for f in 0..factors.len() {
                sums[f * NW + w] += (part(f) / total.max(1e-30)).powi(2);
            }
        }
    }
    let cells = (tensor.values.len() / channels) as f64;
    sums.into_iter()
        .map(|s| (s / cells).sqrt().max(1e-3))
        .collect()
}

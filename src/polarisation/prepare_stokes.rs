//! From chunks to the polarisation of one sky. All chunks share their basis, so they are summed before it is applied.

use super::stokes_tables::{Pair, Polarisation};
use crate::azimuth_fade::fade_rows;
use crate::error::{Error, Result};
use crate::format::BasisView;
use crate::kernel::axis::{Ends, spline};
use crate::kernel::half::widen;
use crate::kernel::math::LANES;
use crate::model::{Model, Nodes};
use crate::sky::prepare::{NodeWeights, OwnFactors, widen_rows};
use crate::sky::tables::Layout;

/// Prepares the polarisation at `place` over a ground of these albedos at the nodes. `layout` is that of the radiance.
pub(super) fn prepare(
    model: &Model,
    nodes: Nodes,
    place: &NodeWeights,
    albedos: &[f64],
    layout: &Layout,
) -> Result<Polarisation> {
    let head = nodes.head;
    let basis = model.polarisation_basis()?;
    let shape = head.shape();
    let mut alpha = [shape.up, shape.down].map(|n| vec![0.0; n * basis.rank]);
    let elevation = spline(place.elevation, head.elevation.intervals, Ends::Free);
    for (a, altitude_weight) in place.altitudes.taps() {
        for (v, visibility_weight) in place.visibilities.taps() {
            let chunk = model.polarisation_chunk(a, v)?;
            if chunk.rank > basis.rank {
                let detail = format!("at most {} as the basis, got {}", basis.rank, chunk.rank);
                return Err(Error::invalid("rank of a polarisation chunk", detail));
            }
            let own = OwnFactors {
                rank: chunk.rank,
                stride: chunk.stride,
                scale: chunk.scale,
                elevation: chunk.elevation,
                alpha: [chunk.alpha_up, chunk.alpha_down],
            };
            let weight = (altitude_weight * visibility_weight) as f32;
            own.add_to(&mut alpha, basis.rank, &elevation, weight);
        }
    }
    let ground = place.ground(head, albedos);
    let applied = Basis::new(&basis, nodes, &ground, place.fade, layout);
    let [up, down] = alpha.map(|alpha| applied.apply(&alpha));
    let polarisation = Polarisation { up, down };
    let mut pairs = polarisation.up.iter().chain(&polarisation.down);
    if pairs.all(Pair::is_finite) {
        return Ok(polarisation);
    }
    let detail = "its polarisation overflows at these conditions: the file is not a sensible sky";
    Err(Error::invalid("model", detail))
}

/// The shared factors with the albedo applied.
struct Basis<'a> {
    rank: usize,
    layout: &'a Layout,
    /// `[phi][rank]`.
    phi: Vec<f32>,
    /// `[block][rank]`.
    channel: Vec<Pair>,
}

impl<'a> Basis<'a> {
    /// `ground` is what the light from the ground is multiplied with at each wavelength, `fade` what the azimuth
    /// counts.
    fn new(view: &BasisView, nodes: Nodes, ground: &[f32], fade: f64, layout: &'a Layout) -> Self {
        let rank = view.rank;
        let mut channel = vec![Pair::ZERO; layout.blocks() * rank];
        for r in 0..rank {
            let row = &view.channel[r * view.channel_stride..][..view.channel_stride];
            for (w, ground) in ground.iter().enumerate() {
                let pair = &mut channel[w / LANES * rank + r].0;
                let value = |part: usize| widen(row[nodes.channel(part, w)]);
                let sum = |part: usize| value(part) + ground * value(part + 2);
                pair[w % LANES] = sum(0);
                // U is odd in the azimuth: nothing of it stays under a vertical sun.
                pair[LANES + w % LANES] = fade as f32 * sum(1);
            }
        }
        let mut phi = widen_rows(view.phi, view.stride, rank);
        fade_rows(&mut phi, rank, fade);
        Self {
            rank,
            layout,
            phi,
            channel,
        }
    }

    /// The cells of one side from the components at its rows.
    fn apply(&self, alpha: &[f32]) -> Vec<Pair> {
        let cells = self.layout.cells();
        let nodes = alpha.len() / self.rank * self.phi.len() / self.rank;
        let mut out = vec![Pair::ZERO; nodes * cells];
        let mut factors = vec![0.0; self.rank];
        let mut nodes = out.chunks_exact_mut(cells);
        for alpha in alpha.chunks_exact(self.rank) {
            for (phi, node) in self.phi.chunks_exact(self.rank).zip(&mut nodes) {
                for (factor, (a, p)) in factors.iter_mut().zip(alpha.iter().zip(phi)) {
                    *factor = a * p;
                }
                for (block, channel) in self.channel.chunks_exact(self.rank).enumerate() {
                    let mut sum = Pair::ZERO;
                    for (&factor, values) in factors.iter().zip(channel) {
                        sum.add(factor, values);
                    }
                    node[self.layout.cell(block)] = sum;
                }
            }
        }
        out
    }
}

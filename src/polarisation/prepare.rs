//! From chunks to the polarisation of one sky. All chunks share their basis, so they are summed before it is applied.

use super::table::{Pair, Polarisation};
use crate::axis::{Ends, spline};
use crate::error::{Error, Result};
use crate::format::{Payload16, PolarisationBasisView, PolarisationView, widen};
use crate::math::LANES;
use crate::model::Model;
use crate::prepare::Place;
use crate::tables::Layout;

/// Prepares the polarisation at `place` over a ground of the given albedo. `layout` is that of the radiance.
pub(super) fn prepare(
    model: &Model,
    place: &Place,
    albedo: f64,
    layout: &Layout,
) -> Result<Polarisation> {
    let head = model.head();
    let basis = model.polarisation_basis()?;
    let shape = head.shape();
    let mut up = vec![0.0; shape.up * basis.rank];
    let mut down = vec![0.0; shape.down * basis.rank];
    let taps = spline(place.elevation, head.elevation.intervals, Ends::Free);
    for (a, altitude_weight) in place.altitudes.taps() {
        for (v, visibility_weight) in place.visibilities.taps() {
            let chunk = model.polarisation_chunk(a, v)?;
            if chunk.rank != basis.rank {
                let detail = format!("expected {} of the basis, got {}", basis.rank, chunk.rank);
                return Err(Error::invalid("rank of a polarisation chunk", detail));
            }
            let weight = (altitude_weight * visibility_weight) as f32;
            let factors: Vec<f32> = (0..chunk.rank)
                .map(|r| weight * chunk.scale[r].get() * elevation(&chunk, &taps, r))
                .collect();
            add(&mut up, chunk.alpha_up, chunk.stride, &factors);
            add(&mut down, chunk.alpha_down, chunk.stride, &factors);
        }
    }
    let applied = Basis::new(&basis, &place.ground(head, albedo), layout);
    let polarisation = Polarisation {
        up: applied.apply(&up),
        down: applied.apply(&down),
    };
    let mut pairs = polarisation.up.iter().chain(&polarisation.down);
    if pairs.all(Pair::is_finite) {
        return Ok(polarisation);
    }
    let detail = "its polarisation overflows at these conditions: the file is not a sensible sky";
    Err(Error::invalid("model", detail))
}

/// Value of a component at the solar elevation of the sky.
fn elevation(chunk: &PolarisationView, taps: &crate::axis::Taps, r: usize) -> f32 {
    let terms = taps.index.iter().zip(taps.weight);
    terms
        .map(|(&i, w)| w * widen(chunk.elevation[i * chunk.stride + r]))
        .sum()
}

/// Adds the rows of a factor matrix, each component times its factor.
fn add(sum: &mut [f32], matrix: &Payload16, stride: usize, factors: &[f32]) {
    let rows = sum.chunks_exact_mut(factors.len());
    for (row, values) in rows.zip(matrix.chunks_exact(stride)) {
        for (sum, (&value, factor)) in row.iter_mut().zip(values.iter().zip(factors)) {
            *sum += factor * widen(value);
        }
    }
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
    /// `ground` is what the light from the ground is multiplied with at each wavelength.
    fn new(view: &PolarisationBasisView, ground: &[f32], layout: &'a Layout) -> Self {
        let (rank, nw) = (view.rank, ground.len());
        let mut channel = vec![Pair::ZERO; layout.blocks() * rank];
        for r in 0..rank {
            let row = &view.channel[r * view.channel_stride..][..view.channel_stride];
            for (w, ground) in ground.iter().enumerate() {
                let pair = &mut channel[w / LANES * rank + r].0;
                let sum = |part: usize| {
                    widen(row[part * nw + w]) + ground * widen(row[(part + 2) * nw + w])
                };
                pair[w % LANES] = sum(0);
                pair[LANES + w % LANES] = sum(1);
            }
        }
        let rows = view.phi.chunks_exact(view.stride);
        let phi = rows.flat_map(|row| row[..rank].iter().map(|&h| widen(h)));
        Self {
            rank,
            layout,
            phi: phi.collect(),
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

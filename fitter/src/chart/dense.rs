//! The traced tensor itself, as a spline in every mode: the floor that no factorisation gets below.

use super::chunk_axes::{Frame, Look, cosine};
use crate::dataset::Axis;
use crate::decompose::{Chunk, Collocation};
use crate::successive_orders::{FIELDS, NW};
use faer::Mat;
use welkin::axis::Taps;

const CHANNELS: usize = FIELDS * NW;

/// Spline coefficients of all fields of a chunk.
pub struct Uncompressed {
    sites: [usize; 3],
    /// `[view][phi][elevation][channel]`.
    coefficients: Vec<f32>,
}

impl Uncompressed {
    /// Interpolates the sites of `chunk`.
    pub fn new(chunk: &Chunk, frame: &Frame) -> Self {
        let [up, down, phi, elevation] = frame.axes();
        let [_, phis, elevations] = chunk.sites;
        let mut values = chunk.values().to_vec();
        let (above, below) = values.split_at_mut(up.len() * phis * elevations * CHANNELS);
        along(above, up, phis * elevations * CHANNELS);
        along(below, down, phis * elevations * CHANNELS);
        along(&mut values, phi, elevations * CHANNELS);
        along(&mut values, elevation, CHANNELS);
        Self {
            sites: chunk.sites,
            coefficients: values,
        }
    }

    /// The fields under one sun.
    pub fn under(&self, elevation: &Taps) -> Slice {
        let [views, phis, elevations] = self.sites;
        let mut fields = vec![0.0; views * phis * CHANNELS];
        for (cell, out) in fields.chunks_exact_mut(CHANNELS).enumerate() {
            for (&e, &weight) in elevation.index.iter().zip(&elevation.weight) {
                let from = (cell * elevations + e) * CHANNELS;
                let row = &self.coefficients[from..][..CHANNELS];
                out.iter_mut().zip(row).for_each(|(o, v)| *o += weight * v);
            }
        }
        Slice { phis, fields }
    }
}

/// Replaces values at the sites of a mode, `inner` apart, by spline coefficients.
fn along(values: &mut [f32], axis: Axis, inner: usize) {
    let collocation = Collocation::new(axis);
    for block in values.chunks_exact_mut(axis.len() * inner) {
        let matrix = Mat::from_fn(axis.len(), inner, |i, j| f64::from(block[i * inner + j]));
        let solved = collocation.solve(&matrix);
        for (k, value) in block.iter_mut().enumerate() {
            *value = solved[(k / inner, k % inner)] as f32;
        }
    }
}

/// Fields of one sun over the sphere.
pub struct Slice {
    phis: usize,
    /// `[view][phi][channel]`.
    fields: Vec<f32>,
}

impl Slice {
    /// Relative radiance over a black ground and what a white ground adds, before interreflection.
    pub fn radiance(&self, chunk: &Chunk, frame: &Frame, look: &Look) -> [[f64; NW]; 2] {
        let place = frame.place(look);
        let mut sums = [0.0f32; CHANNELS];
        for (&v, &a) in place.view.index.iter().zip(&place.view.weight) {
            for (&p, &b) in place.phi.index.iter().zip(&place.phi.weight) {
                let row = &self.fields[(v * self.phis + p) * CHANNELS..][..CHANNELS];
                sums.iter_mut().zip(row).for_each(|(s, x)| *s += a * b * x);
            }
        }
        let scale = frame.scale(look);
        let share = chunk.phase_functions(cosine(look));
        let field =
            |f: usize, w: usize| f64::from(share[f][w] * sums[f * NW + w]) * f64::from(scale[f][w]);
        let black = |w| (0..FIELDS - 1).map(|f| field(f, w)).sum();
        [
            std::array::from_fn(black),
            std::array::from_fn(|w| field(FIELDS - 1, w)),
        ]
    }
}

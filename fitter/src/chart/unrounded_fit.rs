//! A fit as it is before its factors are rounded to half precision.

use super::chunk_axes::{Frame, Look, cosine};
use super::cost::Components;
use crate::decompose::{Basis, Chunk, Own, row_major, splines};
use crate::successive_orders::{FIELDS, NW};

/// The factors of a chunk in single precision.
pub struct Single<'a> {
    chunk: &'a Chunk,
    frame: &'a Frame,
    components: Components,
}

impl<'a> Single<'a> {
    /// Splines through the factors of `own` and `basis`.
    pub fn new(chunk: &'a Chunk, frame: &'a Frame, own: &Own, basis: &Basis) -> Self {
        let rank = basis.rank;
        let [up, down, phi, elevation] = frame.axes();
        let coefficients = |axis, sites: &[f32]| row_major(&splines(axis, sites, rank));
        let (above, below) = own.view.split_at(up.len() * rank);
        let components = Components {
            rank,
            modes: [
                [coefficients(up, above), coefficients(down, below)].concat(),
                coefficients(phi, &basis.phi),
                coefficients(elevation, &own.elevation),
            ],
            channel: basis.channel.clone(),
        };
        Self {
            chunk,
            frame,
            components,
        }
    }

    /// Relative radiance at every wavelength over a ground of this albedo.
    pub fn radiance(&self, look: &Look, albedo: f32) -> [f32; NW] {
        let place = self.frame.place(look);
        let mut share = self.chunk.phase_functions(cosine(look));
        for (w, ground) in share[FIELDS - 1].iter_mut().enumerate() {
            *ground *= self.chunk.interreflection(w, albedo);
        }
        let scale = self.frame.scale(look);
        for (share, scale) in share.iter_mut().zip(scale) {
            share.iter_mut().zip(scale).for_each(|(s, n)| *s *= n);
        }
        self.components.radiance(&place, &share)
    }
}

//! What the evaluator multiplies back: the estimates along the view rays.

use crate::dataset::{Grid, Tensor};
use crate::estimate::{ESTIMATES, OF_FIELD};
use crate::successive_orders::{FIELDS, NW};
use half::f16;
use rayon::prelude::*;
use std::ops::Range;
use welkin::estimate::{Estimates, Sightline};
use welkin::geometry::Planet;

/// The estimates at the sites of a chunk, `[view][phi][elevation][estimate][wavelength]`.
pub struct SiteEstimates(Vec<f32>);

/// The same relative to the level of the sky; in half precision, as they are many and only weigh.
#[derive(Clone)]
pub struct RelativeEstimates(Vec<f16>);

/// Numbers per site.
const WIDTH: usize = ESTIMATES * NW;
/// Smaller ones count as this: nothing is seen there.
const LEAST: f32 = 1e-30;
/// What half precision holds.
const FAINTEST: f32 = 1e-7;
const BRIGHTEST: f32 = 6e4;

impl SiteEstimates {
    /// At altitude `a` of the grid.
    pub fn new(estimates: &Estimates, planet: Planet, grid: &Grid, a: usize) -> Self {
        let altitude = grid.traced_altitude(a);
        let (phis, elevations) = (grid.phi_sites(), grid.elevation_sites());
        let view = |(side, view): (_, f64)| {
            let mut out = vec![0.0; phis.len() * elevations.len() * WIDTH];
            let mut cells = out.chunks_exact_mut(WIDTH);
            for phi in &phis {
                for (elevation, cell) in elevations.iter().zip(&mut cells) {
                    let line = Sightline {
                        altitude,
                        ray: view.sin_cos().into(),
                        side,
                        sun: elevation.sin_cos().into(),
                        azimuth: phi.cos(),
                    };
                    estimates.along(&line, cell);
                }
            }
            out
        };
        let views = grid.view_sites(planet, a);
        let rows = views.into_par_iter().flat_map_iter(view);
        Self(rows.map(|n| n.max(LEAST)).collect())
    }

    /// What a field is relative to.
    pub fn of_field(&self, site: usize, field: usize, wavelength: usize) -> f32 {
        self.0[site * WIDTH + OF_FIELD[field] * NW + wavelength]
    }

    /// What multiply scattered Q and U are relative to.
    pub fn diffuse(&self, site: usize, wavelength: usize) -> f32 {
        self.0[site * WIDTH + (ESTIMATES - 1) * NW + wavelength]
    }

    /// Relative to `levels`, `[elevation][wavelength]`.
    pub fn relative(&self, levels: &[f32]) -> RelativeEstimates {
        let elevations = levels.len() / NW;
        let cells = self.0.chunks_exact(WIDTH).enumerate();
        let relative = cells.flat_map(|(site, cell)| {
            let level = &levels[site % elevations * NW..][..NW];
            let pairs = cell.iter().zip(level.iter().cycle());
            pairs.map(|(n, l)| f16::from_f32((n / l).clamp(FAINTEST, BRIGHTEST)))
        });
        RelativeEstimates(relative.collect())
    }
}

impl RelativeEstimates {
    /// Of sites at which everything is relative to 1.
    #[cfg(test)]
    pub fn ones(sites: usize) -> Self {
        Self(vec![f16::ONE; sites * WIDTH])
    }

    /// What a field is relative to.
    #[inline]
    pub fn of_field(&self, site: usize, field: usize, wavelength: usize) -> f32 {
        self.0[site * WIDTH + OF_FIELD[field] * NW + wavelength].to_f32()
    }
}

/// Geometric mean over view directions of the light of all fields, `[elevation][wavelength]`.
pub fn levels(tensor: &Tensor) -> Vec<f32> {
    let [views, phis, elevations, channels] = tensor.shape;
    let mut mean = vec![0.0; elevations * NW];
    for (site, cell) in tensor.values.chunks_exact(channels).enumerate() {
        let row = &mut mean[site % elevations * NW..][..NW];
        for (w, mean) in row.iter_mut().enumerate() {
            let sum: f32 = (0..FIELDS).map(|f| cell[f * NW + w].max(0.0)).sum();
            *mean += f64::from(sum.max(LEAST).ln()) / (views * phis) as f64;
        }
    }
    mean.into_iter().map(|m| m.exp() as f32).collect()
}

/// Some channels (whole fields) divided by `whole(site, field, wavelength)`, `[view][phi][elevation][field][wavelength]`.
pub fn normalise(
    tensor: &Tensor,
    fields: Range<usize>,
    whole: impl Fn(usize, usize, usize) -> f32,
) -> Vec<f32> {
    let channels = tensor.shape[3];
    let mut out = Vec::with_capacity(tensor.values.len() / channels * fields.len() * NW);
    for (site, cell) in tensor.values.chunks_exact(channels).enumerate() {
        for field in fields.clone() {
            let row = &cell[field * NW..][..NW];
            out.extend(
                row.iter()
                    .enumerate()
                    .map(|(w, v)| v / whole(site, field, w)),
            );
        }
    }
    out
}

//! The traced tensor of one (altitude, visibility): fields over view angle, azimuth, solar elevation and channel.

use super::grid::Grid;
use crate::successive_orders::scattered_source::Sun;
use crate::successive_orders::{FIELDS, Gatherer, NW, POLARISED};
use rayon::prelude::*;

/// Channels of a traced tensor: field · NW + wavelength; intensities first.
pub const CHANNELS: usize = (FIELDS + POLARISED) * NW;

/// Values `[view][phi][elevation][channel]` at the sites of a grid, per unit of solar irradiance, phase functions taken
/// out.
#[derive(Clone, Debug)]
pub struct Tensor {
    /// Lengths of the four modes.
    pub shape: [usize; 4],
    /// Row-major values.
    pub values: Vec<f32>,
}

/// Traces the tensor of altitude `a`.
pub fn trace_tensor(gatherer: &Gatherer, grid: &Grid, a: usize) -> Tensor {
    let altitude = grid.traced_altitude(a);
    let views = grid.view_sites(gatherer.planet(), a);
    let suns = suns(grid);
    let values: Vec<f32> = views
        .par_iter()
        .flat_map_iter(|&(side, elevation)| {
            let path = gatherer.path(altitude, elevation, side);
            let fields = gatherer.fields(&path, elevation.sin(), &suns);
            let channels = fields.into_iter().flat_map(|f| f.spectra().map(|s| *s));
            channels.flatten().collect::<Vec<f32>>()
        })
        .collect();
    let shape = [
        views.len(),
        grid.phi.len(),
        grid.elevation_axis().len(),
        CHANNELS,
    ];
    Tensor { shape, values }
}

/// Every azimuth at every solar elevation, azimuth-major.
fn suns(grid: &Grid) -> Vec<Sun> {
    let elevations = grid.elevation_sites();
    grid.phi_sites()
        .into_iter()
        .flat_map(|phi| {
            elevations.iter().map(move |e| Sun {
                elevation: (e.cos(), e.sin()),
                azimuth: (phi.cos(), phi.sin()),
            })
        })
        .collect()
}

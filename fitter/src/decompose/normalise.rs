//! What the evaluator multiplies back: transmittance of the view ray and the scale of a solar elevation.

use super::collocation::Collocation;
use super::row_major::row_major;
use crate::column::ColumnIntegrator;
use crate::dataset::{Axis, Grid, Tensor};
use crate::successive_orders::{FIELDS, Medium, NW};
use faer::Mat;
use std::ops::Range;
use welkin::geometry::{Planet, Side};

/// Mean densities along the view sites of one altitude; independent of visibility.
pub struct ChunkGeometry {
    /// ln n̄ at the sites, `[view][constituent]`.
    log_density: Mat<f64>,
    /// Ray lengths at the sites, m.
    length: Vec<f64>,
    up: usize,
}

/// Smallest mean density that is stored: below it there is nothing to see.
const THINNEST: f64 = 1e-30;

/// Integrates the profiles of `medium` along the view sites of altitude `a`.
pub fn chunk_geometry(medium: &Medium, planet: Planet, grid: &Grid, a: usize) -> ChunkGeometry {
    let altitude = grid.traced_altitude(a);
    let views = grid.view_sites(planet, a);
    let integrator = ColumnIntegrator::new(&medium.atmosphere);
    let mut log_density = Mat::zeros(views.len(), medium.parts.len());
    let mut length = vec![];
    for (row, &(side, elevation)) in views.iter().enumerate() {
        let l = site_length(planet, altitude, elevation, side);
        let columns = integrator.along(altitude, elevation.sin(), l);
        for k in 0..medium.parts.len() {
            log_density[(row, k)] = (columns[k] / l).max(THINNEST).ln();
        }
        length.push(l);
    }
    ChunkGeometry {
        log_density,
        length,
        up: grid.up.0.len(),
    }
}

/// The ray's length; on the horizon itself rounding may put it on the other side.
fn site_length(planet: Planet, altitude: f64, elevation: f64, side: Side) -> f64 {
    let nudge = match side {
        Side::Up => 1e-12,
        Side::Down => -1e-12,
    };
    planet.ray(altitude, elevation + nudge).length
}

impl ChunkGeometry {
    /// (1 − T) · ω at view site `row` for wavelength `w`: what the air hides, and the share that it does not swallow.
    fn opacity(&self, medium: &Medium, row: usize, w: usize) -> f64 {
        let (mut extinction, mut scattering) = (0.0, 0.0);
        for (k, part) in medium.parts.iter().enumerate() {
            let tau = f64::from(part.extinction[w]) * self.log_density[(row, k)].exp();
            extinction += tau;
            if part.scatters() {
                scattering += tau;
            }
        }
        -(-extinction * self.length[row]).exp_m1() * scattering / extinction
    }

    /// Spline coefficients of ln n̄, `[up + down][constituent]`.
    pub fn coefficients(&self, up: Axis, down: Axis) -> Vec<f32> {
        let split = |from: usize, axis: Axis| {
            let values = self.log_density.subrows(from, axis.len()).to_owned();
            Collocation::new(axis).solve(&values)
        };
        [split(0, up), split(self.up, down)]
            .iter()
            .flat_map(row_major)
            .collect()
    }
}

/// S(e, λ): the typical source function of a chunk at each elevation site.
pub struct Level {
    /// Spline coefficients of ln S as the file has them, `[elevation coefficient][wavelength]`.
    pub coefficients: Vec<f32>,
    /// S, `[elevation site][wavelength]`.
    scale: Mat<f64>,
}

impl Level {
    /// The mean over view directions of ln (L / (1 − T)), rounded to half precision: the fit takes the rounding into
    /// account.
    pub fn new(tensor: &Tensor, geometry: &ChunkGeometry, medium: &Medium, axis: Axis) -> Self {
        let collocation = Collocation::new(axis);
        let exact = collocation.solve(&mean_logarithm(tensor, geometry, medium));
        let round = |v: f64| f64::from(half::f16::from_f64(v));
        let rounded = Mat::from_fn(exact.nrows(), exact.ncols(), |i, j| round(exact[(i, j)]));
        let sites = collocation.values(&rounded);
        Self {
            coefficients: row_major(&rounded),
            scale: Mat::from_fn(sites.nrows(), sites.ncols(), |i, j| sites[(i, j)].exp()),
        }
    }
}

fn mean_logarithm(tensor: &Tensor, geometry: &ChunkGeometry, medium: &Medium) -> Mat<f64> {
    let [views, phis, elevations, channels] = tensor.shape;
    let mut mean = Mat::zeros(elevations, NW);
    for (site, cell) in tensor.values.chunks_exact(channels).enumerate() {
        let (v, e) = (site / (phis * elevations), site % elevations);
        for w in 0..NW {
            let fields = (0..FIELDS).map(|f| f64::from(cell[f * NW + w].max(0.0)));
            let source = fields.sum::<f64>() / geometry.opacity(medium, v, w);
            mean[(e, w)] += source.max(1e-20).ln() / (views * phis) as f64;
        }
    }
    mean
}

/// Some channels (whole fields) divided by opacity and level: values of order one,
/// `[view][phi][elevation][field][wavelength]`.
pub fn normalise(
    tensor: &Tensor,
    geometry: &ChunkGeometry,
    medium: &Medium,
    level: &Level,
    fields: Range<usize>,
) -> Vec<f32> {
    let [views, phis, elevations, channels] = tensor.shape;
    let mut out = Vec::with_capacity(views * phis * elevations * fields.len());
    let mut opacity = [0.0; NW];
    for (site, cell) in tensor.values.chunks_exact(channels).enumerate() {
        let (v, e) = (site / (phis * elevations), site % elevations);
        if site % (phis * elevations) == 0 {
            opacity = std::array::from_fn(|w| geometry.opacity(medium, v, w));
        }
        out.extend(cell[fields.clone()].iter().enumerate().map(|(c, value)| {
            let w = c % NW;
            (f64::from(*value) / (opacity[w] * level.scale[(e, w)])) as f32
        }));
    }
    out
}

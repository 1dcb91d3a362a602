//! What the evaluator multiplies back: transmittance of the view ray and the scale of a solar elevation.

use crate::column::ColumnIntegrator;
use crate::dataset::{Axis, Grid, Tensor};
use crate::decompose::Collocation;
use crate::orders::{FIELDS, Medium, NW};
use faer::Mat;
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
    /// 1 − T at view site `row` for wavelength `w`.
    fn opacity(&self, medium: &Medium, row: usize, w: usize) -> f64 {
        let tau: f64 = medium
            .parts
            .iter()
            .enumerate()
            .map(|(k, part)| f64::from(part.extinction[w]) * self.log_density[(row, k)].exp())
            .sum();
        -(-tau * self.length[row]).exp_m1()
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

/// The rows of a matrix one after the other.
pub fn row_major(matrix: &Mat<f64>) -> Vec<f32> {
    (0..matrix.nrows())
        .flat_map(|i| (0..matrix.ncols()).map(move |j| matrix[(i, j)] as f32))
        .collect()
}

/// S(e, λ): the typical source function at each elevation site.
#[derive(Clone, Debug)]
pub struct ElevationScale {
    /// ln S, `[elevation][wavelength]`.
    log_scale: Mat<f64>,
}

impl ElevationScale {
    /// From the tensor of one altitude and visibility: the mean over view directions of ln (L / (1 − T)).
    pub fn new(tensor: &Tensor, geometry: &ChunkGeometry, medium: &Medium) -> Self {
        let [views, phis, elevations, channels] = tensor.shape;
        let mut log_scale = Mat::zeros(elevations, NW);
        for v in 0..views {
            let opacity: [f64; NW] = std::array::from_fn(|w| geometry.opacity(medium, v, w));
            for p in 0..phis {
                for e in 0..elevations {
                    let cell =
                        &tensor.values[((v * phis + p) * elevations + e) * channels..][..channels];
                    for w in 0..NW {
                        let sum: f64 = (0..FIELDS)
                            .map(|f| f64::from(cell[f * NW + w].max(0.0)))
                            .sum();
                        log_scale[(e, w)] +=
                            (sum / opacity[w]).max(1e-20).ln() / (views * phis) as f64;
                    }
                }
            }
        }
        Self { log_scale }
    }

    /// Spline coefficients `[elevation coefficient][wavelength]`.
    pub fn coefficients(&self, axis: Axis) -> Vec<f32> {
        row_major(&Collocation::new(axis).solve(&self.log_scale))
    }
}

/// Divides by opacity and scale: values of order one, `[view][phi][elevation][channel]`.
pub fn normalise(
    tensor: &Tensor,
    geometry: &ChunkGeometry,
    medium: &Medium,
    scale: &ElevationScale,
) -> Vec<f64> {
    let [views, phis, elevations, channels] = tensor.shape;
    let mut out = Vec::with_capacity(tensor.values.len());
    for v in 0..views {
        let opacity: [f64; NW] = std::array::from_fn(|w| geometry.opacity(medium, v, w));
        for p in 0..phis {
            for e in 0..elevations {
                let cell =
                    &tensor.values[((v * phis + p) * elevations + e) * channels..][..channels];
                out.extend(cell.iter().enumerate().map(|(c, value)| {
                    let w = c % NW;
                    f64::from(*value) / (opacity[w] * scale.log_scale[(e, w)].exp())
                }));
            }
        }
    }
    out
}

//! The scheme of Wilkie et al. 2021 (section 5) on one altitude and visibility: for each solar elevation, albedo and
//! wavelength a matrix over two angles, decomposed to rank 9 and read linearly.
//!
//! The angles are those from the sun and from the zenith, or, after sunset, from the edge of the Earth's shadow. Where
//! no direction has both angles, the matrix holds the nearest that has the second.

use super::chunk_axes::{Frame, Look};
use super::dense::Uncompressed;
use crate::dataset::Sample;
use crate::decompose::Chunk;
use crate::successive_orders::NW;
use faer::Mat;
use rayon::prelude::*;
use welkin::axis::{Stencil, linear};

/// Solar elevations of the paper's Table 2, degrees.
const ELEVATIONS: [f64; 30] = [
    -4.2, -4.0, -3.5, -3.0, -2.5, -2.0, -1.5, -1.0, -0.5, 0.0, 1.0, 2.85, 5.23, 8.05, 11.25, 14.79,
    18.64, 22.77, 27.17, 31.82, 36.71, 41.83, 47.16, 52.71, 58.46, 64.40, 70.53, 76.84, 83.34,
    90.0,
];
/// Its ground albedos.
const ALBEDOS: [f64; 4] = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0];
/// Its rank.
pub const RANK: usize = 9;
const ITERATIONS: usize = 6;

/// Tables of one altitude and visibility.
pub struct Paper {
    /// Nodes of the angle from the sun, rad.
    sun: Vec<f64>,
    /// Nodes of the angle from the zenith or the shadow, rad.
    zenith: Vec<f64>,
    elevations: Vec<f64>,
    /// `[elevation][albedo][wavelength][sun nodes, then zenith nodes][rank]`.
    tables: Vec<f32>,
}

/// Tables and their linear weights for one query.
pub struct Query {
    sun: Stencil,
    zenith: Stencil,
    elevation: Stencil,
    albedo: Stencil,
}

fn nodes(parts: &[(f64, f64, f64)]) -> Vec<f64> {
    let part = |&(first, last, step): &(f64, f64, f64)| {
        let n = ((last - first) / step).round() as usize;
        (0..=n).map(move |i| (first + step * i as f64).to_radians())
    };
    parts.iter().flat_map(part).collect()
}

impl Paper {
    /// Fits the tables to `source`.
    pub fn new(source: &Uncompressed, chunk: &Chunk, frame: &Frame) -> Self {
        let mut paper = Self {
            sun: nodes(&[(0.0, 90.0, 0.5), (91.0, 180.0, 1.0)]),
            zenith: nodes(&[(0.0, 80.0, 1.0), (80.5, 100.0, 0.5), (101.0, 180.0, 1.0)]),
            elevations: ELEVATIONS.map(f64::to_radians).to_vec(),
            tables: vec![],
        };
        let elevations = paper.elevations.clone();
        let tables = elevations
            .par_iter()
            .flat_map_iter(|&e| paper.of_elevation(source, chunk, frame, e));
        paper.tables = tables.collect();
        paper
    }

    /// Bytes of the tables in half precision.
    pub fn bytes(&self) -> usize {
        2 * self.tables.len()
    }

    /// Tables of all albedos and wavelengths.
    fn of_elevation(
        &self,
        source: &Uncompressed,
        chunk: &Chunk,
        frame: &Frame,
        elevation: f64,
    ) -> Vec<f32> {
        let mut at = Look {
            view: 0.0,
            azimuth: 0.0,
            sun: elevation,
        };
        let slice = source.under(&frame.place(&at).elevation);
        let mut cells: Vec<[[f64; NW]; 2]> = vec![];
        for &zenith in &self.zenith {
            let mut previous = None;
            for &sun in &self.sun {
                (at.view, at.azimuth) = direction(elevation, zenith, sun);
                // Columns beyond the reachable ones repeat the last.
                let cell = match previous {
                    Some((view, azimuth)) if (view, azimuth) == (at.view, at.azimuth) => {
                        cells[cells.len() - 1]
                    }
                    _ => slice.radiance(chunk, frame, &at),
                };
                previous = Some((at.view, at.azimuth));
                cells.push(cell);
            }
        }
        let mut out = vec![];
        for albedo in ALBEDOS {
            for w in 0..NW {
                let ground = f64::from(chunk.interreflection(w, albedo as f32));
                let columns = self.sun.len();
                let matrix = Mat::from_fn(self.zenith.len(), columns, |i, j| {
                    let [black, white] = &cells[i * columns + j];
                    (black[w] + ground * white[w]).max(0.0)
                });
                out.extend(decompose(matrix));
            }
        }
        out
    }

    /// What a held-out sample needs.
    pub fn query(&self, sample: &Sample) -> Query {
        let d = sample.direction().map(f64::from);
        let (sine, cosine) = sample.solar_elevation.sin_cos();
        let sun = d[0] * cosine + d[2] * sine;
        let (st, ct) = sample.solar_elevation.min(0.0).sin_cos();
        let zenith = d[2] * ct - d[0] * st;
        let angle = |cosine: f64| cosine.clamp(-1.0, 1.0).acos();
        Query {
            sun: linear(&self.sun, angle(sun)),
            zenith: linear(&self.zenith, angle(zenith)),
            elevation: linear(&self.elevations, sample.solar_elevation),
            albedo: linear(&ALBEDOS, sample.albedo),
        }
    }

    /// Relative radiance: rank 9 for each wavelength at each of the four corners.
    pub fn radiance(&self, query: &Query) -> [f32; NW] {
        let (suns, rows) = (self.sun.len(), self.sun.len() + self.zenith.len());
        let (i, j) = (query.sun.first, suns + query.zenith.first);
        let [a, b] = [query.sun.weight[1] as f32, query.zenith.weight[1] as f32];
        let mut out = [0.0; NW];
        for e in 0..query.elevation.len {
            for k in 0..query.albedo.len {
                let weight = (query.elevation.weight[e] * query.albedo.weight[k]) as f32;
                let corner = (query.elevation.first + e) * ALBEDOS.len() + query.albedo.first + k;
                for (w, out) in out.iter_mut().enumerate() {
                    let table = &self.tables[(corner * NW + w) * rows * RANK..][..rows * RANK];
                    let row = |i: usize| &table[i * RANK..][..RANK];
                    let (s0, s1, z0, z1) = (row(i), row(i + 1), row(j), row(j + 1));
                    let mut sum = 0.0;
                    for r in 0..RANK {
                        sum += (s0[r] + a * (s1[r] - s0[r])) * (z0[r] + b * (z1[r] - z0[r]));
                    }
                    *out += weight * sum.max(0.0);
                }
            }
        }
        out
    }
}

/// Elevation and azimuth (rad) of the direction at the given angles.
fn direction(elevation: f64, zenith: f64, sun: f64) -> (f64, f64) {
    let (r, z) = zenith.sin_cos();
    let (sine, cosine) = elevation.max(0.0).sin_cos();
    let c = ((sun.cos() - z * sine) / (r * cosine).max(1e-9)).clamp(-1.0, 1.0);
    let (x, y) = (r * c, r * (1.0 - c * c).sqrt());
    // After sunset the pole is the edge of the shadow, at a right angle to the sun.
    let (st, ct) = elevation.min(0.0).sin_cos();
    let (x, z) = (x * ct - z * st, x * st + z * ct);
    (z.clamp(-1.0, 1.0).asin(), y.atan2(x))
}

/// The leading singular vectors by subspace iteration, `[columns, then rows][rank]`. Rows are brought to a like size
/// first, so that relative errors count; that is what the paper's emphasis is for.
fn decompose(mut matrix: Mat<f64>) -> Vec<f32> {
    let (rows, columns) = (matrix.nrows(), matrix.ncols());
    let size: Vec<f64> = (0..rows)
        .map(|i| (matrix.row(i).sum() / columns as f64).max(1e-12))
        .collect();
    for j in 0..columns {
        matrix
            .col_as_slice_mut(j)
            .iter_mut()
            .zip(&size)
            .for_each(|(v, s)| *v /= s);
    }
    let mut right = Mat::from_fn(columns, RANK, |j, r| {
        (0.1 * (r * j) as f64 + r as f64).cos()
    });
    for _ in 0..ITERATIONS {
        right = matrix.transpose() * (&matrix * right.qr().compute_thin_Q());
    }
    let right = right.qr().compute_thin_Q();
    let left = &matrix * &right;
    let table = |m: &Mat<f64>, scale: &dyn Fn(usize) -> f64| -> Vec<f32> {
        let cells = (0..m.nrows()).flat_map(|i| (0..RANK).map(move |r| (i, r)));
        cells.map(|(i, r)| (scale(i) * m[(i, r)]) as f32).collect()
    };
    [table(&right, &|_| 1.0), table(&left, &|i| size[i])].concat()
}

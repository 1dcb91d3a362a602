//! The peer: the scheme of Wilkie et al. 2021, section 5, in its published dimensions, on radiance of this model.
//!
//! For each configuration (visibility, albedo, altitude, solar elevation, wavelength) a matrix over the angle from the
//! sun and the zenith angle is decomposed to rank 9. A query reads both vectors of every rank at the two nodes around
//! its angles, for all 16 configurations around its conditions, and mixes them linearly. The tables of one cell of
//! the grid are fitted and stored many times over, so that random queries meet as much memory as they would.

use welkin::{Conditions, Model};

const RANK: usize = 9;
const CORNERS: usize = 16;
/// Copies of the cell.
const COPIES: usize = 128;

/// The two nodes around conditions, per parameter.
pub struct Cell {
    /// m.
    pub visibility: [f64; 2],
    /// Of the ground.
    pub albedo: [f64; 2],
    /// Of the observer, m.
    pub altitude: [f64; 2],
    /// Of the sun, radians.
    pub elevation: [f64; 2],
}

impl Cell {
    /// Conditions in the cell.
    pub fn inside(&self, [a, b, c, d]: [f64; 4]) -> Conditions {
        let between = |[low, high]: [f64; 2], t: f64| low + t * (high - low);
        Conditions {
            visibility: between(self.visibility, a),
            albedo: between(self.albedo, b),
            altitude: between(self.altitude, c),
            solar_elevation: between(self.elevation, d),
            solar_azimuth: 0.0,
        }
    }

    fn corner(&self, corner: usize) -> Conditions {
        self.inside([0, 1, 2, 3].map(|bit| (corner >> bit & 1) as f64))
    }

    /// Weight of each corner.
    fn weights(&self, conditions: &Conditions) -> [f32; CORNERS] {
        let share = |[low, high]: [f64; 2], x: f64| (x - low) / (high - low);
        let t = [
            share(self.visibility, conditions.visibility),
            share(self.albedo, conditions.albedo),
            share(self.altitude, conditions.altitude),
            share(self.elevation, conditions.solar_elevation),
        ];
        std::array::from_fn(|corner| {
            let weight = |bit: usize| match corner >> bit & 1 {
                0 => 1.0 - t[bit],
                _ => t[bit],
            };
            (0..4).map(weight).product::<f64>() as f32
        })
    }
}

/// Nodes of one of the angles, degrees, and where the vectors of a rank stand.
struct Breaks(Vec<f32>);

impl Breaks {
    fn new(parts: &[(f64, f64, f64)]) -> Self {
        let part = |&(first, last, step): &(f64, f64, f64)| {
            let n = ((last - first) / step).round() as usize;
            (0..=n).map(move |i| (first + step * i as f64) as f32)
        };
        Self(parts.iter().flat_map(part).collect())
    }

    fn locate(&self, angle: f32) -> (usize, f32) {
        let i = self
            .0
            .partition_point(|&b| b <= angle)
            .clamp(1, self.0.len() - 1)
            - 1;
        (i, (angle - self.0[i]) / (self.0[i + 1] - self.0[i]))
    }
}

/// The tables of one cell, as often as a grid would hold such.
pub struct Paper {
    cell: Cell,
    wavelengths: usize,
    sun: Breaks,
    zenith: Breaks,
    /// `[copy][corner][wavelength][rank][sun nodes, then zenith nodes]`.
    tables: Vec<f32>,
}

impl Paper {
    /// Decomposes the skies at the corners of the cell.
    pub fn fit(model: &Model, cell: Cell) -> welkin::Result<Self> {
        let mut paper = Self {
            cell,
            wavelengths: model.wavelengths().len(),
            sun: Breaks::new(&[(0.0, 90.0, 0.5), (91.0, 180.0, 1.0)]),
            zenith: Breaks::new(&[(0.0, 80.0, 1.0), (80.5, 100.0, 0.5), (101.0, 180.0, 1.0)]),
            tables: Vec::new(),
        };
        let mut cell = Vec::new();
        for corner in 0..CORNERS {
            cell.extend(paper.configurations(model, &paper.cell.corner(corner))?);
        }
        paper.tables = cell.repeat(COPIES);
        Ok(paper)
    }

    /// Memory of all copies.
    pub fn bytes(&self) -> usize {
        size_of_val(self.tables.as_slice())
    }

    /// Tables of all wavelengths at one corner.
    fn configurations(&self, model: &Model, conditions: &Conditions) -> welkin::Result<Vec<f32>> {
        let sky = model.sky(conditions)?;
        let (rows, columns) = (self.zenith.0.len(), self.sun.0.len());
        let mut spectra = vec![0.0; rows * columns * self.wavelengths];
        let mut cells = spectra.chunks_exact_mut(self.wavelengths);
        for &zenith in &self.zenith.0 {
            for (&sun, spectrum) in self.sun.0.iter().zip(&mut cells) {
                let direction = direction(conditions.solar_elevation, zenith, sun);
                sky.radiance(direction, spectrum)?;
            }
        }
        let mut tables = Vec::new();
        for w in 0..self.wavelengths {
            let matrix: Vec<f32> = spectra
                .iter()
                .skip(w)
                .step_by(self.wavelengths)
                .copied()
                .collect();
            tables.extend(decompose(matrix, columns));
        }
        Ok(tables)
    }

    /// Radiance at all wavelengths; `copy` says where in memory the cell is read.
    pub fn radiance(&self, copy: usize, conditions: &Conditions, view: [f32; 3], out: &mut [f32]) {
        let (sine, cosine) = (conditions.solar_elevation as f32).sin_cos();
        let zenith = view[2].clamp(-1.0, 1.0).acos().to_degrees();
        let gamma = (view[0] * cosine + view[2] * sine)
            .clamp(-1.0, 1.0)
            .acos()
            .to_degrees();
        let (sun, sun_share) = self.sun.locate(gamma);
        let (zenith, zenith_share) = self.zenith.locate(zenith);
        let n = self.sun.0.len() + self.zenith.0.len();
        let zenith = zenith + self.sun.0.len();
        let per_wavelength = RANK * n;
        let per_corner = self.wavelengths * per_wavelength;
        let cell = &self.tables[copy % COPIES * CORNERS * per_corner..][..CORNERS * per_corner];
        out.fill(0.0);
        let weights = self.cell.weights(conditions);
        for (corner, weight) in cell.chunks_exact(per_corner).zip(weights) {
            for (out, table) in out.iter_mut().zip(corner.chunks_exact(per_wavelength)) {
                let mut sum = 0.0;
                for vectors in table.chunks_exact(n) {
                    sum += mix(vectors, sun, sun_share) * mix(vectors, zenith, zenith_share);
                }
                *out += weight * sum.max(0.0);
            }
        }
    }
}

fn mix(vector: &[f32], i: usize, share: f32) -> f32 {
    vector[i] + share * (vector[i + 1] - vector[i])
}

/// The direction at a zenith angle and an angle from the sun (degrees); where no direction has both, the nearest.
fn direction(elevation: f64, zenith: f32, sun: f32) -> [f32; 3] {
    let [zenith, sun] = [zenith, sun].map(|angle| f64::from(angle).to_radians());
    let (r, z) = zenith.sin_cos();
    let cosine = (sun.cos() - z * elevation.sin()) / (r * elevation.cos()).max(1e-9);
    let cosine = cosine.clamp(-1.0, 1.0);
    [r * cosine, r * (1.0 - cosine * cosine).sqrt(), z].map(|v| v as f32)
}

/// Leading singular vectors by orthogonal iteration: `[rank][columns, then rows]`. Rows are brought to a like size
/// first, which is what the paper's emphasis is for.
fn decompose(mut matrix: Vec<f32>, columns: usize) -> Vec<f32> {
    let mut sizes = Vec::new();
    for row in matrix.chunks_exact_mut(columns) {
        let size = (row.iter().sum::<f32>() / columns as f32).max(1e-12);
        row.iter_mut().for_each(|v| *v /= size);
        sizes.push(size);
    }
    let mut basis: Vec<Vec<f32>> = (0..RANK)
        .map(|r| {
            (0..columns)
                .map(|c| (0.1 * (r * c) as f32 + r as f32).cos())
                .collect()
        })
        .collect();
    for _ in 0..8 {
        orthonormalise(&mut basis);
        let left = basis
            .iter()
            .map(|b| times(&matrix, columns, b))
            .collect::<Vec<_>>();
        basis = left
            .iter()
            .map(|l| transposed_times(&matrix, columns, l))
            .collect();
    }
    orthonormalise(&mut basis);
    let mut vectors = Vec::new();
    for right in &basis {
        let left = times(&matrix, columns, right);
        vectors.extend(right);
        vectors.extend(left.iter().zip(&sizes).map(|(l, size)| l * size));
    }
    vectors
}

fn times(matrix: &[f32], columns: usize, vector: &[f32]) -> Vec<f32> {
    matrix
        .chunks_exact(columns)
        .map(|row| dot(row, vector))
        .collect()
}

fn transposed_times(matrix: &[f32], columns: usize, vector: &[f32]) -> Vec<f32> {
    let mut sum = vec![0.0; columns];
    for (row, v) in matrix.chunks_exact(columns).zip(vector) {
        sum.iter_mut().zip(row).for_each(|(s, m)| *s += v * m);
    }
    sum
}

fn dot(a: &[f32], b: &[f32]) -> f32 {
    let mut lanes = [0.0; 8];
    for (a, b) in a.as_chunks::<8>().0.iter().zip(b.as_chunks::<8>().0) {
        (0..8).for_each(|i| lanes[i] += a[i] * b[i]);
    }
    let rest = a.len() / 8 * 8;
    let rest = a[rest..]
        .iter()
        .zip(&b[rest..])
        .map(|(a, b)| a * b)
        .sum::<f32>();
    lanes.iter().sum::<f32>() + rest
}

/// Gram-Schmidt.
fn orthonormalise(basis: &mut [Vec<f32>]) {
    for i in 0..basis.len() {
        let (before, rest) = basis.split_at_mut(i);
        let vector = &mut rest[0];
        for other in before.iter() {
            let share = dot(vector, other);
            vector
                .iter_mut()
                .zip(other)
                .for_each(|(v, o)| *v -= share * o);
        }
        let length = dot(vector, vector).sqrt().max(f32::MIN_POSITIVE);
        vector.iter_mut().for_each(|v| *v /= length);
    }
}

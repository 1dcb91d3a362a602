//! Refinement of coupled factors in the measure that counts: relative radiance.
//!
//! The decomposition treats the fields one by one and all sites alike. Here each factor matrix in turn is moved, by linear least
//! squares on a random selection of sites, to where the *sum* of the fields times their phase functions is right relative to the
//! traced radiance. Steps are damped towards the present factors, so that the fields stay what they stand for.

use super::chunk::Chunk;
use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::linalg::solvers::{Llt, Solve};
use faer::{Accum, Mat, Par, Side};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;

use crate::orders::{FIELDS, NW};

/// Factor matrices at the sites of one chunk, row-major with the rank contiguous.
#[derive(Clone)]
pub struct Own {
    /// `[view][rank]`.
    pub view: Vec<f32>,
    /// `[elevation][rank]`.
    pub elevation: Vec<f32>,
}

/// Factor matrices that all chunks share.
#[derive(Clone)]
pub struct Basis {
    /// Number of components.
    pub rank: usize,
    /// `[phi][rank]`.
    pub phi: Vec<f32>,
    /// `[field][wavelength][rank]`.
    pub channel: Vec<f32>,
}

/// Damping of a step relative to the diagonal of its normal matrix.
const DAMPING: f64 = 2e-3;
/// Albedos at which the radiance is compared.
const ALBEDOS: [f32; 3] = [0.0, 0.3, 1.0];
/// Weight of the relative error of a single field against that of the radiance.
const FIELD_WEIGHT: f32 = 0.4;

/// A linear equation: the radiance (or one field) at a site, a wavelength and an albedo, relative to what was traced.
struct Equation {
    wavelength: usize,
    /// Factor of each field.
    share: [f32; FIELDS],
    /// What Σ share · field should be.
    target: f32,
    /// Square root of its weight.
    weight: f32,
}

/// Normal equations of one row of a factor matrix, gathered in blocks.
struct Normal {
    unknowns: usize,
    matrix: Mat<f32>,
    right: Vec<f32>,
    block: Mat<f32>,
    residuals: Vec<f32>,
    rows: usize,
}

const BLOCK: usize = 512;

impl Normal {
    fn new(unknowns: usize) -> Self {
        Self {
            unknowns,
            matrix: Mat::zeros(unknowns, unknowns),
            right: vec![0.0; unknowns],
            block: Mat::zeros(unknowns, BLOCK),
            residuals: vec![0.0; BLOCK],
            rows: 0,
        }
    }

    /// Adds a row (already times its root weight) with its residual.
    fn push(&mut self, residual: f32, fill: impl FnOnce(&mut [f32])) {
        fill(self.block.col_as_slice_mut(self.rows));
        self.residuals[self.rows] = residual;
        self.rows += 1;
        if self.rows == BLOCK {
            self.flush();
        }
    }

    fn flush(&mut self) {
        let block = self.block.subcols(0, self.rows);
        let lower = BlockStructure::TriangularLower;
        let full = BlockStructure::Rectangular;
        matmul(
            self.matrix.as_mut(),
            lower,
            Accum::Add,
            block,
            full,
            block.transpose(),
            full,
            1.0,
            Par::Seq,
        );
        for i in 0..self.rows {
            let residual = self.residuals[i];
            for (sum, x) in self.right.iter_mut().zip(self.block.col_as_slice(i)) {
                *sum += residual * x;
            }
        }
        self.rows = 0;
    }

    fn join(mut self, mut other: Self) -> Self {
        self.flush();
        other.flush();
        self.matrix += &other.matrix;
        self.right
            .iter_mut()
            .zip(other.right)
            .for_each(|(a, b)| *a += b);
        self
    }

    /// The damped step; none where nothing was gathered.
    fn step(mut self) -> Vec<f32> {
        self.flush();
        let n = self.unknowns;
        let floor = 1e-6 * (0..n).map(|i| f64::from(self.matrix[(i, i)])).sum::<f64>() / n as f64;
        let matrix = Mat::from_fn(n, n, |i, j| {
            let value = f64::from(self.matrix[(i.max(j), i.min(j))]);
            if i == j {
                value * (1.0 + DAMPING) + floor + 1e-30
            } else {
                value
            }
        });
        let right = Mat::from_fn(n, 1, |i, _| f64::from(self.right[i]));
        match Llt::new(matrix.as_ref(), Side::Lower) {
            Ok(llt) => {
                let x = llt.solve(&right);
                (0..n).map(|i| x[(i, 0)] as f32).collect()
            }
            Err(_) => vec![0.0; n],
        }
    }
}

/// One pass over all factor matrices. `seed` selects the sites.
pub fn sweep(chunks: &[Chunk], own: &mut [Own], basis: &mut Basis, seed: u64, shared: bool) {
    if shared {
        channels(chunks, own, basis, seed);
        azimuths(chunks, own, basis, seed);
    }
    own.par_iter_mut().zip(chunks).for_each(|(own, chunk)| {
        elevations(chunk, own, basis, seed);
        views(chunk, own, basis, seed);
    });
}

fn row(matrix: &[f32], i: usize, rank: usize) -> &[f32] {
    &matrix[i * rank..][..rank]
}

fn add(matrix: &mut [f32], i: usize, rank: usize, step: &[f32]) {
    for (x, s) in matrix[i * rank..][..rank].iter_mut().zip(step) {
        *x += s;
    }
}

fn random(seed: u64, chunk: &Chunk, what: u64) -> Pcg64Mcg {
    Pcg64Mcg::seed_from_u64(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ chunk.seed() ^ what << 48)
}

/// Σ_f share_f · channel_(f, w, r) for every r.
fn mix(basis: &Basis, equation: &Equation, out: &mut [f32]) {
    let rank = basis.rank;
    out.fill(0.0);
    for (f, share) in equation.share.iter().enumerate() {
        if *share != 0.0 {
            let channel = row(&basis.channel, f * NW + equation.wavelength, rank);
            for (o, c) in out.iter_mut().zip(channel) {
                *o += share * c;
            }
        }
    }
}

/// The equations that are asked at a site: the radiance at three wavelengths and a random albedo each, one field at one of them.
fn equations(chunk: &Chunk, site: usize, rng: &mut Pcg64Mcg) -> [Equation; 4] {
    let draw = rng.next_u64() as usize;
    let first = draw % 4;
    let albedo = |k: usize| ALBEDOS[(draw >> (8 + 8 * k)) % 3];
    let at = |k: usize| chunk.radiance_equation(site, first + 4 * k, albedo(k));
    let equation = |k: usize| {
        let (wavelength, share) = at(k);
        Equation {
            wavelength,
            share,
            target: 1.0,
            weight: chunk.weight(site),
        }
    };
    let (wavelength, share) = at(draw % 3);
    let field = (draw >> 40) % FIELDS;
    let mut single = [0.0; FIELDS];
    single[field] = share[field];
    [
        equation(0),
        equation(1),
        equation(2),
        Equation {
            wavelength,
            target: share[field] * chunk.value(site, field, wavelength),
            share: single,
            weight: chunk.weight(site) * FIELD_WEIGHT,
        },
    ]
}

fn views(chunk: &Chunk, own: &mut Own, basis: &Basis, seed: u64) {
    let rank = basis.rank;
    let [views, phis, elevations] = chunk.sites;
    let mut rng = random(seed, chunk, 1);
    let mut mixed = vec![0.0; rank];
    for v in 0..views {
        let mut normal = Normal::new(rank);
        for p in 0..phis {
            for e in 0..elevations {
                let site = chunk.site(v, p, e);
                let phi = row(&basis.phi, p, rank);
                let elevation = row(&own.elevation, e, rank);
                for equation in equations(chunk, site, &mut rng) {
                    mix(basis, &equation, &mut mixed);
                    let view = row(&own.view, v, rank);
                    push(&mut normal, &equation, view, |r| {
                        mixed[r] * phi[r] * elevation[r]
                    });
                }
            }
        }
        add(&mut own.view, v, rank, &normal.step());
    }
}

fn elevations(chunk: &Chunk, own: &mut Own, basis: &Basis, seed: u64) {
    let rank = basis.rank;
    let [views, phis, elevations] = chunk.sites;
    let mut rng = random(seed, chunk, 2);
    let mut mixed = vec![0.0; rank];
    for e in 0..elevations {
        let mut normal = Normal::new(rank);
        for v in 0..views {
            for p in 0..phis {
                let site = chunk.site(v, p, e);
                let (phi, view) = (row(&basis.phi, p, rank), row(&own.view, v, rank));
                for equation in equations(chunk, site, &mut rng) {
                    mix(basis, &equation, &mut mixed);
                    let elevation = row(&own.elevation, e, rank);
                    push(&mut normal, &equation, elevation, |r| {
                        mixed[r] * phi[r] * view[r]
                    });
                }
            }
        }
        add(&mut own.elevation, e, rank, &normal.step());
    }
}

/// Adds an equation that is linear in `x` with the coefficients `coefficient`.
#[inline(always)]
fn push(normal: &mut Normal, equation: &Equation, x: &[f32], coefficient: impl Fn(usize) -> f32) {
    let rank = x.len();
    let mut value = 0.0;
    let at = normal.rows;
    let column = normal.block.col_as_slice_mut(at);
    for r in 0..rank {
        let c = coefficient(r);
        value += c * x[r];
        column[r] = c * equation.weight;
    }
    normal.push((equation.target - value) * equation.weight, |_| {});
}

/// Sites per chunk that enter the shared matrices, per wavelength or azimuth.
const SHARED_SITES: usize = 700;

fn azimuths(chunks: &[Chunk], own: &[Own], basis: &mut Basis, seed: u64) {
    let rank = basis.rank;
    let Some(first) = chunks.first() else { return };
    let [views, phis, elevations] = first.sites;
    let steps: Vec<Vec<f32>> = (0..phis)
        .map(|p| {
            let one = |(chunk, own): (&Chunk, &Own)| {
                let mut rng = random(seed, chunk, 3 + p as u64);
                let mut mixed = vec![0.0; rank];
                let mut normal = Normal::new(rank);
                for _ in 0..SHARED_SITES / 2 {
                    let draw = rng.next_u64() as usize;
                    let (v, e) = (draw % views, (draw >> 24) % elevations);
                    let view = row(&own.view, v, rank);
                    let elevation = row(&own.elevation, e, rank);
                    for equation in equations(chunk, chunk.site(v, p, e), &mut rng) {
                        mix(basis, &equation, &mut mixed);
                        let phi = row(&basis.phi, p, rank);
                        push(&mut normal, &equation, phi, |r| {
                            mixed[r] * elevation[r] * view[r]
                        });
                    }
                }
                normal
            };
            let pairs = chunks.par_iter().zip(own).map(one);
            pairs.reduce(|| Normal::new(rank), Normal::join).step()
        })
        .collect();
    for (p, step) in steps.iter().enumerate() {
        add(&mut basis.phi, p, rank, step);
    }
}

fn channels(chunks: &[Chunk], own: &[Own], basis: &mut Basis, seed: u64) {
    let rank = basis.rank;
    for w in 0..NW {
        let one = |(chunk, own): (&Chunk, &Own)| {
            let [views, phis, elevations] = chunk.sites;
            let mut rng = random(seed, chunk, 40 + w as u64);
            let mut normal = Normal::new(FIELDS * rank);
            let mut z = vec![0.0; rank];
            for _ in 0..SHARED_SITES {
                let draw = rng.next_u64() as usize;
                let (v, p, e) = (draw % views, (draw >> 16) % phis, (draw >> 32) % elevations);
                let site = chunk.site(v, p, e);
                let (view, elevation) = (row(&own.view, v, rank), row(&own.elevation, e, rank));
                let phi = row(&basis.phi, p, rank);
                for r in 0..rank {
                    z[r] = view[r] * elevation[r] * phi[r];
                }
                let albedo = ALBEDOS[(draw >> 50) % 3];
                let (_, share) = chunk.radiance_equation(site, w, albedo);
                let weight = chunk.weight(site);
                let mut add = |share: [f32; FIELDS], target: f32, weight: f32| {
                    let mut value = 0.0;
                    for (f, share) in share.iter().enumerate() {
                        let channel = row(&basis.channel, f * NW + w, rank);
                        let sum: f32 = channel.iter().zip(&z).map(|(c, z)| c * z).sum();
                        value += share * sum;
                    }
                    normal.push((target - value) * weight, |column| {
                        for (f, part) in column.chunks_exact_mut(rank).enumerate() {
                            for (c, z) in part.iter_mut().zip(&z) {
                                *c = share[f] * z * weight;
                            }
                        }
                    });
                };
                add(share, 1.0, weight);
                let field = (draw >> 56) % FIELDS;
                let mut single = [0.0; FIELDS];
                single[field] = share[field];
                let target = share[field] * chunk.value(site, field, w);
                add(single, target, weight * FIELD_WEIGHT);
            }
            normal
        };
        let pairs = chunks.par_iter().zip(own).map(one);
        let step = pairs
            .reduce(|| Normal::new(FIELDS * rank), Normal::join)
            .step();
        for f in 0..FIELDS {
            add(
                &mut basis.channel,
                f * NW + w,
                rank,
                &step[f * rank..][..rank],
            );
        }
    }
}

/// Radiance relative to the traced one at random sites (albedo 0.3), unweighted.
pub fn relative_radiance(chunk: &Chunk, own: &Own, basis: &Basis, count: usize) -> Vec<f32> {
    let rank = basis.rank;
    let [views, phis, elevations] = chunk.sites;
    let mut rng = random(0, chunk, 99);
    let mut mixed = vec![0.0; rank];
    (0..count)
        .map(|_| {
            let draw = rng.next_u64() as usize;
            let (v, p, e) = (draw % views, (draw >> 16) % phis, (draw >> 32) % elevations);
            let w = (draw >> 50) % NW;
            let (wavelength, share) = chunk.radiance_equation(chunk.site(v, p, e), w, ALBEDOS[1]);
            let equation = Equation {
                wavelength,
                share,
                target: 1.0,
                weight: 1.0,
            };
            mix(basis, &equation, &mut mixed);
            let (view, elevation) = (row(&own.view, v, rank), row(&own.elevation, e, rank));
            let phi = row(&basis.phi, p, rank);
            (0..rank)
                .map(|r| mixed[r] * view[r] * elevation[r] * phi[r])
                .sum()
        })
        .collect()
}

/// What the factors leave of a chunk.
pub fn residual(chunk: &Chunk, own: &Own, basis: &Basis) -> Chunk {
    let rank = basis.rank;
    let [_, phis, elevations] = chunk.sites;
    let mut z = vec![0.0; rank];
    let mut values = chunk.values().to_vec();
    for (site, cell) in values.chunks_exact_mut(FIELDS * NW).enumerate() {
        let view = row(&own.view, site / (phis * elevations), rank);
        let phi = row(&basis.phi, site / elevations % phis, rank);
        let elevation = row(&own.elevation, site % elevations, rank);
        for r in 0..rank {
            z[r] = view[r] * phi[r] * elevation[r];
        }
        for (c, value) in cell.iter_mut().enumerate() {
            let channel = row(&basis.channel, c, rank);
            *value -= channel.iter().zip(&z).map(|(c, z)| c * z).sum::<f32>();
        }
    }
    chunk.with_values(values)
}

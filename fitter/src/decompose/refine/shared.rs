//! Steps of the factor matrices that all chunks share.

use super::equation::{ALBEDOS, Equation, equations};
use super::factors::{Basis, Own, Pass, add, random, row};
use super::normal::Normal;
use crate::decompose::Chunk;
use crate::successive_orders::{FIELDS, NW};
use rand_pcg::rand_core::Rng;
use rayon::prelude::*;

/// Sites per chunk that enter the shared matrices, per wavelength; half as many per azimuth.
const SITES: usize = 700;
/// Chunks whose equations are gathered one after another.
const GROUP: usize = 8;

/// The step to which `each` chunk adds its equations. Sums are taken in one order, whatever the number of threads.
fn step(
    unknowns: usize,
    (chunks, own): (&[Chunk], &[Own]),
    each: impl Fn(&mut Normal, &Chunk, &Own) + Sync,
) -> Vec<f32> {
    let groups = chunks.par_chunks(GROUP).zip(own.par_chunks(GROUP));
    let gather = |(chunks, own): (&[Chunk], &[Own])| {
        let mut normal = Normal::new(unknowns);
        for (chunk, own) in chunks.iter().zip(own) {
            each(&mut normal, chunk, own);
        }
        normal
    };
    let parts: Vec<Normal> = groups.map(gather).collect();
    let whole = parts.into_iter().reduce(Normal::join);
    whole.map_or_else(|| vec![0.0; unknowns], Normal::step)
}

pub fn azimuths(chunks: &[Chunk], nodes: &[usize], own: &[Own], basis: &mut Basis, pass: Pass) {
    let rank = basis.rank;
    let phis = chunks.first().map_or(0, |chunk| chunk.sites[1]);
    let steps: Vec<Vec<f32>> = (0..phis)
        .map(|p| {
            step(rank, (chunks, own), |normal, chunk, own| {
                azimuth(normal, (chunk, nodes, own), basis, p, pass.seed)
            })
        })
        .collect();
    for (p, step) in steps.iter().enumerate() {
        add(&mut basis.phi, p, rank, step, pass.step);
    }
}

fn azimuth(
    normal: &mut Normal,
    (chunk, nodes, own): (&Chunk, &[usize], &Own),
    basis: &Basis,
    p: usize,
    seed: u64,
) {
    let rank = basis.rank;
    let [views, _, elevations] = chunk.sites;
    let mut rng = random(seed, chunk, 3 + p as u64);
    let mut mixed = vec![0.0; rank];
    let phi = row(&basis.phi, p, rank);
    for _ in 0..SITES / 2 {
        let draw = rng.next_u64() as usize;
        let (v, e) = (draw % views, (draw >> 24) % elevations);
        let (view, elevation) = (row(&own.view, v, rank), row(&own.elevation, e, rank));
        for equation in equations(chunk, nodes, chunk.site(v, p, e), &mut rng) {
            equation.mix(basis, &mut mixed);
            equation.push(normal, phi, |r| mixed[r] * elevation[r] * view[r]);
        }
    }
}

pub fn channels(chunks: &[Chunk], nodes: &[usize], own: &[Own], basis: &mut Basis, pass: Pass) {
    let rank = basis.rank;
    for &w in nodes {
        let step = step(FIELDS * rank, (chunks, own), |normal, chunk, own| {
            channel(normal, (chunk, own), basis, w, pass.seed)
        });
        for (f, step) in step.chunks_exact(rank).enumerate() {
            add(&mut basis.channel, f * NW + w, rank, step, pass.step);
        }
    }
}

fn channel(normal: &mut Normal, (chunk, own): (&Chunk, &Own), basis: &Basis, w: usize, seed: u64) {
    let rank = basis.rank;
    let [views, phis, elevations] = chunk.sites;
    let mut rng = random(seed, chunk, 40 + w as u64);
    let mut z = vec![0.0; rank];
    for _ in 0..SITES {
        let draw = rng.next_u64() as usize;
        let (v, p, e) = (draw % views, (draw >> 16) % phis, (draw >> 32) % elevations);
        let (view, elevation) = (row(&own.view, v, rank), row(&own.elevation, e, rank));
        let phi = row(&basis.phi, p, rank);
        for r in 0..rank {
            z[r] = view[r] * elevation[r] * phi[r];
        }
        let site = chunk.site(v, p, e);
        let radiance = Equation::radiance(chunk, site, w, ALBEDOS[(draw >> 50) % 3]);
        let field = radiance.field(chunk, site, (draw >> 56) % FIELDS);
        for equation in [radiance, field] {
            push(normal, &equation, basis, &z);
        }
    }
}

/// Adds an equation that is linear in the channel factors of its wavelength: `z` is what they are multiplied with.
fn push(normal: &mut Normal, equation: &Equation, basis: &Basis, z: &[f32]) {
    let rank = basis.rank;
    let mut value = 0.0;
    for (f, share) in equation.share.iter().enumerate() {
        let channel = row(&basis.channel, f * NW + equation.wavelength, rank);
        let sum: f32 = channel.iter().zip(z).map(|(c, z)| c * z).sum();
        value += share * sum;
    }
    let weight = equation.robust_weight(value);
    normal.push(|column| {
        for (part, share) in column.chunks_exact_mut(rank).zip(&equation.share) {
            for (c, z) in part.iter_mut().zip(z) {
                *c = share * z * weight;
            }
        }
        (equation.target - value) * weight
    });
}

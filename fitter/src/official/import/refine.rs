//! Moves the factors to where the radiance, relative to that of the file, is right.
//!
//! Each row of a factor matrix in turn takes a damped step of linear least squares over a random selection of sites,
//! channels and albedos; errors above a few percent count linearly.

use super::fields::Fields;
use crate::decompose::{Basis, Fit, Normal, Own};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;

/// Relative errors above this count linearly.
const OUTLIER: f32 = 0.03;
/// Radiance below this share of the level counts less.
const DARK: f32 = 1e-3;
/// Root of the weight of a field by itself against that of the radiance.
const FIELD: f32 = 0.15;
/// Cosine of the angle from the sun within which sites count more, and how much their root weight is.
const AUREOLE: (f32, f32) = (0.966, 2.0);
/// Share of the weight that is spread evenly over the views instead of over solid angle.
const EVEN: f64 = 0.4;
/// Equations per channel and chunk for the factors of the channel, and per azimuth.
const DRAWS: [usize; 2] = [500, 1500];

/// What channels count: root weights.
pub type Importance = Vec<f32>;

/// One equation: Σ_f share_f · field_f = target.
struct Equation {
    channel: usize,
    share: Vec<f32>,
    target: f32,
    weight: f32,
}

struct View<'a> {
    chunk: &'a Fields,
    importance: &'a [f32],
    root_measure: Vec<f32>,
    cosines: Vec<f32>,
    rng: Pcg64Mcg,
}

impl<'a> View<'a> {
    fn new(chunk: &'a Fields, importance: &'a [f32], seed: u64) -> Self {
        let measure = chunk.sites.measure.iter();
        Self {
            chunk,
            importance,
            root_measure: measure
                .map(|m| ((1.0 - EVEN) * m + EVEN).sqrt() as f32)
                .collect(),
            cosines: chunk.sites.cosines(),
            rng: Pcg64Mcg::seed_from_u64(seed),
        }
    }

    fn draw(&mut self, most: usize) -> usize {
        (self.rng.next_u64() >> 33) as usize % most
    }

    /// The radiance of a channel at a random albedo; nothing where it is dark.
    fn radiance(&mut self, site: usize, channel: usize) -> Option<Equation> {
        let albedo = self.draw(self.chunk.albedos);
        let chunk = self.chunk;
        let radiance = chunk.radiance(site, albedo, channel);
        if radiance <= 0.0 {
            return None;
        }
        let mut share = vec![0.0; chunk.fields];
        chunk.shares(site, albedo, channel, &mut share);
        let bright = radiance.max(DARK);
        share.iter_mut().for_each(|s| *s /= bright);
        let [_, azimuths, suns] = chunk.sites.shape();
        let near = if self.cosines[site] > AUREOLE.0 {
            AUREOLE.1
        } else {
            1.0
        };
        Some(Equation {
            channel,
            share,
            target: radiance / bright,
            weight: self.root_measure[site / (azimuths * suns)] * near * self.importance[channel],
        })
    }

    /// A random field by itself.
    fn field(&mut self, of: &Equation, site: usize) -> Equation {
        let field = self.draw(self.chunk.fields);
        let mut share = vec![0.0; self.chunk.fields];
        share[field] = of.share[field];
        let value =
            self.chunk.values[site * self.chunk.width() + field * self.chunk.channels + of.channel];
        Equation {
            channel: of.channel,
            target: share[field] * value,
            share,
            weight: FIELD * of.weight,
        }
    }

    /// The radiance at three random channels, and a field.
    fn at(&mut self, site: usize) -> Vec<Equation> {
        let channels = self.chunk.channels;
        let mut out = vec![];
        for _ in 0..3 {
            let channel = self.draw(channels);
            out.extend(self.radiance(site, channel));
        }
        if let Some(first) = out.first() {
            let field = self.field(first, site);
            out.push(field);
        }
        out
    }
}

impl Equation {
    /// Σ_f share_f · channel_(f, c, r) for every r.
    fn mix(&self, basis: &Basis, channels: usize, out: &mut [f32]) {
        out.fill(0.0);
        for (f, share) in self.share.iter().enumerate() {
            if *share != 0.0 {
                let row = row(&basis.channel, f * channels + self.channel, basis.rank);
                out.iter_mut().zip(row).for_each(|(o, c)| *o += share * c);
            }
        }
    }

    /// Adds itself where it is linear in `x` with these coefficients.
    fn push(&self, normal: &mut Normal, x: &[f32], coefficients: impl Iterator<Item = f32>) {
        normal.push(|column| {
            let mut value = 0.0;
            for ((c, x), entry) in coefficients.zip(x).zip(column.iter_mut()) {
                value += c * x;
                *entry = c;
            }
            let miss = self.target - value;
            let outlier = miss / OUTLIER;
            let weight = self.weight / (1.0 + outlier * outlier).sqrt().sqrt();
            column.iter_mut().for_each(|entry| *entry *= weight);
            miss * weight
        });
    }
}

fn row(matrix: &[f32], i: usize, rank: usize) -> &[f32] {
    &matrix[i * rank..][..rank]
}

fn add(matrix: &mut [f32], i: usize, rank: usize, step: &[f32], share: f32) {
    let row = matrix[i * rank..][..rank].iter_mut();
    row.zip(step).for_each(|(x, s)| *x += share * s);
}

/// `passes` passes over all factor matrices; `progress` is told each.
pub fn refine(
    chunks: &[Fields],
    importance: &Importance,
    fit: &mut Fit,
    passes: usize,
    progress: &dyn Fn(usize),
) {
    for pass in 0..passes {
        // Whole steps see another part of the equations each and never settle; shorter ones average.
        let share = (passes as f32 / 3.0 / (pass as f32 + 1.0)).min(1.0);
        let seed = |k: usize, what: u64| (pass as u64) << 40 | what << 32 | k as u64;
        if pass + 2 < passes {
            // Those of the channels cost as much as all others.
            if pass % 2 == 0 {
                channels(chunks, importance, fit, (share, &|k| seed(k, 1)));
            }
            azimuths(chunks, importance, fit, (share, &|k| seed(k, 2)));
        }
        let basis = &fit.basis;
        let own = fit.own.par_iter_mut().zip(chunks).enumerate();
        own.for_each(|(k, (own, chunk))| {
            suns(View::new(chunk, importance, seed(k, 3)), own, basis, share);
            views(View::new(chunk, importance, seed(k, 4)), own, basis, share);
        });
        progress(pass + 1);
    }
}

fn views(mut view: View, own: &mut Own, basis: &Basis, share: f32) {
    let rank = basis.rank;
    let [_, azimuths, suns] = view.chunk.sites.shape();
    let channels = view.chunk.channels;
    let mut mixed = vec![0.0; rank];
    for v in 0..view.chunk.sites.seen {
        let mut normal = Normal::new(rank);
        let x = row(&own.view, v, rank);
        for p in 0..azimuths {
            let phi = row(&basis.phi, p, rank);
            for e in 0..suns {
                let sun = row(&own.elevation, e, rank);
                for equation in view.at(view.chunk.sites.index(v, p, e)) {
                    equation.mix(basis, channels, &mut mixed);
                    let rest = mixed.iter().zip(phi).zip(sun);
                    equation.push(&mut normal, x, rest.map(|((m, p), s)| m * p * s));
                }
            }
        }
        add(&mut own.view, v, rank, &normal.step(), share);
    }
}

fn suns(mut view: View, own: &mut Own, basis: &Basis, share: f32) {
    let rank = basis.rank;
    let [_, azimuths, suns] = view.chunk.sites.shape();
    let (views, channels) = (view.chunk.sites.seen, view.chunk.channels);
    let mut mixed = vec![0.0; rank];
    for e in 0..suns {
        let mut normal = Normal::new(rank);
        let x = row(&own.elevation, e, rank);
        for v in 0..views {
            let at = row(&own.view, v, rank);
            for p in 0..azimuths {
                let phi = row(&basis.phi, p, rank);
                for equation in view.at(view.chunk.sites.index(v, p, e)) {
                    equation.mix(basis, channels, &mut mixed);
                    let rest = mixed.iter().zip(phi).zip(at);
                    equation.push(&mut normal, x, rest.map(|((m, p), a)| m * p * a));
                }
            }
        }
        add(&mut own.elevation, e, rank, &normal.step(), share);
    }
}

/// The step to which each chunk adds its equations. Sums are taken in one order, whatever the number of threads.
fn together(
    unknowns: usize,
    (chunks, fit): (&[Fields], &Fit),
    each: impl Fn(usize, &Fields, &Own, &mut Normal) + Sync,
) -> Vec<f32> {
    let gather = |(group, part): (usize, (&[Fields], &[Own]))| {
        let mut normal = Normal::new(unknowns);
        for (i, (chunk, own)) in part.0.iter().zip(part.1).enumerate() {
            each(group * GROUP + i, chunk, own, &mut normal);
        }
        normal
    };
    let groups = chunks.par_chunks(GROUP).zip(fit.own.par_chunks(GROUP));
    let parts: Vec<Normal> = groups.enumerate().map(gather).collect();
    let whole = parts.into_iter().reduce(Normal::join);
    whole.map_or_else(|| vec![0.0; unknowns], Normal::step)
}

/// Chunks whose equations are gathered one after another.
const GROUP: usize = 3;

type Pass<'a> = (f32, &'a (dyn Fn(usize) -> u64 + Sync));

fn azimuths(chunks: &[Fields], importance: &Importance, fit: &mut Fit, (share, seed): Pass) {
    let rank = fit.basis.rank;
    for p in 0..fit.basis.phi.len() / rank {
        let step = together(rank, (chunks, fit), |k, chunk, own, normal| {
            let mut view = View::new(chunk, importance, seed(k) ^ (p as u64) << 16);
            let (views, suns) = (chunk.sites.seen, chunk.sites.suns.len());
            let mut mixed = vec![0.0; rank];
            for _ in 0..DRAWS[1] / 4 {
                let (v, e) = (view.draw(views), view.draw(suns));
                let (at, sun) = (row(&own.view, v, rank), row(&own.elevation, e, rank));
                for equation in view.at(chunk.sites.index(v, p, e)) {
                    equation.mix(&fit.basis, chunk.channels, &mut mixed);
                    let rest = mixed.iter().zip(at).zip(sun);
                    let x = row(&fit.basis.phi, p, rank);
                    equation.push(normal, x, rest.map(|((m, a), s)| m * a * s));
                }
            }
        });
        add(&mut fit.basis.phi, p, rank, &step, share);
    }
}

fn channels(chunks: &[Fields], importance: &Importance, fit: &mut Fit, (share, seed): Pass) {
    let rank = fit.basis.rank;
    let Some(first) = chunks.first() else { return };
    let (channels, fields) = (first.channels, first.fields);
    for c in 0..channels {
        let rows = |matrix: &[f32]| -> Vec<f32> {
            let rows = (0..fields).flat_map(|f| row(matrix, f * channels + c, rank));
            rows.copied().collect()
        };
        let x = rows(&fit.basis.channel);
        let step = together(fields * rank, (chunks, fit), |k, chunk, own, normal| {
            let mut view = View::new(chunk, importance, seed(k) ^ (c as u64) << 16);
            let [_, azimuths, suns] = chunk.sites.shape();
            let views = chunk.sites.seen;
            let mut z = vec![0.0; rank];
            for _ in 0..DRAWS[0] {
                let (v, p, e) = (view.draw(views), view.draw(azimuths), view.draw(suns));
                let at = [
                    row(&own.view, v, rank),
                    row(&fit.basis.phi, p, rank),
                    row(&own.elevation, e, rank),
                ];
                for (r, z) in z.iter_mut().enumerate() {
                    *z = at[0][r] * at[1][r] * at[2][r];
                }
                let site = chunk.sites.index(v, p, e);
                let Some(radiance) = view.radiance(site, c) else {
                    continue;
                };
                let field = view.field(&radiance, site);
                for equation in [radiance, field] {
                    let shares = equation.share.iter();
                    let all = shares.flat_map(|share| z.iter().map(move |z| share * z));
                    equation.push(normal, &x, all);
                }
            }
        });
        for (f, step) in step.chunks_exact(rank).enumerate() {
            add(&mut fit.basis.channel, f * channels + c, rank, step, share);
        }
    }
}

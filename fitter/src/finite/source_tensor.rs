//! The source function of multiply scattered light, from the moments of the light field to a few components.
//!
//! At a point, in a direction and under a sun, the source is `σ_R · S_R + σ_A · S_A`: what molecules and what particles
//! make of the incoming light. `S_R` depends on four numbers (the coherency tensor), `S_A` on the harmonics of the
//! radiance times those of the local mixture's phase function. Divided by a level per sun and wavelength, both are
//! smooth in every variable.

use super::modes::Tensor;
use super::weighted::{Weighted, decompose};
use crate::successive_orders::{DEGREE, Lobes, Medium, Moments, NW, PER_SPHERE, Spectrum, grid};
use crate::units::Solved;
use faer::Mat;
use grid::{ALTITUDES, COUNT, ORDERS, SUNS, TENSOR};
use rayon::prelude::*;
use welkin::format::{PhaseFunction, Ranks, SOURCE_FIELDS, SourceBasis, SourceCore};

/// Channels: field · NW + wavelength.
const CHANNELS: usize = SOURCE_FIELDS * NW;
/// How much a component of the tensor counts against a harmonic: isotropic light gives both the same share of the
/// source.
const TENSOR_WEIGHT: f64 = 4.0;
/// Up to here (m) all altitudes count alike; above, ever less.
const DENSE_AIR: f64 = 16_000.0;
/// Over this height (m) the weight falls by a factor e.
const FADING: f64 = 12_000.0;
/// A source so many times its level and brighter counts by its relative error: where the ground lies in shadow and high
/// air in the sun, and above ozone in the ultraviolet, it is a thousand times the level.
const BRIGHT: f64 = 2.0;
/// Species that a file has beside the molecules, and lobes of each that are worth it.
const MOST_PARTICLES: usize = 15;
const MOST_LOBES: usize = 3;
/// Of the decomposition.
const PASSES: usize = 12;
/// Least light that is distinguished from none, relative to the sun.
const DARKNESS: f32 = 1e-14;

/// Fits all visibilities: what they share, and the core of each.
pub fn fit(solved: &[Solved], ranks: Ranks) -> (SourceBasis, Vec<SourceCore>) {
    let (all, levels): (Vec<_>, Vec<_>) = solved.par_iter().map(normalised).unzip();
    let (bases, cores) = decompose(&all, ranks, PASSES);
    let parts = solved.iter().zip(levels).zip(cores);
    let cores = parts.map(|((one, levels), core)| packed(one, &levels, ranks, &core));
    (basis(&bases, ranks), cores.collect())
}

fn basis(bases: &[Mat<f64>; 4], ranks: Ranks) -> SourceBasis {
    let weights = mode_weights();
    let factors = std::array::from_fn(|mode| {
        let (basis, weights) = (&bases[mode], &weights[mode]);
        let row = |i: usize| (0..basis.ncols()).map(move |r| (basis[(i, r)] / weights[i]) as f32);
        (0..basis.nrows()).flat_map(row).collect()
    });
    SourceBasis {
        degree: DEGREE,
        orders: ORDERS,
        ranks,
        altitude: ALTITUDES.to_vec(),
        sun: (0..SUNS).map(grid::sun_node).collect(),
        factors,
    }
}

fn packed(solved: &Solved, levels: &Levels, ranks: Ranks, core: &Tensor) -> SourceCore {
    let species = species(&solved.medium);
    SourceCore {
        ranks,
        phase: species.iter().map(|s| s.phase).collect(),
        parameter: species.iter().flat_map(|s| s.parameter).collect(),
        scattering: species
            .iter()
            .flat_map(|s| s.scattering.iter().flatten().copied())
            .collect(),
        level: levels.iter().flatten().flatten().map(|l| l.ln()).collect(),
        core: core.values.iter().map(|&v| v as f32).collect(),
    }
}

/// Weights of the nodes of each mode in the fit.
fn mode_weights() -> [Vec<f64>; 4] {
    let altitude = |h: &f64| (-(h - DENSE_AIR).max(0.0) / FADING).exp();
    let moment = |m: usize| if m < TENSOR { TENSOR_WEIGHT } else { 1.0 };
    [
        ALTITUDES.iter().map(altitude).collect(),
        vec![1.0; SUNS],
        (0..COUNT).map(moment).collect(),
        vec![1.0; CHANNELS],
    ]
}

/// `[field][sun]`.
type Levels = [Vec<Spectrum>; SOURCE_FIELDS];

/// The tensor `[altitude][sun][moment][channel]` of the sources over their levels, times the weights of the modes, and
/// these levels.
fn normalised(solved: &Solved) -> (Weighted, Levels) {
    let fields = [&solved.light.sky, &solved.light.ground].map(|m| scattered(&solved.medium, m));
    let levels = [&fields[0], &fields[1]].map(|field| level(field));
    let [altitude, _, moment, _] = mode_weights();
    let mut values = Vec::with_capacity(ALTITUDES.len() * SUNS * COUNT * CHANNELS);
    let mut weights = Vec::with_capacity(ALTITUDES.len() * SUNS * CHANNELS);
    for i in 0..ALTITUDES.len() {
        for j in 0..SUNS {
            for (field, level) in fields.iter().zip(&levels) {
                let isotropic = isotropic(&field[i * SUNS + j]);
                let ratio = |w: usize| f64::from(isotropic[w] / level[j][w]);
                weights.extend((0..NW).map(|w| (BRIGHT / ratio(w)).min(1.0)));
            }
            for m in 0..COUNT {
                let weight = altitude[i] * moment[m];
                for (field, level) in fields.iter().zip(&levels) {
                    let value = &field[i * SUNS + j][m];
                    values.extend((0..NW).map(|w| weight * f64::from(value[w] / level[j][w])));
                }
            }
        }
    }
    let shape = [ALTITUDES.len(), SUNS, COUNT, CHANNELS];
    let tensor = Tensor { shape, values };
    (Weighted { tensor, weights }, levels)
}

/// Moments of the light field as moments of the source per unit of scattering coefficient.
fn scattered(medium: &Medium, moments: &Moments) -> Vec<[Spectrum; COUNT]> {
    let per_irradiance =
        |node: &[Spectrum; COUNT]| node.map(|m| m.map(|v| v * grid::SOLAR_UNITS.recip()));
    let mut out: Vec<_> = moments.nodes().iter().map(per_irradiance).collect();
    for (row, h) in out.chunks_exact_mut(SUNS).zip(ALTITUDES) {
        let mixture = mixture(medium, h);
        for node in row {
            molecules(medium, node);
            for (moment, degree) in node[TENSOR..].iter_mut().zip(grid::DEGREES) {
                for w in 0..NW {
                    moment[w] *= mixture[degree][w];
                }
            }
        }
    }
    out
}

/// Turns the coherency tensor of the light into that of the scattered light; depolarisation is an isotropic part.
fn molecules(medium: &Medium, node: &mut [Spectrum; COUNT]) {
    for w in 0..NW {
        let delta = medium.polarising[w];
        let trace = node[0][w] + node[1][w] + node[2][w];
        for (t, moment) in node[..TENSOR].iter_mut().enumerate() {
            let isotropic = if t < 3 {
                0.5 * (1.0 - delta) * trace
            } else {
                0.0
            };
            moment[w] = PER_SPHERE * (1.5 * delta * moment[w] + isotropic);
        }
    }
}

/// Mean of g^l over the particles at an altitude, weighted by their scattering, per degree l.
fn mixture(medium: &Medium, altitude: f64) -> Vec<Spectrum> {
    let profiles = medium.profiles(altitude);
    let mut sums = vec![[0.0; NW]; DEGREE + 1];
    for (part, p) in medium.parts.iter().zip(profiles) {
        // Where there are no particles, their mixture is that of the thinnest air.
        let share = if part.aerosols.is_empty() {
            0.0
        } else {
            p.max(1e-20)
        };
        for (sum, term) in sums.iter_mut().zip(&part.legendre) {
            for w in 0..NW {
                sum[w] += share * term[w];
            }
        }
    }
    let total = sums[0];
    for sum in &mut sums {
        for w in 0..NW {
            sum[w] = if total[w] > 0.0 {
                sum[w] / total[w]
            } else {
                0.0
            };
        }
    }
    sums
}

/// Geometric mean of the isotropic part over the altitudes where air is dense.
fn level(field: &[[Spectrum; COUNT]]) -> Vec<Spectrum> {
    let dense = ALTITUDES.iter().filter(|&&h| h <= DENSE_AIR).count();
    let mean = |j: usize, w: usize| {
        let logarithm = |i: usize| isotropic(&field[i * SUNS + j])[w].ln();
        ((0..dense).map(logarithm).sum::<f32>() / dense as f32).exp()
    };
    (0..SUNS)
        .map(|j| std::array::from_fn(|w| mean(j, w)))
        .collect()
}

/// The source that does not depend on the direction.
fn isotropic(node: &[Spectrum; COUNT]) -> Spectrum {
    std::array::from_fn(|w| (node[0][w] + node[1][w] + node[2][w]).max(DARKNESS))
}

/// A phase function with its scattering coefficient per constituent.
struct Species {
    phase: PhaseFunction,
    parameter: Spectrum,
    scattering: Vec<Spectrum>,
}

/// Molecules first, then the particles in the order of the atmosphere; those with the same phase function are one.
/// Tabulated phase functions are sums of as many Henyey-Greenstein functions as the format has place for.
fn species(medium: &Medium) -> Vec<Species> {
    let mut out: Vec<Species> = vec![Species {
        phase: PhaseFunction::Rayleigh,
        // Δ = (1 − ρ)/(1 + ρ/2) solved for ρ.
        parameter: medium
            .polarising
            .map(|d| ((1.0 - d) / (1.0 + d / 2.0)).clamp(0.0, 1.0)),
        scattering: medium.parts.iter().map(|part| part.rayleigh).collect(),
    }];
    let count = lobes_of_each(medium);
    for (k, part) in medium.parts.iter().enumerate() {
        for aerosol in &part.aerosols {
            let lobes = match &aerosol.table {
                Some(table) => &table.positive_lobes(count),
                None => &aerosol.lobes,
            };
            for lobe in lobes.iter() {
                let scattering = std::array::from_fn(|w| lobe.weight[w] * aerosol.scattering[w]);
                add_species(&mut out, medium.parts.len(), (k, lobe.g), scattering);
            }
        }
    }
    out
}

/// How many lobes there may be for each tabulated phase function.
fn lobes_of_each(medium: &Medium) -> usize {
    let mut known: Vec<&Lobes> = vec![];
    let (mut plain, mut tabulated) = (0, 0);
    for aerosol in medium.parts.iter().flat_map(|part| &part.aerosols) {
        if !known.contains(&&aerosol.lobes) {
            known.push(&aerosol.lobes);
            match aerosol.table {
                Some(_) => tabulated += 1,
                None => plain += 1,
            }
        }
    }
    let left = MOST_PARTICLES.saturating_sub(plain);
    (left / tabulated.max(1)).clamp(1, MOST_LOBES)
}

fn add_species(
    out: &mut Vec<Species>,
    parts: usize,
    (part, g): (usize, Spectrum),
    scattering: Spectrum,
) {
    let known = |s: &Species| s.phase == PhaseFunction::HenyeyGreenstein && s.parameter == g;
    let index = out.iter().position(known).unwrap_or_else(|| {
        out.push(Species {
            phase: PhaseFunction::HenyeyGreenstein,
            parameter: g,
            scattering: vec![[0.0; NW]; parts],
        });
        out.len() - 1
    });
    for (sum, s) in out[index].scattering[part].iter_mut().zip(scattering) {
        *sum += s;
    }
}

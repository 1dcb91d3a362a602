//! Bands of absorption lines as sums of exponentials, so that every term is monochromatic and can be traced exactly.
//!
//! Bird & Riordan 1984 give the mean transmittance of a band about 10 nm wide as a function of the gas along the path.
//! A sum of exponentials with weights that are not negative is fitted to that function. Absorption goes with the
//! density of the gas: that of the mixed gases with the pressure, as in their model.

use super::monochromatic::Monochromatic;
use super::table::{Curve, Table};
use crate::non_negative::least_squares;
use anyhow::Result;

/// Precipitable water above the ground in the US standard atmosphere, cm, times the longest relative path.
const MOST_WATER: f64 = 1.42 * MOST_AIR;
/// Longest path through the air, relative to the vertical one.
const MOST_AIR: f64 = 40.0;
/// Terms with less weight are left out.
const LEAST_WEIGHT: f64 = 1e-3;
/// Most terms of a band in which both gases absorb; a file may hold 64 (format specification, section 6.9).
const MOST_TERMS: usize = 48;

/// Bands that take less than this of the longest path have one term.
const WEAK: f64 = 0.01;

/// A part of a band with the same absorption.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// Share of the band.
    pub weight: f64,
    /// Its light.
    pub light: Monochromatic,
}

/// Absorption by water vapour and by the uniformly mixed gases.
pub struct AbsorptionBands {
    water: Curve,
    mixed: Curve,
}

impl AbsorptionBands {
    /// From the table in `fitter/data`.
    pub fn new() -> Result<Self> {
        let text = include_str!("../../data/absorption_bands.csv");
        let table = Table::parse("absorption_bands.csv", text)?;
        Ok(Self {
            water: table.curve("wavelength_nm", "water")?,
            mixed: table.curve("wavelength_nm", "mixed")?,
        })
    }

    /// What a band about `wavelength` (nm) is made of; one term beside all bands.
    pub fn terms(&self, wavelength: f64) -> Vec<Term> {
        let water = exponentials(self.water.at(wavelength), MOST_WATER, water_transmittance);
        let mixed = exponentials(self.mixed.at(wavelength), MOST_AIR, mixed_transmittance);
        let pairs = water.iter().flat_map(|w| mixed.iter().map(move |m| (w, m)));
        let all = pairs.map(|(water, mixed)| Term {
            weight: water.weight * mixed.weight,
            light: Monochromatic {
                wavelength,
                water: water.depth,
                mixed: mixed.depth,
            },
        });
        merged(all.collect())
    }
}

/// At most [`MOST_TERMS`]: the lightest becomes one with another, at the least cost, again and again.
fn merged(mut terms: Vec<Term>) -> Vec<Term> {
    while terms.len() > MOST_TERMS {
        let weight = |&i: &usize| terms[i].weight;
        let lightest = (0..terms.len()).min_by(|a, b| weight(a).total_cmp(&weight(b)));
        let light = terms.swap_remove(lightest.expect("terms"));
        let nearest = terms
            .iter_mut()
            .min_by(|a, b| cost(light, **a).total_cmp(&cost(light, **b)));
        nearest.expect("terms").take(light);
    }
    terms
}

/// What making one term of both costs: the more, the less their light is alike along paths of all lengths, and the
/// heavier the second is, the first being the lightest of all.
fn cost(a: Term, b: Term) -> f64 {
    let apart = |a: f64, b: f64, most: f64| {
        let [a, b] = [a, b].map(|depth| (1.0 + depth * most).ln());
        (a - b).abs()
    };
    let water = apart(a.light.water, b.light.water, MOST_WATER);
    let mixed = apart(a.light.mixed, b.light.mixed, MOST_AIR);
    b.weight * (water + mixed).powi(2)
}

impl Term {
    /// One term for both, with the mean of their absorption.
    fn take(&mut self, other: Self) {
        let weight = self.weight + other.weight;
        let mean = |mine: f64, its: f64| (self.weight * mine + other.weight * its) / weight;
        self.light.water = mean(self.light.water, other.light.water);
        self.light.mixed = mean(self.light.mixed, other.light.mixed);
        self.weight = weight;
    }
}

/// Mean transmittance of a band of water vapour; `x` = coefficient times precipitable water, cm.
pub fn water_transmittance(x: f64) -> f64 {
    (-0.2385 * x / (1.0 + 20.07 * x).powf(0.45)).exp()
}

/// Mean transmittance of a band of the mixed gases; `x` = coefficient times relative path.
pub fn mixed_transmittance(x: f64) -> f64 {
    (-1.41 * x / (1.0 + 118.3 * x).powf(0.45)).exp()
}

#[derive(Clone, Copy)]
struct Exponential {
    weight: f64,
    /// Optical depth per unit of the gas.
    depth: f64,
}

/// Weights that are not negative and depths with Σ weight · exp(−depth · gas) ≈ transmittance(coefficient · gas) for
/// gas in 0..=most.
fn exponentials(coefficient: f64, most: f64, transmittance: fn(f64) -> f64) -> Vec<Exponential> {
    const CANDIDATES: usize = 13;
    const SITES: usize = 60;
    let clear = Exponential {
        weight: 1.0,
        depth: 0.0,
    };
    let least = transmittance(coefficient * most);
    if 1.0 - least < 2e-3 {
        return vec![clear];
    }
    if 1.0 - least < WEAK {
        let typical = 0.2 * most;
        return vec![Exponential {
            weight: 1.0,
            depth: -transmittance(coefficient * typical).ln() / typical,
        }];
    }
    let spread =
        |i: usize, n: usize, from: f64, to: f64| from * (to / from).powf(i as f64 / (n - 1) as f64);
    // Depths of the longest path; with nothing at all among them.
    let depth = |j: usize| match j {
        0 => 0.0,
        j => spread(j - 1, CANDIDATES - 1, 0.04, 1e5) / most,
    };
    let site = |i: usize| spread(i, SITES, 2e-4, 1.0) * most;
    let mut rows = vec![];
    let mut wanted = vec![];
    for i in 0..SITES {
        rows.push(
            (0..CANDIDATES)
                .map(|j| (-depth(j) * site(i)).exp())
                .collect::<Vec<f64>>(),
        );
        wanted.push(transmittance(coefficient * site(i)));
    }
    // The sum of the weights, nearly exactly.
    const EXACT: f64 = 100.0;
    rows.push(vec![EXACT; CANDIDATES]);
    wanted.push(EXACT);
    let weights = least_squares(&rows, &wanted);
    let kept = weights
        .iter()
        .enumerate()
        .filter(|&(_, &w)| w > LEAST_WEIGHT);
    let kept: Vec<(usize, f64)> = kept.map(|(j, &w)| (j, w)).collect();
    let sum: f64 = kept.iter().map(|k| k.1).sum();
    kept.iter()
        .map(|&(j, weight)| Exponential {
            weight: weight / sum,
            depth: depth(j),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_exponentials_are_the_published_functions() {
        for (most, transmittance) in [
            (MOST_WATER, water_transmittance as fn(f64) -> f64),
            (MOST_AIR, mixed_transmittance),
        ] {
            for coefficient in [1e-3, 0.03, 0.4, 2.5, 27.0, 55.0, 1000.0] {
                let terms = exponentials(coefficient, most, transmittance);
                let worst = (0..200)
                    .map(|i| most * 10f64.powf(-4.0 * f64::from(i) / 199.0))
                    .map(|gas| {
                        let sum: f64 = terms
                            .iter()
                            .map(|t| t.weight * (-t.depth * gas).exp())
                            .sum();
                        (sum - transmittance(coefficient * gas)).abs()
                    })
                    .fold(0.0, f64::max);
                assert!(terms.len() <= 11, "{} terms", terms.len());
                assert!(
                    worst < 0.01,
                    "{coefficient}: {worst}, {} terms",
                    terms.len()
                );
            }
        }
    }

    /// All terms are within 0.0048 of the product of both functions here.
    #[test]
    fn where_both_gases_absorb_few_terms_do() {
        let bands = AbsorptionBands::new().unwrap();
        let along = |i: u32| 10f64.powf(-4.0 * f64::from(i) / 19.0);
        let mut most = 0;
        for wavelength in (0..141).map(|i| 1100.0 + 10.0 * f64::from(i)) {
            let terms = bands.terms(wavelength);
            most = most.max(terms.len());
            let [water, mixed] = [&bands.water, &bands.mixed].map(|c| c.at(wavelength));
            for (i, j) in (0..20).flat_map(|i| (0..20).map(move |j| (i, j))) {
                let (vapour, air) = (MOST_WATER * along(i), MOST_AIR * along(j));
                let through = |t: &Term| (-t.light.water * vapour - t.light.mixed * air).exp();
                let sum: f64 = terms.iter().map(|t| t.weight * through(t)).sum();
                let truth = water_transmittance(water * vapour) * mixed_transmittance(mixed * air);
                assert!((sum - truth).abs() < 0.0048, "{wavelength}: {sum}, {truth}");
            }
        }
        assert_eq!(most, MOST_TERMS);
    }

    #[test]
    fn most_of_the_spectrum_has_one_term() {
        let bands = AbsorptionBands::new().unwrap();
        assert_eq!(bands.terms(550.0).len(), 1);
        assert_eq!(bands.terms(860.0).len(), 1);
        let strong = bands.terms(940.0);
        assert!(strong.len() > 3 && strong.iter().all(|t| t.light.mixed == 0.0));
        assert!((strong.iter().map(|t| t.weight).sum::<f64>() - 1.0).abs() < 1e-9);
    }
}

//! The weights of all terms of all cells, from traced spectra; and how well they do.

use super::cells::Cell;
use super::training::{Training, lights};
use super::weights::{Taps, Target, floored, learn, value};
use crate::dataset::{NODES, Sample, Store};
use crate::progress::bar;
use anyhow::Result;
use rayon::prelude::*;

/// Traced spectra of one visibility.
struct Spectra {
    /// Without light of their own: where they look.
    samples: Vec<Sample>,
    /// ln L of the nodes as a reader takes it, `[sample][node]`.
    nodes: Vec<Vec<f64>>,
    /// Radiance of each term, `[term][sample]`.
    terms: Vec<Vec<f64>>,
}

/// What was learned.
pub struct Learned {
    /// The cells.
    pub cells: Vec<Cell>,
    /// Taps of the terms, cell by cell.
    pub taps: Vec<Taps>,
    /// ln L at the nodes of the skies that were learned from, `[sky][node]`.
    pub skies: Vec<Vec<f64>>,
    /// Some of them.
    pub examples: Vec<Vec<f64>>,
    /// Errors at lines of sight that were not learned from.
    pub errors: Vec<HeldOut>,
}

/// Relative error of a cell at a line of sight that was not learned from.
#[derive(Clone, Copy, Debug)]
pub struct HeldOut {
    /// Wavelength of the cell, nm.
    pub wavelength: f64,
    /// Solar elevation, rad.
    pub solar_elevation: f64,
    /// Relative error of the radiance.
    pub error: f64,
}

/// Skies that readers get as examples.
const EXAMPLES: usize = 96;
/// Darker samples teach nothing.
const DARK: f64 = 1e-13;

impl Training {
    /// Learns weights from spectra in `store`, which are traced if need be.
    pub fn learn(&self, store: &Store, cells: Vec<Cell>) -> Result<Learned> {
        let spectra = self.spectra(store, &cells)?;
        let lights = lights(&cells);
        let x = &spectra.nodes;
        let cell_of: Vec<usize> = cells
            .iter()
            .enumerate()
            .flat_map(|(c, cell)| cell.terms.iter().map(move |_| c))
            .collect();
        let weight: Vec<f64> = cells
            .iter()
            .flat_map(|c| c.terms.iter().map(|t| t.weight))
            .collect();
        let whole = sums(&cell_of, &weight, &spectra.terms, cells.len());
        // Every third sun is held out for the table of errors.
        let held_out: Vec<bool> = (0..x.len()).map(|s| s / self.counts[0] % 3 == 2).collect();
        let learned = |all: bool| -> Vec<Taps> {
            let used: Vec<usize> = (0..x.len())
                .filter(|&s| all || !held_out[s])
                .filter(|&s| whole.iter().all(|cell| cell[s] > DARK))
                .collect();
            let x: Vec<Vec<f64>> = used.iter().map(|&s| x[s].clone()).collect();
            let one = |g: usize| {
                let radiance = |s: &usize| spectra.terms[g][*s];
                let logarithm: Vec<f64> = used
                    .iter()
                    .zip(&x)
                    .map(|(s, x)| {
                        let least =
                            x.iter().copied().fold(f64::MIN, f64::max) + super::weights::FLOOR.ln();
                        radiance(s).max(f64::MIN_POSITIVE).ln().max(least)
                    })
                    .collect();
                let share = |s: &usize| weight[g] * radiance(s) / whole[cell_of[g]][*s];
                let share: Vec<f64> = used.iter().map(share).collect();
                let target = Target {
                    light: lights[g],
                    logarithm: &logarithm,
                    share: &share,
                };
                learn(&NODES, &x, &target)
            };
            (0..lights.len()).into_par_iter().map(one).collect()
        };
        let judged = learned(false);
        let errors = (0..x.len()).filter(|&s| held_out[s]).flat_map(|s| {
            let made: Vec<f64> = judged.iter().map(|taps| value(taps, &x[s]).exp()).collect();
            let mut cell = vec![0.0; cells.len()];
            for (g, l) in made.iter().enumerate() {
                cell[cell_of[g]] += weight[g] * l;
            }
            let solar_elevation = spectra.samples[s].solar_elevation;
            let (cells, whole) = (&cells, &whole);
            let lit = cell
                .into_iter()
                .enumerate()
                .filter(move |(c, _)| whole[*c][s] > DARK);
            lit.map(move |(c, l)| HeldOut {
                wavelength: cells[c].wavelength,
                solar_elevation,
                error: l / whole[c][s] - 1.0,
            })
            .collect::<Vec<_>>()
        });
        let errors = errors.collect();
        let lit = |s: &usize| whole.iter().all(|cell| cell[*s] > DARK);
        let skies: Vec<Vec<f64>> = (0..x.len()).filter(lit).map(|s| x[s].clone()).collect();
        let example = |i: usize| skies[i * skies.len() / EXAMPLES].clone();
        Ok(Learned {
            taps: learned(true),
            cells,
            examples: (0..EXAMPLES).map(example).collect(),
            skies,
            errors,
        })
    }

    /// Traces what is not in `store`.
    fn spectra(&self, store: &Store, cells: &[Cell]) -> Result<Spectra> {
        let lights = lights(cells);
        let sets = lights.len().div_ceil(NODES.len());
        let progress = bar(self.visibilities.len() * (sets + 1), "tracing spectra");
        let mut out = Spectra {
            samples: vec![],
            nodes: vec![],
            terms: vec![vec![]; lights.len()],
        };
        for &visibility in &self.visibilities {
            let nodes = self.unit(store, visibility, &NODES, &nodes_name())?;
            progress.inc(1);
            out.nodes.extend(nodes.iter().map(|s| floored(&s.radiance)));
            for set in 0..sets {
                let part = &lights[set * NODES.len()..lights.len().min((set + 1) * NODES.len())];
                let traced = self.unit(store, visibility, part, &set.to_string())?;
                for (k, _) in part.iter().enumerate() {
                    let term = &mut out.terms[set * NODES.len() + k];
                    term.extend(traced.iter().map(|s| s.radiance[k]));
                }
                progress.inc(1);
            }
            out.samples.extend(nodes);
        }
        progress.finish();
        Ok(out)
    }
}

/// Units of other nodes have other names.
fn nodes_name() -> String {
    format!("nodes-{:08x}", crc32fast::hash(format!("{NODES:?}").as_bytes()))
}

/// Radiance of the cells, `[cell][sample]`.
fn sums(cell_of: &[usize], weight: &[f64], terms: &[Vec<f64>], cells: usize) -> Vec<Vec<f64>> {
    let mut out = vec![vec![0.0; terms[0].len()]; cells];
    for ((&cell, w), term) in cell_of.iter().zip(weight).zip(terms) {
        out[cell]
            .iter_mut()
            .zip(term)
            .for_each(|(sum, l)| *sum += w * l);
    }
    out
}

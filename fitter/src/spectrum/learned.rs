//! The weights of all terms of all cells, from traced spectra; and how well they do.

use super::cells::Cell;
use super::thinned::{needed, strong};
use super::training::{TOGETHER, Training, guarded, lights};
use super::weights::{FLOOR, Taps, Target, floored, learn, value};
use crate::air::Air;
use crate::assess::Quantiles;
use crate::atmosphere::Monochromatic;
use crate::dataset::{Coverage, Sample, Store};
use crate::progress::stage;
use crate::successive_orders::NW;
use anyhow::Result;
use rayon::prelude::*;

/// What was learned.
pub struct Learned {
    /// The cells that readers need.
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
const EXAMPLES: usize = 64;
/// Darker samples teach nothing.
const DARK: f64 = 1e-13;

/// Traced spectra, ready to be learned from.
pub struct Lesson {
    coverage: Coverage,
    cells: Vec<Cell>,
    lights: Vec<Monochromatic>,
    /// Weight of each term, and the cell that it belongs to.
    terms: Vec<(f64, usize)>,
    /// Without light of their own: where they look.
    samples: Vec<Sample>,
    /// ln L of the nodes as a reader takes it, `[sample][node]`.
    nodes: Vec<Vec<f64>>,
    /// Radiance of each term, `[term][sample]`.
    radiance: Vec<Vec<f64>>,
    /// Radiance of each cell, `[cell][sample]`.
    whole: Vec<Vec<f64>>,
    /// Every third sun is held out.
    held_out: Vec<bool>,
}

impl Training {
    /// Spectra from `store`, which are traced if need be.
    pub fn lesson(
        &self,
        store: &Store,
        (air, coverage): (&Air, &Coverage),
        cells: Vec<Cell>,
    ) -> Result<Lesson> {
        let name = nodes_name(coverage);
        let lights = lights(&cells);
        let sets = lights.len().div_ceil(TOGETHER);
        let progress = stage(self.visibilities.len() * (sets + 1), "tracing spectra");
        let (mut samples, mut nodes) = (vec![], vec![]);
        let mut radiance = vec![vec![]; lights.len()];
        for &visibility in &self.visibilities {
            let traced = self.unit(store, (air, visibility), &coverage.nodes, &name)?;
            progress.inc(1);
            nodes.extend(traced.iter().map(|s| floored(&s.radiance)));
            samples.extend(traced);
            for (set, part) in lights.chunks(TOGETHER).enumerate() {
                let part = guarded(part, coverage);
                let traced = self.unit(store, (air, visibility), &part, &set.to_string())?;
                for (k, term) in radiance[set * TOGETHER..]
                    .iter_mut()
                    .take(TOGETHER)
                    .enumerate()
                {
                    term.extend(traced.iter().map(|s| s.radiance[k]));
                }
                progress.inc(1);
            }
        }
        progress.finish();
        let of_cell = |(c, cell): (usize, &Cell)| {
            cell.terms
                .iter()
                .map(move |t| (t.weight, c))
                .collect::<Vec<_>>()
        };
        let terms: Vec<(f64, usize)> = cells.iter().enumerate().flat_map(of_cell).collect();
        Ok(Lesson {
            coverage: *coverage,
            whole: sums(&terms, &radiance, cells.len()),
            held_out: (0..samples.len())
                .map(|s| s / self.counts[0] % 3 == 2)
                .collect(),
            cells,
            lights,
            terms,
            samples,
            nodes,
            radiance,
        })
    }
}

impl Lesson {
    /// Learns from everything; errors are those of learning without what is held out.
    pub fn learn(self) -> Learned {
        let all: Vec<usize> = (0..NW).collect();
        let errors = self.errors(&all);
        let used = self.used(|_| true);
        let taps = self.taps(&all, &used);
        let skies: Vec<Vec<f64>> = used.iter().map(|&s| self.nodes[s].clone()).collect();
        let example = |i: usize| skies[i * skies.len() / EXAMPLES].clone();
        let kept = self.needed(&used);
        let mut taps = taps.into_iter();
        let cells = self.cells.into_iter().map(|cell| {
            let taps: Vec<Taps> = taps.by_ref().take(cell.terms.len()).collect();
            without_weak(cell, taps)
        });
        let kept = cells.enumerate().filter(|(c, _)| kept.contains(c));
        let (cells, taps): (Vec<_>, Vec<_>) = kept.map(|(_, cell)| cell).unzip();
        Learned {
            taps: taps.concat(),
            examples: (0..EXAMPLES).map(example).collect(),
            skies,
            errors,
            cells,
        }
    }

    /// Indices of the cells that do not lie between their neighbours.
    fn needed(&self, used: &[usize]) -> Vec<usize> {
        let wavelengths: Vec<f64> = self.cells.iter().map(|c| c.wavelength).collect();
        let logarithms = |cell: &Vec<f64>| used.iter().map(|&s| cell[s].ln()).collect();
        let logarithms: Vec<Vec<f64>> = self.whole.iter().map(logarithms).collect();
        needed(&wavelengths, &logarithms)
    }

    /// Errors at what is held out if these nodes are all there is.
    pub fn errors(&self, nodes: &[usize]) -> Vec<HeldOut> {
        let taps = self.taps(nodes, &self.used(|s| !self.held_out[s]));
        let judged: Vec<usize> = (0..self.samples.len())
            .filter(|&s| self.held_out[s])
            .collect();
        let one = |&s: &usize| {
            let mut made = vec![0.0; self.cells.len()];
            for (&(weight, cell), taps) in self.terms.iter().zip(&taps) {
                made[cell] += weight * value(taps, &self.nodes[s]).exp();
            }
            let lit = made
                .into_iter()
                .enumerate()
                .filter(|&(c, _)| self.whole[c][s] > DARK);
            lit.map(|(c, l)| HeldOut {
                wavelength: self.cells[c].wavelength,
                solar_elevation: self.samples[s].solar_elevation,
                error: l / self.whole[c][s] - 1.0,
            })
            .collect::<Vec<_>>()
        };
        judged.par_iter().flat_map_iter(one).collect()
    }

    /// The nodes without the one that is used least, beside all lines and at the ends not to be missed.
    pub fn without_least(&self, nodes: &[usize]) -> Vec<usize> {
        let taps = self.taps(nodes, &self.used(|s| !self.held_out[s]));
        let use_of = |n: usize| -> f64 {
            let terms = self.terms.iter().zip(&taps);
            let shares = terms.map(|(&(weight, _), taps)| {
                let mine = taps.iter().filter(|t| t.0 == n);
                weight * mine.map(|t| t.1.abs()).sum::<f64>()
            });
            shares.sum()
        };
        let least = nodes
            .iter()
            .copied()
            .min_by(|&a, &b| use_of(a).total_cmp(&use_of(b)));
        nodes
            .iter()
            .copied()
            .filter(|&n| Some(n) != least)
            .collect()
    }

    /// Samples in which all cells are lit.
    fn used(&self, wanted: impl Fn(usize) -> bool) -> Vec<usize> {
        let lit = |s: &usize| self.whole.iter().all(|cell| cell[*s] > DARK);
        (0..self.samples.len())
            .filter(|&s| wanted(s))
            .filter(lit)
            .collect()
    }

    /// Taps of all terms, learned from the samples `used`.
    fn taps(&self, nodes: &[usize], used: &[usize]) -> Vec<Taps> {
        let lights: Vec<Monochromatic> = nodes.iter().map(|&n| self.coverage.nodes[n]).collect();
        let pick = |&s: &usize| nodes.iter().map(|&n| self.nodes[s][n]).collect();
        let x: Vec<Vec<f64>> = used.iter().map(pick).collect();
        let one = |g: usize| {
            let (weight, cell) = self.terms[g];
            let radiance = |s: &usize| self.radiance[g][*s];
            let brightest = |x: &Vec<f64>| x.iter().copied().fold(f64::MIN, f64::max);
            let logarithm = |(s, x): (&usize, &Vec<f64>)| {
                let least = brightest(x) + FLOOR.ln();
                radiance(s).max(f64::MIN_POSITIVE).ln().max(least)
            };
            let logarithm: Vec<f64> = used.iter().zip(&x).map(logarithm).collect();
            let share = |s: &usize| weight * radiance(s) / self.whole[cell][*s];
            let share: Vec<f64> = used.iter().map(share).collect();
            let target = Target {
                light: self.lights[g],
                logarithm: &logarithm,
                share: &share,
            };
            let taps = learn(&lights, &x, &target);
            taps.into_iter().map(|(n, w)| (nodes[n], w)).collect()
        };
        (0..self.terms.len()).into_par_iter().map(one).collect()
    }
}

/// Without the terms that count for nothing; the others make up for them.
fn without_weak(cell: Cell, taps: Vec<Taps>) -> (Cell, Vec<Taps>) {
    let weights: Vec<f64> = cell.terms.iter().map(|t| t.weight).collect();
    let kept = strong(&weights);
    let pairs = cell.terms.into_iter().zip(taps).zip(kept);
    let (mut terms, taps): (Vec<_>, Vec<_>) = pairs
        .filter(|(_, kept)| *kept)
        .map(|(pair, _)| pair)
        .unzip();
    let left: f64 = terms.iter().map(|t| t.weight).sum();
    let whole: f64 = weights.iter().sum();
    terms.iter_mut().for_each(|t| t.weight *= whole / left);
    let wavelength = cell.wavelength;
    (Cell { wavelength, terms }, taps)
}

/// Units of other nodes have other names.
fn nodes_name(coverage: &Coverage) -> String {
    format!(
        "nodes-{:08x}",
        crc32fast::hash(format!("{:?}", coverage.nodes).as_bytes())
    )
}

/// Radiance of the cells, `[cell][sample]`.
fn sums(terms: &[(f64, usize)], radiance: &[Vec<f64>], cells: usize) -> Vec<Vec<f64>> {
    let mut out = vec![vec![0.0; radiance[0].len()]; cells];
    for (&(weight, cell), term) in terms.iter().zip(radiance) {
        out[cell]
            .iter_mut()
            .zip(term)
            .for_each(|(sum, l)| *sum += weight * l);
    }
    out
}

/// Quantiles of errors by 20 nm, as CSV.
pub fn held_out_table(errors: &[HeldOut]) -> String {
    let mut out = String::from(
        "from_nm,to_nm,day_median,day_p95,day_p99,twilight_median,twilight_p95,twilight_p99\n",
    );
    let wavelengths = || errors.iter().map(|e| e.wavelength);
    let last = wavelengths().fold(0.0, f64::max);
    let mut from = wavelengths().fold(f64::MAX, f64::min);
    while from < last {
        let cells = quantiles(errors, [from, from + BAND]).map(|v| format!("{v:.5}"));
        out += &format!("{from},{},{}\n", from + BAND, cells.join(","));
        from += BAND;
    }
    out
}

/// Width of the bands of the table, nm.
const BAND: f64 = 20.0;

/// Median, p95 and p99 by day, then in twilight, of the errors from one wavelength to another (nm).
pub fn quantiles(errors: &[HeldOut], [from, to]: [f64; 2]) -> [f64; 6] {
    let class = |day: bool| {
        let band = errors.iter().filter(|e| (from..to).contains(&e.wavelength));
        let band = band.filter(|e| (e.solar_elevation > 0.0) == day);
        let found = Quantiles::of(band.map(|e| e.error.abs()));
        found.map_or([f64::NAN; 3], |q| [q.median, q.p95, q.p99])
    };
    let ([a, b, c], [d, e, f]) = (class(true), class(false));
    [a, b, c, d, e, f]
}

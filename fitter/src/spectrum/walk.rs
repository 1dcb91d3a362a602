//! A walk over wavelengths between nodes and cells: traced light that a model is judged by.

use super::cells::Cell;
use super::training::{SUNS, lights};
use crate::air::Air;
use crate::atmosphere::absorption_bands::AbsorptionBands;
use crate::dataset::{Sample, Store, truth};
use crate::finite::study::{Case, cases};
use crate::progress::bar;
use crate::successive_orders::ray_points::trace;
use crate::successive_orders::{Gatherer, Medium, NW, SOLAR_ANGULAR_RADIUS, Settings, solve};
use crate::units::Solved;
use anyhow::{Context, Result};
use rayon::prelude::*;
use std::cell::LazyCell;

/// What is walked over.
#[derive(Clone, Debug)]
pub struct Walk {
    /// Visibility, m.
    pub visibility: f64,
    /// Altitudes of the observers, m.
    pub altitudes: Vec<f64>,
    /// View directions per altitude, and suns that they all have.
    pub counts: [usize; 2],
    /// Finite segments.
    pub segments: usize,
    /// nm.
    pub wavelengths: Vec<f64>,
}

/// Traced light of a walk.
pub struct Traced {
    /// Lines of sight, without light.
    pub samples: Vec<Sample>,
    /// Segments.
    pub cases: Vec<Case>,
    /// I, Q, U per unit of solar irradiance, `[wavelength][sample]`.
    pub stokes: Vec<Vec<[f64; 3]>>,
    /// I, Q, U and transmittance of the segments, `[wavelength][case]`.
    pub segments: Vec<Vec<[f64; 4]>>,
}

/// Seed of lines of sight and segments: neither trained nor fitted with.
const SEED: u64 = 16;

impl Walk {
    /// Traces the walk through some air as finely as a model, keeping units in `store`.
    pub fn trace(&self, store: &Store, air: &Air) -> Result<Traced> {
        let bands = AbsorptionBands::new()?;
        let cell = |&wavelength: &f64| Cell {
            wavelength,
            terms: bands.terms(wavelength),
        };
        let cells: Vec<Cell> = self.wavelengths.iter().map(cell).collect();
        let lights = lights(&cells);
        let sets = lights.len().div_ceil(NW);
        let progress = bar(sets, "walking over wavelengths");
        let mut out = Traced {
            samples: vec![],
            cases: vec![],
            stokes: vec![],
            segments: vec![],
        };
        let mut terms = vec![];
        for set in 0..sets {
            let mut part = lights[set * NW..lights.len().min((set + 1) * NW)].to_vec();
            let count = part.len();
            part.resize(NW, *part.last().context("no lights")?);
            let medium = Medium::new(air.at(self.visibility, &part)?, SOLAR_ANGULAR_RADIUS)?;
            let (samples, cases, segments) = self.set(store, medium, set)?;
            for w in 0..count {
                let [q, u] = [0, 1].map(|c| move |s: &Sample| s.polarisation[c][w]);
                let sky = samples
                    .iter()
                    .map(|s| [s.radiance[w], q(s), u(s)])
                    .collect();
                let air = segments
                    .iter()
                    .map(|s| [0, 1, 2, 3].map(|c| s[c][w]))
                    .collect();
                terms.push((sky, air));
            }
            (out.samples, out.cases) = (samples, cases);
            progress.inc(1);
        }
        progress.finish();
        let mut terms = terms.into_iter();
        for cell in &cells {
            let parts: Vec<_> = terms.by_ref().take(cell.terms.len()).collect();
            let weights: Vec<f64> = cell.terms.iter().map(|t| t.weight).collect();
            let skies = parts.iter().map(|p| &p.0);
            out.stokes.push(mean(&weights, skies));
            out.segments
                .push(mean(&weights, parts.iter().map(|p| &p.1)));
        }
        Ok(out)
    }

    /// Lines of sight and segments with the light of one set.
    fn set(&self, store: &Store, medium: Medium, set: usize) -> Result<Set> {
        let solved = LazyCell::new(|| {
            let light = solve(&medium, Settings::default(), &|_| {});
            Solved {
                visibility: self.visibility,
                medium,
                light,
            }
        });
        let sky = store.unit(&format!("walk-{}-{set}", self.visibility), || {
            let solved = &*solved;
            let gatherer = Gatherer::new(&solved.medium, &solved.light, 1.0);
            let one = |&h: &f64| {
                let (counts, seed) = (self.counts, SEED + h as u64);
                truth(&gatherer, &solved.light, (h, SUNS), counts, seed)
            };
            let samples: Vec<Sample> = self.altitudes.iter().flat_map(one).collect();
            Ok(samples.iter().flat_map(Sample::to_values).collect())
        })?;
        let highest = self.altitudes.iter().copied().fold(0.0, f64::max);
        let segments = store.unit(&format!("walk-segments-{}-{set}", self.visibility), || {
            let solved = std::slice::from_ref(&*solved);
            let cases = cases(solved, self.segments, highest, SEED)?;
            let one = |case: &Case| segment(case, &solved[0]);
            Ok(cases.par_iter().flat_map_iter(one).collect())
        })?;
        let rows = segments.chunks_exact(SEGMENT);
        let (cases, light) = rows.map(from_row).unzip();
        Ok((Sample::from_values(&sky), cases, light))
    }
}

/// Samples, cases, and I, Q, U, T of the cases.
type Set = (Vec<Sample>, Vec<Case>, Vec<[[f64; NW]; 4]>);

/// Length of a segment in a file.
const SEGMENT: usize = 6 + 4 * NW;

fn segment(case: &Case, solved: &Solved) -> Vec<f32> {
    let mu = case.direction[0].sin();
    let path = trace(&solved.medium, case.altitude, mu, case.length, false, 1.0);
    let [i, q, u] = case.truth(solved);
    let [elevation, azimuth] = case.direction;
    let place = [
        case.altitude,
        elevation,
        azimuth,
        case.length,
        case.sun,
        case.albedo,
    ];
    let light = [i, q, u, path.transmittance];
    place
        .iter()
        .map(|&v| v as f32)
        .chain(light.into_iter().flatten())
        .collect()
}

fn from_row(row: &[f32]) -> (Case, [[f64; NW]; 4]) {
    let v: Vec<f64> = row.iter().copied().map(f64::from).collect();
    let case = Case {
        visibility: 0,
        altitude: v[0],
        direction: [v[1], v[2]],
        length: v[3],
        sun: v[4],
        albedo: v[5],
    };
    let light = std::array::from_fn(|c| std::array::from_fn(|w| v[6 + c * NW + w]));
    (case, light)
}

/// Weighted mean of rows of equal length.
fn mean<'a, const N: usize>(
    weights: &[f64],
    rows: impl Iterator<Item = &'a Vec<[f64; N]>>,
) -> Vec<[f64; N]> {
    let mut out: Vec<[f64; N]> = vec![];
    for (w, row) in weights.iter().zip(rows) {
        out.resize(row.len(), [0.0; N]);
        for (sum, value) in out.iter_mut().zip(row) {
            for c in 0..N {
                sum[c] += w * value[c];
            }
        }
    }
    out
}

//! What a model file holds of a spectrum.

use super::cells::{Cell, cells};
use super::colour::{self, Observer};
use super::learned::{Learned, Lesson};
use super::of_default::of_default;
use super::packed::{Packed, lines};
use super::training::Training;
use super::weights::TAPS;
use crate::air::Air;
use crate::atmosphere::Monochromatic;
use crate::dataset::Store;
use crate::units::{Between, Plan, Solved};
use anyhow::{Result, bail};
use std::path::Path;
use welkin::format::Spectrum;

/// What lies between the nodes of a model, if anything: learned from traced spectra, which are kept in the folder `work`,
/// or as in the default model.
pub fn pack(plan: &Plan, work: &Path, solved: &[Solved]) -> Result<Option<Packed>> {
    let visibilities: Vec<f64> = solved.iter().map(|s| s.visibility).collect();
    let mut packed = match &plan.between {
        Between::Learned(training) => learned(plan, training, work)?,
        Between::Default => of_default(plan, work, solved)?,
        Between::Nothing => return Ok(None),
    };
    let spectrum = &mut packed.spectrum;
    for &visibility in &visibilities {
        let beside = beside_lines(&plan.air, visibility, &spectrum.wavelength)?;
        let row = beside.into_iter().flatten().map(|k| k as f32);
        spectrum.extinction.extend(row);
    }
    for light in &packed.lights {
        let lines = lines(&plan.air, visibilities[0], *light)?;
        let row = lines.into_iter().map(|k| k as f32);
        spectrum.term_extinction.extend(row);
    }
    Ok(Some(packed))
}

fn learned(plan: &Plan, training: &Training, work: &Path) -> Result<Packed> {
    let learned = lesson_of(plan, training, work)?.learn();
    let cells = &learned.cells;
    let mut spectrum = Spectrum {
        taps: TAPS,
        wavelength: cells.iter().map(|c| c.wavelength).collect(),
        first_term: first_terms(cells),
        example: learned
            .examples
            .iter()
            .flatten()
            .map(|&l| l as f32)
            .collect(),
        ..Spectrum::default()
    };
    let terms = || cells.iter().flat_map(|c| &c.terms);
    for (term, taps) in terms().zip(&learned.taps) {
        spectrum.term_weight.push(term.weight as f32);
        for t in 0..TAPS {
            let (node, weight) = taps.get(t).copied().unwrap_or((0, 0.0));
            spectrum.tap_node.push(node as u32);
            spectrum.tap_weight.push(weight as f32);
        }
    }
    Ok(Packed {
        xyz: colour_weights(&learned, &plan.coverage.nodes)?,
        lights: terms().map(|t| t.light).collect(),
        spectrum,
    })
}

/// Spectra of all visibilities that are learned from.
pub fn lesson(plan: &Plan, work: &Path) -> Result<Lesson> {
    match &plan.between {
        Between::Learned(training) => lesson_of(plan, training, work),
        _ => bail!("a model of this kind learns nothing"),
    }
}

fn lesson_of(plan: &Plan, training: &Training, work: &Path) -> Result<Lesson> {
    let cells = cells(&plan.coverage)?;
    let store = Store::open(work, training.key(&cells, &plan.air))?;
    training.lesson(&store, (&plan.air, &plan.coverage), cells)
}

fn first_terms(cells: &[Cell]) -> Vec<u32> {
    let mut sum = 0;
    let ends = cells.iter().map(|c| {
        sum += c.terms.len() as u32;
        sum
    });
    std::iter::once(0).chain(ends).collect()
}

/// Extinction without lines, `[constituent][cell]`, m⁻¹.
fn beside_lines(air: &Air, visibility: f64, cells: &[f64]) -> Result<Vec<Vec<f64>>> {
    let light = |&nm: &f64| Monochromatic::beside_lines(nm);
    let lights: Vec<Monochromatic> = cells.iter().map(light).collect();
    let air = air.at(visibility, &lights)?;
    Ok(air.constituents.into_iter().map(|c| c.extinction).collect())
}

/// Fitted to the examples, whose spectra the taps make. Light that eyes do not see, or that gases absorb, has no weight, so
/// that colours need few nodes.
fn colour_weights(learned: &Learned, nodes: &[Monochromatic]) -> Result<Vec<[f64; 3]>> {
    let seen = |n: &usize| nodes[*n].is_beside_lines() && colour::sees(nodes[*n].wavelength);
    let seen: Vec<usize> = (0..nodes.len()).filter(seen).collect();
    let mut out = vec![[0.0; 3]; nodes.len()];
    let mut taps = learned.taps.iter();
    let terms: Vec<Vec<_>> = learned
        .cells
        .iter()
        .map(|c| {
            c.terms
                .iter()
                .map(|t| t.weight)
                .zip(taps.by_ref())
                .collect()
        })
        .collect();
    let cells: Vec<Vec<f64>> = learned
        .skies
        .iter()
        .map(|nodes| colour::logarithms(&terms, nodes))
        .collect();
    let wavelengths: Vec<f64> = learned.cells.iter().map(|c| c.wavelength).collect();
    let nodes: Vec<Vec<f64>> = learned
        .skies
        .iter()
        .map(|sky| seen.iter().map(|&n| sky[n].exp()).collect())
        .collect();
    let weights = colour::weights(&Observer::new()?, &wavelengths, &cells, &nodes);
    for (n, weights) in seen.into_iter().zip(weights) {
        out[n] = weights;
    }
    Ok(out)
}

//! What a model file holds of a spectrum.

use super::cells::{Cell, cells};
use super::colour::{self, Observer};
use super::learned::{Learned, Lesson};
use super::weights::TAPS;
use crate::atmosphere::{Monochromatic, Particles, real_at};
use crate::dataset::Store;
use crate::units::Plan;
use crate::units::Solved;
use anyhow::Result;
use std::path::Path;
use welkin::format::Spectrum;

/// The spectrum and the colour weights of a model.
pub struct Packed {
    /// The payload of its chunk.
    pub spectrum: Spectrum,
    /// XYZ per unit of relative radiance at each node.
    pub xyz: Vec<[f64; 3]>,
}

/// Learns what lies between the nodes, keeping traced spectra in the folder `work`, for the visibilities of `solved`.
pub fn pack(plan: &Plan, work: &Path, solved: &[Solved]) -> Result<Packed> {
    let learned = lesson(plan, work)?.learn();
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
    for solved in solved {
        let beside = beside_lines(solved.visibility, cells)?;
        spectrum
            .extinction
            .extend(beside.into_iter().flatten().map(|k| k as f32));
    }
    let terms = cells.iter().flat_map(|c| &c.terms).zip(&learned.taps);
    for (term, taps) in terms {
        spectrum.term_weight.push(term.weight as f32);
        let lines = lines(solved[0].visibility, term.light)?;
        spectrum
            .term_extinction
            .extend(lines.into_iter().map(|k| k as f32));
        for t in 0..TAPS {
            let (node, weight) = taps.get(t).copied().unwrap_or((0, 0.0));
            spectrum.tap_node.push(node as u32);
            spectrum.tap_weight.push(weight as f32);
        }
    }
    let xyz = colour_weights(&learned, &plan.coverage.nodes)?;
    Ok(Packed { spectrum, xyz })
}

/// Spectra of all visibilities that are learned from.
pub fn lesson(plan: &Plan, work: &Path) -> Result<Lesson> {
    let cells = cells(&plan.coverage)?;
    let store = Store::open(work, plan.training.key(&cells))?;
    plan.training.lesson(&store, &plan.coverage, cells)
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
fn beside_lines(visibility: f64, cells: &[Cell]) -> Result<Vec<Vec<f64>>> {
    let light = |c: &Cell| Monochromatic::beside_lines(c.wavelength);
    let lights: Vec<Monochromatic> = cells.iter().map(light).collect();
    let air = real_at(visibility, &lights, Particles::HenyeyGreenstein)?;
    Ok(air.constituents.into_iter().map(|c| c.extinction).collect())
}

/// What lines add to the extinction of each constituent, m⁻¹.
fn lines(visibility: f64, light: Monochromatic) -> Result<Vec<f64>> {
    let pair = [light, Monochromatic::beside_lines(light.wavelength)];
    let air = real_at(visibility, &pair, Particles::HenyeyGreenstein)?;
    let added = air
        .constituents
        .iter()
        .map(|c| (c.extinction[0] - c.extinction[1]).max(0.0));
    Ok(added.collect())
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

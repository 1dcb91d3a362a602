//! What lies between the nodes of the default model, for other air: how its wavelengths depend on each other is much the
//! same, and need not be learned anew.

use super::packed::{Packed, lines};
use super::weights::floored;
use crate::air::Air;
use crate::atmosphere::{Monochromatic, VISIBILITIES};
use crate::units::{Plan, Solved};
use anyhow::{Context, Result, ensure};
use std::path::Path;
use welkin::DEFAULT_MODEL;
use welkin::format::{Payload, Spectrum, unpack};

/// Skies that readers get as examples.
const EXAMPLES: usize = 64;

/// The spectrum of the default model without any extinction, with examples from the air of `plan`.
pub fn of_default(plan: &Plan, work: &Path, solved: &[Solved]) -> Result<Packed> {
    let (head, chunks) = unpack(DEFAULT_MODEL)?;
    ensure!(
        head.wavelengths == plan.coverage.wavelengths(),
        "the default model has other nodes of the wavelength"
    );
    let spectrum = chunks.into_iter().find_map(|chunk| match chunk.payload {
        Payload::Spectrum(spectrum) => Some(spectrum),
        _ => None,
    });
    let spectrum = spectrum.context("the default model has no spectrum")?;
    Ok(Packed {
        xyz: head.xyz,
        lights: lights(&spectrum, head.constituents)?,
        spectrum: Spectrum {
            extinction: vec![],
            term_extinction: vec![],
            example: examples(plan, work, solved)?,
            ..spectrum
        },
    })
}

/// The light of each term, from what it adds to the extinction of the gases.
fn lights(spectrum: &Spectrum, constituents: usize) -> Result<Vec<Monochromatic>> {
    let air = |light| lines(&Air::Continental, VISIBILITIES[0], light);
    let rows = spectrum.term_extinction.chunks_exact(constituents);
    let ends = spectrum.first_term.windows(2);
    let wavelengths = spectrum.wavelength.iter().zip(ends);
    let wavelengths = wavelengths.flat_map(|(&nm, end)| (end[0]..end[1]).map(move |_| nm));
    let one = |(wavelength, row): (f64, &[f32])| {
        let [water, mixed] = [
            Monochromatic::vapour(wavelength, 1.0),
            Monochromatic::mixed(wavelength, 1.0),
        ]
        .map(air);
        let depth = |unit: Vec<f64>| {
            let found = row.iter().zip(unit).find(|(_, unit)| *unit > 0.0);
            found.map_or(0.0, |(&k, unit)| f64::from(k) / unit)
        };
        Ok(Monochromatic {
            wavelength,
            water: depth(water?),
            mixed: depth(mixed?),
        })
    };
    wavelengths.zip(rows).map(one).collect()
}

/// ln L at the nodes of some held-out skies.
fn examples(plan: &Plan, work: &Path, solved: &[Solved]) -> Result<Vec<f32>> {
    let store = plan.store(work)?;
    let mut lit = vec![];
    for s in solved {
        for &altitude in &plan.grid.altitudes {
            let samples = plan.held_out(&store, s, altitude)?;
            let all_lit = samples
                .iter()
                .filter(|s| s.radiance.iter().all(|&l| l > 0.0));
            lit.extend(all_lit.map(|s| floored(&s.radiance)));
        }
    }
    let count = EXAMPLES.min(lit.len());
    let chosen = (0..count).map(|i| &lit[i * lit.len() / count]);
    Ok(chosen.flatten().map(|&l| l as f32).collect())
}

#[cfg(test)]
mod tests {
    use super::super::cells::cells;
    use super::*;
    use crate::dataset::VISIBLE;

    /// Against the bands that they come from.
    #[test]
    fn terms_have_their_light_again() {
        let (head, chunks) = unpack(DEFAULT_MODEL).unwrap();
        let spectrum = chunks.iter().find_map(|chunk| match &chunk.payload {
            Payload::Spectrum(spectrum) => Some(spectrum),
            _ => None,
        });
        let spectrum = spectrum.unwrap();
        let lights = lights(spectrum, head.constituents).unwrap();
        assert_eq!(lights.len(), spectrum.term_weight.len());
        let known: Vec<Monochromatic> = cells(&VISIBLE)
            .unwrap()
            .iter()
            .flat_map(|cell| cell.terms.iter().map(|t| t.light))
            .collect();
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-5 * b.abs();
        for light in lights {
            let same = |k: &&Monochromatic| {
                k.wavelength == light.wavelength
                    && near(light.water, k.water)
                    && near(light.mixed, k.mixed)
            };
            assert!(known.iter().any(|k| same(&k)), "{light:?}");
        }
    }
}

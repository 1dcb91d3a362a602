//! The wavelengths that weights are learned for.

use crate::atmosphere::absorption_bands::{AbsorptionBands, Term};
use crate::dataset::Coverage;
use anyhow::Result;

/// A wavelength, and what the band about it is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// nm.
    pub wavelength: f64,
    /// Of weights that add up to 1.
    pub terms: Vec<Term>,
}

/// The cells of a model.
pub fn cells(coverage: &Coverage) -> Result<Vec<Cell>> {
    let bands = AbsorptionBands::new()?;
    let steps = coverage.steps.iter().flat_map(|&(from, to, step)| {
        let n = ((to - from) / step).round() as usize;
        (0..n).map(move |i| from + step * i as f64)
    });
    let wavelengths = steps.chain([coverage.range()[1]]);
    Ok(wavelengths
        .map(|wavelength| Cell {
            wavelength,
            terms: bands.terms(wavelength),
        })
        .collect())
}

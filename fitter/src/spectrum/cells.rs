//! The wavelengths that weights are learned for.

use crate::atmosphere::absorption_bands::{AbsorptionBands, Term};
use anyhow::Result;

/// A wavelength, and what the band about it is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// nm.
    pub wavelength: f64,
    /// Of weights that add up to 1.
    pub terms: Vec<Term>,
}

/// Ranges of wavelengths (nm) and the steps in them: ozone bends on the scale of a nanometre below 345 nm, absorption
/// bands of the air on that of their data.
const STEPS: [(f64, f64, f64); 4] = [
    (300.0, 345.0, 1.0),
    (345.0, 680.0, 5.0),
    (680.0, 780.0, 2.5),
    (780.0, 1100.0, 5.0),
];

/// The cells of a model, 300..1100 nm.
pub fn cells() -> Result<Vec<Cell>> {
    let bands = AbsorptionBands::new()?;
    let steps = STEPS.iter().flat_map(|&(from, to, step)| {
        let n = ((to - from) / step).round() as usize;
        (0..n).map(move |i| from + step * i as f64)
    });
    let wavelengths = steps.chain([STEPS[STEPS.len() - 1].1]);
    Ok(wavelengths
        .map(|wavelength| Cell {
            wavelength,
            terms: bands.terms(wavelength),
        })
        .collect())
}

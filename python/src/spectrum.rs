//! Light at any wavelengths from light at the nodes of a model.

use pyo3::prelude::*;
use welkin::{Result, SpectralInterpolation};

use crate::arrays;
use crate::errors::out_of_range;

/// Wavelengths that are asked of every row, and the rule that makes their light of the nodes'.
pub struct Spectrum<'a> {
    rule: &'a SpectralInterpolation,
    /// Each with the factor that makes relative radiance what is wanted.
    asked: Vec<(f64, f64)>,
}

impl<'a> Spectrum<'a> {
    /// Wavelengths (nm), a number or an array (K,), that are in the range of the model.
    pub fn read(
        rule: &'a SpectralInterpolation,
        wavelengths: &Bound<'_, PyAny>,
        unit: impl Fn(f64) -> f64,
    ) -> PyResult<Self> {
        let asked = arrays::wavelengths(wavelengths)?;
        let [min, max] = rule.range();
        if let Some(&value) = asked.iter().find(|&&l| !(min..=max).contains(&l)) {
            let limits = [value, min, max];
            return Err(out_of_range(wavelengths.py(), "wavelength", limits, "nm"));
        }
        let asked = asked.into_iter().map(|l| (l, unit(l))).collect();
        Ok(Self { rule, asked })
    }

    pub fn len(&self) -> usize {
        self.asked.len()
    }

    /// One row, from relative radiance (sr⁻¹) at each wavelength.
    pub fn write_each(&self, out: &mut [f32], light: impl Fn(f64) -> Result<f32>) -> Result<()> {
        for (out, &(wavelength, unit)) in out.iter_mut().zip(&self.asked) {
            let value = f64::from(light(wavelength)?) * unit;
            *out = value.min(f64::from(f32::MAX)) as f32;
        }
        Ok(())
    }

    /// One row, from relative radiance (sr⁻¹) at the nodes.
    pub fn write(&self, nodes: &[f32], out: &mut [f32]) -> Result<()> {
        for (out, &(wavelength, unit)) in out.iter_mut().zip(&self.asked) {
            let value = f64::from(self.rule.between(nodes, wavelength)?) * unit;
            *out = value.min(f64::from(f32::MAX)) as f32;
        }
        Ok(())
    }
}

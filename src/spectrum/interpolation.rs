//! Light and air of a model at any wavelength.

use super::band_extinction::BandExtinction;
use super::between::{between, between_wavelengths, check};
use super::cell_weights::CellWeights;
use super::node_weights::{SpectralWeights, mixed};
use crate::error::{Error, Result};
use crate::format::{Head, SpectrumView};
use crate::kernel::axis::{Stencil, hermite, sample};

/// How values at the wavelengths of a model make values at any wavelength: by the weights of its spectrum chunk, or
/// where it has none by a curve through the neighbours ([`between_wavelengths`]).
///
/// Of [`Model::spectral_interpolation`](crate::Model::spectral_interpolation); skies and the like share it. Queries do
/// not allocate. `Send + Sync`.
///
/// ```
/// use welkin::{Conditions, Model};
///
/// let model = Model::default_model()?;
/// let sky = model.sky(&Conditions::default())?;
/// let mut values = vec![0.0; sky.wavelengths().len()];
/// sky.relative_radiance([0.0, 0.0, 1.0], &mut values)?; // once for many wavelengths
/// let interpolation = model.spectral_interpolation()?;
/// let light = interpolation.between(&values, 500.0)?; // sr⁻¹
/// assert_eq!(light, sky.relative_radiance_at([0.0, 0.0, 1.0], 500.0)?);
/// let irradiance = interpolation.solar_irradiance(500.0); // W m⁻² nm⁻¹
/// assert!(irradiance > 1.5);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct SpectralInterpolation {
    nodes: Vec<f64>,
    solar: Vec<f32>,
    solar_axis: [f64; 2],
    cells: Option<Cells>,
}

/// What a spectrum chunk knows.
#[derive(Clone, Debug)]
struct Cells {
    weights: CellWeights,
    extinction: BandExtinction,
}

impl SpectralInterpolation {
    pub(crate) fn new(head: &Head, spectrum: Option<&SpectrumView>) -> Self {
        Self {
            nodes: head.wavelengths.clone(),
            solar: head.solar_irradiance.clone(),
            solar_axis: [head.solar_start, head.solar_step],
            cells: spectrum.map(|view| Cells {
                weights: CellWeights::new(view),
                extinction: BandExtinction::new(view, head.constituents),
            }),
        }
    }

    /// Wavelengths of the values, nm.
    pub fn wavelengths(&self) -> &[f64] {
        &self.nodes
    }

    /// Shortest and longest wavelength, nm.
    pub fn range(&self) -> [f64; 2] {
        match &self.cells {
            Some(cells) => cells.weights.range(),
            None => [self.nodes[0], self.nodes[self.nodes.len() - 1]],
        }
    }

    /// Whether the model has a spectrum chunk.
    pub fn has_cells(&self) -> bool {
        self.cells.is_some()
    }

    /// Radiance per unit of solar irradiance at a wavelength (nm) from `values` at the wavelengths of the model.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for the wavelength; [`Error::Length`] unless there is one value per wavelength;
    /// [`Error::Invalid`] for values that are not finite.
    pub fn between(&self, values: &[f32], wavelength: f64) -> Result<f32> {
        let Some(cells) = &self.cells else {
            return between_wavelengths(&self.nodes, values, wavelength);
        };
        if values.len() != self.nodes.len() {
            return Err(Error::Length {
                what: "values",
                expected: self.nodes.len() as u64,
                got: values.len() as u64,
            });
        }
        self.check(wavelength)?;
        if !values.iter().all(|v| v.is_finite()) {
            return Err(Error::invalid("values", "must be finite"));
        }
        let value = mixed(|| cells.weights.taps(wavelength), values);
        Ok(value.min(f64::from(f32::MAX)) as f32)
    }

    /// The wavelengths of the model that count at a wavelength (nm): their indices and weights, each index once. With
    /// these the logarithms of radiance are summed, and the shares of light that are polarised.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for the wavelength.
    pub fn weights(&self, wavelength: f64) -> Result<impl Iterator<Item = (usize, f64)>> {
        self.check(wavelength)?;
        Ok(self.taps(wavelength).into_taps())
    }

    /// Solar spectral irradiance (W m⁻² nm⁻¹) outside the air at a wavelength, nm.
    pub fn solar_irradiance(&self, wavelength: f64) -> f64 {
        sample(&self.solar, self.solar_axis, wavelength)
    }

    /// Refuses wavelengths out of range.
    pub(crate) fn check(&self, wavelength: f64) -> Result<()> {
        check(wavelength, self.range())
    }

    /// Radiance at a wavelength in range.
    pub(crate) fn radiance(&self, values: &[f32], wavelength: f64) -> f64 {
        match &self.cells {
            Some(cells) => mixed(|| cells.weights.taps(wavelength), values),
            None => between(&self.nodes, values, wavelength),
        }
    }

    /// Nodes and weights at a wavelength in range.
    pub(crate) fn taps(&self, wavelength: f64) -> SpectralWeights {
        match &self.cells {
            Some(cells) => cells.weights.taps(wavelength).collect(),
            None => SpectralWeights::of_nodes(&hermite(&self.nodes, wavelength)),
        }
    }

    /// Weights of cells, if there are any.
    pub(crate) fn cell_weights(&self) -> Option<&CellWeights> {
        self.cells.as_ref().map(|cells| &cells.weights)
    }

    /// Transmittance of columns (m, one per constituent) at a wavelength in range, if there are cells.
    pub(crate) fn transmittance(
        &self,
        wavelength: f64,
        visibility: &Stencil,
        columns: impl Fn(usize) -> f32,
    ) -> Option<f64> {
        let cells = self.cells.as_ref()?;
        let place = cells.weights.locate(wavelength);
        Some(cells.extinction.transmittance(place, visibility, columns))
    }
}

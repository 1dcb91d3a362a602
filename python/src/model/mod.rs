//! `Model`: what a file says, and everything that is prepared from it.

pub mod axis;
pub mod budget;
mod general;
pub mod opening;
mod prepare;
mod prepare_bands;

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use welkin::Model;

use crate::arrays::{Array, list, wavelengths};
use crate::conditions;
use crate::errors::{out_of_range, raise, refuse};
use crate::rows::alone;
use opening::Recipe;

/// A model of the clear sky: a file, of which only what questions need is read.
///
/// Made by `default_model`, `open`, `from_bytes` or `stream`. Frame of everything: metres, radians, nanometres; +z is
/// the zenith, azimuths count counter-clockwise from +x seen from above.
///
/// Spectra are what the methods `…_at` give: those without give the nodes of the model (see `wavelengths`).
#[pyclass(frozen, name = "Model", module = "welkin_sky")]
pub struct PyModel {
    pub model: Arc<Model>,
    recipe: Recipe,
}

impl PyModel {
    fn new(model: Model, recipe: Recipe) -> Self {
        Self {
            model: Arc::new(model),
            recipe,
        }
    }
}

#[pymethods]
impl PyModel {
    /// Wavelengths that the file stores, its nodes, nm: (W,).
    ///
    /// At nodes within absorption bands (of the default model 580, 605, 740, 762, 763, 825, 939 and 941 nm) values are
    /// terms that spectra are made of and not the spectral radiance there, from which they differ by up to 40 %:
    /// `radiance_at` gives that at any wavelength, these among them.
    #[getter]
    fn wavelengths<'py>(&self, py: Python<'py>) -> PyResult<Array<'py, f64>> {
        list(py, self.model.wavelengths())
    }

    /// Shortest and longest wavelength that can be asked for, nm.
    #[getter]
    fn wavelength_range(&self, py: Python<'_>) -> PyResult<(f64, f64)> {
        alone(py, || self.model.wavelength_range()).map(Into::into)
    }

    /// Lowest and highest elevation of the sun, rad.
    #[getter]
    fn solar_elevation_range(&self) -> (f64, f64) {
        self.model.solar_elevation_range().into()
    }

    /// Lowest and highest visibility, m.
    #[getter]
    fn visibility_range(&self) -> (f64, f64) {
        self.model.visibility_range().into()
    }

    /// Lowest and highest altitude of an observer, m.
    #[getter]
    fn altitude_range(&self) -> (f64, f64) {
        self.model.altitude_range().into()
    }

    /// Radius of the planet, m.
    #[getter]
    fn planet_radius(&self) -> f64 {
        self.model.head().planet.radius
    }

    /// Altitude at which the atmosphere ends, m.
    #[getter]
    fn top_altitude(&self) -> f64 {
        self.model.head().planet.top
    }

    /// Whether the file says what absorption lines do between its wavelengths.
    #[getter]
    fn has_spectrum(&self) -> bool {
        self.model.has_spectrum()
    }

    /// Whether the file holds the polarisation of skylight.
    #[getter]
    fn is_polarised(&self) -> bool {
        self.model.is_polarised()
    }

    /// Whether the light is that of the moon.
    #[getter]
    fn is_moonlit(&self) -> bool {
        self.model.is_moonlit()
    }

    /// Whether the model has a ground of its own: see `over`.
    #[getter]
    fn has_ground(&self) -> bool {
        self.model.ground().is_some()
    }

    /// Length of the file, bytes.
    #[getter]
    fn file_bytes(&self) -> usize {
        self.model.file_bytes()
    }

    /// Bytes of the file that were needed so far.
    #[getter]
    fn touched_bytes(&self) -> usize {
        self.model.touched_bytes()
    }

    /// Requests to the source of a streamed model so far, and the bytes that they brought.
    #[getter]
    fn traffic(&self) -> (u64, u64) {
        let traffic = self.model.traffic();
        (traffic.requests, traffic.bytes)
    }

    /// What whoever made the file wrote about it, as a dict; never needed for evaluation.
    #[getter]
    fn metadata<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let text = &self.model.head().metadata;
        let told = || refuse(py, "value", "metadata is not a JSON object");
        let read = py.import("json")?.call_method1("loads", (text,));
        let object = read.ok().and_then(|read| read.cast_into().ok());
        object.ok_or_else(told)
    }

    /// Verifies the whole file at once instead of its chunks at their first touch.
    fn verify(&self, py: Python<'_>) -> PyResult<()> {
        alone(py, || self.model.verify())
    }

    /// Solar spectral irradiance outside the air at wavelengths in nm, W m⁻² nm⁻¹: a number or (K,) → (K,).
    fn solar_irradiance<'py>(
        &self,
        py: Python<'py>,
        wavelengths: &Bound<'py, PyAny>,
    ) -> PyResult<Array<'py, f64>> {
        let asked = self::wavelengths(wavelengths)?;
        let rule = alone(py, || self.model.spectral_interpolation())?;
        let [min, max] = rule.range();
        if let Some(&value) = asked.iter().find(|&&l| !(min..=max).contains(&l)) {
            let limits = [value, min, max];
            return Err(out_of_range(py, "wavelength", limits, "nm"));
        }
        let values: Vec<_> = asked.iter().map(|&l| rule.solar_irradiance(l)).collect();
        list(py, &values)
    }

    /// Conditions with every one moved into the range of the model. Refuses only what is not finite.
    fn clamped<'py>(
        &self,
        py: Python<'py>,
        conditions: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let given = conditions::read(Some(conditions), None)?;
        let clamped = given.clamped(&self.model).map_err(|e| raise(py, e))?;
        conditions::shown(py, &clamped)
    }

    fn __repr__(&self) -> String {
        let nodes = self.model.wavelengths();
        let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
        let bytes = self.model.file_bytes();
        format!(
            "<welkin_sky.Model: {} wavelengths in {first}–{last} nm, {bytes} bytes>",
            nodes.len()
        )
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.recipe.reduce(py)
    }
}

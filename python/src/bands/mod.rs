//! Bands of a sensor, and their responses.

pub mod air;
pub mod sky;
pub mod sun;

use numpy::PyUntypedArrayMethods;
use pyo3::prelude::*;
use welkin::{Bands, Response};

use crate::arrays::{Array, Output, list, numbers, shown};
use crate::errors::{raise, refuse};
use crate::rows::{block_rows, run};
use crate::threads::Threads;

/// What a band of a sensor makes of light: its response over wavelength. Made by `Response.wavelength` or `.table`.
#[pyclass(frozen, name = "Response", module = "welkin_sky")]
#[derive(Clone)]
pub struct PyResponse {
    response: Response,
}

#[pymethods]
impl PyResponse {
    /// A single wavelength, nm: the value of the band is the spectral radiance there, W m⁻² sr⁻¹ nm⁻¹.
    #[staticmethod]
    fn wavelength(wavelength: f64) -> Self {
        Self {
            response: Response::wavelength(wavelength),
        }
    }

    /// A curve through values (K,) at increasing wavelengths (K,) in nm, linear between them and zero beyond.
    ///
    /// The value of the band is the integral of response times spectral radiance, W m⁻² sr⁻¹.
    #[staticmethod]
    fn table(
        py: Python<'_>,
        wavelengths: &Bound<'_, PyAny>,
        values: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let wavelengths = numbers::<f64>(wavelengths, "wavelengths")?;
        let values = numbers::<f64>(values, "values")?;
        let made = Response::table(wavelengths.as_slice()?, values.as_slice()?);
        let response = made.map_err(|error| raise(py, error))?;
        Ok(Self { response })
    }

    /// The same curve over its integral: the value of the band is the mean spectral radiance, W m⁻² sr⁻¹ nm⁻¹.
    fn normalised(&self) -> Self {
        Self {
            response: self.response.clone().normalised(),
        }
    }

    /// ∫ R dλ, nm; 1 for a single wavelength.
    #[getter]
    fn integral(&self) -> f64 {
        self.response.integral()
    }

    /// First and last wavelength that count, nm.
    #[getter]
    fn range(&self) -> (f64, f64) {
        self.response.range().into()
    }
}

/// Responses, and numbers that stand for single wavelengths.
pub fn responses(values: &Bound<'_, PyAny>) -> PyResult<Vec<Response>> {
    let read = |value: PyResult<Bound<'_, PyAny>>| {
        let value = value?;
        match value.cast::<PyResponse>() {
            Ok(response) => Ok(response.get().response.clone()),
            Err(_) => Ok(Response::wavelength(value.extract()?)),
        }
    };
    values.try_iter()?.map(read).collect()
}

/// The bands of a sensor, projected onto few wavelengths of a model. Made by `Model.bands`.
#[pyclass(frozen, name = "Bands", module = "welkin_sky")]
pub struct PyBands {
    pub bands: Bands,
}

impl From<Bands> for PyBands {
    fn from(bands: Bands) -> Self {
        Self { bands }
    }
}

#[pymethods]
impl PyBands {
    fn __len__(&self) -> usize {
        self.bands.count()
    }

    /// Wavelengths of the model that the bands are made of, nm: (N,).
    #[getter]
    fn nodes<'py>(&self, py: Python<'py>) -> PyResult<Array<'py, f64>> {
        list(py, self.bands.nodes())
    }

    /// How far each band is from the integral over its response, relative, over typical skies: median, 99th percentile.
    #[getter]
    fn residuals(&self) -> Vec<(f64, f64)> {
        let residuals = self.bands.residuals().iter();
        residuals.map(|r| (r.median, r.p99)).collect()
    }

    /// The bands of relative radiance (sr⁻¹) at all wavelengths of the model: (…, W) → (…, B).
    #[pyo3(signature = (relative_radiance, *, threads=None))]
    fn project<'py>(
        &self,
        py: Python<'py>,
        relative_radiance: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let relative = numbers::<f32>(relative_radiance, "relative_radiance")?;
        let Some((&width, lead)) = relative.shape().split_last() else {
            let message = "relative_radiance must have the shape (…, W), got ()";
            return Err(refuse(py, "length", message));
        };
        if width == 0 {
            let message = format!("no wavelengths: {}", shown(relative.shape()));
            return Err(refuse(py, "length", &message));
        }
        let mut output = Output::new(py, lead, &[self.bands.count()])?;
        let size = block_rows(lead.iter().product());
        let blocks = relative.as_slice()?.chunks(size * width);
        let blocks = blocks.zip(output.blocks(size)?);
        run(
            py,
            threads,
            blocks,
            |_, (relative, out): (&[f32], &mut [f32])| {
                let rows = relative.chunks_exact(width);
                let mut rows = rows.zip(out.chunks_exact_mut(self.bands.count()));
                rows.try_for_each(|(relative, out)| self.bands.project(relative, out))
            },
        )?;
        Ok(output.array)
    }
}

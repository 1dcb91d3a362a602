//! `BakedSky`: spectra.

use std::sync::Arc;

use pyo3::prelude::*;
use welkin::BakedSky;

use super::{Error, error, separate, shown};
use crate::arrays::{Array, Directions, Output, Vectors, fill, fill_each, list, wavelengths};
use crate::broadcast::{Operand, common};
use crate::conditions;
use crate::errors::raise;
use crate::rows::{block_rows, run};
use crate::threads::Threads;

/// A sky as tables: many times faster than the `Sky` that it was made from. Made by `Sky.bake`. Directions as of `Sky`.
///
/// Spectra are what `radiance_at` gives: `radiance` gives the nodes of the model (see `wavelengths`).
#[pyclass(frozen, name = "BakedSky", module = "welkin_sky")]
pub struct PyBakedSky {
    pub sky: Arc<BakedSky>,
}

impl From<BakedSky> for PyBakedSky {
    fn from(sky: BakedSky) -> Self {
        Self { sky: Arc::new(sky) }
    }
}

#[pymethods]
impl PyBakedSky {
    /// What the sky was prepared for.
    #[getter]
    fn conditions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        conditions::shown(py, self.sky.conditions())
    }

    /// Wavelengths of `radiance`, nm: (W,), the nodes of the model.
    ///
    /// At nodes within absorption bands (of the default model 580, 605, 740, 762, 763, 825, 939 and 941 nm) values are
    /// terms that spectra are made of and not the spectral quantity there, from which they differ by up to 40 %:
    /// `radiance_at` gives that at any wavelength, these among them.
    #[getter]
    fn wavelengths<'py>(&self, py: Python<'py>) -> PyResult<Array<'py, f64>> {
        list(py, self.sky.wavelengths())
    }

    /// Relative error that baking added: median, 95th, 99th and 99.9th percentile, largest.
    #[getter]
    fn bake_error(&self) -> Error {
        error(self.sky.bake_error())
    }

    /// Memory that the sky holds, bytes.
    #[getter]
    fn bytes(&self) -> usize {
        self.sky.bytes()
    }

    /// The same sky, turned so that the sun has this azimuth (rad). Costs no preparation.
    fn with_solar_azimuth(&self, py: Python<'_>, azimuth: f64) -> PyResult<Self> {
        let mut sky = BakedSky::clone(&self.sky);
        sky.set_solar_azimuth(azimuth).map_err(|e| raise(py, e))?;
        Ok(sky.into())
    }

    /// Spectral radiance, W m⁻² sr⁻¹ nm⁻¹, at the nodes `wavelengths`: (…, 3) → (…, W).
    ///
    /// Within absorption bands the nodes are not spectral radiance: see `wavelengths`, and ask `radiance_at`.
    #[pyo3(signature = (directions, *, threads=None))]
    fn radiance<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let directions = Directions::directions(directions)?;
        let tail = [self.sky.wavelengths().len()];
        fill(py, threads, &directions, &tail, |directions, out| {
            separate(directions, |directions| {
                self.sky.radiance_batch(directions, out)
            })
        })
    }

    /// Spectral radiance, W m⁻² sr⁻¹ nm⁻¹, at wavelengths in nm, a number or (K,), that are the same for all
    /// directions: (…, 3) → (…, K). Takes them in single precision, four at a time, as `hero`.
    #[pyo3(signature = (directions, wavelengths, *, threads=None))]
    fn radiance_at<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        wavelengths: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let asked = self::wavelengths(wavelengths)?;
        let directions = Directions::directions(directions)?;
        fill_each(
            py,
            threads,
            &directions,
            &[asked.len()],
            |direction, out| {
                for (asked, out) in asked.chunks(4).zip(out.chunks_mut(4)) {
                    let four = std::array::from_fn(|i| asked[i.min(asked.len() - 1)] as f32);
                    let values = self.sky.hero(direction, four)?;
                    out.copy_from_slice(&values[..out.len()]);
                }
                Ok(())
            },
        )
    }

    /// Spectral radiance, W m⁻² sr⁻¹ nm⁻¹, at four wavelengths (nm) for each direction: (…, 3), (…, 4) → (…, 4).
    #[pyo3(signature = (directions, wavelengths, *, threads=None))]
    fn hero<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        wavelengths: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let directions: Operand<f32, 3> = Operand::vectors(directions, "directions")?;
        let wavelengths: Operand<f32, 4> = Operand::vectors(wavelengths, "wavelengths")?;
        let lead = common(py, &[directions.named(), wavelengths.named()])?;
        let (directions, wavelengths) = (directions.spread(&lead)?, wavelengths.spread(&lead)?);
        let (directions, wavelengths) = (directions.values()?, wavelengths.values()?);
        let mut output = Output::new(py, &lead, &[4])?;
        let size = block_rows(lead.iter().product());
        run(py, threads, output.blocks(size)?, |block, out| {
            let out = out.as_chunks_mut().0;
            let rows = block * size..block * size + out.len();
            let wavelengths: Vec<_> = rows.clone().map(|i| wavelengths.at(i)).collect();
            let directions: Vec<_> = rows.map(|i| directions.at(i)).collect();
            separate(&directions, |d| self.sky.hero_batch(d, &wavelengths, out))
        })?;
        Ok(output.array)
    }

    /// Spectral irradiance, W m⁻² nm⁻¹, that the sky without the sun's disc gives one side of planes with these
    /// normals: (…, 3) → (…, W). Takes some thousand queries each.
    #[pyo3(signature = (normals, *, threads=None))]
    fn irradiance<'py>(
        &self,
        py: Python<'py>,
        normals: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let normals = Vectors::read(normals, "normals")?;
        let tail = [self.sky.wavelengths().len()];
        fill_each(py, threads, &normals, &tail, |normal, out| {
            self.sky.irradiance(normal, out)
        })
    }

    fn __repr__(&self) -> PyResult<String> {
        shown("BakedSky", self.sky.bytes(), &self.sky.bake_error())
    }
}

//! `SolarDisc`: the sun through the air.

use pyo3::prelude::*;
use welkin::SolarDisc;

use crate::arrays::{Array, Directions, Vectors, fill_each, list, wavelengths};
use crate::threads::Threads;

/// The disc of the sun as an observer sees it through the air. Made by `Model.solar_disc`. Directions as of `Sky`.
///
/// Its radiance is that of the disc alone, zero beside it: add that of the sky.
#[pyclass(frozen, name = "SolarDisc", module = "welkin_sky")]
pub struct PySolarDisc {
    pub disc: SolarDisc,
}

impl From<SolarDisc> for PySolarDisc {
    fn from(disc: SolarDisc) -> Self {
        Self { disc }
    }
}

#[pymethods]
impl PySolarDisc {
    /// Wavelengths of `radiance`, nm: (W,), the nodes of the model.
    ///
    /// At nodes within absorption bands (of the default model 580, 605, 740, 762, 763, 825, 939 and 941 nm) values are
    /// terms that spectra are made of and not the spectral quantity there, which may be several times as much:
    /// `radiance_at` gives that at any wavelength, these among them.
    #[getter]
    fn wavelengths<'py>(&self, py: Python<'py>) -> PyResult<Array<'py, f64>> {
        list(py, self.disc.wavelengths())
    }

    /// Unit vector towards the centre.
    #[getter]
    fn direction(&self) -> (f32, f32, f32) {
        self.disc.direction().into()
    }

    /// Whether any of the disc is above the geometric horizon.
    #[getter]
    fn is_visible(&self) -> bool {
        self.disc.is_visible()
    }

    /// Solid angle of the whole disc, sr.
    #[getter]
    fn solid_angle(&self) -> f64 {
        self.disc.solid_angle()
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
        let tail = [self.disc.wavelengths().len()];
        fill_each(py, threads, &directions, &tail, |direction, out| {
            self.disc.radiance(direction, out)
        })
    }

    /// Spectral radiance, W m⁻² sr⁻¹ nm⁻¹, at wavelengths in nm, a number or (K,): (…, 3) → (…, K).
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
                out.iter_mut()
                    .zip(&asked)
                    .try_for_each(|(value, &wavelength)| {
                        *value = self.disc.radiance_at(direction, wavelength)?;
                        Ok(())
                    })
            },
        )
    }

    /// CIE 1931 X, Y, Z, cd m⁻² (Y is luminance): (…, 3) → (…, 3).
    #[pyo3(signature = (directions, *, threads=None))]
    fn xyz<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let directions = Directions::directions(directions)?;
        fill_each(py, threads, &directions, &[3], |direction, out| {
            out.copy_from_slice(&self.disc.xyz(direction)?);
            Ok(())
        })
    }

    /// Spectral irradiance, W m⁻² nm⁻¹, that the visible part of the disc gives one side of planes with these normals:
    /// (…, 3) → (…, W).
    #[pyo3(signature = (normals, *, threads=None))]
    fn irradiance<'py>(
        &self,
        py: Python<'py>,
        normals: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let normals = Vectors::read(normals, "normals")?;
        let tail = [self.disc.wavelengths().len()];
        fill_each(py, threads, &normals, &tail, |normal, out| {
            self.disc.irradiance(normal, out)
        })
    }
}

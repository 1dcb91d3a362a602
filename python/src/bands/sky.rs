//! Skies in bands.

use pyo3::prelude::*;
use welkin::{BakedBandSky, BakedSky, BandSky, PolarisedBandSky};

use crate::arrays::{Array, Directions, Vectors, fill, fill_each};
use crate::baked::{Error, error, separate, shown};
use crate::conditions;
use crate::errors::raise;
use crate::frame;
use crate::polarised::stokes_rows;
use crate::rows::alone;
use crate::threads::Threads;

/// A sky in the bands of a sensor. Made by `Model.band_sky`. Directions as of `Sky`.
#[pyclass(frozen, name = "BandSky", module = "welkin_sky")]
pub struct PyBandSky {
    sky: BandSky,
}

impl From<BandSky> for PyBandSky {
    fn from(sky: BandSky) -> Self {
        Self { sky }
    }
}

#[pymethods]
impl PyBandSky {
    /// What the sky was prepared for.
    #[getter]
    fn conditions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        conditions::shown(py, self.sky.conditions())
    }

    /// How many bands there are.
    #[getter]
    fn bands(&self) -> usize {
        self.sky.bands()
    }

    /// Unit vector towards the sun's centre.
    #[getter]
    fn sun_direction(&self) -> (f32, f32, f32) {
        self.sky.sun_direction().into()
    }

    /// The same sky, turned so that the sun has this azimuth (rad). Costs no preparation.
    fn with_solar_azimuth(&self, py: Python<'_>, azimuth: f64) -> PyResult<Self> {
        let mut sky = self.sky.clone();
        sky.set_solar_azimuth(azimuth).map_err(|e| raise(py, e))?;
        Ok(sky.into())
    }

    /// The value of each band, in the unit of its `Response`: (…, 3) → (…, B).
    #[pyo3(signature = (directions, *, threads=None))]
    fn radiance<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let directions = Directions::directions(directions)?;
        fill(
            py,
            threads,
            &directions,
            &[self.sky.bands()],
            |directions, out| self.sky.radiance_batch(directions, out),
        )
    }

    /// Bakes the sky into tables that are asked many times faster. tolerance: as of `Sky.bake`.
    #[pyo3(signature = (tolerance=BakedSky::TOLERANCE), text_signature = "($self, tolerance=0.0025)")]
    fn bake(&self, py: Python<'_>, tolerance: f64) -> PyResult<PyBakedBandSky> {
        let sky = alone(py, || self.sky.bake(tolerance))?;
        Ok(PyBakedBandSky { sky })
    }
}

/// A sky in bands as tables. Made by `BandSky.bake`. Directions as of `Sky`.
#[pyclass(frozen, name = "BakedBandSky", module = "welkin_sky")]
pub struct PyBakedBandSky {
    pub sky: BakedBandSky,
}

#[pymethods]
impl PyBakedBandSky {
    /// What the sky was prepared for.
    #[getter]
    fn conditions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        conditions::shown(py, self.sky.conditions())
    }

    /// How many bands there are.
    #[getter]
    fn bands(&self) -> usize {
        self.sky.bands()
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

    /// The value of each band, in the unit of its `Response`: (…, 3) → (…, B).
    #[pyo3(signature = (directions, *, threads=None))]
    fn radiance<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let directions = Directions::directions(directions)?;
        fill(
            py,
            threads,
            &directions,
            &[self.sky.bands()],
            |directions, out| {
                separate(directions, |directions| {
                    self.sky.radiance_batch(directions, out)
                })
            },
        )
    }

    /// Irradiance in the bands that the sky without the sun's disc gives one side of planes with these normals:
    /// (…, 3) → (…, B).
    #[pyo3(signature = (normals, *, threads=None))]
    fn irradiance<'py>(
        &self,
        py: Python<'py>,
        normals: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let normals = Vectors::read(normals, "normals")?;
        fill_each(py, threads, &normals, &[self.sky.bands()], |normal, out| {
            self.sky.irradiance(normal, out)
        })
    }

    fn __repr__(&self) -> PyResult<String> {
        shown("BakedBandSky", self.sky.bytes(), &self.sky.bake_error())
    }
}

/// A sky in bands with its polarisation. Made by `Model.polarised_band_sky`. Directions as of `Sky`.
#[pyclass(frozen, name = "PolarisedBandSky", module = "welkin_sky")]
pub struct PyPolarisedBandSky {
    pub sky: PolarisedBandSky,
}

impl From<PolarisedBandSky> for PyPolarisedBandSky {
    fn from(sky: PolarisedBandSky) -> Self {
        Self { sky }
    }
}

#[pymethods]
impl PyPolarisedBandSky {
    /// What the sky was prepared for.
    #[getter]
    fn conditions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        conditions::shown(py, self.sky.conditions())
    }

    /// How many bands there are.
    #[getter]
    fn bands(&self) -> usize {
        self.sky.bands()
    }

    /// Stokes vectors I, Q, U of each band: (…, 3) → (…, 3, B). frame: as of `PolarisedSky.stokes`.
    #[pyo3(signature = (directions, frame=None, *, threads=None))]
    fn stokes<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        frame: Option<&Bound<'py, PyAny>>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let frame = frame::read(frame)?;
        let directions = Directions::directions(directions)?;
        stokes_rows(
            py,
            threads,
            &directions,
            self.sky.bands(),
            |direction, stokes| self.sky.stokes(direction, frame, stokes),
        )
    }
}

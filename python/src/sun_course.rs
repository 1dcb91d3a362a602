//! `SunCourse`: colour skies of a sun that moves.

use pyo3::prelude::*;
use welkin::SunCourse;

use crate::baked::colour::PyBakedColourSky;
use crate::baked::{Error, error};
use crate::rows::alone;

/// Baked colour skies under every sun of a range: the next frame of a day costs microseconds. Made by
/// `Model.sun_course`.
#[pyclass(frozen, name = "SunCourse", module = "welkin_sky")]
pub struct PySunCourse {
    course: SunCourse,
}

impl From<SunCourse> for PySunCourse {
    fn from(course: SunCourse) -> Self {
        Self { course }
    }
}

#[pymethods]
impl PySunCourse {
    /// Lowest and highest elevation of the sun, rad.
    #[getter]
    fn elevations(&self) -> (f64, f64) {
        self.course.elevations().into()
    }

    /// How many skies are baked.
    #[getter]
    fn skies(&self) -> usize {
        self.course.skies()
    }

    /// What interpolation adds to the error of baking where it was worst: median, 95th, 99th and 99.9th percentile,
    /// largest.
    #[getter]
    fn interpolation_error(&self) -> Error {
        error(self.course.interpolation_error())
    }

    /// Memory that it holds, bytes.
    #[getter]
    fn bytes(&self) -> usize {
        self.course.bytes()
    }

    /// The sky under a sun at an elevation and an azimuth, rad.
    #[pyo3(signature = (solar_elevation, solar_azimuth=0.0))]
    fn at(
        &self,
        py: Python<'_>,
        solar_elevation: f64,
        solar_azimuth: f64,
    ) -> PyResult<PyBakedColourSky> {
        let sky = alone(py, || self.course.at(solar_elevation, solar_azimuth))?;
        Ok(sky.into())
    }
}

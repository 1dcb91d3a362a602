//! `BakedColourSky`: colours.

use pyo3::prelude::*;
use welkin::BakedColourSky;

use super::{Error, error, separate, shown};
use crate::arrays::{Array, Directions, fill};
use crate::conditions;
use crate::errors::raise;
use crate::sampler::PySkySampler;
use crate::sky::space;
use crate::solar_disc::PySolarDisc;
use crate::threads::Threads;

/// A sky as tables of its colour, the fastest of all. Made by `ColourSky.bake` or `SunCourse.at`. Directions as of
/// `Sky`.
#[pyclass(frozen, name = "BakedColourSky", module = "welkin_sky")]
pub struct PyBakedColourSky {
    pub sky: BakedColourSky,
}

impl From<BakedColourSky> for PyBakedColourSky {
    fn from(sky: BakedColourSky) -> Self {
        Self { sky }
    }
}

#[pymethods]
impl PyBakedColourSky {
    /// What the sky was prepared for.
    #[getter]
    fn conditions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        conditions::shown(py, self.sky.conditions())
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
        let mut sky = self.sky.clone();
        sky.set_solar_azimuth(azimuth).map_err(|e| raise(py, e))?;
        Ok(sky.into())
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
        fill(py, threads, &directions, &[3], |directions, out| {
            let out = out.as_chunks_mut().0;
            separate(directions, |directions| self.sky.xyz_batch(directions, out))
        })
    }

    /// Linear RGB, cd m⁻², not clipped: (…, 3) → (…, 3). space: as of `Sky.rgb`.
    #[pyo3(signature = (directions, space="srgb", *, threads=None))]
    fn rgb<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        space: &str,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let space = self::space(py, space)?;
        let directions = Directions::directions(directions)?;
        fill(py, threads, &directions, &[3], |directions, out| {
            let out = out.as_chunks_mut().0;
            separate(directions, |directions| {
                self.sky.rgb_batch(directions, space, out)
            })
        })
    }

    /// Prepares drawing of directions by luminance. sun: a `SolarDisc` that is drawn too.
    #[pyo3(signature = (sun=None))]
    fn sampler(&self, py: Python<'_>, sun: Option<&PySolarDisc>) -> PySkySampler {
        let sampler = py.detach(|| match sun {
            Some(sun) => self.sky.sampler().with_sun(&sun.disc),
            None => self.sky.sampler(),
        });
        sampler.into()
    }

    fn __repr__(&self) -> PyResult<String> {
        shown("BakedColourSky", self.sky.bytes(), &self.sky.bake_error())
    }
}

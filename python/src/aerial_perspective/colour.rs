//! `ColourAerialPerspective`: colours alone.

use pyo3::prelude::*;
use welkin::ColourAerialPerspective;

use super::{Pair, RGB, colours, distances};
use crate::arrays::{Output, vector};
use crate::conditions;
use crate::errors::raise;
use crate::rows::alone;
use crate::sky::space;
use crate::threads::Threads;
use crate::transmittance::Lines;

/// An aerial perspective for colour alone. Made by `Model.colour_aerial_perspective`. Points as of `AerialPerspective`.
#[pyclass(frozen, name = "ColourAerialPerspective", module = "welkin_sky")]
pub struct PyColourAerialPerspective {
    pub aerial: ColourAerialPerspective,
}

impl From<ColourAerialPerspective> for PyColourAerialPerspective {
    fn from(aerial: ColourAerialPerspective) -> Self {
        Self { aerial }
    }
}

#[pymethods]
impl PyColourAerialPerspective {
    /// What it was prepared for.
    #[getter]
    fn conditions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        conditions::shown(py, self.aerial.conditions())
    }

    /// Memory that it holds, bytes.
    #[getter]
    fn bytes(&self) -> usize {
        self.aerial.bytes()
    }

    /// The same with the sun at another azimuth (rad). Costs no preparation.
    fn with_solar_azimuth(&self, py: Python<'_>, azimuth: f64) -> PyResult<Self> {
        let mut aerial = self.aerial.clone();
        aerial
            .set_solar_azimuth(azimuth)
            .map_err(|e| raise(py, e))?;
        Ok(aerial.into())
    }

    /// In-scattered light as CIE 1931 X, Y, Z, cd m⁻², and the factors by which the air changes those of white things:
    /// (…, 3), (…, 3) → (…, 3), (…, 3).
    #[pyo3(signature = (start, end, *, threads=None))]
    fn xyz<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Pair<'py>> {
        let lines = Lines::read(start, end, "end")?;
        lines.fill_two(py, threads, RGB, |start, end, light, factors| {
            colours(self.aerial.xyz(start, end)?, light, factors)
        })
    }

    /// The same as linear RGB, not clipped. space: as of `Sky.rgb`.
    #[pyo3(signature = (start, end, space="srgb", *, threads=None))]
    fn rgb<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: &Bound<'py, PyAny>,
        space: &str,
        threads: Option<Threads>,
    ) -> PyResult<Pair<'py>> {
        let space = self::space(py, space)?;
        let lines = Lines::read(start, end, "end")?;
        lines.fill_two(py, threads, RGB, |start, end, light, factors| {
            colours(self.aerial.rgb(start, end, space)?, light, factors)
        })
    }

    /// Linear sRGB from one start at growing distances (m) in one direction, each piece integrated once:
    /// (3,), (3,), (D,) → (D, 3), (D, 3).
    fn linear_srgb_along<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        direction: &Bound<'py, PyAny>,
        distances: &Bound<'py, PyAny>,
    ) -> PyResult<Pair<'py>> {
        let (start, direction) = (vector(start, "start")?, vector(direction, "direction")?);
        let distances = self::distances(distances)?;
        let mut light = Output::new(py, &[distances.len()], &[3])?;
        let mut factors = Output::new(py, &[distances.len()], &[3])?;
        let to = light.all()?.as_chunks_mut().0;
        let passed = factors.all()?.as_chunks_mut().0;
        alone(py, || {
            self.aerial
                .linear_srgb_along(start, direction, &distances, to, passed)
        })?;
        Ok((light.array, factors.array))
    }
}

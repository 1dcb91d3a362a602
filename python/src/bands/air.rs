//! Segments in bands.

use pyo3::prelude::*;
use welkin::{BandAerialPerspective, BandTransmittance};

use crate::aerial_perspective::Pair;
use crate::arrays::Array;
use crate::conditions;
use crate::threads::Threads;
use crate::transmittance::Lines;

/// The air at one visibility in the bands of a sensor. Made by `Model.band_transmittance`. Points as of
/// `Transmittance`.
#[pyclass(frozen, name = "BandTransmittance", module = "welkin_sky")]
pub struct PyBandTransmittance {
    air: BandTransmittance,
}

impl From<BandTransmittance> for PyBandTransmittance {
    fn from(air: BandTransmittance) -> Self {
        Self { air }
    }
}

#[pymethods]
impl PyBandTransmittance {
    /// How many bands there are.
    #[getter]
    fn bands(&self) -> usize {
        self.air.bands()
    }

    /// Transmittance between points: (…, 3), (…, 3) → (…, B).
    #[pyo3(signature = (start, end, *, threads=None))]
    fn between<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let lines = Lines::read(start, end, "end")?;
        lines.fill(py, threads, self.air.bands(), |start, end, out| {
            self.air.transmittance(start, end, out)
        })
    }

    /// Transmittance from points to space, zero where the ground is in the way: (…, 3), (…, 3) → (…, B).
    #[pyo3(signature = (start, directions, *, threads=None))]
    fn to_space<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        directions: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let lines = Lines::read(start, directions, "directions")?;
        lines.fill(py, threads, self.air.bands(), |start, direction, out| {
            self.air.transmittance_to_space(start, direction, out)
        })
    }
}

/// An aerial perspective in the bands of a sensor. Made by `Model.band_aerial_perspective`. Points as of
/// `AerialPerspective`.
#[pyclass(frozen, name = "BandAerialPerspective", module = "welkin_sky")]
pub struct PyBandAerialPerspective {
    aerial: BandAerialPerspective,
}

impl From<BandAerialPerspective> for PyBandAerialPerspective {
    fn from(aerial: BandAerialPerspective) -> Self {
        Self { aerial }
    }
}

#[pymethods]
impl PyBandAerialPerspective {
    /// What it was prepared for.
    #[getter]
    fn conditions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        conditions::shown(py, self.aerial.conditions())
    }

    /// How many bands there are.
    #[getter]
    fn bands(&self) -> usize {
        self.aerial.bands()
    }

    /// Light that the air between points scatters to the start, and the transmittance between them:
    /// (…, 3), (…, 3) → (…, B), (…, B).
    #[pyo3(signature = (start, end, *, threads=None))]
    fn in_scattering<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Pair<'py>> {
        let width = self.aerial.bands();
        let tails: [&[usize]; 2] = [&[width], &[width]];
        let lines = Lines::read(start, end, "end")?;
        lines.fill_two(py, threads, tails, |start, end, light, factors| {
            self.aerial.in_scattering(start, end, light, factors)
        })
    }
}

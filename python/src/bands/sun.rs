//! The sun's disc in bands.

use pyo3::prelude::*;
use welkin::BandSolarDisc;

use crate::arrays::{Array, Directions, Vectors, fill_each};
use crate::threads::Threads;

/// The disc of the sun in the bands of a sensor. Made by `Model.band_solar_disc`. Directions as of `Sky`.
#[pyclass(frozen, name = "BandSolarDisc", module = "welkin_sky")]
pub struct PyBandSolarDisc {
    disc: BandSolarDisc,
}

impl From<BandSolarDisc> for PyBandSolarDisc {
    fn from(disc: BandSolarDisc) -> Self {
        Self { disc }
    }
}

#[pymethods]
impl PyBandSolarDisc {
    /// How many bands there are.
    #[getter]
    fn bands(&self) -> usize {
        self.disc.bands()
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

    /// The value of each band, zero beside the disc: (…, 3) → (…, B).
    #[pyo3(signature = (directions, *, threads=None))]
    fn radiance<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let directions = Directions::directions(directions)?;
        fill_each(
            py,
            threads,
            &directions,
            &[self.disc.bands()],
            |direction, out| self.disc.radiance(direction, out),
        )
    }

    /// Irradiance in the bands that the visible part of the disc gives one side of planes with these normals:
    /// (…, 3) → (…, B).
    #[pyo3(signature = (normals, *, threads=None))]
    fn irradiance<'py>(
        &self,
        py: Python<'py>,
        normals: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let normals = Vectors::read(normals, "normals")?;
        fill_each(
            py,
            threads,
            &normals,
            &[self.disc.bands()],
            |normal, out| self.disc.irradiance(normal, out),
        )
    }
}

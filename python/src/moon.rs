//! Moonlight: the fields of a `Moon`, and the sum of two skies.

use std::f64::consts::FRAC_PI_2;

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use welkin::{Moon, SkySum};

use crate::arrays::{Array, Directions, fill_each, scalar};
use crate::errors::{out_of_range, refuse};
use crate::model::PyModel;
use crate::sky::space;
use crate::threads::Threads;

impl PyModel {
    /// A moon whose light this model can take, from an object with its fields.
    pub fn moon(&self, moon: &Bound<'_, PyAny>) -> PyResult<Moon> {
        let py = moon.py();
        if self.model.is_moonlit() {
            let message = "the model is moonlit already: ask the one that it was made of";
            return Err(refuse(py, "value", message));
        }
        let moon = read(moon)?;
        for (parameter, value) in [("elevation", moon.elevation), ("azimuth", moon.azimuth)] {
            if !value.is_finite() {
                let limits = [value, f64::MIN, f64::MAX];
                return Err(out_of_range(py, parameter, limits, "rad"));
            }
        }
        if moon.elevation.abs() > FRAC_PI_2 {
            let limits = [moon.elevation, -FRAC_PI_2, FRAC_PI_2];
            return Err(out_of_range(py, "elevation", limits, "rad"));
        }
        Ok(moon)
    }
}

/// A moon from an object with its fields.
fn read(moon: &Bound<'_, PyAny>) -> PyResult<Moon> {
    let field = |name: &str| -> PyResult<f64> {
        let told = |_| PyTypeError::new_err("moon must be a welkin_sky.Moon");
        scalar(&moon.getattr(name).map_err(told)?, name, "")
    };
    Ok(Moon {
        elevation: field("elevation")?,
        azimuth: field("azimuth")?,
        phase_angle: field("phase_angle")?,
        distance: field("distance")?,
    })
}

/// The same in Python.
pub fn shown<'py>(py: Python<'py>, moon: &Moon) -> PyResult<Bound<'py, PyAny>> {
    let class = py.import("welkin_sky.conditions")?.getattr("Moon")?;
    class.call1((
        moon.elevation,
        moon.azimuth,
        moon.phase_angle,
        moon.distance,
    ))
}

/// The phase angle (rad) of a moon at mean distance in a direction, with the sun in another: vectors (3,) of one frame.
#[pyfunction]
pub fn phase_angle_between(moon: [f64; 3], sun: [f64; 3]) -> f64 {
    Moon::phase_angle_between(moon, sun)
}

/// The sum of the skies of sun and moon. Made by `Model.sky_with_moon`. Directions as of `Sky`.
#[pyclass(frozen, name = "SkySum", module = "welkin_sky")]
pub struct PySkySum {
    sky: SkySum,
    width: usize,
}

impl PySkySum {
    pub fn new(sky: SkySum, width: usize) -> Self {
        Self { sky, width }
    }
}

#[pymethods]
impl PySkySum {
    /// How many of sun and moon are high enough to add light: 0 to 2.
    #[getter]
    fn parts(&self) -> usize {
        self.sky.parts().len()
    }

    /// Spectral radiance, W m⁻² sr⁻¹ nm⁻¹, at the nodes of the model: (…, 3) → (…, W).
    ///
    /// Within absorption bands the nodes are not spectral radiance: see `Sky.wavelengths`.
    #[pyo3(signature = (directions, *, threads=None))]
    fn radiance<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let directions = Directions::directions(directions)?;
        fill_each(py, threads, &directions, &[self.width], |direction, out| {
            self.sky.radiance(direction, out)
        })
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
            out.copy_from_slice(&self.sky.xyz(direction)?);
            Ok(())
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
        fill_each(py, threads, &directions, &[3], |direction, out| {
            out.copy_from_slice(&space.from_xyz(self.sky.xyz(direction)?));
            Ok(())
        })
    }
}

//! `JoinedAerialPerspective`: things before the sky of an observer.

use std::sync::Arc;

use pyo3::prelude::*;
use welkin::{AerialPerspective, Result, Sky};

use super::{Pair, RGB, colours};
use crate::errors::raise;
use crate::sky::space;
use crate::threads::Threads;
use crate::transmittance::Lines;

/// The air between an observer and things before the observer's sky. Made by `AerialPerspective.joined_to`.
///
/// Points are arrays (…, 3) in metres as of `AerialPerspective`; the observer stands above the origin.
#[pyclass(frozen, name = "JoinedAerialPerspective", module = "welkin_sky")]
pub struct PyJoinedAerialPerspective {
    aerial: Arc<AerialPerspective>,
    sky: Arc<Sky>,
    camera: [f64; 3],
}

impl PyJoinedAerialPerspective {
    pub fn new(py: Python<'_>, aerial: &Arc<AerialPerspective>, sky: &Arc<Sky>) -> PyResult<Self> {
        let joined = aerial.joined_to(sky).map_err(|error| raise(py, error))?;
        Ok(Self {
            camera: joined.camera(),
            aerial: Arc::clone(aerial),
            sky: Arc::clone(sky),
        })
    }

    fn joined(&self) -> Result<welkin::JoinedAerialPerspective<'_>> {
        self.aerial.joined_to(&self.sky)
    }
}

#[pymethods]
impl PyJoinedAerialPerspective {
    /// Where the observer is, m.
    #[getter]
    fn camera(&self) -> (f64, f64, f64) {
        self.camera.into()
    }

    /// Light that the air before points scatters to the observer, W m⁻² sr⁻¹ nm⁻¹, and the transmittance:
    /// (…, 3) → (…, W), (…, W).
    #[pyo3(signature = (points, *, threads=None))]
    fn in_scattering<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Pair<'py>> {
        let joined = self.joined().map_err(|error| raise(py, error))?;
        let width = self.aerial.wavelengths().len();
        let tails: [&[usize]; 2] = [&[width], &[width]];
        let lines = Lines::to_points(points)?;
        lines.fill_two(py, threads, tails, |_, point, light, factors| {
            joined.in_scattering(point, light, factors)
        })
    }

    /// The same as linear RGB, cd m⁻², and the factors of red, green and blue: (…, 3) → (…, 3), (…, 3).
    ///
    /// space: "srgb" or "xyz".
    #[pyo3(signature = (points, space="srgb", *, threads=None))]
    fn rgb<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        space: &str,
        threads: Option<Threads>,
    ) -> PyResult<Pair<'py>> {
        let space = self::space(py, space)?;
        let joined = self.joined().map_err(|error| raise(py, error))?;
        let lines = Lines::to_points(points)?;
        match space {
            welkin::ColourSpace::Srgb => {
                lines.fill_two(py, threads, RGB, |_, point, light, factors| {
                    colours(joined.linear_srgb(point)?, light, factors)
                })
            }
            welkin::ColourSpace::Xyz => {
                lines.fill_two(py, threads, RGB, |_, point, light, factors| {
                    colours(joined.xyz(point)?, light, factors)
                })
            }
            other => {
                let message =
                    format!("a joined aerial perspective knows srgb and xyz, not {other}");
                Err(crate::errors::refuse(py, "value", &message))
            }
        }
    }
}

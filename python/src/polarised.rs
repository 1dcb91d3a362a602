//! `PolarisedSky`: Stokes vectors of one set of conditions.

use std::sync::Arc;

use pyo3::prelude::*;
use welkin::{BakedSky, PolarisedSky, Stokes};

use crate::arrays::{Array, Directions, fill, list, wavelengths};
use crate::baked::polarised::PyBakedPolarisedSky;
use crate::conditions;
use crate::errors::raise;
use crate::frame;
use crate::rows::alone;
use crate::threads::Threads;

/// The clear sky of one scene with its polarisation. Made by `Model.polarised_sky`. Directions as of `Sky`.
///
/// Spectra are what `stokes_at` gives: `stokes` gives the nodes of the model (see `wavelengths`).
#[pyclass(frozen, name = "PolarisedSky", module = "welkin_sky")]
pub struct PyPolarisedSky {
    pub sky: Arc<PolarisedSky>,
}

impl From<PolarisedSky> for PyPolarisedSky {
    fn from(sky: PolarisedSky) -> Self {
        Self { sky: Arc::new(sky) }
    }
}

#[pymethods]
impl PyPolarisedSky {
    /// What the sky was prepared for.
    #[getter]
    fn conditions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        conditions::shown(py, self.sky.sky().conditions())
    }

    /// Wavelengths of `stokes`, nm: (W,), the nodes of the model.
    ///
    /// At nodes within absorption bands (of the default model 580, 605, 740, 762, 763, 825, 939 and 941 nm) values are
    /// terms that spectra are made of and not the spectral quantity there, from which they differ by up to 40 %:
    /// `stokes_at` gives that at any wavelength, these among them.
    #[getter]
    fn wavelengths<'py>(&self, py: Python<'py>) -> PyResult<Array<'py, f64>> {
        list(py, self.sky.sky().wavelengths())
    }

    /// Unit vector towards the sun's centre.
    #[getter]
    fn sun_direction(&self) -> (f32, f32, f32) {
        self.sky.sky().sun_direction().into()
    }

    /// Memory that the sky holds, bytes.
    #[getter]
    fn bytes(&self) -> usize {
        self.sky.bytes()
    }

    /// The same sky, turned so that the sun has this azimuth (rad). Costs no preparation.
    fn with_solar_azimuth(&self, py: Python<'_>, azimuth: f64) -> PyResult<Self> {
        let mut sky = PolarisedSky::clone(&self.sky);
        sky.set_solar_azimuth(azimuth).map_err(|e| raise(py, e))?;
        Ok(sky.into())
    }

    /// Radiance without polarisation at the nodes `wavelengths`, W m⁻² sr⁻¹ nm⁻¹: (…, 3) → (…, W).
    ///
    /// Within absorption bands the nodes are not spectral radiance: see `wavelengths`, and ask `stokes_at` for I.
    #[pyo3(signature = (directions, *, threads=None))]
    fn radiance<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let directions = Directions::directions(directions)?;
        let tail = [self.sky.sky().wavelengths().len()];
        fill(py, threads, &directions, &tail, |directions, out| {
            self.sky.sky().radiance_batch(directions, out)
        })
    }

    /// Stokes vectors I, Q, U, W m⁻² sr⁻¹ nm⁻¹, at the nodes `wavelengths`: (…, 3) → (…, 3, W).
    ///
    /// Within absorption bands the nodes are not spectra: see `wavelengths`, and ask `stokes_at`.
    ///
    /// frame: where Q > 0 is. "vertical" (None): in the vertical plane of the view direction; "sun_aligned": across the
    /// plane of view and sun; or an axis (x, y, z), such as a camera's up vector. U > 0 is 45° to the right of it.
    #[pyo3(signature = (directions, frame=None, *, threads=None))]
    fn stokes<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        frame: Option<&Bound<'py, PyAny>>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let frame = frame::read(frame)?;
        self.spectra(py, directions, threads, |direction, stokes| {
            self.sky.stokes(direction, frame, stokes)
        })
    }

    /// The same per unit of solar spectral irradiance, sr⁻¹: (…, 3) → (…, 3, W).
    #[pyo3(signature = (directions, frame=None, *, threads=None))]
    fn relative_stokes<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        frame: Option<&Bound<'py, PyAny>>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let frame = frame::read(frame)?;
        self.spectra(py, directions, threads, |direction, stokes| {
            self.sky.relative_stokes(direction, frame, stokes)
        })
    }

    /// Stokes vectors I, Q, U, W m⁻² sr⁻¹ nm⁻¹, at wavelengths in nm, a number or (K,): (…, 3) → (…, 3, K).
    #[pyo3(signature = (directions, wavelengths, frame=None, *, threads=None))]
    fn stokes_at<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        wavelengths: &Bound<'py, PyAny>,
        frame: Option<&Bound<'py, PyAny>>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let frame = frame::read(frame)?;
        let asked = self::wavelengths(wavelengths)?;
        let directions = Directions::directions(directions)?;
        stokes_rows(
            py,
            threads,
            &directions,
            asked.len(),
            |direction, stokes| {
                stokes
                    .iter_mut()
                    .zip(&asked)
                    .try_for_each(|(stokes, &wavelength)| {
                        *stokes = self.sky.stokes_at(direction, frame, wavelength)?;
                        Ok(())
                    })
            },
        )
    }

    /// Stokes vectors I, Q, U of CIE 1931 X, Y and Z, cd m⁻²: (…, 3) → (…, 3, 3), the last axis X, Y, Z.
    #[pyo3(signature = (directions, frame=None, *, threads=None))]
    fn xyz_stokes<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        frame: Option<&Bound<'py, PyAny>>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let frame = frame::read(frame)?;
        let directions = Directions::directions(directions)?;
        stokes_rows(py, threads, &directions, 3, |direction, stokes| {
            stokes.copy_from_slice(&self.sky.xyz(direction, frame)?);
            Ok(())
        })
    }

    /// Bakes the sky into tables that are asked many times faster. tolerance: as of `Sky.bake`.
    #[pyo3(signature = (tolerance=BakedSky::TOLERANCE), text_signature = "($self, tolerance=0.0025)")]
    fn bake(&self, py: Python<'_>, tolerance: f64) -> PyResult<PyBakedPolarisedSky> {
        Ok(alone(py, || self.sky.bake(tolerance))?.into())
    }
}

impl PyPolarisedSky {
    fn spectra<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        threads: Option<Threads>,
        work: impl Fn([f32; 3], &mut [Stokes]) -> welkin::Result<()> + Sync,
    ) -> PyResult<Array<'py>> {
        let directions = Directions::directions(directions)?;
        let width = self.sky.sky().wavelengths().len();
        stokes_rows(py, threads, &directions, width, work)
    }
}

/// Fills an array (…, 3, width) with I, Q and U of each direction.
pub fn stokes_rows<'py>(
    py: Python<'py>,
    threads: Option<Threads>,
    directions: &Directions<'py>,
    width: usize,
    work: impl Fn([f32; 3], &mut [Stokes]) -> welkin::Result<()> + Sync,
) -> PyResult<Array<'py>> {
    fill(py, threads, directions, &[3, width], |directions, out| {
        let mut stokes = vec![Stokes::default(); width];
        let rows = out.chunks_exact_mut((3 * width).max(1));
        for (&direction, row) in directions.iter().zip(rows) {
            work(direction, &mut stokes)?;
            part(&stokes, row);
        }
        Ok(())
    })
}

/// Writes all I, then all Q, then all U.
pub fn part(stokes: &[Stokes], out: &mut [f32]) {
    let width = stokes.len();
    for (k, stokes) in stokes.iter().enumerate() {
        out[k] = stokes.i;
        out[width + k] = stokes.q;
        out[2 * width + k] = stokes.u;
    }
}

//! `AerialPerspective`: spectra.

use std::sync::Arc;

use pyo3::prelude::*;
use welkin::{AerialPerspective, Stokes, StokesSpectra};

use super::joined::PyJoinedAerialPerspective;
use super::{Pair, RGB, colours, distances};
use crate::arrays::{Array, Output, list, vector, wavelengths};
use crate::conditions;
use crate::errors::raise;
use crate::frame;
use crate::rows::alone;
use crate::sky::{PySky, space};
use crate::threads::Threads;
use crate::transmittance::{Lines, PyTransmittance, each};

/// Transmittance and in-scattered light of segments in one scene. Made by `Model.aerial_perspective`.
///
/// Points are arrays (…, 3) in metres: the origin is on the ground, +z up there. Starts and ends are broadcast against
/// each other. What is seen of a thing is in_scattering + transmittance · thing.
///
/// For spectra ask the methods `…_at`: those without give the nodes of the model, which are not the spectrum within
/// absorption bands (see `wavelengths`).
#[pyclass(frozen, name = "AerialPerspective", module = "welkin_sky")]
pub struct PyAerialPerspective {
    pub aerial: Arc<AerialPerspective>,
}

impl From<AerialPerspective> for PyAerialPerspective {
    fn from(aerial: AerialPerspective) -> Self {
        Self {
            aerial: Arc::new(aerial),
        }
    }
}

#[pymethods]
impl PyAerialPerspective {
    /// What it was prepared for.
    #[getter]
    fn conditions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        conditions::shown(py, self.aerial.conditions())
    }

    /// Wavelengths of the results, nm: (W,), the nodes of the model.
    ///
    /// At nodes within absorption bands (of the default model 580, 605, 740, 762, 763, 825, 939 and 941 nm) values are
    /// terms that spectra are made of and not the spectral quantity there, which may be several times as much:
    /// `in_scattering_at` and `transmittance.between_at` give that at any wavelength, these among them.
    #[getter]
    fn wavelengths<'py>(&self, py: Python<'py>) -> PyResult<Array<'py, f64>> {
        list(py, self.aerial.wavelengths())
    }

    /// How far the air of segments may be from the origin, as an angle at the planet's centre, rad.
    #[getter]
    fn reach(&self) -> f64 {
        self.aerial.reach()
    }

    /// Memory that it holds, bytes.
    #[getter]
    fn bytes(&self) -> usize {
        self.aerial.bytes()
    }

    /// The air: transmittance alone.
    #[getter]
    fn transmittance(&self) -> PyTransmittance {
        self.aerial.transmittance().clone().into()
    }

    /// The same with the sun at another azimuth (rad). Costs no preparation.
    fn with_solar_azimuth(&self, py: Python<'_>, azimuth: f64) -> PyResult<Self> {
        let mut aerial = AerialPerspective::clone(&self.aerial);
        aerial
            .set_solar_azimuth(azimuth)
            .map_err(|e| raise(py, e))?;
        Ok(aerial.into())
    }

    /// Light that the air between points scatters to the start, W m⁻² sr⁻¹ nm⁻¹, and the transmittance between them:
    /// (…, 3), (…, 3) → (…, W), (…, W).
    ///
    /// Within absorption bands the nodes are not spectral radiance: see `wavelengths`, and ask `in_scattering_at`.
    #[pyo3(signature = (start, end, *, threads=None))]
    fn in_scattering<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Pair<'py>> {
        let width = self.aerial.wavelengths().len();
        let tails: [&[usize]; 2] = [&[width], &[width]];
        let lines = Lines::read(start, end, "end")?;
        lines.fill_two(py, threads, tails, |start, end, light, factors| {
            self.aerial.in_scattering(start, end, light, factors)
        })
    }

    /// The same from points in directions through all of the air, up to the ground where that is in the way:
    /// (…, 3), (…, 3) → (…, W), (…, W).
    #[pyo3(signature = (start, directions, *, threads=None))]
    fn to_end<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        directions: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Pair<'py>> {
        let width = self.aerial.wavelengths().len();
        let tails: [&[usize]; 2] = [&[width], &[width]];
        let lines = Lines::read(start, directions, "directions")?;
        lines.fill_two(py, threads, tails, |start, direction, light, factors| {
            self.aerial.to_end(start, direction, light, factors)
        })
    }

    /// In-scattered light at wavelengths in nm, a number or (K,), W m⁻² sr⁻¹ nm⁻¹: (…, 3), (…, 3) → (…, K). For the
    /// transmittance ask `transmittance.between_at`.
    #[pyo3(signature = (start, end, wavelengths, *, threads=None))]
    fn in_scattering_at<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: &Bound<'py, PyAny>,
        wavelengths: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let asked = self::wavelengths(wavelengths)?;
        let lines = Lines::read(start, end, "end")?;
        lines.fill(py, threads, asked.len(), |start, end, out| {
            each(out, &asked, |l| self.aerial.in_scattering_at(start, end, l))
        })
    }

    /// Stokes vectors I, Q, U of in-scattered light, W m⁻² sr⁻¹ nm⁻¹, and the transmittance:
    /// (…, 3), (…, 3) → (…, 3, W), (…, W). frame: as of `PolarisedSky.stokes`, of the view from the start.
    #[pyo3(signature = (start, end, frame=None, *, threads=None))]
    fn in_scattering_stokes<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: &Bound<'py, PyAny>,
        frame: Option<&Bound<'py, PyAny>>,
        threads: Option<Threads>,
    ) -> PyResult<Pair<'py>> {
        let frame = frame::read(frame)?;
        let width = self.aerial.wavelengths().len();
        let tails: [&[usize]; 2] = [&[3, width], &[width]];
        let lines = Lines::read(start, end, "end")?;
        lines.fill_two(py, threads, tails, |start, end, light, factors| {
            let (i, rest) = light.split_at_mut(width);
            let (q, u) = rest.split_at_mut(width);
            let light = StokesSpectra { i, q, u };
            self.aerial
                .in_scattering_stokes(start, end, frame, light, factors)
        })
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

    /// Stokes vectors I, Q, U of in-scattered light in linear sRGB, cd m⁻², and the factors of red, green and blue:
    /// (…, 3), (…, 3) → (…, 3, 3), (…, 3), the last axis red, green, blue.
    #[pyo3(signature = (start, end, frame=None, *, threads=None))]
    fn linear_srgb_stokes<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: &Bound<'py, PyAny>,
        frame: Option<&Bound<'py, PyAny>>,
        threads: Option<Threads>,
    ) -> PyResult<Pair<'py>> {
        let frame = frame::read(frame)?;
        let lines = Lines::read(start, end, "end")?;
        lines.fill_two(
            py,
            threads,
            [&[3, 3], &[3]],
            |start, end, light, factors| {
                let (stokes, passed): ([Stokes; 3], _) =
                    self.aerial.linear_srgb_stokes(start, end, frame)?;
                crate::polarised::part(&stokes, light);
                factors.copy_from_slice(&passed);
                Ok(())
            },
        )
    }

    /// `in_scattering` from one start at growing distances (m) in one direction, each piece integrated once:
    /// (3,), (3,), (D,) → (D, W), (D, W).
    fn in_scattering_along<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        direction: &Bound<'py, PyAny>,
        distances: &Bound<'py, PyAny>,
    ) -> PyResult<Pair<'py>> {
        let (start, direction) = (vector(start, "start")?, vector(direction, "direction")?);
        let distances = self::distances(distances)?;
        let width = self.aerial.wavelengths().len();
        let mut light = Output::new(py, &[distances.len()], &[width])?;
        let mut factors = Output::new(py, &[distances.len()], &[width])?;
        let (to, passed) = (light.all()?, factors.all()?);
        alone(py, || {
            self.aerial
                .in_scattering_along(start, direction, &distances, to, passed)
        })?;
        Ok((light.array, factors.array))
    }

    /// The air between the observer of a sky and things before that sky: what is far vanishes in it without a seam.
    fn joined_to(&self, py: Python<'_>, sky: &PySky) -> PyResult<PyJoinedAerialPerspective> {
        PyJoinedAerialPerspective::new(py, &self.aerial, &sky.sky)
    }
}

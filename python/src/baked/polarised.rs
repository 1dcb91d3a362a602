//! `BakedPolarisedSky`: Stokes vectors.

use std::sync::Arc;

use pyo3::prelude::*;
use welkin::{BakedPolarisedSky, BakedSky, Directions as Separate, Result, StokesSpectra};

use super::{Error, error, separate, shown};
use crate::arrays::{Array, Directions, Output, fill, list, wavelengths};
use crate::broadcast::{Operand, common};
use crate::conditions;
use crate::errors::raise;
use crate::frame;
use crate::polarised::{part, stokes_rows};
use crate::rows::{block_rows, run};
use crate::threads::Threads;

/// A polarised sky as tables. Made by `PolarisedSky.bake`. Directions as of `Sky`, frames as of `PolarisedSky.stokes`.
#[pyclass(frozen, name = "BakedPolarisedSky", module = "welkin_sky")]
pub struct PyBakedPolarisedSky {
    sky: Arc<BakedPolarisedSky>,
}

impl From<BakedPolarisedSky> for PyBakedPolarisedSky {
    fn from(sky: BakedPolarisedSky) -> Self {
        Self { sky: Arc::new(sky) }
    }
}

impl PyBakedPolarisedSky {
    fn plain(&self) -> &BakedSky {
        self.sky.sky()
    }
}

#[pymethods]
impl PyBakedPolarisedSky {
    /// What the sky was prepared for.
    #[getter]
    fn conditions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        conditions::shown(py, self.plain().conditions())
    }

    /// Wavelengths of `stokes`, nm: (W,), the nodes of the model.
    ///
    /// At nodes within absorption bands (of the default model 580, 605, 740, 762, 763, 825, 939 and 941 nm) values are
    /// terms that spectra are made of and not the spectral quantity there, from which they differ by up to 40 %:
    /// `stokes_at` gives that at any wavelength, these among them.
    #[getter]
    fn wavelengths<'py>(&self, py: Python<'py>) -> PyResult<Array<'py, f64>> {
        list(py, self.plain().wavelengths())
    }

    /// Relative error that baking added to I: median, 95th, 99th and 99.9th percentile, largest.
    #[getter]
    fn bake_error(&self) -> Error {
        error(self.plain().bake_error())
    }

    /// The same of (Q, U) over I, as a distance.
    #[getter]
    fn polarisation_error(&self) -> Error {
        error(self.sky.polarisation_error())
    }

    /// Memory that the sky holds, bytes.
    #[getter]
    fn bytes(&self) -> usize {
        self.sky.bytes()
    }

    /// The same sky, turned so that the sun has this azimuth (rad). Costs no preparation.
    fn with_solar_azimuth(&self, py: Python<'_>, azimuth: f64) -> PyResult<Self> {
        let mut sky = BakedPolarisedSky::clone(&self.sky);
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
        let tail = [self.plain().wavelengths().len()];
        fill(py, threads, &directions, &tail, |directions, out| {
            separate(directions, |directions| {
                self.plain().radiance_batch(directions, out)
            })
        })
    }

    /// Stokes vectors I, Q, U, W m⁻² sr⁻¹ nm⁻¹, at the nodes `wavelengths`: (…, 3) → (…, 3, W).
    ///
    /// Within absorption bands the nodes are not spectra: see `wavelengths`, and ask `stokes_at`.
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
        let width = self.plain().wavelengths().len();
        let evaluate = |directions: &Separate, out: StokesSpectra| {
            self.sky.stokes_batch(directions, frame, out)
        };
        spectra(py, threads, &directions, width, evaluate)
    }

    /// Stokes vectors I, Q, U, W m⁻² sr⁻¹ nm⁻¹, at wavelengths in nm, a number or (K,), that are the same for all
    /// directions: (…, 3) → (…, 3, K). Takes them in single precision, four at a time, as `hero`.
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
        stokes_rows(py, threads, &directions, asked.len(), |direction, out| {
            for (asked, out) in asked.chunks(4).zip(out.chunks_mut(4)) {
                let four = std::array::from_fn(|i| asked[i.min(asked.len() - 1)] as f32);
                let stokes = self.sky.hero(direction, frame, four)?;
                out.copy_from_slice(&stokes[..out.len()]);
            }
            Ok(())
        })
    }

    /// Stokes vectors at four wavelengths (nm) for each direction: (…, 3), (…, 4) → (…, 3, 4).
    #[pyo3(signature = (directions, wavelengths, frame=None, *, threads=None))]
    fn hero<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        wavelengths: &Bound<'py, PyAny>,
        frame: Option<&Bound<'py, PyAny>>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let frame = frame::read(frame)?;
        let directions: Operand<f32, 3> = Operand::vectors(directions, "directions")?;
        let wavelengths: Operand<f32, 4> = Operand::vectors(wavelengths, "wavelengths")?;
        let lead = common(py, &[directions.named(), wavelengths.named()])?;
        let (directions, wavelengths) = (directions.spread(&lead)?, wavelengths.spread(&lead)?);
        let (directions, wavelengths) = (directions.values()?, wavelengths.values()?);
        let mut output = Output::new(py, &lead, &[3, 4])?;
        let size = block_rows(lead.iter().product());
        run(
            py,
            threads,
            output.blocks(size)?,
            |block, out: &mut [f32]| {
                for (i, row) in out.chunks_exact_mut(12).enumerate() {
                    let i = block * size + i;
                    let stokes = self.sky.hero(directions.at(i), frame, wavelengths.at(i))?;
                    part(&stokes, row);
                }
                Ok(())
            },
        )?;
        Ok(output.array)
    }

    fn __repr__(&self) -> PyResult<String> {
        shown(
            "BakedPolarisedSky",
            self.sky.bytes(),
            &self.plain().bake_error(),
        )
    }
}

/// Fills an array (…, 3, width) from planes of I, Q and U.
pub fn spectra<'py>(
    py: Python<'py>,
    threads: Option<Threads>,
    directions: &Directions<'py>,
    width: usize,
    evaluate: impl Fn(&Separate, StokesSpectra) -> Result<()> + Sync,
) -> PyResult<Array<'py>> {
    fill(py, threads, directions, &[3, width], |directions, out| {
        let plane = directions.len() * width;
        let mut planes = vec![0.0; 3 * plane];
        let (i, rest) = planes.split_at_mut(plane);
        let (q, u) = rest.split_at_mut(plane);
        separate(directions, |d| evaluate(d, StokesSpectra { i, q, u }))?;
        for (component, plane) in planes.chunks_exact(plane).enumerate() {
            let rows = out
                .chunks_exact_mut(3 * width)
                .zip(plane.chunks_exact(width));
            for (row, values) in rows {
                row[component * width..][..width].copy_from_slice(values);
            }
        }
        Ok(())
    })
}

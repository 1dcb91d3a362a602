//! `Transmittance`: the air along straight lines.

use pyo3::prelude::*;
use welkin::{Result, Transmittance};

use crate::arrays::{Array, Output, list, wavelengths};
use crate::broadcast::{Operand, common};
use crate::rows::{block_rows, run};
use crate::threads::Threads;

/// The air at one visibility: transmittance along straight lines. Made by `Model.transmittance`.
///
/// Points are arrays (…, 3) in metres: the origin is on the ground, +z up there, the planet's centre at (0, 0, −R).
/// Starts, ends and directions are broadcast against each other. Nothing blocks the way between two points.
///
/// For spectra ask the methods `…_at`: those without give the nodes of the model, which are not the spectrum within
/// absorption bands (see `wavelengths`).
#[pyclass(frozen, name = "Transmittance", module = "welkin_sky")]
pub struct PyTransmittance {
    air: Transmittance,
}

impl From<Transmittance> for PyTransmittance {
    fn from(air: Transmittance) -> Self {
        Self { air }
    }
}

#[pymethods]
impl PyTransmittance {
    /// Wavelengths of the results, nm: (W,), the nodes of the model.
    ///
    /// At nodes within absorption bands (of the default model 580, 605, 740, 762, 763, 825, 939 and 941 nm) values are
    /// terms that spectra are made of and not the spectral quantity there, which may be several times as much:
    /// `between_at` gives that at any wavelength, these among them.
    #[getter]
    fn wavelengths<'py>(&self, py: Python<'py>) -> PyResult<Array<'py, f64>> {
        list(py, self.air.wavelengths())
    }

    /// Transmittance between points at `wavelengths`: (…, 3), (…, 3) → (…, W).
    ///
    /// Within absorption bands the nodes are not spectral transmittance: see `wavelengths`, and ask `between_at`.
    #[pyo3(signature = (start, end, *, threads=None))]
    fn between<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let width = self.air.wavelengths().len();
        let lines = Lines::read(start, end, "end")?;
        lines.fill(py, threads, width, |start, end, out| {
            self.air.transmittance(start, end, out)
        })
    }

    /// Optical depth between points: (…, 3), (…, 3) → (…, W).
    #[pyo3(signature = (start, end, *, threads=None))]
    fn optical_depth<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let width = self.air.wavelengths().len();
        let lines = Lines::read(start, end, "end")?;
        lines.fill(py, threads, width, |start, end, out| {
            self.air.optical_depth(start, end, out)
        })
    }

    /// Transmittance from points to space, zero where the ground is in the way: (…, 3), (…, 3) → (…, W).
    #[pyo3(signature = (start, directions, *, threads=None))]
    fn to_space<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        directions: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let width = self.air.wavelengths().len();
        let lines = Lines::read(start, directions, "directions")?;
        lines.fill(py, threads, width, |start, direction, out| {
            self.air.transmittance_to_space(start, direction, out)
        })
    }

    /// Transmittance from points through all of the air, up to the ground where that is in the way: as `to_space`.
    #[pyo3(signature = (start, directions, *, threads=None))]
    fn to_end<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        directions: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let width = self.air.wavelengths().len();
        let lines = Lines::read(start, directions, "directions")?;
        lines.fill(py, threads, width, |start, direction, out| {
            self.air.transmittance_to_end(start, direction, out)
        })
    }

    /// Transmittance between points at wavelengths in nm, a number or (K,): (…, 3), (…, 3) → (…, K).
    ///
    /// In an absorption band it is the mean over the band.
    #[pyo3(signature = (start, end, wavelengths, *, threads=None))]
    fn between_at<'py>(
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
            each(out, &asked, |l| self.air.transmittance_at(start, end, l))
        })
    }

    /// Transmittance from points to space at wavelengths in nm: (…, 3), (…, 3) → (…, K).
    #[pyo3(signature = (start, directions, wavelengths, *, threads=None))]
    fn to_space_at<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        directions: &Bound<'py, PyAny>,
        wavelengths: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let asked = self::wavelengths(wavelengths)?;
        let lines = Lines::read(start, directions, "directions")?;
        lines.fill(py, threads, asked.len(), |start, direction, out| {
            each(out, &asked, |l| {
                self.air.transmittance_to_space_at(start, direction, l)
            })
        })
    }
}

/// Starts with as many ends or directions.
pub struct Lines<'py> {
    start: Operand<'py, f64, 3>,
    end: Operand<'py, f64, 3>,
    lead: Vec<usize>,
}

impl<'py> Lines<'py> {
    pub fn read(
        start: &Bound<'py, PyAny>,
        end: &Bound<'py, PyAny>,
        what: &'static str,
    ) -> PyResult<Self> {
        let py = start.py();
        let start = Operand::vectors(start, "start")?;
        let end = Operand::vectors(end, what)?;
        let lead = common(py, &[start.named(), end.named()])?;
        Ok(Self {
            start: start.spread(&lead)?,
            end: end.spread(&lead)?,
            lead,
        })
    }

    /// To points, from wherever.
    pub fn to_points(points: &Bound<'py, PyAny>) -> PyResult<Self> {
        let origin = [0.0; 3].into_pyobject(points.py())?;
        let end = Operand::vectors(points, "points")?;
        Ok(Self {
            start: Operand::vectors(&origin, "start")?,
            lead: end.lead().to_vec(),
            end,
        })
    }

    /// An array (…, width), a line at a time.
    pub fn fill(
        &self,
        py: Python<'py>,
        threads: Option<Threads>,
        width: usize,
        work: impl Fn([f64; 3], [f64; 3], &mut [f32]) -> Result<()> + Sync,
    ) -> PyResult<Array<'py>> {
        let (start, end) = (self.start.values()?, self.end.values()?);
        let mut output = Output::new(py, &self.lead, &[width])?;
        let size = block_rows(self.lead.iter().product());
        run(
            py,
            threads,
            output.blocks(size)?,
            |block, out: &mut [f32]| {
                let mut rows = out.chunks_exact_mut(width.max(1)).enumerate();
                rows.try_for_each(|(i, out)| {
                    let i = block * size + i;
                    work(start.at(i), end.at(i), out)
                })
            },
        )?;
        Ok(output.array)
    }

    /// Two arrays (…, tail), a line at a time.
    pub fn fill_two(
        &self,
        py: Python<'py>,
        threads: Option<Threads>,
        tails: [&[usize]; 2],
        work: impl Fn([f64; 3], [f64; 3], &mut [f32], &mut [f32]) -> Result<()> + Sync,
    ) -> PyResult<(Array<'py>, Array<'py>)> {
        let (start, end) = (self.start.values()?, self.end.values()?);
        let mut light = Output::new(py, &self.lead, tails[0])?;
        let mut factors = Output::new(py, &self.lead, tails[1])?;
        let size = block_rows(self.lead.iter().product());
        let widths = tails.map(|tail| tail.iter().product::<usize>().max(1));
        let blocks = light.blocks(size)?.zip(factors.blocks(size)?);
        run(py, threads, blocks, |block, (light, factors)| {
            let rows = light.chunks_exact_mut(widths[0]);
            let mut rows = rows.zip(factors.chunks_exact_mut(widths[1])).enumerate();
            rows.try_for_each(|(i, (light, factors)): (_, (&mut [f32], &mut [f32]))| {
                let i = block * size + i;
                work(start.at(i), end.at(i), light, factors)
            })
        })?;
        Ok((light.array, factors.array))
    }
}

/// A value for each wavelength.
pub fn each(
    out: &mut [f32],
    wavelengths: &[f64],
    value: impl Fn(f64) -> Result<f32>,
) -> Result<()> {
    let mut values = out.iter_mut().zip(wavelengths);
    values.try_for_each(|(out, &wavelength)| {
        *out = value(wavelength)?;
        Ok(())
    })
}

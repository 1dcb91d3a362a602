//! `SkySampler`: directions drawn by luminance.

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use welkin::{Part, SkySampler};

use crate::arrays::{Array, Directions, Output, Vectors, fill_each};
use crate::rows::{block_rows, run};
use crate::threads::Threads;

/// Draws directions by the luminance of a sky, with or without the sun. Made by `BakedColourSky.sampler`.
#[pyclass(frozen, name = "SkySampler", module = "welkin_sky")]
pub struct PySkySampler {
    sampler: SkySampler,
}

impl From<SkySampler> for PySkySampler {
    fn from(sampler: SkySampler) -> Self {
        Self { sampler }
    }
}

#[pymethods]
impl PySkySampler {
    /// Maps points of the unit square to directions: (…, 2) → `Samples`, a named tuple of arrays.
    ///
    /// `directions` (…, 3); `pdf` (…), their density per solid angle, sr⁻¹; `xyz` (…, 3), the light from there, cd m⁻²;
    /// `is_sun` (…), whether it was drawn for the sun's disc. Numbers outside 0 to 1, or NaN, are refused.
    #[pyo3(signature = (unit_square, *, threads=None))]
    fn sample<'py>(
        &self,
        py: Python<'py>,
        unit_square: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let numbers = Vectors::<f32, 2>::read(unit_square, "unit_square")?;
        let (lead, numbers) = (numbers.lead(), numbers.rows()?);
        if let Some(&bad) = numbers
            .as_flattened()
            .iter()
            .find(|v| !(0.0..=1.0).contains(*v))
        {
            let limits = [f64::from(bad), 0.0, 1.0];
            return Err(crate::errors::out_of_range(py, "unit_square", limits, ""));
        }
        let mut directions = Output::<f32>::new(py, lead, &[3])?;
        let mut densities = Output::<f32>::new(py, lead, &[])?;
        let mut colours = Output::<f32>::new(py, lead, &[3])?;
        let mut suns = Output::<bool>::new(py, lead, &[])?;
        let size = block_rows(numbers.len());
        let light = densities.blocks(size)?.zip(colours.blocks(size)?);
        let outputs = directions.blocks(size)?.zip(light).zip(suns.blocks(size)?);
        run(
            py,
            threads,
            numbers.chunks(size).zip(outputs),
            |_, (numbers, outputs)| {
                let ((directions, (densities, colours)), suns) = outputs;
                for (i, &numbers) in numbers.iter().enumerate() {
                    let sample = self.sampler.sample(numbers);
                    directions.as_chunks_mut().0[i] = sample.direction;
                    densities[i] = sample.pdf;
                    colours.as_chunks_mut().0[i] = sample.xyz;
                    suns[i] = sample.part == Part::Sun;
                }
                Ok(())
            },
        )?;
        let fields = (directions.array, densities.array, colours.array, suns.array);
        let samples = py.import("welkin_sky.samples")?.getattr("Samples")?;
        samples.call1(fields.into_pyobject(py)?.cast_into::<PyTuple>()?)
    }

    /// The density of `sample` at directions, sr⁻¹: (…, 3) → (…).
    #[pyo3(signature = (directions, *, threads=None))]
    fn pdf<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let directions = Directions::directions(directions)?;
        fill_each(py, threads, &directions, &[], |direction, out| {
            out[0] = self.sampler.pdf(direction)?;
            Ok(())
        })
    }

    /// CIE 1931 X, Y, Z, cd m⁻², of what draws are in proportion to, the sun's disc among it: (…, 3) → (…, 3).
    #[pyo3(signature = (directions, *, threads=None))]
    fn xyz<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let directions = Directions::directions(directions)?;
        fill_each(py, threads, &directions, &[3], |direction, out| {
            out.copy_from_slice(&self.sampler.xyz(direction)?);
            Ok(())
        })
    }

    /// Memory without the sun's disc, bytes.
    #[getter]
    fn bytes(&self) -> usize {
        self.sampler.bytes()
    }
}

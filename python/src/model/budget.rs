//! What a scene needs of a model.

use pyo3::prelude::*;
use welkin::{BakedSky, Budget, Channels, Plan};

use super::PyModel;
use crate::arrays::pair;
use crate::errors::refuse;
use crate::rows::alone;

/// What a scene reads, holds and errs. Made by `Model.plan`, read by `Model.load`.
#[pyclass(frozen, name = "Plan", module = "welkin_sky")]
pub struct PyPlan {
    pub plan: Plan,
}

#[pymethods]
impl PyModel {
    /// Finds what a scene needs that meets conditions in these ranges; reads nothing.
    ///
    /// altitude, visibility (m), solar_elevation (rad): lowest and highest; the whole range of the model if not given.
    /// tolerance: as of `Sky.bake`. channels: "spectral", "colour" or "stokes".
    #[pyo3(
        signature = (
            *, altitude=None, visibility=None, solar_elevation=None, tolerance=BakedSky::TOLERANCE, channels="spectral"
        ),
        text_signature = "($self, *, \
            altitude=None, visibility=None, solar_elevation=None, tolerance=0.0025, channels='spectral')"
    )]
    fn plan(
        &self,
        py: Python<'_>,
        altitude: Option<&Bound<'_, PyAny>>,
        visibility: Option<&Bound<'_, PyAny>>,
        solar_elevation: Option<&Bound<'_, PyAny>>,
        tolerance: f64,
        channels: &str,
    ) -> PyResult<PyPlan> {
        let within = |given: Option<&Bound<'_, PyAny>>, name, whole, unit| {
            given.map_or(Ok(whole), |given| pair(given, name, whole, unit))
        };
        let budget = Budget {
            altitude: within(altitude, "altitude", self.model.altitude_range(), "m")?,
            visibility: within(visibility, "visibility", self.model.visibility_range(), "m")?,
            solar_elevation: within(
                solar_elevation,
                "solar_elevation",
                self.model.solar_elevation_range(),
                "rad",
            )?,
            tolerance,
            channels: channels_of(py, channels)?,
        };
        let plan = alone(py, || self.model.plan(&budget))?;
        Ok(PyPlan { plan })
    }

    /// Reads and verifies what a plan of this model asks for, with few requests: after that no sky of the scene reads.
    fn load(&self, py: Python<'_>, plan: &PyPlan) -> PyResult<()> {
        alone(py, || self.model.load(&plan.plan))
    }
}

#[pymethods]
impl PyPlan {
    /// Bytes of the file that are read: the head and the chunks.
    #[getter]
    fn file_bytes(&self) -> usize {
        self.plan.file_bytes
    }

    /// Chunks that are read.
    #[getter]
    fn chunk_count(&self) -> usize {
        self.plan.chunk_count
    }

    /// Most bytes that a baked sky of the scene holds.
    #[getter]
    fn sky_bytes(&self) -> usize {
        self.plan.sky_bytes
    }

    /// Largest median of the relative error of a chunk against its traced data.
    #[getter]
    fn error_median(&self) -> f32 {
        self.plan.error_median
    }

    /// Largest 99th percentile of the same.
    #[getter]
    fn error_p99(&self) -> f32 {
        self.plan.error_p99
    }

    /// Median and 99th percentile of the error of the degree of polarisation; None but for "stokes".
    #[getter]
    fn degree_error(&self) -> Option<(f32, f32)> {
        self.plan.degree_error.map(Into::into)
    }

    /// Relative error that baking adds at most at 95 % of directions and channels.
    #[getter]
    fn bake_p95(&self) -> f64 {
        self.plan.bake_p95
    }

    fn __repr__(&self) -> String {
        let plan = &self.plan;
        let (bytes, chunks, sky) = (plan.file_bytes, plan.chunk_count, plan.sky_bytes);
        format!("<welkin_sky.Plan: {bytes} bytes of {chunks} chunks, skies of {sky} bytes>")
    }
}

fn channels_of(py: Python<'_>, name: &str) -> PyResult<Channels> {
    match name {
        "spectral" => Ok(Channels::Spectral),
        "colour" => Ok(Channels::Colour),
        "stokes" => Ok(Channels::Stokes),
        _ => {
            let message = format!("unknown channels {name:?}: known are spectral, colour, stokes");
            Err(refuse(py, "value", &message))
        }
    }
}

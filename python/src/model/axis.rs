//! What the visibilities of a file stand for.

use pyo3::prelude::*;
use welkin::ModelAxis;

use super::PyModel;
use crate::arrays::{Array, list};
use crate::errors::raise;
use crate::rows::alone;

/// A quantity that the visibilities of a model stand for, as ozone or an amount of dust. Made by `Model.axis`.
#[pyclass(frozen, name = "ModelAxis", module = "welkin_sky")]
pub struct PyModelAxis {
    axis: ModelAxis,
}

#[pymethods]
impl PyModel {
    /// The quantity that the visibilities of the file stand for, or None where they stand for themselves.
    #[getter]
    fn axis(&self, py: Python<'_>) -> PyResult<Option<PyModelAxis>> {
        let axis = alone(py, || self.model.axis())?;
        Ok(axis.map(|axis| PyModelAxis { axis }))
    }
}

#[pymethods]
impl PyModelAxis {
    /// What the file calls the quantity.
    #[getter]
    fn name(&self) -> &str {
        self.axis.name()
    }

    /// What it is measured in; empty for a number without unit.
    #[getter]
    fn unit(&self) -> &str {
        self.axis.unit()
    }

    /// Its values at the nodes, which increase or decrease: (V,).
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Array<'py, f64>> {
        list(py, self.axis.values())
    }

    /// Least and largest value.
    #[getter]
    fn range(&self) -> (f64, f64) {
        self.axis.range().into()
    }

    /// The visibility, m, that stands for a value: what conditions take. Raises RangeError beyond `range`.
    fn visibility(&self, py: Python<'_>, value: f64) -> PyResult<f64> {
        self.axis
            .visibility(value)
            .map_err(|error| raise(py, error))
    }

    /// The value that a visibility in m stands for.
    fn value(&self, py: Python<'_>, visibility: f64) -> PyResult<f64> {
        self.axis
            .value(visibility)
            .map_err(|error| raise(py, error))
    }

    fn __repr__(&self) -> String {
        let [low, high] = self.axis.range();
        let (name, unit) = (self.axis.name(), self.axis.unit());
        format!("<welkin_sky.ModelAxis: {name:?} {low} to {high} {unit:?}>")
    }
}

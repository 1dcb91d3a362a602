//! Where models come from.

use std::path::PathBuf;

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use welkin::{Albedo, Model, Moon};

use super::PyModel;
use crate::errors::raise;
use crate::moon;
use crate::rows::alone;
use crate::source::{Source, to_bytes};

const STREAMED: &str = "a streamed model cannot be pickled: open the file, and pickle that model";

/// How a model was opened, to do it again in another process.
pub enum Recipe {
    Default,
    Path(PathBuf, bool),
    Bytes(Py<PyBytes>),
    Stream,
    Moonlit(Box<Recipe>, Moon),
    /// Wavelengths and albedos.
    Over(Box<Recipe>, [Vec<f64>; 2]),
}

impl Recipe {
    pub fn clone_ref(&self, py: Python<'_>) -> Self {
        match self {
            Self::Default => Self::Default,
            Self::Path(path, in_memory) => Self::Path(path.clone(), *in_memory),
            Self::Bytes(bytes) => Self::Bytes(bytes.clone_ref(py)),
            Self::Stream => Self::Stream,
            Self::Moonlit(of, moon) => Self::Moonlit(Box::new(of.clone_ref(py)), *moon),
            Self::Over(of, ground) => Self::Over(Box::new(of.clone_ref(py)), ground.clone()),
        }
    }

    pub fn reduce<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let module = py.import("welkin_sky")?;
        let call = |name: &str| module.getattr(name);
        let call_and_arguments = match self {
            Self::Default => (call("default_model")?, ()).into_pyobject(py)?.into_any(),
            Self::Path(path, in_memory) => {
                let arguments = (path, in_memory);
                (call("open")?, arguments).into_pyobject(py)?.into_any()
            }
            Self::Bytes(bytes) => {
                let arguments = (bytes.clone_ref(py),);
                (call("from_bytes")?, arguments)
                    .into_pyobject(py)?
                    .into_any()
            }
            Self::Stream => {
                return Err(PyTypeError::new_err(STREAMED));
            }
            Self::Moonlit(of, moon) => {
                let model = of.open(py)?.into_pyobject(py)?;
                let arguments = (model, moon::shown(py, moon)?);
                let method = module.getattr("Model")?.getattr("moonlit")?;
                (method, arguments).into_pyobject(py)?.into_any()
            }
            Self::Over(of, [wavelengths, albedos]) => {
                let model = of.open(py)?.into_pyobject(py)?;
                let arguments = (model, wavelengths.clone(), albedos.clone());
                let method = module.getattr("Model")?.getattr("over")?;
                (method, arguments).into_pyobject(py)?.into_any()
            }
        };
        Ok(call_and_arguments)
    }

    fn open(&self, py: Python<'_>) -> PyResult<PyModel> {
        match self {
            Self::Default => default_model(py),
            Self::Path(path, in_memory) => open(py, path.clone(), *in_memory),
            Self::Bytes(bytes) => from_bytes(py, bytes.bind(py).as_any()),
            Self::Stream => Err(PyTypeError::new_err(STREAMED)),
            Self::Moonlit(of, moon) => of.open(py)?.moonlit_by(py, moon),
            Self::Over(of, ground) => of.open(py)?.over_ground(py, ground.clone()),
        }
    }
}

impl PyModel {
    /// Over a ground with these wavelengths (nm) and albedos.
    pub fn over_ground(&self, py: Python<'_>, ground: [Vec<f64>; 2]) -> PyResult<Self> {
        let [wavelengths, albedos] = &ground;
        let albedo = Albedo::table(wavelengths, albedos).map_err(|e| raise(py, e))?;
        let model = alone(py, || Ok(self.model.over(&albedo)))?;
        let recipe = Recipe::Over(Box::new(self.recipe.clone_ref(py)), ground);
        Ok(Self::new(model, recipe))
    }

    pub fn moonlit_by(&self, py: Python<'_>, moon: &Moon) -> PyResult<Self> {
        let model = alone(py, || self.model.moonlit(moon))?;
        let recipe = Recipe::Moonlit(Box::new(self.recipe.clone_ref(py)), *moon);
        Ok(Self::new(model, recipe))
    }
}

/// The model that is part of this package.
#[pyfunction]
pub fn default_model(py: Python<'_>) -> PyResult<PyModel> {
    let model = alone(py, Model::default_model)?;
    Ok(PyModel::new(model, Recipe::Default))
}

/// Opens a file, and reads its head.
///
/// The file is mapped: it must not be cut off or changed in place while the model lives (replacing it is fine).
/// in_memory: reads all of it at once instead, for files of which that cannot be promised.
#[pyfunction]
#[pyo3(signature = (path, in_memory=false))]
pub fn open(py: Python<'_>, path: PathBuf, in_memory: bool) -> PyResult<PyModel> {
    let opened = alone(py, || match in_memory {
        true => Model::read(&path),
        false => Model::open(&path),
    });
    // Another process may run elsewhere.
    let path = std::path::absolute(&path).unwrap_or(path);
    Ok(PyModel::new(opened?, Recipe::Path(path, in_memory)))
}

/// Opens a file that is in memory: bytes, or anything with a buffer, which is copied.
#[pyfunction]
pub fn from_bytes(py: Python<'_>, data: &Bound<'_, PyAny>) -> PyResult<PyModel> {
    let data = to_bytes(data)?.cast_into::<PyBytes>()?;
    let bytes = data.as_bytes();
    let model = alone(py, || Model::from_bytes(bytes))?;
    Ok(PyModel::new(model, Recipe::Bytes(data.unbind())))
}

/// Opens a file that is read in pieces, from a slow disk or over a network.
///
/// source: a callable (offset, length) → bytes, fewer only where the file ends, or an object with such a method
/// `read_at`. It is called from any thread. What it raises is the cause of an `IoError`.
#[pyfunction]
pub fn stream(py: Python<'_>, source: &Bound<'_, PyAny>) -> PyResult<PyModel> {
    let source = Source::new(source)?;
    let model = alone(py, || Model::stream(source))?;
    Ok(PyModel::new(model, Recipe::Stream))
}

//! The tables of baked skies as numpy arrays, for evaluation elsewhere.

use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use welkin::{BakedSky, SkyBuffers};

use crate::baked::colour::PyBakedColourSky;
use crate::baked::spectral::PyBakedSky;
use crate::bands::sky::{PyBakedBandSky, PyPolarisedBandSky};
use crate::rows::alone;

/// `(groups, n, 4)`.
fn array<'py>(py: Python<'py>, values: &[[f32; 4]], groups: usize) -> PyResult<Bound<'py, PyAny>> {
    let flat = PyArray1::from_slice(py, values.as_flattened());
    Ok(flat.reshape([groups, values.len() / groups, 4])?.into_any())
}

fn dictionary(py: Python<'_>, buffers: SkyBuffers) -> PyResult<Bound<'_, PyDict>> {
    let (h, out) = (&buffers.header, PyDict::new(py));
    out.set_item("sun", h.sun)?;
    out.set_item("horizon", h.horizon)?;
    out.set_item("azimuth", h.azimuth)?;
    out.set_item("shrink", h.shrink)?;
    out.set_item("crowding", h.crowding)?;
    out.set_item("pole", h.pole)?;
    out.set_item("opaque", h.opaque)?;
    out.set_item("intervals", h.intervals)?;
    out.set_item("sun_intervals", h.sun_intervals)?;
    out.set_item("channels", h.channels)?;
    out.set_item("layout", h.layout)?;
    let groups = h.groups as usize;
    out.set_item("envelope", array(py, &buffers.envelope, groups)?)?;
    out.set_item("cells", array(py, &buffers.cells, groups)?)?;
    out.set_item("scale", array(py, &buffers.scale, groups)?)?;
    let polarisation = match h.polarised {
        0 => None,
        _ => Some(array(py, &buffers.polarisation, 2 * groups)?),
    };
    out.set_item("polarisation", polarisation)?;
    Ok(out)
}

#[pymethods]
impl PyBakedColourSky {
    /// The tables as arrays for shaders and array languages: X, Y and Z, by the formulae of `SkyBuffers` in the library.
    fn buffers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        dictionary(py, self.sky.buffers())
    }
}

#[pymethods]
impl PyBakedSky {
    /// The tables as arrays for shaders and array languages: all wavelengths, by the formulae of `SkyBuffers` in the
    /// library.
    fn buffers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        dictionary(py, self.sky.buffers())
    }
}

#[pymethods]
impl PyBakedBandSky {
    /// The tables as arrays for shaders and array languages: all bands, by the formulae of `SkyBuffers` in the library.
    fn buffers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        dictionary(py, self.sky.buffers())
    }
}

#[pymethods]
impl PyPolarisedBandSky {
    /// Bakes the sky (tolerance: as of `Sky.bake`) and hands out its tables with those of the polarisation: all bands, by
    /// the formulae of `SkyBuffers` in the library.
    #[pyo3(signature = (tolerance=BakedSky::TOLERANCE), text_signature = "($self, tolerance=0.0025)")]
    fn buffers<'py>(&self, py: Python<'py>, tolerance: f64) -> PyResult<Bound<'py, PyDict>> {
        let baked = alone(py, || self.sky.bake(tolerance))?;
        dictionary(py, baked.buffers())
    }
}

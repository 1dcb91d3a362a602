//! Polarisation frames by name, or an axis.

use pyo3::prelude::*;
use welkin::PolarisationFrame;

use crate::arrays::vector;
use crate::errors::refuse;

/// `None` is the vertical frame.
pub fn read(frame: Option<&Bound<'_, PyAny>>) -> PyResult<PolarisationFrame> {
    let Some(frame) = frame else {
        return Ok(PolarisationFrame::Vertical);
    };
    let Ok(name) = frame.extract::<String>() else {
        return Ok(PolarisationFrame::Axis(vector(frame, "frame")?));
    };
    match name.as_str() {
        "vertical" => Ok(PolarisationFrame::Vertical),
        "sun_aligned" => Ok(PolarisationFrame::SunAligned),
        _ => {
            let message = format!(
                "unknown frame {name:?}: known are vertical, sun_aligned, or an axis (x, y, z)"
            );
            Err(refuse(frame.py(), "value", &message))
        }
    }
}

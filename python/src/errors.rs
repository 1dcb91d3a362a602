//! From the library's errors to the exceptions of `welkin_sky.errors`.

use std::f64::consts::FRAC_PI_2;
use std::io;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use welkin::Error;

/// The exception for an error, with what the error knows as attributes.
pub fn raise(py: Python<'_>, error: Error) -> PyErr {
    let message = format!("{error}{}", hint(&error));
    let class = error.class();
    let attributes = PyDict::new(py);
    let cause = match describe(&attributes, error) {
        Ok(cause) => cause,
        Err(failed) => return failed,
    };
    let made = exception(py, class, &message, &attributes);
    let raised = made.unwrap_or_else(|failed| failed);
    if cause.is_some() {
        raised.set_cause(py, cause);
    }
    raised
}

/// An angle of more than a quarter turn that would be in range if it were in degrees.
fn hint(error: &Error) -> &'static str {
    match *error {
        Error::OutOfRange {
            value,
            min,
            max,
            unit: "rad",
            ..
        } if value.abs() > FRAC_PI_2 && (min..=max).contains(&value.to_radians()) => {
            " (in degrees? use np.radians)"
        }
        _ => "",
    }
}

/// An exception of the same kind as an [`Error`] of this class.
pub fn refuse(py: Python<'_>, class: &str, message: &str) -> PyErr {
    exception(py, class, message, &PyDict::new(py)).unwrap_or_else(|failed| failed)
}

/// A parameter that is not in its range, as [`Error::OutOfRange`] says it.
pub fn out_of_range(
    py: Python<'_>,
    parameter: &'static str,
    [value, min, max]: [f64; 3],
    unit: &'static str,
) -> PyErr {
    let error = Error::OutOfRange {
        parameter,
        value,
        min,
        max,
        unit,
    };
    raise(py, error)
}

fn exception(
    py: Python<'_>,
    class: &str,
    message: &str,
    attributes: &Bound<'_, PyDict>,
) -> PyResult<PyErr> {
    let make = py.import("welkin_sky.errors")?.getattr("_of_class")?;
    Ok(PyErr::from_value(make.call1((class, message, attributes))?))
}

/// Fills in the attributes; gives the exception of a Python source that failed.
fn describe(attributes: &Bound<'_, PyDict>, error: Error) -> PyResult<Option<PyErr>> {
    match error {
        Error::OutOfRange {
            parameter,
            value,
            min,
            max,
            unit,
        } => {
            attributes.set_item("parameter", parameter)?;
            attributes.set_item("value", value)?;
            attributes.set_item("min", min)?;
            attributes.set_item("max", max)?;
            attributes.set_item("unit", unit)?;
        }
        Error::OutOfAxis {
            name,
            value,
            min,
            max,
            unit,
        } => {
            attributes.set_item("parameter", name)?;
            attributes.set_item("value", value)?;
            attributes.set_item("min", min)?;
            attributes.set_item("max", max)?;
            attributes.set_item("unit", unit)?;
        }
        Error::Direction { got } => attributes.set_item("got", got.map(f64::from).to_vec())?,
        Error::Point { got } | Error::Reach { got, .. } => {
            attributes.set_item("got", got.to_vec())?;
        }
        Error::Length { expected, got, .. } => {
            attributes.set_item("expected", expected)?;
            attributes.set_item("got", got)?;
        }
        Error::Tolerance { expected, got } => {
            attributes.set_item("expected", expected)?;
            attributes.set_item("got", got)?;
        }
        Error::MissingChunk {
            kind,
            altitude,
            visibility,
        } => {
            attributes.set_item("kind", kind)?;
            attributes.set_item("altitude", altitude)?;
            attributes.set_item("visibility", visibility)?;
        }
        Error::Io { path, source } => {
            attributes.set_item("errno", source.raw_os_error())?;
            attributes.set_item("filename", path.into_os_string())?;
            attributes.set_item("missing", source.kind() == io::ErrorKind::NotFound)?;
        }
        Error::Read { offset, source } => {
            attributes.set_item("offset", offset)?;
            return Ok(python_cause(source));
        }
        _ => {}
    }
    Ok(None)
}

fn python_cause(source: io::Error) -> Option<PyErr> {
    source.into_inner()?.downcast::<PyErr>().ok().map(|e| *e)
}

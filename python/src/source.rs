//! A Python callable as the source of a streamed model.

use std::io;

use pyo3::prelude::*;
use welkin::ReadAt;

/// Calls `read(offset, length)`, which gives bytes.
pub struct Source {
    read: Py<PyAny>,
}

impl Source {
    /// A callable, or an object with a method `read_at` that is one.
    pub fn new(source: &Bound<'_, PyAny>) -> PyResult<Self> {
        let read = match source.hasattr("read_at")? {
            true => source.getattr("read_at")?,
            false => source.clone(),
        };
        if !read.is_callable() {
            let message = "the source must be a callable (offset, length) or have a method read_at";
            return Err(pyo3::exceptions::PyTypeError::new_err(message));
        }
        Ok(Self {
            read: read.unbind(),
        })
    }
}

impl ReadAt for Source {
    fn read_at(&self, offset: u64, buffer: &mut [u8]) -> io::Result<usize> {
        Python::attach(|py| {
            let answer = self.read.call1(py, (offset, buffer.len()));
            let copy = answer.and_then(|answer| copy(answer.bind(py), buffer));
            copy.map_err(io::Error::other)
        })
    }
}

/// Bytes, or what `bytes` makes some of.
fn copy(answer: &Bound<'_, PyAny>, buffer: &mut [u8]) -> PyResult<usize> {
    let bytes = to_bytes(answer)?;
    let bytes: &[u8] = bytes.extract()?;
    let Some(start) = buffer.get_mut(..bytes.len()) else {
        let message = format!(
            "{} bytes came, {} were asked for",
            bytes.len(),
            buffer.len()
        );
        return Err(pyo3::exceptions::PyValueError::new_err(message));
    };
    start.copy_from_slice(bytes);
    Ok(bytes.len())
}

/// A buffer as bytes; a number is none, of which `bytes` would make zeros.
pub fn to_bytes<'py>(data: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    if data.is_instance_of::<pyo3::types::PyBytes>() {
        return Ok(data.clone());
    }
    let view = data
        .py()
        .import("builtins")?
        .call_method1("memoryview", (data,))?;
    view.call_method0("tobytes")
}

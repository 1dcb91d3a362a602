//! Baked skies: tables that are asked in batches.

pub mod colour;
pub mod polarised;
pub mod spectral;

use pyo3::prelude::*;
use welkin::{BakeError, Directions, Result};

use crate::rows::MOST_ROWS;

/// Median, 95th, 99th and 99.9th percentile and largest of an error.
pub type Error = (f64, f64, f64, f64, f64);

pub fn error(error: BakeError) -> Error {
    (error.median, error.p95, error.p99, error.p999, error.max)
}

/// Hands a block of rows over as a structure of arrays.
pub fn separate<T>(
    directions: &[[f32; 3]],
    work: impl FnOnce(&Directions) -> Result<T>,
) -> Result<T> {
    let mut parts = [[0.0; MOST_ROWS]; 3];
    for (i, direction) in directions.iter().enumerate() {
        for (part, &component) in parts.iter_mut().zip(direction) {
            part[i] = component;
        }
    }
    let [x, y, z] = parts.each_ref().map(|part| &part[..directions.len()]);
    work(&Directions { x, y, z })
}

/// What the classes of baked skies say of themselves.
pub fn shown(name: &str, bytes: usize, error: &BakeError) -> PyResult<String> {
    let percent = 100.0 * error.p95;
    Ok(format!(
        "<welkin_sky.{name}: {bytes} bytes, {percent:.2} % added at 95 %>"
    ))
}

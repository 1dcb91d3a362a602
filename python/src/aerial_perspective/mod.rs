//! Aerial perspective: light and transmittance of segments.

pub mod colour;
pub mod joined;
pub mod spectral;

use pyo3::prelude::*;

use crate::arrays::Array;

/// Light, and what the air leaves of the light from the end.
pub type Pair<'py> = (Array<'py>, Array<'py>);

/// Shape of three components.
pub const RGB: [&[usize]; 2] = [&[3], &[3]];

/// Writes two colours.
pub fn colours(
    pair: ([f32; 3], [f32; 3]),
    light: &mut [f32],
    factors: &mut [f32],
) -> welkin::Result<()> {
    light.copy_from_slice(&pair.0);
    factors.copy_from_slice(&pair.1);
    Ok(())
}

/// Growing distances (m) along a ray.
pub fn distances(values: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let array = crate::arrays::numbers::<f64>(values, "distances")?;
    Ok(numpy::PyReadonlyArrayDyn::as_slice(&array)?.to_vec())
}

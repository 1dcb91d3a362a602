//! Camera-aligned volumes of aerial perspective.

use pyo3::prelude::*;
use welkin::CameraVolume;

use crate::aerial_perspective::colour::PyColourAerialPerspective;
use crate::aerial_perspective::{Pair, distances};
use crate::arrays::{Output, vector};
use crate::rows::alone;
use crate::threads::{Threads, pool};

#[pymethods]
impl PyColourAerialPerspective {
    /// A camera-aligned volume ("froxels") in linear sRGB: light, cd m⁻², and factors: (rows, columns, D, 3) each.
    ///
    /// camera (m), axis, right, up: (3,). size: columns, rows. depths: (D,), growing, in lengths of `axis`. Row r,
    /// column c, slice k ends at camera + depths[k] (axis + x right + y up) with x = (2c + 1) / columns − 1 and
    /// y = 1 − (2r + 1) / rows. Rays between marched ones are interpolated where that is good enough.
    #[pyo3(signature = (camera, axis, right, up, size, depths, *, threads=None))]
    #[expect(clippy::too_many_arguments, reason = "a camera has so many")]
    fn linear_srgb_volume<'py>(
        &self,
        py: Python<'py>,
        camera: &Bound<'py, PyAny>,
        axis: &Bound<'py, PyAny>,
        right: &Bound<'py, PyAny>,
        up: &Bound<'py, PyAny>,
        size: [usize; 2],
        depths: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Pair<'py>> {
        let depths = distances(depths)?;
        let volume = CameraVolume {
            from: vector(camera, "camera")?,
            axis: vector(axis, "axis")?,
            right: vector(right, "right")?,
            up: vector(up, "up")?,
            size,
            depths: &depths,
        };
        let lead = [size[1], size[0], depths.len()];
        let mut light = Output::new(py, &lead, &[3])?;
        let mut factors = Output::new(py, &lead, &[3])?;
        let to = light.all()?.as_chunks_mut().0;
        let passed = factors.all()?.as_chunks_mut().0;
        let pool = pool(py, threads)?;
        let work = || self.aerial.linear_srgb_volume(&volume, to, passed);
        alone(py, || match &pool {
            Some(pool) => pool.install(work),
            None => crate::threads::single(work),
        })?;
        Ok((light.array, factors.array))
    }
}

//! Radiance of a direction under any conditions.

use super::evaluate::One;
use super::opened::PointQuery;
use crate::conditions::Conditions;
use crate::error::{Error, Result};
use crate::kernel::simd::dispatch;

impl PointQuery<'_> {
    /// Spectral radiance in W m⁻² sr⁻¹ nm⁻¹ at each of [`PointQuery::wavelengths`]; frame and meaning as of
    /// [`Sky`](crate::Sky).
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for conditions outside the model, [`Error::Direction`] for a vector that is zero or not
    /// finite, [`Error::Length`] unless `out` has one element per wavelength, [`Error::MissingChunk`].
    pub fn radiance(
        &self,
        conditions: &Conditions,
        direction: [f32; 3],
        out: &mut [f32],
    ) -> Result<()> {
        self.relative_radiance(conditions, direction, out)?;
        for (out, irradiance) in out.iter_mut().zip(&self.irradiance) {
            *out = (*out * irradiance).min(f32::MAX);
        }
        Ok(())
    }

    /// Radiance per unit of solar spectral irradiance, sr⁻¹.
    ///
    /// # Errors
    /// As [`PointQuery::radiance`].
    pub fn relative_radiance(
        &self,
        conditions: &Conditions,
        direction: [f32; 3],
        out: &mut [f32],
    ) -> Result<()> {
        if out.len() != self.head.shape.wavelengths {
            return Err(Error::Length {
                what: "output",
                expected: self.head.shape.wavelengths as u64,
                got: out.len() as u64,
            });
        }
        dispatch(One {
            model: self,
            conditions,
            direction,
            out,
        })
    }
}

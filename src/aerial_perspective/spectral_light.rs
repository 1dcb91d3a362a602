//! In-scattered light at any wavelength. Format specification, sections 7.3 and 7.7.

use super::prepared::AerialPerspective;
use crate::error::Result;
use crate::kernel::math::{LANES, bound};
use crate::sky::MOST_WAVELENGTHS;
use crate::transmittance::Segment;

impl AerialPerspective {
    /// Light that the air between `from` and `to` scatters to `from` at any wavelength (nm) within the range of the
    /// model, W m⁻² sr⁻¹ nm⁻¹. The transmittance between them is
    /// [`Transmittance::transmittance_at`](crate::Transmittance::transmittance_at).
    ///
    /// # Errors
    /// As [`AerialPerspective::in_scattering`]; [`Error::OutOfRange`](crate::Error::OutOfRange) for the wavelength.
    pub fn in_scattering_at(&self, from: [f64; 3], to: [f64; 3], wavelength: f64) -> Result<f32> {
        let relative = self.relative_in_scattering_at(from, to, wavelength)?;
        let irradiance = self.air.interpolation().solar_irradiance(wavelength);
        Ok((f64::from(relative) * irradiance).min(f64::from(f32::MAX)) as f32)
    }

    /// The same per unit of solar spectral irradiance, sr⁻¹.
    ///
    /// # Errors
    /// As [`AerialPerspective::in_scattering_at`].
    pub fn relative_in_scattering_at(
        &self,
        from: [f64; 3],
        to: [f64; 3],
        wavelength: f64,
    ) -> Result<f32> {
        self.air.interpolation().check(wavelength)?;
        let segment = self.segment(from, to)?;
        let mut values = [0.0; MOST_WAVELENGTHS];
        let values = &mut values[..self.wavelengths().len()];
        self.relative_at_nodes(&segment, values);
        if let Some(over) = &self.over {
            let mut second = [0.0; MOST_WAVELENGTHS];
            let second = &mut second[..values.len()];
            over.second.relative_at_nodes(&segment, second);
            over.grounds.blend(wavelength, values, second);
        }
        Ok(self.relative_at(values, wavelength))
    }

    fn relative_at_nodes(&self, segment: &Segment, values: &mut [f32]) {
        self.integrate(segment, |block, result| {
            let out = values[block * LANES..].iter_mut();
            for (out, light) in out.zip(result.scattered) {
                *out = bound(light, 0.0, f32::MAX);
            }
        });
    }

    /// Relative radiance at a wavelength in range from that at the nodes.
    pub(super) fn relative_at(&self, values: &[f32], wavelength: f64) -> f32 {
        let value = self.air.interpolation().radiance(values, wavelength);
        value.min(f64::from(f32::MAX)) as f32
    }
}

//! Transmittance at any wavelength. Format specification, section 7.6.

use super::{Segment, Transmittance};
use crate::error::Result;
use crate::spectrum::MOST_WAVELENGTHS;

impl Transmittance {
    /// Transmittance between two points at any wavelength (nm) within the range of the model. In an absorption band it
    /// is the mean over the band, and so the product of those of two parts of a line is not that of the whole.
    ///
    /// In a model without a spectrum it is interpolated as radiance is.
    ///
    /// # Errors
    /// [`Error::Point`](crate::Error::Point) for coordinates that are not finite or beyond 10⁹ m;
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) for the wavelength.
    pub fn transmittance_at(&self, from: [f64; 3], to: [f64; 3], wavelength: f64) -> Result<f32> {
        self.interpolation.check(wavelength)?;
        let segment = Segment::between(&self.planet(), from, to)?;
        Ok(self.along(&segment, wavelength))
    }

    /// [`Transmittance::transmittance_to_space`] at any wavelength (nm) within the range of the model, as
    /// [`Transmittance::transmittance_at`].
    ///
    /// # Errors
    /// As [`Transmittance::transmittance_at`]; [`Error::Direction`](crate::Error::Direction) for a vector that is zero
    /// or not finite.
    pub fn transmittance_to_space_at(
        &self,
        from: [f64; 3],
        direction: [f64; 3],
        wavelength: f64,
    ) -> Result<f32> {
        self.interpolation.check(wavelength)?;
        let (segment, ground) = Segment::to_end(&self.planet(), from, direction)?;
        Ok(if ground {
            0.0
        } else {
            self.along(&segment, wavelength)
        })
    }

    /// [`Transmittance::transmittance_to_end`] at any wavelength (nm) within the range of the model, as
    /// [`Transmittance::transmittance_at`].
    ///
    /// # Errors
    /// As [`Transmittance::transmittance_to_space_at`].
    pub fn transmittance_to_end_at(
        &self,
        from: [f64; 3],
        direction: [f64; 3],
        wavelength: f64,
    ) -> Result<f32> {
        self.interpolation.check(wavelength)?;
        let (segment, _) = Segment::to_end(&self.planet(), from, direction)?;
        Ok(self.along(&segment, wavelength))
    }

    /// At a wavelength in range.
    fn along(&self, segment: &Segment, wavelength: f64) -> f32 {
        let columns = self.columns(segment);
        let cells = self
            .interpolation
            .transmittance(wavelength, &self.visibility, |k| columns.get(k));
        let value = cells.unwrap_or_else(|| {
            let mut values = [0.0; MOST_WAVELENGTHS];
            let values = &mut values[..self.wavelengths.len()];
            self.attenuate(segment, values);
            self.interpolation.radiance(values, wavelength).min(1.0)
        });
        value as f32
    }
}

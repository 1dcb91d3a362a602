//! What a sky needs besides, where the albedo of the ground depends on wavelength.

use super::{MOST_WAVELENGTHS, Sky};
use crate::error::Result;
use crate::ground::{Albedo, OverGround};

impl Sky {
    /// The same sky, where its ground has this albedo.
    pub(crate) fn with_ground(self, over: OverGround<Self>) -> Self {
        Self {
            over: Some(Box::new(over)),
            ..self
        }
    }

    /// What there is besides.
    pub(crate) fn over_ground(&self) -> Option<&OverGround<Self>> {
        self.over.as_deref()
    }

    /// The albedo of the ground, if it depends on wavelength: then light at [`Sky::wavelengths`] has at each the ground of
    /// that, and does not make light between them by [`SpectralInterpolation`](crate::SpectralInterpolation). Ask
    /// [`Sky::radiance_at`].
    pub fn ground(&self) -> Option<&Albedo> {
        self.over.as_ref().map(|over| over.grounds.albedo())
    }

    /// The sky that has the colours.
    #[inline(always)]
    pub(crate) fn coloured(&self) -> &Self {
        self.over.as_ref().map_or(self, |over| &over.colour)
    }
}

impl OverGround<Sky> {
    pub fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        self.second.set_solar_azimuth(azimuth)?;
        self.colour.set_solar_azimuth(azimuth)
    }

    pub fn bytes(&self) -> usize {
        self.grounds.bytes() + self.second.bytes() + self.colour.bytes()
    }

    /// Relative radiance at the nodes as it is over the ground of a wavelength.
    pub fn blend(&self, direction: [f32; 3], wavelength: f64, relative: &mut [f32]) -> Result<()> {
        let mut second = [0.0; MOST_WAVELENGTHS];
        let second = &mut second[..relative.len()];
        self.second.relative_radiance(direction, second)?;
        self.grounds.blend(wavelength, relative, second);
        Ok(())
    }
}

//! What segments need besides, where the albedo of the ground depends on wavelength.

use super::prepared::AerialPerspective;
use crate::error::Result;
use crate::ground::{Albedo, OverGround};

impl AerialPerspective {
    /// The same, where its ground has this albedo.
    pub(crate) fn with_ground(self, over: OverGround<Self>) -> Self {
        Self {
            over: Some(Box::new(over)),
            ..self
        }
    }

    /// The albedo of the ground, if it depends on wavelength.
    pub(super) fn ground(&self) -> Option<&Albedo> {
        self.over.as_ref().map(|over| over.grounds.albedo())
    }

    /// What has the colours.
    #[inline(always)]
    pub(super) fn coloured(&self) -> &Self {
        self.over.as_ref().map_or(self, |over| &over.colour)
    }
}

impl OverGround<AerialPerspective> {
    pub fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        self.second.set_solar_azimuth(azimuth)?;
        self.colour.set_solar_azimuth(azimuth)
    }

    pub fn bytes(&self) -> usize {
        self.grounds.bytes() + self.second.bytes() + self.colour.bytes()
    }
}

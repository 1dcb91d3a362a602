//! What segments need besides, where the albedo of the ground depends on wavelength.

use super::prepared::AerialPerspective;
use crate::error::Result;
use crate::ground::{Albedo, BetweenGrounds};

/// The aerial perspective itself has at each node the ground of that.
#[derive(Clone, Debug)]
pub(crate) struct OverGround {
    pub grounds: BetweenGrounds,
    /// Over the other ground.
    pub second: AerialPerspective,
    /// For colours, over the albedos that the ground has in them.
    pub colour: AerialPerspective,
}

impl AerialPerspective {
    /// The same, where its ground has this albedo.
    pub(crate) fn with_ground(self, over: OverGround) -> Self {
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

impl OverGround {
    pub fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        self.second.set_solar_azimuth(azimuth)?;
        self.colour.set_solar_azimuth(azimuth)
    }

    pub fn bytes(&self) -> usize {
        self.grounds.bytes() + self.second.bytes() + self.colour.bytes()
    }
}

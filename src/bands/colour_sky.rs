//! A prepared sky for colour alone.

use super::colour_ground::coloured_over;
use crate::conditions::Conditions;
use crate::error::Result;
use crate::model::Model;
use crate::sky::Sky;

/// A [`Sky`] for colour alone: only the wavelengths that X, Y and Z are made of are prepared and asked, so that neither
/// takes longer where a model reaches beyond what eyes see.
///
/// ```
/// use welkin::{BakedSky, Conditions, Model};
///
/// let model = Model::default_model()?;
/// let sky = model.colour_sky(&Conditions::default())?;
/// let rgb = sky.linear_srgb([0.0, 0.0, 1.0])?; // cd m⁻², not clipped
/// let baked = sky.bake(BakedSky::TOLERANCE)?; // for many directions
/// assert!(rgb[2] > rgb[0] && baked.bytes() > 0);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct ColourSky {
    sky: Sky,
}

impl Model {
    /// Prepares a sky for colour alone, which does not need the spectrum chunk of a file that has one, but over a ground
    /// whose albedo depends on wavelength ([`Model::over`]).
    ///
    /// # Errors
    /// As [`Model::sky`].
    pub fn colour_sky(&self, conditions: &Conditions) -> Result<ColourSky> {
        let conditions = conditions.checked(self)?;
        let (nodes, albedos) = coloured_over(self, &conditions)?;
        let sky = Sky::prepare(self, nodes.nodes(), &conditions, &albedos)?;
        Ok(ColourSky { sky })
    }
}

impl ColourSky {
    /// The conditions that the sky was prepared for.
    pub fn conditions(&self) -> &Conditions {
        self.sky.conditions()
    }

    /// As [`Sky::set_solar_azimuth`].
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) if the azimuth is not finite.
    pub fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        self.sky.set_solar_azimuth(azimuth)
    }

    /// Unit vector towards the sun's centre.
    pub fn sun_direction(&self) -> [f32; 3] {
        self.sky.sun_direction()
    }

    /// Memory on the heap, bytes.
    pub fn bytes(&self) -> usize {
        self.sky.bytes()
    }

    /// As [`Sky::xyz`].
    ///
    /// # Errors
    /// As [`Sky::xyz`].
    pub fn xyz(&self, direction: [f32; 3]) -> Result<[f32; 3]> {
        self.sky.xyz(direction)
    }

    /// As [`Sky::xyz_batch`].
    ///
    /// # Errors
    /// As [`Sky::xyz_batch`].
    pub fn xyz_batch(&self, directions: &[[f32; 3]], out: &mut [[f32; 3]]) -> Result<()> {
        self.sky.xyz_batch(directions, out)
    }

    /// As [`Sky::linear_srgb`].
    ///
    /// # Errors
    /// As [`Sky::linear_srgb`].
    pub fn linear_srgb(&self, direction: [f32; 3]) -> Result<[f32; 3]> {
        self.sky.linear_srgb(direction)
    }

    /// The sky at the wavelengths that count.
    pub(crate) fn sky(&self) -> &Sky {
        &self.sky
    }
}

//! Segments in colour alone.

use super::prepared::AerialPerspective;
use crate::bands::coloured_over;
use crate::conditions::Conditions;
use crate::error::Result;
use crate::model::Model;
use crate::sky::ColourSpace;

/// An [`AerialPerspective`] for colour alone: only the wavelengths that X, Y and Z are made of are prepared and asked.
/// Queries do not allocate, but that of a whole volume. `Send + Sync`.
///
/// ```
/// use welkin::{Conditions, Model};
///
/// let aerial = Model::default_model()?.colour_aerial_perspective(&Conditions::default())?;
/// let camera = [0.0, 0.0, 2.0];
/// let (near, _) = aerial.linear_srgb(camera, [1e3, 0.0, 2.0])?; // cd m⁻²
/// let (far, factors) = aerial.linear_srgb(camera, [30e3, 0.0, 2.0])?;
/// assert!(far[1] > near[1] && factors[2] < factors[0]);
/// // The slices of a volume along a ray.
/// let [mut light, mut factors] = [[[0.0; 3]; 4]; 2];
/// aerial.linear_srgb_along(camera, [1.0, 0.0, 0.1], &[1e2, 1e3, 1e4, 3e4], &mut light, &mut factors)?;
/// assert!(light[3][1] > light[0][1]);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct ColourAerialPerspective {
    aerial: AerialPerspective,
}

impl Model {
    /// Prepares transmittance and in-scattering for a scene in colour, in half the time and memory of
    /// [`Model::aerial_perspective`].
    ///
    /// # Errors
    /// As [`Model::aerial_perspective`].
    pub fn colour_aerial_perspective(
        &self,
        conditions: &Conditions,
    ) -> Result<ColourAerialPerspective> {
        let conditions = conditions.checked(self)?;
        let (nodes, albedos) = coloured_over(self, &conditions)?;
        let aerial = AerialPerspective::prepare(self, nodes.nodes(), &conditions, &albedos)?;
        Ok(ColourAerialPerspective { aerial })
    }
}

impl ColourAerialPerspective {
    /// The conditions that it was prepared for.
    pub fn conditions(&self) -> &Conditions {
        self.aerial.conditions()
    }

    /// As [`AerialPerspective::set_solar_azimuth`].
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) if the azimuth is not finite.
    pub fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        self.aerial.set_solar_azimuth(azimuth)
    }

    /// As [`AerialPerspective::bytes`].
    pub fn bytes(&self) -> usize {
        self.aerial.bytes()
    }

    /// As [`AerialPerspective::xyz`].
    ///
    /// # Errors
    /// As [`AerialPerspective::xyz`].
    pub fn xyz(&self, from: [f64; 3], to: [f64; 3]) -> Result<([f32; 3], [f32; 3])> {
        self.aerial.xyz(from, to)
    }

    /// As [`AerialPerspective::linear_srgb`].
    ///
    /// # Errors
    /// As [`AerialPerspective::xyz`].
    pub fn linear_srgb(&self, from: [f64; 3], to: [f64; 3]) -> Result<([f32; 3], [f32; 3])> {
        self.aerial.linear_srgb(from, to)
    }

    /// As [`AerialPerspective::rgb`].
    ///
    /// # Errors
    /// As [`AerialPerspective::xyz`].
    pub fn rgb(
        &self,
        from: [f64; 3],
        to: [f64; 3],
        space: ColourSpace,
    ) -> Result<([f32; 3], [f32; 3])> {
        self.aerial.rgb(from, to, space)
    }

    /// As [`AerialPerspective::linear_srgb_along`].
    ///
    /// # Errors
    /// As [`AerialPerspective::in_scattering_along`].
    pub fn linear_srgb_along(
        &self,
        from: [f64; 3],
        direction: [f64; 3],
        distances: &[f64],
        light: &mut [[f32; 3]],
        factors: &mut [[f32; 3]],
    ) -> Result<()> {
        self.aerial
            .linear_srgb_along(from, direction, distances, light, factors)
    }

    /// As [`AerialPerspective::rgb_along`].
    ///
    /// # Errors
    /// As [`AerialPerspective::in_scattering_along`].
    pub fn rgb_along(
        &self,
        from: [f64; 3],
        direction: [f64; 3],
        distances: &[f64],
        space: ColourSpace,
        light: &mut [[f32; 3]],
        factors: &mut [[f32; 3]],
    ) -> Result<()> {
        self.aerial
            .rgb_along(from, direction, distances, space, light, factors)
    }
}

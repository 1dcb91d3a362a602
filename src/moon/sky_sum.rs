//! Skies that several lights make together.

use crate::error::{Error, Result};
use crate::sky::{Sky, check_length, xyz_to_linear_srgb};

/// The sum of the skies of sun and moon, from [`Model::sky_with_moon`](crate::Model::sky_with_moon). `Send + Sync`.
///
/// To bake it, bake its parts and add what they give: radiances add.
///
/// ```
/// use welkin::{Conditions, Model, Moon};
///
/// let model = Model::default_model()?;
/// let dusk = Conditions { solar_elevation: -2f64.to_radians(), ..Conditions::default() };
/// let sky = model.sky_with_moon(&dusk, &Moon::default())?;
/// assert_eq!(sky.parts().len(), 2);
/// let rgb = sky.linear_srgb([0.0, 0.0, 1.0])?; // cd m⁻², not clipped
/// let mut radiance = vec![0.0; model.wavelengths().len()];
/// sky.radiance([0.0, 0.0, 1.0], &mut radiance)?; // W m⁻² sr⁻¹ nm⁻¹
/// # assert!(rgb[1] > 0.0 && radiance[3] > 0.0);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct SkySum {
    parts: Vec<Sky>,
    wavelengths: usize,
}

impl SkySum {
    pub(super) fn new(parts: Vec<Sky>, wavelengths: &[f64]) -> Self {
        Self {
            parts,
            wavelengths: wavelengths.len(),
        }
    }

    /// The skies that are added: that of the sun, then that of the moon, as far as these are in the range.
    pub fn parts(&self) -> &[Sky] {
        &self.parts
    }

    /// Spectral radiance in W m⁻² sr⁻¹ nm⁻¹ at each of the model's wavelengths.
    ///
    /// # Errors
    /// As [`Sky::radiance`].
    pub fn radiance(&self, direction: [f32; 3], out: &mut [f32]) -> Result<()> {
        check_length(out.len(), self.wavelengths)?;
        check_direction(direction)?;
        let Some((first, rest)) = self.parts.split_first() else {
            out.fill(0.0);
            return Ok(());
        };
        first.radiance(direction, out)?;
        let mut buffer = [0.0; crate::sky::MOST_WAVELENGTHS];
        let one = &mut buffer[..out.len()];
        for sky in rest {
            sky.radiance(direction, one)?;
            let pairs = out.iter_mut().zip(&*one);
            pairs.for_each(|(sum, value)| *sum = (*sum + value).min(f32::MAX));
        }
        Ok(())
    }

    /// CIE 1931 XYZ of the radiance; Y is the luminance in cd m⁻².
    ///
    /// # Errors
    /// [`Error::Direction`] for a vector that is zero or not finite.
    pub fn xyz(&self, direction: [f32; 3]) -> Result<[f32; 3]> {
        check_direction(direction)?;
        self.parts.iter().try_fold([0.0; 3], |sum, sky| {
            let xyz = sky.xyz(direction)?;
            Ok(core::array::from_fn(|c| sum[c] + xyz[c]))
        })
    }

    /// Linear sRGB of the radiance in cd m⁻²; not clipped.
    ///
    /// # Errors
    /// As [`SkySum::xyz`].
    pub fn linear_srgb(&self, direction: [f32; 3]) -> Result<[f32; 3]> {
        Ok(xyz_to_linear_srgb(self.xyz(direction)?))
    }
}

/// Where there is no sky to refuse it.
fn check_direction(direction: [f32; 3]) -> Result<()> {
    let is_finite = direction.iter().all(|v| v.is_finite());
    match is_finite && direction.iter().any(|&v| v != 0.0) {
        true => Ok(()),
        false => Err(Error::Direction { got: direction }),
    }
}

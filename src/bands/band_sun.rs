//! The disc of the sun in the bands of a sensor.

use super::band_set::Bands;
use super::mixture::Mixture;
use crate::conditions::Conditions;
use crate::error::Result;
use crate::model::Model;
use crate::sky::{MOST_WAVELENGTHS, check_length};
use crate::sun::SolarDisc;

/// A [`SolarDisc`] in the [`Bands`] of a sensor. Queries do not allocate. `Send + Sync`.
///
/// ```
/// use welkin::{Conditions, Model, Response};
///
/// let model = Model::default_model()?;
/// let bands = model.bands(&[Response::wavelength(440.0), Response::wavelength(680.0)])?;
/// let disc = model.band_solar_disc(&Conditions::default(), &bands)?;
/// let mut irradiance = [0.0; 2]; // of level ground, W m⁻² nm⁻¹
/// disc.irradiance([0.0, 0.0, 1.0], &mut irradiance)?;
/// assert!(irradiance[1] > 0.1);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct BandSolarDisc {
    disc: SolarDisc,
    mixture: Mixture,
}

impl Model {
    /// The disc of the sun in bands.
    ///
    /// # Errors
    /// As [`Model::solar_disc`]; [`Error::Invalid`](crate::Error::Invalid) for bands of another model.
    pub fn band_solar_disc(&self, conditions: &Conditions, bands: &Bands) -> Result<BandSolarDisc> {
        let fit = bands.air(self)?;
        Ok(BandSolarDisc {
            disc: SolarDisc::prepare(self, &fit.head, conditions)?,
            mixture: fit.mixture.clone(),
        })
    }
}

impl BandSolarDisc {
    /// How many bands a query gives.
    pub fn bands(&self) -> usize {
        self.mixture.bands()
    }

    /// As [`SolarDisc::direction`].
    pub fn direction(&self) -> [f32; 3] {
        self.disc.direction()
    }

    /// As [`SolarDisc::is_visible`].
    pub fn is_visible(&self) -> bool {
        self.disc.is_visible()
    }

    /// As [`SolarDisc::solid_angle`].
    pub fn solid_angle(&self) -> f64 {
        self.disc.solid_angle()
    }

    /// As [`SolarDisc::radiance`], in bands.
    ///
    /// # Errors
    /// [`Error::Direction`](crate::Error::Direction) for a vector that is zero or not finite;
    /// [`Error::Length`](crate::Error::Length) unless `out` has one element per band.
    pub fn radiance(&self, direction: [f32; 3], out: &mut [f32]) -> Result<()> {
        self.mix(out, |disc, out| disc.radiance(direction, out))
    }

    /// As [`SolarDisc::irradiance`], in bands.
    ///
    /// # Errors
    /// As [`BandSolarDisc::radiance`].
    pub fn irradiance(&self, normal: [f32; 3], out: &mut [f32]) -> Result<()> {
        self.mix(out, |disc, out| disc.irradiance(normal, out))
    }

    fn mix(
        &self,
        out: &mut [f32],
        ask: impl FnOnce(&SolarDisc, &mut [f32]) -> Result<()>,
    ) -> Result<()> {
        check_length(out.len(), self.bands())?;
        let mut exponentials = [0.0; MOST_WAVELENGTHS];
        let exponentials = &mut exponentials[..self.mixture.len()];
        ask(&self.disc, exponentials)?;
        self.mixture.light(exponentials, out);
        Ok(())
    }
}

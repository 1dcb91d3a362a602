//! Models under moonlight.

use super::moon_light::Moon;
use super::sky_sum::SkySum;
use crate::conditions::Conditions;
use crate::error::Result;
use crate::model::Model;

impl Model {
    /// The same model with the moon in place of the sun: its spectral irradiance is that of moonlight, and so are
    /// colours. Everything that a model gives, it gives of the air that the moon lights; conditions say where the moon
    /// stands ([`Moon::conditions`]), as `solar_elevation` and `solar_azimuth`. The discs of sun and moon count as
    /// equally large (the moon's is 3 % smaller), the moon's as evenly bright. Shares the chunks of this model.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) for a phase angle outside 0..=π or a distance outside [`Moon::DISTANCES`].
    pub fn moonlit(&self, moon: &Moon) -> Result<Self> {
        let relative = moon.relative_irradiance()?;
        Ok(self.with_moonlight(|head| {
            let (start, step) = (head.solar_start, head.solar_step);
            for (i, sample) in head.solar_irradiance.iter_mut().enumerate() {
                *sample = (f64::from(*sample) * relative(start + i as f64 * step)) as f32;
            }
            for (xyz, &wavelength) in head.xyz.iter_mut().zip(&head.wavelengths) {
                *xyz = xyz.map(|weight| weight * relative(wavelength));
            }
        }))
    }

    /// The sky in the light of sun and moon together. Of the two, one that is below
    /// [`Model::solar_elevation_range`] adds nothing; where both are, the sky is black.
    ///
    /// # Errors
    /// As [`Model::sky`] and [`Model::moonlit`].
    pub fn sky_with_moon(&self, conditions: &Conditions, moon: &Moon) -> Result<SkySum> {
        let moonlit = self.moonlit(moon)?;
        let [lowest, _] = self.solar_elevation_range();
        let moon_conditions = moon.conditions(conditions);
        let both = [(self, conditions), (&moonlit, &moon_conditions)];
        let mut skies = Vec::new();
        for (model, conditions) in both {
            if conditions.solar_elevation.is_nan() || conditions.solar_elevation >= lowest {
                skies.push(model.sky(conditions)?);
            }
        }
        if skies.is_empty() {
            let lit = Conditions {
                solar_elevation: lowest,
                ..*conditions
            };
            lit.checked(self)?;
        }
        Ok(SkySum::new(skies, self.wavelengths()))
    }
}

//! A prepared sky in the bands of a sensor.

use super::band_projection::Projection;
use super::band_set::Bands;
use crate::conditions::Conditions;
use crate::error::Result;
use crate::model::Model;
use crate::polarisation::{PolarisationFrame, PolarisedSky, Stokes};
use crate::sky::{MOST_WAVELENGTHS, Sky, check_length};

/// A [`Sky`] in the [`Bands`] of a sensor. Only the wavelengths that the bands are made of are prepared and asked.
///
/// What [`Sky`] says about directions holds here, too. After [`Model::band_sky`] nothing allocates. `Send + Sync`.
///
/// ```
/// use welkin::{Conditions, Model, Response};
///
/// let model = Model::default_model()?;
/// let bands = model.bands(&[Response::wavelength(450.0), Response::wavelength(650.0)])?;
/// let sky = model.band_sky(&Conditions::default(), &bands)?;
/// let mut radiance = [0.0; 4]; // `[directions][bands]`, W m⁻² sr⁻¹ nm⁻¹
/// sky.radiance_batch(&[[0.0, 0.0, 1.0], [0.9, 0.0, 0.1]], &mut radiance)?;
/// assert!(radiance[0] > radiance[1]);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct BandSky {
    sky: Sky,
    projection: Projection,
}

impl Model {
    /// Prepares a sky in bands: as [`Model::sky`], at the wavelengths that the bands are made of.
    ///
    /// # Errors
    /// As [`Model::sky`]; [`Error::Invalid`](crate::Error::Invalid) for bands of another model.
    pub fn band_sky(&self, conditions: &Conditions, bands: &Bands) -> Result<BandSky> {
        let conditions = conditions.checked(self)?;
        Ok(BandSky {
            sky: Sky::prepare(
                self,
                bands.at(self)?,
                &conditions,
                &bands.albedos(&conditions),
            )?,
            projection: bands.projection(&conditions),
        })
    }

    /// Prepares a sky in bands with its polarisation: as [`Model::polarised_sky`], at the wavelengths that the bands
    /// are made of.
    ///
    /// # Errors
    /// As [`Model::polarised_sky`]; [`Error::Invalid`](crate::Error::Invalid) for bands of another model.
    pub fn polarised_band_sky(
        &self,
        conditions: &Conditions,
        bands: &Bands,
    ) -> Result<PolarisedBandSky> {
        let conditions = conditions.checked(self)?;
        Ok(PolarisedBandSky {
            sky: PolarisedSky::prepare(
                self,
                bands.at(self)?,
                &conditions,
                &bands.albedos(&conditions),
            )?,
            projection: bands.projection(&conditions),
        })
    }
}

impl BandSky {
    /// The conditions that the sky was prepared for.
    pub fn conditions(&self) -> &Conditions {
        self.sky.conditions()
    }

    /// How many bands a query gives.
    pub fn bands(&self) -> usize {
        self.projection.bands()
    }

    /// As [`Sky::set_solar_azimuth`].
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) if the azimuth is not finite.
    pub fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        self.sky.set_solar_azimuth(azimuth)
    }

    /// As [`Sky::sun_direction`].
    pub fn sun_direction(&self) -> [f32; 3] {
        self.sky.sun_direction()
    }

    /// Memory on the heap, bytes.
    pub fn bytes(&self) -> usize {
        self.sky.bytes() + self.projection.bytes()
    }

    /// The value of each band in a direction: see [`Bands`] for the unit.
    ///
    /// # Errors
    /// [`Error::Direction`](crate::Error::Direction) for a vector that is zero or not finite;
    /// [`Error::Length`](crate::Error::Length) unless `out` has one element per band.
    pub fn radiance(&self, direction: [f32; 3], out: &mut [f32]) -> Result<()> {
        self.radiance_batch(&[direction], out)
    }

    /// [`BandSky::radiance`] for many directions; `out` is `[directions][bands]`.
    ///
    /// # Errors
    /// As [`BandSky::radiance`]. What precedes a bad direction is written.
    pub fn radiance_batch(&self, directions: &[[f32; 3]], out: &mut [f32]) -> Result<()> {
        let bands = self.bands();
        check_length(out.len(), directions.len().saturating_mul(bands))?;
        let mut relative = [0.0; MOST_WAVELENGTHS];
        let relative = &mut relative[..self.sky.wavelengths().len()];
        for (&direction, out) in directions.iter().zip(out.chunks_exact_mut(bands)) {
            self.sky.relative_radiance(direction, relative)?;
            self.projection.apply(relative, out);
        }
        Ok(())
    }

    /// The sky at its wavelengths, and what makes bands of them.
    pub(crate) fn parts(&self) -> (&Sky, &Projection) {
        (&self.sky, &self.projection)
    }
}

/// A [`PolarisedSky`] in the [`Bands`] of a sensor.
///
/// ```
/// use welkin::{Conditions, Model, PolarisationFrame, Response, Stokes};
///
/// let model = Model::default_model()?;
/// let bands = model.bands(&[Response::wavelength(450.0), Response::wavelength(650.0)])?;
/// let sky = model.polarised_band_sky(&Conditions::default(), &bands)?;
/// let mut light = [Stokes::default(); 2];
/// sky.stokes([0.0, 0.5, 0.9], PolarisationFrame::Vertical, &mut light)?;
/// assert!(light.iter().all(|band| band.i > 0.0 && band.degree() < 1.0));
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct PolarisedBandSky {
    sky: PolarisedSky,
    projection: Projection,
}

impl PolarisedBandSky {
    /// The conditions that the sky was prepared for.
    pub fn conditions(&self) -> &Conditions {
        self.sky.sky().conditions()
    }

    /// How many bands a query gives.
    pub fn bands(&self) -> usize {
        self.projection.bands()
    }

    /// As [`Sky::set_solar_azimuth`].
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) if the azimuth is not finite.
    pub fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        self.sky.set_solar_azimuth(azimuth)
    }

    /// Memory on the heap, bytes.
    pub fn bytes(&self) -> usize {
        self.sky.bytes() + self.projection.bytes()
    }

    /// The Stokes vector of each band, in the frame of the caller. Q² + U² ≤ I², but for rounding.
    ///
    /// # Errors
    /// [`Error::Direction`](crate::Error::Direction) for a direction or an axis that is zero or not finite;
    /// [`Error::Length`](crate::Error::Length) unless `out` has one element per band.
    pub fn stokes(
        &self,
        direction: [f32; 3],
        frame: PolarisationFrame,
        out: &mut [Stokes],
    ) -> Result<()> {
        check_length(out.len(), self.bands())?;
        let mut relative = [Stokes::default(); MOST_WAVELENGTHS];
        let relative = &mut relative[..self.sky.sky().wavelengths().len()];
        self.sky.relative_stokes(direction, frame, relative)?;
        self.projection.apply_stokes(relative, out);
        Ok(())
    }

    /// The sky at its wavelengths, and what makes bands of them.
    pub(crate) fn parts(&self) -> (&PolarisedSky, &Projection) {
        (&self.sky, &self.projection)
    }
}

//! Baked skies in the bands of a sensor.

use super::baked_polarised::BakedPolarisedSky;
use super::baked_spectral::{BakedSky, LANES};
use super::batch::Directions;
use super::fill::Channels;
use super::grid_choice::BakeError;
use crate::bands::{BandSky, PolarisedBandSky, Projection};
use crate::conditions::Conditions;
use crate::error::Result;
use crate::kernel::lanes::Lanes;
use crate::polarisation::{PolarisationFrame, StokesSpectra};
use crate::sky::MOST_WAVELENGTHS;

/// A [`BandSky`] as tables: as [`BakedSky`], with bands in place of wavelengths.
///
/// ```
/// use welkin::{BakedSky, Conditions, Model, Response};
///
/// let model = Model::default_model()?;
/// let bands = model.bands(&[Response::wavelength(450.0), Response::wavelength(650.0)])?;
/// let sky = model.band_sky(&Conditions::default(), &bands)?;
/// let baked = sky.bake(BakedSky::TOLERANCE)?;
/// let (mut fast, mut exact) = ([0.0; 2], [0.0; 2]);
/// baked.radiance([0.3, 0.1, 0.9], &mut fast)?;
/// sky.radiance([0.3, 0.1, 0.9], &mut exact)?;
/// assert!((fast[0] / exact[0] - 1.0).abs() < 0.01);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct BakedBandSky {
    pub(super) sky: BakedSky,
}

/// A [`PolarisedBandSky`] as tables: as [`BakedPolarisedSky`], with bands in place of wavelengths.
///
/// ```
/// use welkin::{BakedSky, Conditions, Model, PolarisationFrame, Response, StokesSpectra};
///
/// let model = Model::default_model()?;
/// let bands = model.bands(&[Response::wavelength(450.0), Response::wavelength(650.0)])?;
/// let sky = model.polarised_band_sky(&Conditions::default(), &bands)?;
/// let baked = sky.bake(BakedSky::TOLERANCE)?;
/// let [mut i, mut q, mut u] = [[0.0; 2]; 3];
/// let light = StokesSpectra { i: &mut i, q: &mut q, u: &mut u };
/// baked.stokes([-0.4, 0.0, 0.9], PolarisationFrame::SunAligned, light)?;
/// assert!(q[1] > 0.3 * i[1]);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct BakedPolarisedBandSky {
    pub(super) sky: BakedPolarisedSky,
}

struct OfBands<'a>(&'a Projection);

impl Channels<LANES> for OfBands<'_> {
    fn blocks(&self) -> usize {
        self.0.bands().div_ceil(LANES)
    }

    fn count(&self) -> usize {
        self.0.bands()
    }

    #[inline(always)]
    fn project(&self, radiance: &[f32], mut emit: impl FnMut(usize, Lanes<LANES>)) {
        let mut bands = [1.0; MOST_WAVELENGTHS];
        self.0.apply(radiance, &mut bands[..self.0.bands()]);
        let blocks = bands.as_chunks::<LANES>().0.iter().take(self.blocks());
        blocks
            .enumerate()
            .for_each(|(block, lanes)| emit(block, Lanes(*lanes)));
    }
}

impl BandSky {
    /// Bakes the sky: as [`Sky::bake`](crate::Sky::bake), for its bands.
    ///
    /// # Errors
    /// As [`Sky::bake`](crate::Sky::bake).
    pub fn bake(&self, tolerance: f64) -> Result<BakedBandSky> {
        let (sky, projection) = self.parts();
        let bands = projection.bands();
        Ok(BakedBandSky {
            sky: BakedSky::relative(sky, &OfBands(projection), bands, tolerance)?,
        })
    }
}

impl PolarisedBandSky {
    /// Bakes the sky: as [`PolarisedSky::bake`](crate::PolarisedSky::bake), for its bands.
    ///
    /// # Errors
    /// As [`Sky::bake`](crate::Sky::bake).
    pub fn bake(&self, tolerance: f64) -> Result<BakedPolarisedBandSky> {
        let (sky, projection) = self.parts();
        let bands = projection.bands();
        let radiance = BakedSky::relative(sky.sky(), &OfBands(projection), bands, tolerance)?;
        let sky = BakedPolarisedSky::of(radiance, sky, Some(projection), tolerance)?;
        Ok(BakedPolarisedBandSky { sky })
    }
}

impl BakedBandSky {
    /// The conditions that the sky was prepared for.
    pub fn conditions(&self) -> &Conditions {
        self.sky.conditions()
    }

    /// How many bands a query gives.
    pub fn bands(&self) -> usize {
        self.sky.wavelengths().len()
    }

    /// As [`Sky::set_solar_azimuth`](crate::Sky::set_solar_azimuth).
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] if the azimuth is not finite.
    pub fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        self.sky.set_solar_azimuth(azimuth)
    }

    /// What baking added to the error of the bands.
    pub fn bake_error(&self) -> BakeError {
        self.sky.bake_error()
    }

    /// Memory on the heap, bytes.
    pub fn bytes(&self) -> usize {
        self.sky.bytes()
    }

    /// As [`BandSky::radiance`].
    ///
    /// # Errors
    /// As [`BandSky::radiance`].
    #[inline]
    pub fn radiance(&self, direction: [f32; 3], out: &mut [f32]) -> Result<()> {
        self.sky.radiance(direction, out)
    }

    /// [`BakedBandSky::radiance`] for many directions; `out` is `[directions][bands]`.
    ///
    /// # Errors
    /// As [`BakedSky::radiance_batch`].
    pub fn radiance_batch(&self, directions: &Directions, out: &mut [f32]) -> Result<()> {
        self.sky.radiance_batch(directions, out)
    }

    /// As [`BakedSky::irradiance`], in bands.
    ///
    /// # Errors
    /// As [`BakedSky::irradiance`].
    pub fn irradiance(&self, normal: [f32; 3], out: &mut [f32]) -> Result<()> {
        self.sky.irradiance(normal, out)
    }
}

impl BakedPolarisedBandSky {
    /// The conditions that the sky was prepared for.
    pub fn conditions(&self) -> &Conditions {
        self.sky.sky().conditions()
    }

    /// How many bands a query gives.
    pub fn bands(&self) -> usize {
        self.sky.sky().wavelengths().len()
    }

    /// As [`Sky::set_solar_azimuth`](crate::Sky::set_solar_azimuth).
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] if the azimuth is not finite.
    pub fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        self.sky.set_solar_azimuth(azimuth)
    }

    /// What baking added to the error of the bands.
    pub fn bake_error(&self) -> BakeError {
        self.sky.sky().bake_error()
    }

    /// As [`BakedPolarisedSky::polarisation_error`].
    pub fn polarisation_error(&self) -> BakeError {
        self.sky.polarisation_error()
    }

    /// Memory on the heap, bytes.
    pub fn bytes(&self) -> usize {
        self.sky.bytes()
    }

    /// The Stokes vector of each band, as [`PolarisedBandSky::stokes`].
    ///
    /// # Errors
    /// As [`BakedPolarisedSky::stokes`].
    #[inline]
    pub fn stokes(
        &self,
        direction: [f32; 3],
        frame: PolarisationFrame,
        out: StokesSpectra,
    ) -> Result<()> {
        self.sky.stokes(direction, frame, out)
    }

    /// [`BakedPolarisedBandSky::stokes`] for many directions; the parts are `[directions][bands]`.
    ///
    /// # Errors
    /// As [`BakedPolarisedSky::stokes_batch`].
    pub fn stokes_batch(
        &self,
        directions: &Directions,
        frame: PolarisationFrame,
        out: StokesSpectra,
    ) -> Result<()> {
        self.sky.stokes_batch(directions, frame, out)
    }
}

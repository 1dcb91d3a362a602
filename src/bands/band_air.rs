//! The air in the bands of a sensor.

use super::band_set::Bands;
use super::mixture::Mixture;
use crate::error::Result;
use crate::model::Model;
use crate::sky::{MOST_WAVELENGTHS, check_length};
use crate::transmittance::Transmittance;

/// A [`Transmittance`] in the [`Bands`] of a sensor: the mean over response and sunlight of what passes, which is not
/// what passes at a mean wavelength. A sum of few exponentials for each band, fitted to lines of all kinds through the
/// air to 0.1 %; it is 1 over no distance, falls with distance and is the same both ways. Queries do not allocate.
/// `Send + Sync`.
///
/// ```
/// use welkin::{Model, Response};
///
/// let model = Model::default_model()?;
/// let wide = Response::table(&[400.0, 700.0], &[1.0, 1.0])?;
/// let bands = model.bands(&[wide, Response::wavelength(440.0)])?;
/// let air = model.band_transmittance(40e3, &bands)?; // visibility, m
/// let mut transmittance = [0.0; 2];
/// air.transmittance([0.0, 0.0, 100.0], [20e3, 0.0, 100.0], &mut transmittance)?;
/// assert!(transmittance[1] < transmittance[0] && transmittance[0] < 1.0);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct BandTransmittance {
    air: Transmittance,
    mixture: Mixture,
}

impl Model {
    /// Prepares the air at a visibility (m) in bands.
    ///
    /// # Errors
    /// As [`Model::transmittance`]; [`Error::Invalid`](crate::Error::Invalid) for bands of another model.
    pub fn band_transmittance(&self, visibility: f64, bands: &Bands) -> Result<BandTransmittance> {
        let fit = bands.air(self)?;
        Ok(BandTransmittance {
            air: Transmittance::prepare(self, &fit.head, visibility)?,
            mixture: fit.mixture.clone(),
        })
    }
}

impl BandTransmittance {
    /// How many bands a query gives.
    pub fn bands(&self) -> usize {
        self.mixture.bands()
    }

    /// Memory on the heap, bytes.
    pub fn bytes(&self) -> usize {
        self.air.bytes() + self.mixture.bytes()
    }

    /// As [`Transmittance::transmittance`], in bands.
    ///
    /// # Errors
    /// As [`Transmittance::transmittance`]; [`Error::Length`](crate::Error::Length) unless `out` has one element per
    /// band.
    pub fn transmittance(&self, from: [f64; 3], to: [f64; 3], out: &mut [f32]) -> Result<()> {
        self.mix(out, |air, out| air.transmittance(from, to, out))
    }

    /// As [`Transmittance::transmittance_to_space`], in bands.
    ///
    /// # Errors
    /// As [`Transmittance::transmittance_to_space`]; [`Error::Length`](crate::Error::Length) as above.
    pub fn transmittance_to_space(
        &self,
        from: [f64; 3],
        direction: [f64; 3],
        out: &mut [f32],
    ) -> Result<()> {
        self.mix(out, |air, out| {
            air.transmittance_to_space(from, direction, out)
        })
    }

    /// As [`Transmittance::transmittance_to_end`], in bands.
    ///
    /// # Errors
    /// As [`Transmittance::transmittance_to_end`]; [`Error::Length`](crate::Error::Length) as above.
    pub fn transmittance_to_end(
        &self,
        from: [f64; 3],
        direction: [f64; 3],
        out: &mut [f32],
    ) -> Result<()> {
        self.mix(out, |air, out| {
            air.transmittance_to_end(from, direction, out)
        })
    }

    fn mix(
        &self,
        out: &mut [f32],
        ask: impl FnOnce(&Transmittance, &mut [f32]) -> Result<()>,
    ) -> Result<()> {
        check_length(out.len(), self.bands())?;
        let mut exponentials = [0.0; MOST_WAVELENGTHS];
        let exponentials = &mut exponentials[..self.mixture.len()];
        ask(&self.air, exponentials)?;
        self.mixture.means(exponentials, out);
        Ok(())
    }
}

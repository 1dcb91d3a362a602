//! Stokes vectors of segments that end in the observer's sky.

use super::Haze;
use crate::error::Result;
use crate::polarisation::{Frame, PolarisedSky, Stokes, StokesSpectra};

/// As [`Foreground`](super::Foreground), with Stokes vectors; see [`Haze::before_polarised`].
#[derive(Clone, Copy, Debug)]
pub struct PolarisedForeground<'a> {
    haze: &'a Haze,
    sky: &'a PolarisedSky,
}

impl Haze {
    /// As [`Haze::before`], for Stokes vectors.
    ///
    /// # Errors
    /// As [`Haze::before`].
    pub fn before_polarised<'a>(
        &'a self,
        sky: &'a PolarisedSky,
    ) -> Result<PolarisedForeground<'a>> {
        self.before(sky.sky())?;
        Ok(PolarisedForeground { haze: self, sky })
    }
}

impl PolarisedForeground<'_> {
    /// Where the observer is, m.
    pub fn camera(&self) -> [f64; 3] {
        [0.0, 0.0, self.sky.sky().conditions().altitude]
    }

    /// As [`Haze::aerial_perspective_stokes`] from the observer.
    ///
    /// # Errors
    /// As [`Haze::in_scatter_stokes`]. What precedes a bad point is written.
    pub fn aerial_perspective_stokes(
        &self,
        points: &[[f64; 3]],
        frame: Frame,
        in_scatter: StokesSpectra,
        transmittance: &mut [f32],
    ) -> Result<()> {
        let (sky, camera) = (Some(self.sky), self.camera());
        self.haze
            .spectra(sky, camera, points, frame, in_scatter, transmittance)
    }

    /// As [`Haze::linear_srgb_stokes`] from the observer.
    ///
    /// # Errors
    /// As [`Haze::in_scatter_stokes`].
    pub fn linear_srgb_stokes(
        &self,
        to: [f64; 3],
        frame: Frame,
    ) -> Result<([Stokes; 3], [f32; 3])> {
        self.haze
            .polarised_srgb(Some(self.sky), self.camera(), to, frame)
    }
}

//! Stokes vectors of segments that end in the observer's sky.

use super::prepared::AerialPerspective;
use crate::error::Result;
use crate::polarisation::{PolarisationFrame, PolarisedSky, Stokes, StokesSpectra};

/// As [`JoinedAerialPerspective`](super::JoinedAerialPerspective), with Stokes vectors; see
/// [`AerialPerspective::joined_to_polarised`].
///
/// ```
/// use welkin::{Conditions, Model, PolarisationFrame};
///
/// let model = Model::default_model()?;
/// let conditions = Conditions::default();
/// let sky = model.polarised_sky(&conditions)?;
/// let aerial = model.aerial_perspective(&conditions)?;
/// let joined = aerial.joined_to_polarised(&sky)?;
/// let camera_up = PolarisationFrame::Axis([0.0, 0.0, 1.0]);
/// let (light, _) = joined.linear_srgb_stokes([0.0, 20e3, 500.0], camera_up)?;
/// // A polariser in front of the camera makes distant air darker.
/// assert!(light[2].through_polariser(0.0) < light[2].i);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct JoinedPolarisedAerialPerspective<'a> {
    aerial: &'a AerialPerspective,
    sky: &'a PolarisedSky,
}

impl AerialPerspective {
    /// As [`AerialPerspective::joined_to`], for Stokes vectors.
    ///
    /// # Errors
    /// As [`AerialPerspective::joined_to`].
    pub fn joined_to_polarised<'a>(
        &'a self,
        sky: &'a PolarisedSky,
    ) -> Result<JoinedPolarisedAerialPerspective<'a>> {
        self.joined_to(sky.sky())?;
        Ok(JoinedPolarisedAerialPerspective { aerial: self, sky })
    }
}

impl JoinedPolarisedAerialPerspective<'_> {
    /// Where the observer is, m.
    pub fn camera(&self) -> [f64; 3] {
        [0.0, 0.0, self.sky.sky().conditions().altitude]
    }

    /// As [`AerialPerspective::in_scattering_stokes_batch`] from the observer.
    ///
    /// # Errors
    /// As [`AerialPerspective::in_scattering_stokes`]. What precedes a bad point is written.
    pub fn in_scattering_stokes_batch(
        &self,
        points: &[[f64; 3]],
        frame: PolarisationFrame,
        in_scattering: StokesSpectra,
        transmittance: &mut [f32],
    ) -> Result<()> {
        let (sky, camera) = (Some(self.sky), self.camera());
        self.aerial
            .spectra(sky, camera, points, frame, in_scattering, transmittance)
    }

    /// As [`AerialPerspective::linear_srgb_stokes`] from the observer.
    ///
    /// # Errors
    /// As [`AerialPerspective::in_scattering_stokes`].
    pub fn linear_srgb_stokes(
        &self,
        to: [f64; 3],
        frame: PolarisationFrame,
    ) -> Result<([Stokes; 3], [f32; 3])> {
        self.aerial
            .polarised_srgb(Some(self.sky), self.camera(), to, frame)
    }
}

//! Segments in the bands of a sensor.

use super::prepared::AerialPerspective;
use crate::bands::{BandSky, BandTransmittance, Bands, PolarisedBandSky, Projection};
use crate::conditions::Conditions;
use crate::error::Result;
use crate::model::Model;
use crate::polarisation::{PolarisationFrame, Stokes, StokesSpectra};
use crate::sky::{MOST_WAVELENGTHS, check_length};

/// An [`AerialPerspective`] in the [`Bands`] of a sensor. Queries do not allocate. `Send + Sync`.
///
/// ```
/// use welkin::{Conditions, Model, Response};
///
/// let model = Model::default_model()?;
/// let bands = model.bands(&[Response::wavelength(450.0), Response::wavelength(650.0)])?;
/// let aerial = model.band_aerial_perspective(&Conditions::default(), &bands)?;
/// let [mut light, mut transmittance] = [[0.0; 2]; 2];
/// let (from, to) = ([0.0, 0.0, 2.0], [0.0, 20e3, 200.0]);
/// aerial.in_scattering(from, to, &mut light, &mut transmittance)?; // W m⁻² sr⁻¹ nm⁻¹
/// assert!(light[0] > light[1] && transmittance[0] < transmittance[1]);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct BandAerialPerspective {
    /// Per unit of sunlight.
    aerial: AerialPerspective,
    projection: Projection,
    air: BandTransmittance,
}

impl Model {
    /// Prepares transmittance and in-scattering for a scene in bands, at the wavelengths that they are made of.
    ///
    /// # Errors
    /// As [`Model::aerial_perspective`]; [`Error::Invalid`](crate::Error::Invalid) for bands of another model.
    pub fn band_aerial_perspective(
        &self,
        conditions: &Conditions,
        bands: &Bands,
    ) -> Result<BandAerialPerspective> {
        let conditions = conditions.checked(self)?;
        let albedos = bands.albedos(&conditions);
        let aerial = AerialPerspective::prepare(self, bands.at(self)?, &conditions, &albedos)?;
        let visibility = aerial.conditions().visibility;
        Ok(BandAerialPerspective {
            aerial,
            projection: bands.projection(&conditions),
            air: self.band_transmittance(visibility, bands)?,
        })
    }
}

impl BandAerialPerspective {
    /// The conditions that it was prepared for.
    pub fn conditions(&self) -> &Conditions {
        self.aerial.conditions()
    }

    /// How many bands a query gives.
    pub fn bands(&self) -> usize {
        self.projection.bands()
    }

    /// The air: transmittance alone.
    pub fn transmittance(&self) -> &BandTransmittance {
        &self.air
    }

    /// Memory on the heap, bytes.
    pub fn bytes(&self) -> usize {
        self.aerial.bytes() + self.projection.bytes() + self.air.bytes()
    }

    /// As [`AerialPerspective::set_solar_azimuth`].
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) if the azimuth is not finite.
    pub fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        self.aerial.set_solar_azimuth(azimuth)
    }

    /// As [`AerialPerspective::in_scattering`], in bands.
    ///
    /// # Errors
    /// As [`AerialPerspective::in_scattering`]; [`Error::Length`](crate::Error::Length) unless both outputs have one
    /// element per band.
    pub fn in_scattering(
        &self,
        from: [f64; 3],
        to: [f64; 3],
        in_scattering: &mut [f32],
        transmittance: &mut [f32],
    ) -> Result<()> {
        check_length(in_scattering.len(), self.bands())?;
        let mut room = [[0.0; MOST_WAVELENGTHS]; 2];
        let [light, through] = self.room(&mut room);
        self.aerial.in_scattering(from, to, light, through)?;
        self.projection.apply(light, in_scattering);
        self.air.transmittance(from, to, transmittance)
    }

    /// As [`AerialPerspective::in_scattering_stokes`], in bands.
    ///
    /// # Errors
    /// As [`BandAerialPerspective::in_scattering`]; [`Error::Direction`](crate::Error::Direction) for an axis that is
    /// zero or not finite.
    pub fn in_scattering_stokes(
        &self,
        from: [f64; 3],
        to: [f64; 3],
        frame: PolarisationFrame,
        in_scattering: &mut [Stokes],
        transmittance: &mut [f32],
    ) -> Result<()> {
        check_length(in_scattering.len(), self.bands())?;
        self.stokes(in_scattering, |light, through| {
            self.aerial
                .in_scattering_stokes(from, to, frame, light, through)
        })?;
        self.air.transmittance(from, to, transmittance)
    }

    /// Segments from the observer of a sky in the same bands, at whose ends that sky takes over: as
    /// [`AerialPerspective::joined_to`].
    ///
    /// # Errors
    /// As [`AerialPerspective::joined_to`].
    pub fn joined_to<'a>(&'a self, sky: &'a BandSky) -> Result<JoinedBandAerialPerspective<'a>> {
        self.aerial.joined_to(sky.parts().0)?;
        Ok(JoinedBandAerialPerspective {
            aerial: self,
            sky: Joined::Plain(sky),
        })
    }

    /// The same before a sky with its polarisation.
    ///
    /// # Errors
    /// As [`AerialPerspective::joined_to`].
    pub fn joined_to_polarised<'a>(
        &'a self,
        sky: &'a PolarisedBandSky,
    ) -> Result<JoinedBandAerialPerspective<'a>> {
        self.aerial.joined_to_polarised(sky.parts().0)?;
        Ok(JoinedBandAerialPerspective {
            aerial: self,
            sky: Joined::Polarised(sky),
        })
    }

    fn room<'r>(&self, room: &'r mut [[f32; MOST_WAVELENGTHS]; 2]) -> [&'r mut [f32]; 2] {
        let n = self.aerial.wavelengths().len();
        room.each_mut().map(|row| &mut row[..n])
    }

    /// Asks for Stokes vectors per unit of sunlight and makes bands of them.
    fn stokes(
        &self,
        out: &mut [Stokes],
        ask: impl FnOnce(StokesSpectra, &mut [f32]) -> Result<()>,
    ) -> Result<()> {
        let n = self.aerial.wavelengths().len();
        let mut room = [[0.0; MOST_WAVELENGTHS]; 4];
        let [i, q, u, through] = room.each_mut().map(|row| &mut row[..n]);
        let (i, q, u) = (i, q, u);
        ask(
            StokesSpectra {
                i: &mut *i,
                q: &mut *q,
                u: &mut *u,
            },
            through,
        )?;
        let mut relative = [Stokes::default(); MOST_WAVELENGTHS];
        for (k, light) in relative[..n].iter_mut().enumerate() {
            *light = Stokes {
                i: i[k],
                q: q[k],
                u: u[k],
            };
        }
        self.projection.apply_stokes(&relative[..n], out);
        Ok(())
    }
}

/// Segments before the observer's sky, in bands; see [`BandAerialPerspective::joined_to`].
///
/// ```
/// use welkin::{Conditions, Model, Response};
///
/// let model = Model::default_model()?;
/// let conditions = Conditions { altitude: 100.0, ..Conditions::default() };
/// let bands = model.bands(&[Response::wavelength(450.0), Response::wavelength(650.0)])?;
/// let sky = model.band_sky(&conditions, &bands)?;
/// let aerial = model.band_aerial_perspective(&conditions, &bands)?;
/// let [mut light, mut transmittance, mut beyond] = [[0.0; 2]; 3];
/// let end = [0.0, 0.8e6, 0.6e6 + 100.0]; // beyond the air
/// aerial.joined_to(&sky)?.in_scattering(end, &mut light, &mut transmittance)?;
/// sky.radiance([0.0, 0.8, 0.6], &mut beyond)?;
/// assert!((light[0] / beyond[0] - 1.0).abs() < 1e-4);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct JoinedBandAerialPerspective<'a> {
    aerial: &'a BandAerialPerspective,
    sky: Joined<'a>,
}

#[derive(Clone, Copy, Debug)]
enum Joined<'a> {
    Plain(&'a BandSky),
    Polarised(&'a PolarisedBandSky),
}

impl JoinedBandAerialPerspective<'_> {
    /// Where the observer is, m.
    pub fn camera(&self) -> [f64; 3] {
        let conditions = match self.sky {
            Joined::Plain(sky) => sky.conditions(),
            Joined::Polarised(sky) => sky.conditions(),
        };
        [0.0, 0.0, conditions.altitude]
    }

    /// As [`BandAerialPerspective::in_scattering`] from the observer.
    ///
    /// # Errors
    /// As [`BandAerialPerspective::in_scattering`].
    pub fn in_scattering(
        &self,
        to: [f64; 3],
        in_scattering: &mut [f32],
        transmittance: &mut [f32],
    ) -> Result<()> {
        let aerial = self.aerial;
        check_length(in_scattering.len(), aerial.bands())?;
        let mut room = [[0.0; MOST_WAVELENGTHS]; 2];
        let [light, through] = aerial.room(&mut room);
        let sky = match self.sky {
            Joined::Plain(sky) => sky.parts().0,
            Joined::Polarised(sky) => sky.parts().0.sky(),
        };
        let joined = aerial.aerial.joined_to(sky)?;
        joined.in_scattering(to, light, through)?;
        aerial.projection.apply(light, in_scattering);
        aerial.air.transmittance(self.camera(), to, transmittance)
    }

    /// As [`BandAerialPerspective::in_scattering_stokes`] from the observer; before a sky without polarisation that
    /// does not take over.
    ///
    /// # Errors
    /// As [`BandAerialPerspective::in_scattering_stokes`].
    pub fn in_scattering_stokes(
        &self,
        to: [f64; 3],
        frame: PolarisationFrame,
        in_scattering: &mut [Stokes],
        transmittance: &mut [f32],
    ) -> Result<()> {
        let (aerial, camera) = (self.aerial, self.camera());
        let Joined::Polarised(sky) = self.sky else {
            return aerial.in_scattering_stokes(camera, to, frame, in_scattering, transmittance);
        };
        check_length(in_scattering.len(), aerial.bands())?;
        aerial.stokes(in_scattering, |light, through| {
            let joined = aerial.aerial.joined_to_polarised(sky.parts().0)?;
            joined.in_scattering_stokes_batch(&[to], frame, light, through)
        })?;
        aerial.air.transmittance(camera, to, transmittance)
    }
}

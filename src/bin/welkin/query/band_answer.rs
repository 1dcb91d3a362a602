//! Answers in the bands of a sensor, where nodes of the model alone do not make them.

use welkin::{
    BandAerialPerspective, BandSolarDisc, BandTransmittance, Bands, Conditions, Model,
    PolarisationFrame, PolarisedBandSky, Result, Stokes,
};

use super::kept::{Kept, kept};
use super::quantity::Question;

/// What a thread keeps from row to row: the last of everything.
pub struct BandAnswerer<'a> {
    model: &'a Model,
    bands: &'a Bands,
    polarised: Kept<PolarisedBandSky>,
    aerial: Kept<BandAerialPerspective>,
    disc: Kept<BandSolarDisc>,
    air: Kept<BandTransmittance, u64>,
    light: Vec<Stokes>,
    through: Vec<f32>,
}

impl<'a> BandAnswerer<'a> {
    pub fn new(model: &'a Model, bands: &'a Bands) -> Self {
        Self {
            model,
            bands,
            polarised: None,
            aerial: None,
            disc: None,
            air: None,
            light: vec![Stokes::default(); bands.count()],
            through: vec![0.0; bands.count()],
        }
    }

    /// Bands of relative radiance at the nodes.
    pub fn project(&self, relative: &[f32], out: &mut [f32]) -> Result<()> {
        self.bands.project(relative, out)
    }

    pub fn transmittance(
        &mut self,
        question: &Question,
        conditions: &Conditions,
        out: &mut [f32],
    ) -> Result<()> {
        let (model, bands) = (self.model, self.bands);
        let visibility = conditions.checked(model)?.visibility;
        let air = kept(&mut self.air, visibility.to_bits(), || {
            model.band_transmittance(visibility, bands)
        })?;
        let [from, to] = question.ray.ends(conditions);
        match question.ray.is_endless() {
            true => air.transmittance_to_end(from, question.ray.direction, out),
            false => air.transmittance(from, to, out),
        }
    }

    pub fn sun(
        &mut self,
        question: &Question,
        conditions: &Conditions,
        out: &mut [f32],
    ) -> Result<()> {
        let (model, bands) = (self.model, self.bands);
        let disc = kept(&mut self.disc, question.place(), || {
            model.band_solar_disc(conditions, bands)
        })?;
        disc.radiance(question.ray.narrow(), out)
    }

    /// Of the sky, or of what the air within a finite distance scatters: one number of each Stokes vector.
    pub fn stokes(
        &mut self,
        question: &Question,
        conditions: &Conditions,
        frame: PolarisationFrame,
        of: impl Fn(&Stokes) -> f32,
        out: &mut [f32],
    ) -> Result<()> {
        let (model, bands) = (self.model, self.bands);
        let light = &mut self.light;
        match question.ray.is_endless() {
            true => {
                let sky = kept(&mut self.polarised, question.place(), || {
                    model.polarised_band_sky(conditions, bands)
                })?;
                sky.stokes(question.ray.narrow(), frame, light)?;
            }
            false => {
                let aerial = kept(&mut self.aerial, question.place(), || {
                    model.band_aerial_perspective(conditions, bands)
                })?;
                let [from, to] = question.ray.ends(conditions);
                aerial.in_scattering_stokes(from, to, frame, light, &mut self.through)?;
            }
        }
        out.iter_mut()
            .zip(light)
            .for_each(|(out, light)| *out = of(light));
        Ok(())
    }
}

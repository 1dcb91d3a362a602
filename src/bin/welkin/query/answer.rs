//! Answers questions that come sorted, so that neighbours have as much in common as can be.

use welkin::{
    AerialPerspective, AerialPerspectiveQuery, Conditions, PolarisationFrame, PolarisedSky, Result,
    Sky, SolarDisc, Stokes, Transmittance,
};

use super::band_answer::BandAnswerer;
use super::kept::{Kept, kept};
use super::quantity::{Key, Quantity, Question};
use super::shared::Shared;

/// What a thread keeps from row to row: the last of everything.
pub struct Answerer<'a> {
    shared: &'a Shared<'a>,
    aerial_perspective_query: Option<AerialPerspectiveQuery<'a>>,
    sky: Kept<Sky>,
    polarised: Kept<PolarisedSky>,
    aerial: Kept<AerialPerspective>,
    disc: Kept<SolarDisc>,
    air: Kept<Transmittance, u64>,
    spectrum: Spectrum,
    bands: Option<BandAnswerer<'a>>,
}

/// The last spectrum: rows often differ in their wavelength only.
#[derive(Default)]
struct Spectrum {
    key: Option<Key>,
    values: Vec<f32>,
    /// What else was computed with it.
    rest: Vec<f32>,
}

impl<'a> Answerer<'a> {
    pub fn new(shared: &'a Shared<'a>) -> Self {
        let zeros = || vec![0.0; shared.irradiance.len()];
        Self {
            shared,
            aerial_perspective_query: None,
            sky: None,
            polarised: None,
            aerial: None,
            disc: None,
            air: None,
            spectrum: Spectrum {
                key: None,
                values: zeros(),
                rest: zeros(),
            },
            bands: (shared.bands.as_ref()).map(|bands| BandAnswerer::new(shared.model, bands)),
        }
    }

    /// One number, or one for each band.
    pub fn answer(&mut self, question: &Question, out: &mut [f32]) -> Result<()> {
        // Taken out, so that it can be asked beside the rest.
        if let Some(mut bands) = self.bands.take() {
            let answered = self.answer_in(&mut bands, question, out);
            self.bands = Some(bands);
            return answered;
        }
        let value = self.at_wavelength(question)?;
        out.iter_mut().for_each(|out| *out = value);
        Ok(())
    }

    fn answer_in(
        &mut self,
        bands: &mut BandAnswerer,
        question: &Question,
        out: &mut [f32],
    ) -> Result<()> {
        let conditions = &self.shared.reachable(&question.conditions)?;
        let (vertical, aligned) = (PolarisationFrame::Vertical, PolarisationFrame::SunAligned);
        match question.quantity {
            Quantity::Radiance | Quantity::RelativeRadiance | Quantity::InScatter => {
                bands.project(self.spectrum(question)?, out)
            }
            Quantity::Transmittance => bands.transmittance(question, conditions, out),
            Quantity::SunRadiance => bands.sun(question, conditions, out),
            Quantity::Polarisation => {
                bands.stokes(question, conditions, aligned, Stokes::signed_degree, out)
            }
            Quantity::StokesQ => bands.stokes(question, conditions, vertical, |l| l.q, out),
            Quantity::StokesU => bands.stokes(question, conditions, vertical, |l| l.u, out),
        }
    }

    fn at_wavelength(&mut self, question: &Question) -> Result<f32> {
        let wavelength = question.wavelength;
        match question.quantity {
            Quantity::Radiance => {
                let relative = self.at(question)?;
                Ok(self.shared.times_irradiance(relative, wavelength))
            }
            // Of transmittance through lines nodes tell nothing.
            Quantity::Transmittance if self.shared.model.has_spectrum() => {
                self.transmittance_at(question)
            }
            Quantity::SunRadiance if self.shared.model.has_spectrum() => self.sun_at(question),
            Quantity::RelativeRadiance | Quantity::Transmittance => self.at(question),
            Quantity::InScatter | Quantity::SunRadiance => {
                let relative = self.at(question)?;
                Ok(self.shared.times_irradiance(relative, wavelength))
            }
            Quantity::Polarisation => Ok(self
                .stokes(question, PolarisationFrame::SunAligned)?
                .signed_degree()),
            Quantity::StokesQ => Ok(self.stokes(question, PolarisationFrame::Vertical)?.q),
            Quantity::StokesU => Ok(self.stokes(question, PolarisationFrame::Vertical)?.u),
        }
    }

    /// The spectrum of a question at its wavelength, relative to the sun's where that makes it smooth.
    fn at(&mut self, question: &Question) -> Result<f32> {
        let shared = self.shared;
        shared.between(self.spectrum(question)?, question.wavelength)
    }

    /// The same at the wavelengths of the model.
    fn spectrum(&mut self, question: &Question) -> Result<&[f32]> {
        let key = Some(question.key());
        if self.spectrum.key != key {
            self.spectrum.key = None;
            self.fill(question)?;
            self.spectrum.key = key;
        }
        Ok(&self.spectrum.values)
    }

    fn fill(&mut self, question: &Question) -> Result<()> {
        let conditions = self.shared.reachable(&question.conditions)?;
        match question.quantity {
            Quantity::Transmittance => self.transmittance(question, &conditions),
            Quantity::InScatter => {
                self.in_scattering(question, &conditions)?;
                self.divide();
                Ok(())
            }
            Quantity::SunRadiance => {
                self.sun(question, &conditions)?;
                self.divide();
                Ok(())
            }
            _ => self.radiance(question, &conditions),
        }
    }

    /// Takes the sun's spectrum out.
    fn divide(&mut self) {
        let values = self.spectrum.values.iter_mut();
        for (value, irradiance) in values.zip(&self.shared.irradiance) {
            // Where the sun does not shine there is no light either.
            *value = match *irradiance > 0.0 {
                true => (*value / irradiance).min(f32::MAX),
                false => 0.0,
            };
        }
    }

    fn radiance(&mut self, question: &Question, conditions: &Conditions) -> Result<()> {
        let (direction, out) = (question.ray.narrow(), &mut self.spectrum.values);
        if let Some(query) = self.shared.point_query() {
            return query.relative_radiance(conditions, direction, out);
        }
        let model = self.shared.model;
        let sky = kept(&mut self.sky, question.place(), || model.sky(conditions))?;
        sky.relative_radiance(direction, out)
    }

    fn transmittance(&mut self, question: &Question, conditions: &Conditions) -> Result<()> {
        let model = self.shared.model;
        let visibility = conditions.checked(model)?.visibility;
        let air = kept(&mut self.air, visibility.to_bits(), || {
            model.transmittance(visibility)
        })?;
        let ([from, to], out) = (question.ray.ends(conditions), &mut self.spectrum.values);
        match question.ray.is_endless() {
            true => air.transmittance_to_end(from, question.ray.direction, out),
            false => air.transmittance(from, to, out),
        }
    }

    fn transmittance_at(&mut self, question: &Question) -> Result<f32> {
        let (model, wavelength) = (self.shared.model, question.wavelength);
        let conditions = self.shared.reachable(&question.conditions)?;
        let visibility = conditions.checked(model)?.visibility;
        let air = kept(&mut self.air, visibility.to_bits(), || {
            model.transmittance(visibility)
        })?;
        let [from, to] = question.ray.ends(&conditions);
        match question.ray.is_endless() {
            true => air.transmittance_to_end_at(from, question.ray.direction, wavelength),
            false => air.transmittance_at(from, to, wavelength),
        }
    }

    fn sun_at(&mut self, question: &Question) -> Result<f32> {
        let model = self.shared.model;
        let conditions = self.shared.reachable(&question.conditions)?;
        let disc = kept(&mut self.disc, question.place(), || {
            model.solar_disc(&conditions)
        })?;
        disc.radiance_at(question.ray.narrow(), question.wavelength)
    }

    fn in_scattering(&mut self, question: &Question, conditions: &Conditions) -> Result<()> {
        let ray = &question.ray;
        if let Some(shared) = self.shared.aerial() {
            let aerial = self
                .aerial_perspective_query
                .get_or_insert_with(|| shared.clone());
            let Spectrum { values, rest, .. } = &mut self.spectrum;
            let [from, to] = ray.ends(conditions);
            return match ray.is_endless() {
                true => aerial.to_end(conditions, from, ray.direction, values, rest),
                false => aerial.in_scattering(conditions, from, to, values, rest),
            };
        }
        let model = self.shared.model;
        let aerial = kept(&mut self.aerial, question.place(), || {
            model.aerial_perspective(conditions)
        })?;
        ray.through(aerial, &mut self.spectrum.values, &mut self.spectrum.rest)
    }

    fn sun(&mut self, question: &Question, conditions: &Conditions) -> Result<()> {
        let model = self.shared.model;
        let disc = kept(&mut self.disc, question.place(), || {
            model.solar_disc(conditions)
        })?;
        disc.radiance(question.ray.narrow(), &mut self.spectrum.values)
    }

    /// Of the sky, or of what the air within a finite distance scatters.
    fn stokes(&mut self, question: &Question, frame: PolarisationFrame) -> Result<Stokes> {
        let (model, wavelength) = (self.shared.model, question.wavelength);
        let conditions = &self.shared.reachable(&question.conditions)?;
        if question.ray.is_endless() {
            if let Some(query) = self.shared.polarised() {
                return query.stokes_at(conditions, question.ray.narrow(), frame, wavelength);
            }
            let sky = kept(&mut self.polarised, question.place(), || {
                model.polarised_sky(conditions)
            })?;
            return sky.stokes_at(question.ray.narrow(), frame, wavelength);
        }
        let [from, to] = question.ray.ends(conditions);
        let light = if let Some(shared) = self.shared.aerial() {
            let aerial = self
                .aerial_perspective_query
                .get_or_insert_with(|| shared.clone());
            aerial.relative_stokes_at(conditions, from, to, frame, wavelength)?
        } else {
            let aerial = kept(&mut self.aerial, question.place(), || {
                model.aerial_perspective(conditions)
            })?;
            aerial.relative_stokes_at(from, to, frame, wavelength)?
        };
        let irradiance = model.head().solar_irradiance_at(wavelength) as f32;
        Ok(Stokes {
            i: irradiance * light.i,
            q: irradiance * light.q,
            u: irradiance * light.u,
        })
    }
}

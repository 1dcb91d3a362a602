//! One gas or kind of particle of a JSON atmosphere.

use super::super::composition::{Constituent, Phase, Scatterer};
use super::spectral::{Profiles, Values};
use super::within;
use anyhow::{Context, Result, bail};
use serde::{Deserialize, Serialize};

/// As it stands in the file.
#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Species {
    pub name: String,
    pub kind: String,
    pub extinction_per_m: Profiles,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub single_scattering_albedo: Option<Values>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depolarisation: Option<Values>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub g: Option<Values>,
}

impl Species {
    /// What it adds to an atmosphere: one constituent, or several where the shape of the profile changes with the
    /// wavelength.
    pub fn constituents(&self, nodes: usize, wavelengths: usize) -> Result<Vec<Constituent>> {
        self.extinction_per_m.check(nodes, wavelengths)?;
        let phase = self.phase(wavelengths)?;
        let albedos = self.albedo(wavelengths)?;
        let mut constituents: Vec<Constituent> = vec![];
        for (w, albedo) in albedos.into_iter().enumerate() {
            let extinction = self.extinction_per_m.at(w);
            let peak = extinction.iter().fold(0.0_f64, |a, &b| a.max(b));
            if peak == 0.0 {
                continue;
            }
            let profile: Vec<f64> = extinction.iter().map(|e| e / peak).collect();
            let place = constituents.iter().position(|c| c.has_shape(&profile));
            let place = place.unwrap_or_else(|| {
                constituents.push(self.nothing(profile, wavelengths, phase.as_ref()));
                constituents.len() - 1
            });
            constituents[place].add(w, peak, albedo);
        }
        if constituents.is_empty() {
            constituents.push(self.nothing(vec![0.0; nodes], wavelengths, phase.as_ref()));
        }
        Ok(constituents)
    }

    /// Single-scattering albedos; needed where something is scattered.
    fn albedo(&self, wavelengths: usize) -> Result<Vec<f64>> {
        match &self.single_scattering_albedo {
            Some(values) => values.read("single_scattering_albedo", wavelengths, 0.0, 1.0),
            None if self.kind == "absorber" => Ok(vec![0.0; wavelengths]),
            None => bail!("single_scattering_albedo is missing"),
        }
    }

    fn phase(&self, wavelengths: usize) -> Result<Option<Phase>> {
        Ok(match self.kind.as_str() {
            "rayleigh" => {
                let rho = self.depolarisation.as_ref();
                let rho = rho.context("depolarisation is missing")?;
                Some(Phase::Rayleigh {
                    depolarisation: rho.read("depolarisation", wavelengths, 0.0, 1.0)?,
                })
            }
            "henyey_greenstein" => {
                let g = self.g.as_ref().context("g is missing")?;
                Some(Phase::HenyeyGreenstein {
                    g: g.read("g", wavelengths, -0.9999, 0.9999)?,
                })
            }
            "absorber" => None,
            other => {
                bail!("kind \"{other}\" is not one of rayleigh, henyey_greenstein, absorber")
            }
        })
    }

    /// A constituent of this profile without any extinction yet.
    fn nothing(&self, profile: Vec<f64>, wavelengths: usize, phase: Option<&Phase>) -> Constituent {
        let scatterers = phase.map(|phase| Scatterer {
            name: self.name.clone(),
            phase: phase.clone(),
            extinction: vec![0.0; wavelengths],
            scattering: vec![0.0; wavelengths],
        });
        Constituent {
            name: self.name.clone(),
            profile,
            extinction: vec![0.0; wavelengths],
            scatterers: scatterers.into_iter().collect(),
        }
    }
}

impl Constituent {
    /// Sets the coefficients at wavelength index `w`.
    fn add(&mut self, w: usize, extinction: f64, albedo: f64) {
        self.extinction[w] = extinction;
        for scatterer in &mut self.scatterers {
            scatterer.extinction[w] = extinction;
            scatterer.scattering[w] = extinction * albedo;
        }
    }
}

impl Values {
    /// One checked value per wavelength.
    fn read(&self, field: &str, wavelengths: usize, low: f64, high: f64) -> Result<Vec<f64>> {
        self.check_length(field, wavelengths)?;
        let value = |w| {
            let value = self.at(w);
            within(&self.place(field, w), value, low, high)?;
            Ok(value)
        };
        (0..wavelengths).map(value).collect()
    }
}

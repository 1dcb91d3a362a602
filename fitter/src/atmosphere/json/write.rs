//! An atmosphere as a JSON file.

use super::super::composition::{Constituent, Phase, Scatterer};
use super::species::Species;
use super::spectral::{Profiles, Values};
use super::{Case, File};
use anyhow::{Context, Result, bail};

impl Case {
    /// The text of a file that [`Case::parse`] reads back: every species with its extinction at every node and
    /// wavelength, so that no other program needs to know how they are made. Numbers are written to the last bit.
    ///
    /// # Errors
    /// Scattering matrices, for which the format has no words, and whatever `parse` refuses.
    pub fn to_json(&self) -> Result<String> {
        let file = self.file()?;
        file.check()?;
        let text = serde_json::to_string(&file)?;
        Self::parse(&text).context("this atmosphere cannot be a file")?;
        Ok(text)
    }

    fn file(&self) -> Result<File> {
        let air = &self.atmosphere;
        let mut species = vec![];
        for constituent in &air.constituents {
            species.extend(constituent.species()?);
        }
        Ok(File {
            id: self.id.clone(),
            wavelength_nm: Values::new(air.wavelengths.clone()),
            planet_radius_m: air.planet_radius,
            toa_altitude_m: air.top(),
            ground_albedo: self.albedo,
            sun_elevation_deg: self.sun_elevation_deg,
            altitude_m: air.altitudes.clone(),
            species,
            columns: self.columns.clone(),
            rows: self.rows.clone(),
        })
    }
}

impl Constituent {
    /// Its scatterers, and what else absorbs.
    fn species(&self) -> Result<Vec<Species>> {
        let parts = self.scatterers.iter();
        let mut species = parts
            .map(|s| self.scatterer(s))
            .collect::<Result<Vec<_>>>()?;
        if let Some(rest) = self.rest() {
            species.push(Species {
                name: self.name.clone(),
                kind: "absorber".into(),
                extinction_per_m: self.profiles(&rest),
                single_scattering_albedo: None,
                depolarisation: None,
                g: None,
            });
        }
        Ok(species)
    }

    fn scatterer(&self, scatterer: &Scatterer) -> Result<Species> {
        let pairs = scatterer.scattering.iter().zip(&scatterer.extinction);
        let albedo = |(s, e): (&f64, &f64)| if *e > 0.0 { s / e } else { 1.0 };
        let mut species = Species {
            name: format!("{}: {}", self.name, scatterer.name),
            kind: String::new(),
            extinction_per_m: self.profiles(&scatterer.extinction),
            single_scattering_albedo: Some(Values::new(pairs.map(albedo).collect())),
            depolarisation: None,
            g: None,
        };
        match &scatterer.phase {
            Phase::Rayleigh { depolarisation } => {
                species.kind = "rayleigh".into();
                species.depolarisation = Some(Values::new(depolarisation.clone()));
            }
            Phase::HenyeyGreenstein { g } => {
                species.kind = "henyey_greenstein".into();
                species.g = Some(Values::new(g.clone()));
            }
            Phase::Tabulated(_) => bail!(
                "{}: a JSON atmosphere knows Rayleigh and Henyey-Greenstein scattering only",
                species.name
            ),
        }
        Ok(species)
    }

    /// Extinction by no scatterer, per wavelength; none where it is rounding.
    fn rest(&self) -> Option<Vec<f64>> {
        let scatterers =
            |w: usize| -> f64 { self.scatterers.iter().map(|s| s.extinction[w]).sum() };
        let extinction = self.extinction.iter().enumerate();
        let rest: Vec<f64> = extinction
            .map(|(w, e)| match e - scatterers(w) {
                rest if rest.abs() <= 1e-12 * e => 0.0,
                rest => rest,
            })
            .collect();
        let absorbs = rest.iter().any(|&e| e != 0.0);
        (absorbs || self.scatterers.is_empty()).then_some(rest)
    }

    fn profiles(&self, coefficients: &[f64]) -> Profiles {
        let profile = |c: &f64| self.profile.iter().map(|p| p * c).collect();
        Profiles::new(coefficients.iter().map(profile).collect())
    }
}

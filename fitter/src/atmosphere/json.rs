//! The JSON atmosphere: profiles, scene and lines of sight of one test case in one file.
//!
//! Every species gives its extinction at the altitude nodes, at one wavelength. Lengths in metres, angles in degrees, as the
//! names of the fields say.

use super::{Atmosphere, Constituent, Phase, Scatterer};
use anyhow::{Context, Result, bail, ensure};
use serde::Deserialize;
use std::path::Path;

/// An atmosphere with the sun and the ground that go with it.
#[derive(Clone, Debug)]
pub struct Case {
    /// Short name, may be empty.
    pub id: String,
    /// The air.
    pub atmosphere: Atmosphere,
    /// Sun elevation, degrees.
    pub sun_elevation_deg: f64,
    /// Ground albedo.
    pub albedo: f64,
    /// Names of the columns of `rows`.
    pub columns: Vec<String>,
    /// Lines of sight and what is known about them.
    pub rows: Vec<Vec<Option<f64>>>,
}

#[derive(Deserialize)]
struct File {
    #[serde(default)]
    id: String,
    wavelength_nm: f64,
    planet_radius_m: f64,
    toa_altitude_m: f64,
    ground_albedo: f64,
    sun_elevation_deg: f64,
    altitude_m: Vec<f64>,
    species: Vec<Species>,
    #[serde(default)]
    columns: Vec<String>,
    #[serde(default)]
    rows: Vec<Vec<Option<f64>>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Species {
    name: String,
    kind: String,
    extinction_per_m: Vec<f64>,
    single_scattering_albedo: Option<f64>,
    depolarisation: Option<f64>,
    g: Option<f64>,
}

impl Case {
    /// Reads a file.
    pub fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path)
            .with_context(|| format!("cannot read {}", path.display()))?;
        Self::parse(&text).with_context(|| path.display().to_string())
    }

    /// Reads JSON text.
    pub fn parse(text: &str) -> Result<Self> {
        let file: File = serde_json::from_str(text)?;
        file.check()?;
        let atmosphere = file.atmosphere()?;
        for (i, row) in file.rows.iter().enumerate() {
            ensure!(
                row.len() == file.columns.len(),
                "rows[{i}] has {} values for {} columns",
                row.len(),
                file.columns.len()
            );
        }
        Ok(Self {
            id: file.id,
            atmosphere,
            sun_elevation_deg: file.sun_elevation_deg,
            albedo: file.ground_albedo,
            columns: file.columns,
            rows: file.rows,
        })
    }

    /// A column of `rows`, if there is one of that name.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|c| c == name)
    }

    /// The value in `row` of the named column.
    pub fn value(&self, row: usize, name: &str) -> Result<f64> {
        let column = self
            .column(name)
            .with_context(|| format!("columns: no {name}"))?;
        self.rows[row][column].with_context(|| format!("rows[{row}].{name} is null"))
    }
}

fn within(field: &str, value: f64, low: f64, high: f64) -> Result<()> {
    ensure!(
        value.is_finite() && (low..=high).contains(&value),
        "{field} = {value} is outside {low}..{high}"
    );
    Ok(())
}

impl File {
    fn check(&self) -> Result<()> {
        within("wavelength_nm", self.wavelength_nm, 100.0, 100_000.0)?;
        within("planet_radius_m", self.planet_radius_m, 1e3, 1e13)?;
        within("ground_albedo", self.ground_albedo, 0.0, 1.0)?;
        within("sun_elevation_deg", self.sun_elevation_deg, -90.0, 90.0)?;
        self.check_altitudes()?;
        ensure!(!self.species.is_empty(), "species is empty");
        self.species
            .iter()
            .enumerate()
            .try_for_each(|(i, species)| {
                species
                    .check(self.altitude_m.len())
                    .with_context(|| format!("species[{i}] ({})", species.name))
            })
    }

    fn check_altitudes(&self) -> Result<()> {
        let z = &self.altitude_m;
        ensure!(z.len() >= 2, "altitude_m has fewer than two nodes");
        for (i, &value) in z.iter().enumerate() {
            within(&format!("altitude_m[{i}]"), value, 0.0, 1e9)?;
            ensure!(
                i == 0 || value > z[i - 1],
                "altitude_m[{i}] = {value} does not exceed the node before it"
            );
        }
        ensure!(z[0] == 0.0, "altitude_m[0] = {} is not 0", z[0]);
        let top = z[z.len() - 1];
        ensure!(
            (self.toa_altitude_m - top).abs() <= 1e-6 * top,
            "toa_altitude_m = {} is not the last node of altitude_m, {top}",
            self.toa_altitude_m
        );
        Ok(())
    }

    fn atmosphere(&self) -> Result<Atmosphere> {
        let mut constituents: Vec<Constituent> = vec![];
        for species in &self.species {
            let c = species.constituent()?;
            match constituents
                .iter_mut()
                .find(|other| other.profile_matches(&c))
            {
                Some(same) => same.absorb(c),
                None => constituents.push(c),
            }
        }
        Ok(Atmosphere {
            planet_radius: self.planet_radius_m,
            altitudes: self.altitude_m.clone(),
            wavelengths: vec![self.wavelength_nm],
            constituents,
        })
    }
}

impl Species {
    fn check(&self, nodes: usize) -> Result<()> {
        ensure!(
            self.extinction_per_m.len() == nodes,
            "extinction_per_m has {} values for {nodes} nodes of altitude_m",
            self.extinction_per_m.len()
        );
        for (i, &value) in self.extinction_per_m.iter().enumerate() {
            within(&format!("extinction_per_m[{i}]"), value, 0.0, 1e3)?;
        }
        if let Some(albedo) = self.single_scattering_albedo {
            within("single_scattering_albedo", albedo, 0.0, 1.0)?;
        }
        Ok(())
    }

    fn phase(&self) -> Result<Option<Phase>> {
        Ok(match self.kind.as_str() {
            "rayleigh" => {
                let rho = self.depolarisation.context("depolarisation is missing")?;
                within("depolarisation", rho, 0.0, 1.0)?;
                Some(Phase::Rayleigh {
                    depolarisation: vec![rho],
                })
            }
            "henyey_greenstein" => {
                let g = self.g.context("g is missing")?;
                within("g", g, -0.9999, 0.9999)?;
                Some(Phase::HenyeyGreenstein { g: vec![g] })
            }
            "absorber" => None,
            other => {
                bail!("kind \"{other}\" is not one of rayleigh, henyey_greenstein, absorber")
            }
        })
    }

    fn constituent(&self) -> Result<Constituent> {
        let context = || format!("species {}", self.name);
        let phase = self.phase().with_context(context)?;
        let peak = self.extinction_per_m.iter().fold(0.0_f64, |a, &b| a.max(b));
        let scale = if peak > 0.0 { peak } else { 1.0 };
        let scatterers = match phase {
            None => vec![],
            Some(phase) => vec![Scatterer {
                name: self.name.clone(),
                phase,
                scattering: vec![
                    scale
                        * self
                            .single_scattering_albedo
                            .context("single_scattering_albedo is missing")
                            .with_context(context)?,
                ],
            }],
        };
        Ok(Constituent {
            name: self.name.clone(),
            profile: self.extinction_per_m.iter().map(|e| e / scale).collect(),
            extinction: vec![scale],
            scatterers,
        })
    }
}

impl Constituent {
    /// Whether both have the same shape with altitude.
    fn profile_matches(&self, other: &Self) -> bool {
        let pairs = self.profile.iter().zip(&other.profile);
        pairs.into_iter().all(|(a, b)| (a - b).abs() <= 1e-12 * a)
    }

    /// Takes up what has the same profile.
    fn absorb(&mut self, other: Self) {
        self.name = format!("{} + {}", self.name, other.name);
        for (a, b) in self.extinction.iter_mut().zip(&other.extinction) {
            *a += b;
        }
        self.scatterers.extend(other.scatterers);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = r#"{"id": "x", "wavelength_nm": 550, "planet_radius_m": 6371000.0, "toa_altitude_m": 2000.0,
        "ground_albedo": 0.3, "sun_elevation_deg": 20.0, "altitude_m": [0.0, 1000.0, 2000.0], "checks": {"any": 1},
        "species": [
          {"name": "air", "kind": "rayleigh", "extinction_per_m": [2e-5, 1e-5, 0.0], "single_scattering_albedo": 1.0, "depolarisation": 0.03},
          {"name": "soot", "kind": "henyey_greenstein", "extinction_per_m": [4e-5, 2e-5, 0.0], "single_scattering_albedo": 0.2, "g": 0.3},
          {"name": "o3", "kind": "absorber", "extinction_per_m": [0.0, 1e-6, 1e-6]}],
        "columns": ["obs_alt_m", "T"], "rows": [[0.0, null]]}"#;

    #[test]
    fn species_of_one_shape_share_a_constituent() {
        let case = Case::parse(GOOD).unwrap();
        assert_eq!(case.atmosphere.constituents.len(), 2);
        assert_eq!(case.atmosphere.constituents[0].scatterers.len(), 2);
        let there = case.atmosphere.extinction(500.0, 0);
        assert!((there - 4.55e-5).abs() < 1e-15, "{there}");
        assert_eq!(case.value(0, "obs_alt_m").unwrap(), 0.0);
    }

    #[test]
    fn bad_files_are_refused_by_field() {
        for (from, to, names) in [
            ("\"wavelength_nm\": 550,", "", "wavelength_nm"),
            (
                "\"planet_radius_m\": 6371000.0",
                "\"planet_radius_m\": -1",
                "planet_radius_m",
            ),
            ("6371000.0", "NaN", "line 1"),
            (
                "\"ground_albedo\": 0.3",
                "\"ground_albedo\": 1.3",
                "ground_albedo",
            ),
            (
                "[0.0, 1000.0, 2000.0]",
                "[0.0, 1000.0, 900.0]",
                "altitude_m[2]",
            ),
            (
                "[0.0, 1000.0, 2000.0]",
                "[10.0, 1000.0, 2000.0]",
                "altitude_m[0]",
            ),
            (
                "\"toa_altitude_m\": 2000.0",
                "\"toa_altitude_m\": 3000.0",
                "toa_altitude_m",
            ),
            (
                "[2e-5, 1e-5, 0.0]",
                "[2e-5, -1e-5, 0.0]",
                "extinction_per_m[1]",
            ),
            ("[2e-5, 1e-5, 0.0]", "[2e-5, 1e-5]", "extinction_per_m"),
            (
                "[2e-5, 1e-5, 0.0]",
                "[2e300, 1e-5, 0.0]",
                "extinction_per_m[0]",
            ),
            ("\"g\": 0.3", "\"g\": 1.0", "g = 1"),
            (", \"g\": 0.3", "", "g is missing"),
            (
                "\"depolarisation\": 0.03",
                "\"depolarisation\": -0.1",
                "depolarisation",
            ),
            (
                "\"single_scattering_albedo\": 0.2",
                "\"single_scattering_albedo\": 2",
                "single_scattering_albedo",
            ),
            ("\"absorber\"", "\"mie\"", "mie"),
            (
                "\"absorber\", \"extinction_per_m\"",
                "\"absorber\", \"extinction_per_km\"",
                "extinction_per_km",
            ),
            ("[[0.0, null]]", "[[0.0]]", "rows[0]"),
        ] {
            let bad = GOOD.replace(from, to);
            assert_ne!(bad, GOOD, "{from}");
            let message = format!("{:#}", Case::parse(&bad).unwrap_err());
            assert!(message.contains(names), "{names}: {message}");
        }
    }
}

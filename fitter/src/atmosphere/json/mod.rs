//! The JSON atmosphere: profiles, scene and lines of sight of one test case in one file.
//!
//! Every species gives its extinction at the altitude nodes, at one wavelength or several. Lengths in metres, angles in
//! degrees, as the names of the fields say; all of them are described in `docs/atmosphere.md`.

mod species;
mod spectral;
#[cfg(test)]
mod tests;
mod write;

use super::composition::{Atmosphere, Constituent};
use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};
use species::Species;
use spectral::Values;
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

#[derive(Deserialize, Serialize)]
struct File {
    #[serde(default)]
    id: String,
    wavelength_nm: Values,
    planet_radius_m: f64,
    toa_altitude_m: f64,
    ground_albedo: f64,
    sun_elevation_deg: f64,
    altitude_m: Vec<f64>,
    species: Vec<Species>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    columns: Vec<String>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    rows: Vec<Vec<Option<f64>>>,
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
        "{field} = {value:?} is outside {low}..{high}"
    );
    Ok(())
}

impl File {
    fn check(&self) -> Result<()> {
        self.check_wavelengths()?;
        within("planet_radius_m", self.planet_radius_m, 1e3, 1e13)?;
        within("ground_albedo", self.ground_albedo, 0.0, 1.0)?;
        within("sun_elevation_deg", self.sun_elevation_deg, -90.0, 90.0)?;
        self.check_altitudes()?;
        ensure!(!self.species.is_empty(), "species is empty");
        Ok(())
    }

    fn check_wavelengths(&self) -> Result<()> {
        let wavelengths = self.wavelength_nm.as_slice();
        ensure!(!wavelengths.is_empty(), "wavelength_nm is empty");
        for (i, &nm) in wavelengths.iter().enumerate() {
            let place = self.wavelength_nm.place("wavelength_nm", i);
            within(&place, nm, 100.0, 100_000.0)?;
            ensure!(
                i == 0 || nm > wavelengths[i - 1],
                "{place} = {nm} does not exceed the wavelength before it"
            );
        }
        Ok(())
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
        let wavelengths = self.wavelength_nm.as_slice();
        let mut constituents: Vec<Constituent> = vec![];
        for (i, species) in self.species.iter().enumerate() {
            let parts = species
                .constituents(self.altitude_m.len(), wavelengths.len())
                .with_context(|| format!("species[{i}] ({})", species.name))?;
            for part in parts {
                match constituents.iter_mut().find(|c| c.has_shape(&part.profile)) {
                    Some(same) => same.absorb(part),
                    None => constituents.push(part),
                }
            }
        }
        Ok(Atmosphere {
            planet_radius: self.planet_radius_m,
            altitudes: self.altitude_m.clone(),
            wavelengths: wavelengths.to_vec(),
            constituents,
        })
    }
}

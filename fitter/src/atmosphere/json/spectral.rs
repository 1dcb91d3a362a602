//! What a JSON atmosphere gives once for all wavelengths or once for each.

use super::within;
use anyhow::{Result, ensure};
use serde::{Deserialize, Serialize};

/// Numbers that may depend on the wavelength.
#[derive(Clone, Deserialize, Serialize)]
#[serde(
    untagged,
    expecting = "expected a number, or a list with a number for each wavelength"
)]
pub enum Values {
    Same(f64),
    Each(Vec<f64>),
}

/// Altitude profiles that may depend on the wavelength.
#[derive(Deserialize, Serialize)]
#[serde(
    untagged,
    expecting = "expected a list with a number for each altitude, or a list of such lists, one for each wavelength"
)]
pub enum Profiles {
    Same(Vec<f64>),
    Each(Vec<Vec<f64>>),
}

impl Values {
    /// One number where there is one wavelength, a list where there are more.
    pub fn new(mut values: Vec<f64>) -> Self {
        match values.len() {
            1 => Self::Same(values.remove(0)),
            _ => Self::Each(values),
        }
    }

    /// The value at wavelength index `w`.
    pub fn at(&self, w: usize) -> f64 {
        match self {
            Self::Same(value) => *value,
            Self::Each(values) => values[w],
        }
    }

    /// All that are there.
    pub fn as_slice(&self) -> &[f64] {
        match self {
            Self::Same(value) => std::slice::from_ref(value),
            Self::Each(values) => values,
        }
    }

    /// What the value at `w` is called in messages.
    pub fn place(&self, field: &str, w: usize) -> String {
        match self {
            Self::Same(_) => field.to_owned(),
            Self::Each(_) => format!("{field}[{w}]"),
        }
    }

    pub fn check_length(&self, field: &str, wavelengths: usize) -> Result<()> {
        match self {
            Self::Same(_) => Ok(()),
            Self::Each(values) => check_length(field, values.len(), wavelengths),
        }
    }
}

impl Profiles {
    /// One profile where there is one wavelength, a list of them where there are more.
    pub fn new(mut profiles: Vec<Vec<f64>>) -> Self {
        match profiles.len() {
            1 => Self::Same(profiles.remove(0)),
            _ => Self::Each(profiles),
        }
    }

    /// The profile at wavelength index `w`.
    pub fn at(&self, w: usize) -> &[f64] {
        match self {
            Self::Same(profile) => profile,
            Self::Each(profiles) => &profiles[w],
        }
    }

    /// Whether all numbers are there and can be extinction coefficients.
    pub fn check(&self, nodes: usize, wavelengths: usize) -> Result<()> {
        const FIELD: &str = "extinction_per_m";
        match self {
            Self::Same(profile) => check_profile(FIELD, profile, nodes),
            Self::Each(profiles) => {
                check_length(FIELD, profiles.len(), wavelengths)?;
                let mut numbered = profiles.iter().enumerate();
                numbered.try_for_each(|(w, p)| check_profile(&format!("{FIELD}[{w}]"), p, nodes))
            }
        }
    }
}

fn check_length(field: &str, length: usize, wavelengths: usize) -> Result<()> {
    ensure!(
        length == wavelengths,
        "{field} has {length} entries for {wavelengths} of wavelength_nm"
    );
    Ok(())
}

fn check_profile(field: &str, profile: &[f64], nodes: usize) -> Result<()> {
    ensure!(
        profile.len() == nodes,
        "{field} has {} values for {nodes} nodes of altitude_m",
        profile.len()
    );
    for (i, &value) in profile.iter().enumerate() {
        within(&format!("{field}[{i}]"), value, 0.0, 1e3)?;
    }
    Ok(())
}

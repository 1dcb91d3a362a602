//! The gases of a recipe.

use super::carbon_dioxide;
use super::columns::Functions;
use super::error::{RecipeError, field};
use super::file::{Columns, File, Gases, Molecules};
use crate::atmosphere::gases::{DOBSON, GasProfile, OZONE_TEMPERATURES, WATER_MOLECULE};
use crate::atmosphere::table::{Curve, Table};
use crate::atmosphere::{Constituent, Monochromatic, column};
use anyhow::Result;

/// J/K.
const BOLTZMANN: f64 = 1.380_649e-23;
/// Mass of a mole of dry air and of carbon dioxide, kg; and how many molecules that is.
const MOLAR_MASS: [f64; 2] = [28.9595e-3, 44.0095e-3];
const AVOGADRO: f64 = 6.022_140_76e23;
/// Number densities below this, cm⁻³, are none.
const NOTHING: f64 = 1e-3;
/// Top of the atmosphere, km.
const TOP: f64 = 100.0;

macro_rules! table {
    ($name:literal) => {
        Table::parse($name, include_str!(concat!("../../data/", $name)))
    };
}

/// Names of the standard atmospheres.
const STANDARDS: [&str; 6] = [
    "us_standard",
    "tropical",
    "midlatitude_summer",
    "midlatitude_winter",
    "subarctic_summer",
    "subarctic_winter",
];

/// The gases of a recipe over the altitude.
pub struct Gas<'a> {
    fields: &'a Gases,
    profile: GasProfile,
    /// How much denser than the profile the air is.
    factor: f64,
}

impl<'a> Gas<'a> {
    /// Those that the recipe says.
    pub fn new(file: &'a File, altitudes: &[f64]) -> Result<Self> {
        let fields = &file.gases;
        let profile = profile(file)?;
        let mut gas = Self {
            fields,
            profile,
            factor: 1.0,
        };
        if let Some(hpa) = fields.surface_pressure_hpa {
            let weight = file.planet.gravity_m_s2 * fields.molecules.mass();
            gas.factor = hpa * 100.0 / (weight * gas.molecules(altitudes));
        }
        Ok(gas)
    }

    /// Where a table of the recipe's own bends, m.
    pub fn bends(file: &File) -> Result<Vec<f64>> {
        let table = file.gases.table.is_some();
        let nodes =
            |profile: GasProfile| profile.air.nodes().iter().map(|km| km * 1000.0).collect();
        Ok(if table { nodes(profile(file)?) } else { vec![] })
    }

    /// Molecules above a square metre, before the factor.
    fn molecules(&self, altitudes: &[f64]) -> f64 {
        column_of(&self.profile.air, altitudes)
    }

    /// Scattering, and absorption by oxygen and other mixed gases, which is that of as much air as there is.
    pub fn air(&self, altitudes: &[f64], lights: &[Monochromatic]) -> Result<Constituent> {
        let mut air = match self.fields.molecules {
            Molecules::Air => {
                let us = column_of(&GasProfile::us_standard()?.air, altitudes);
                let share = self.molecules(altitudes) / us;
                let scaled = lights.iter().map(|light| Monochromatic {
                    mixed: light.mixed * share,
                    ..*light
                });
                self.profile.air(altitudes, &scaled.collect::<Vec<_>>())?
            }
            Molecules::CarbonDioxide => carbon_dioxide::scattering(
                altitudes
                    .iter()
                    .map(|z| self.profile.air.log_at(z / 1000.0))
                    .collect(),
                lights,
            ),
        };
        let parts = air.scatterers.iter_mut();
        let coefficients = parts.flat_map(|s| s.extinction.iter_mut().chain(&mut s.scattering));
        coefficients
            .chain(&mut air.extinction)
            .for_each(|c| *c *= self.factor);
        Ok(air)
    }

    /// Ozone in as many parts as there may be, and water vapour.
    pub fn absorbers(
        &self,
        altitudes: &[f64],
        lights: &[Monochromatic],
        parts: usize,
    ) -> Result<Vec<Constituent>> {
        let [cold, _, warm] = OZONE_TEMPERATURES;
        let temperatures = match parts {
            1 => vec![self.mean_ozone_temperature(altitudes)],
            2 => vec![cold, warm],
            _ => OZONE_TEMPERATURES.to_vec(),
        };
        let ozone = self.fields.ozone_du;
        let mut out = self
            .profile
            .ozone(altitudes, lights, ozone, &temperatures)?;
        out.extend(
            self.profile
                .water(altitudes, lights, self.fields.water_cm)?,
        );
        Ok(out)
    }

    /// Whether there is ozone, and how many other gases have profiles of their own.
    pub fn counts(&self) -> (bool, usize) {
        (
            self.profile.ozone.is_some(),
            1 + usize::from(self.profile.water.is_some()),
        )
    }

    fn mean_ozone_temperature(&self, altitudes: &[f64]) -> f64 {
        let Some(ozone) = &self.profile.ozone else {
            return OZONE_TEMPERATURES[0];
        };
        let density: Vec<f64> = altitudes.iter().map(|z| ozone.log_at(z / 1000.0)).collect();
        let temperature = |z: &f64| self.profile.temperature.at(z / 1000.0);
        let weighted: Vec<f64> = altitudes
            .iter()
            .zip(&density)
            .map(|(z, n)| n * temperature(z))
            .collect();
        column(altitudes, &weighted) / column(altitudes, &density)
    }

    /// Column of ozone, Dobson units.
    pub fn dobson(&self, altitudes: &[f64]) -> f64 {
        let own = || {
            self.profile
                .ozone
                .as_ref()
                .map(|ozone| column_of(ozone, altitudes))
        };
        let own = || own().map_or(0.0, |molecules| molecules * 1e-4 / DOBSON);
        self.fields.ozone_du.unwrap_or_else(own)
    }

    /// Precipitable water, cm.
    pub fn water(&self, altitudes: &[f64]) -> f64 {
        let own = || {
            self.profile
                .water
                .as_ref()
                .map(|water| column_of(water, altitudes))
        };
        let own = || own().map_or(0.0, |molecules| molecules * 1e-4 * WATER_MOLECULE);
        self.fields.water_cm.unwrap_or_else(own)
    }
}

/// Molecules above a square metre.
fn column_of(per_cm3: &Curve, altitudes: &[f64]) -> f64 {
    let density: Vec<f64> = altitudes
        .iter()
        .map(|z| per_cm3.log_at(z / 1000.0) * 1e6)
        .collect();
    column(altitudes, &density)
}

impl Molecules {
    /// Mass of one, kg.
    fn mass(self) -> f64 {
        let molar = match self {
            Self::Air => MOLAR_MASS[0],
            Self::CarbonDioxide => MOLAR_MASS[1],
        };
        molar / AVOGADRO
    }
}

fn profile(file: &File) -> Result<GasProfile> {
    let gases = &file.gases;
    if let Some(columns) = &gases.table {
        return Ok(own(columns)?);
    }
    if let Some(isothermal) = &gases.isothermal {
        let mass = gases.molecules.mass();
        let kelvin = isothermal.temperature_k;
        let height = BOLTZMANN * kelvin / (mass * file.planet.gravity_m_s2);
        return Ok(exponential(kelvin, height)?);
    }
    standard(gases.standard.as_deref().unwrap_or(STANDARDS[0]))
}

fn standard(name: &str) -> Result<GasProfile> {
    let table = match name {
        "us_standard" => return GasProfile::us_standard(),
        "tropical" => table!("atm_afgl_tropical.csv"),
        "midlatitude_summer" => table!("atm_afgl_midlatitude_summer.csv"),
        "midlatitude_winter" => table!("atm_afgl_midlatitude_winter.csv"),
        "subarctic_summer" => table!("atm_afgl_subarctic_summer.csv"),
        "subarctic_winter" => table!("atm_afgl_subarctic_winter.csv"),
        other => {
            let what = format!("there is no {other:?}, only {}", STANDARDS.join(", "));
            return Err(field("gases.standard", what).into());
        }
    };
    GasProfile::of(&table?)
}

/// Gas that falls to 1/e along `height`, m; the factor of the surface pressure makes it as dense as it is.
fn exponential(kelvin: f64, height: f64) -> Result<GasProfile, RecipeError> {
    let curve = |y: Vec<f64>| {
        Curve::new(vec![0.0, TOP], y).map_err(|e| field("gases.isothermal", e.to_string()))
    };
    let top = 1e15 * (-1000.0 * TOP / height).exp();
    Ok(GasProfile {
        temperature: curve(vec![kelvin; 2])?,
        air: curve(vec![1e15, top.max(NOTHING)])?,
        ozone: None,
        water: None,
    })
}

fn own(columns: &Columns) -> Result<GasProfile, RecipeError> {
    const PLACE: &str = "gases.table";
    let table = Functions::new(PLACE, columns, "altitude_km")?;
    let known = [
        "temperature_k",
        "air_per_cm3",
        "ozone_per_cm3",
        "water_per_cm3",
    ];
    table.only(|name| known.contains(&name))?;
    table.only_altitudes()?;
    let [from, to] = table.range();
    if from != 0.0 || to < 30.0 {
        let what = format!("altitude_km runs from {from} to {to}, not from 0 to 30 or higher");
        return Err(field(PLACE, what));
    }
    let density = |name: &str| -> Result<Curve, RecipeError> {
        let curve = table.curve(name, 0.0, 1e25)?;
        continued(&curve).map_err(|e| field(PLACE, e.to_string()))
    };
    let maybe = |name: &str| table.has(name).then(|| density(name)).transpose();
    Ok(GasProfile {
        temperature: table.curve("temperature_k", 50.0, 3000.0)?,
        air: density("air_per_cm3")?,
        ozone: maybe("ozone_per_cm3")?,
        water: maybe("water_per_cm3")?,
    })
}

/// A number density that is nowhere nothing and thins out above its last row as between the last two.
fn continued(density: &Curve) -> Result<Curve> {
    let mut altitudes = density.nodes().to_vec();
    let mut values: Vec<f64> = altitudes
        .iter()
        .map(|&z| density.at(z).max(NOTHING))
        .collect();
    let last = altitudes.len() - 1;
    if altitudes[last] < TOP {
        let thickness = altitudes[last] - altitudes[last - 1];
        let slope = (values[last] / values[last - 1]).ln().min(0.0) / thickness;
        let above = TOP - altitudes[last];
        values.push((values[last] * (slope * above).exp()).max(NOTHING));
        altitudes.push(TOP);
    }
    Curve::new(altitudes, values)
}

//! The gases: profiles over the altitude, and what they scatter and absorb.

use super::composition::{Constituent, Phase, Scatterer, column};
use super::monochromatic::Monochromatic;
use super::table::{Curve, Table};
use anyhow::Result;

/// Temperatures of the measured cross sections of ozone, K, between which its absorption is linear.
pub const OZONE_TEMPERATURES: [f64; 3] = [223.0, 243.0, 293.0];

/// Molecules per cm² in a Dobson unit.
pub const DOBSON: f64 = 2.6867e16;

/// Precipitable water of one molecule per cm², cm: its mass in g.
pub const WATER_MOLECULE: f64 = 18.015_28 / 6.022_140_76e23;

macro_rules! table {
    ($name:literal) => {
        Table::parse($name, include_str!(concat!("../../data/", $name)))
    };
}

/// Gases over the altitude (km), in molecules per cm³.
pub struct GasProfile {
    /// K.
    pub temperature: Curve,
    /// All molecules.
    pub air: Curve,
    /// Ozone, if there is any.
    pub ozone: Option<Curve>,
    /// Water vapour, if there is any.
    pub water: Option<Curve>,
}

impl GasProfile {
    /// From a table with the columns `z_km`, `T_K`, `n_air`, `n_o3` and `n_h2o`.
    pub fn of(table: &Table) -> Result<Self> {
        let curve = |name| table.curve("z_km", name);
        Ok(Self {
            temperature: curve("T_K")?,
            air: curve("n_air")?,
            ozone: Some(curve("n_o3")?),
            water: Some(curve("n_h2o")?),
        })
    }

    /// The US standard atmosphere.
    pub fn us_standard() -> Result<Self> {
        Self::of(&table!("atm_afgl_us_standard.csv")?)
    }

    /// Rayleigh scattering of air, and absorption by the uniformly mixed gases as of all the air.
    pub fn air(&self, altitudes: &[f64], lights: &[Monochromatic]) -> Result<Constituent> {
        let rayleigh = table!("rayleigh_bodhaine1999.csv")?;
        let cross_section = rayleigh.curve("wavelength_nm", "sigma_cm2")?;
        let depolarisation = rayleigh.curve("wavelength_nm", "depol")?;
        let (air, scale) = density(&self.air, altitudes);
        let scattering = lights
            .iter()
            .map(|l| cross_section.log_at(l.wavelength) * scale);
        let scattering: Vec<f64> = scattering.collect();
        let all = column(altitudes, &air);
        let absorption = lights.iter().map(|l| l.mixed / all);
        Ok(Constituent {
            name: "air".into(),
            extinction: scattering
                .iter()
                .zip(absorption)
                .map(|(s, a)| s + a)
                .collect(),
            profile: air,
            scatterers: vec![Scatterer {
                name: "rayleigh".into(),
                phase: Phase::Rayleigh {
                    depolarisation: lights
                        .iter()
                        .map(|l| depolarisation.at(l.wavelength))
                        .collect(),
                },
                extinction: scattering.clone(),
                scattering,
            }],
        })
    }

    /// Ozone as a mixture of several, each with the cross section at one of the `temperatures` (K, increasing);
    /// `dobson` is its column, if not that of the profile.
    pub fn ozone(
        &self,
        altitudes: &[f64],
        lights: &[Monochromatic],
        dobson: Option<f64>,
        temperatures: &[f64],
    ) -> Result<Vec<Constituent>> {
        let Some(ozone) = &self.ozone else {
            return Ok(vec![]);
        };
        let cross_sections = CrossSections::new()?;
        let (ozone, standard) = density(ozone, altitudes);
        let scale = match dobson {
            Some(dobson) => dobson * DOBSON / column(altitudes, &ozone),
            None => standard,
        };
        let part = |(i, &kelvin): (usize, &f64)| {
            let densities = altitudes.iter().zip(&ozone);
            let share = |z: &f64| shares(self.temperature.at(z / 1000.0), temperatures)[i];
            let depth = |l: &Monochromatic| cross_sections.at(l.wavelength, kelvin) * scale;
            Constituent {
                name: format!("ozone at {kelvin} K"),
                profile: densities.map(|(z, n)| n * share(z)).collect(),
                extinction: lights.iter().map(depth).collect(),
                scatterers: vec![],
            }
        };
        Ok(temperatures.iter().enumerate().map(part).collect())
    }

    /// Absorption by water vapour; `precipitable` (cm) is its column, if not that of the profile.
    pub fn water(
        &self,
        altitudes: &[f64],
        lights: &[Monochromatic],
        precipitable: Option<f64>,
    ) -> Result<Option<Constituent>> {
        let Some(water) = &self.water else {
            return Ok(None);
        };
        let (vapour, standard) = density(water, altitudes);
        let scale = match precipitable {
            Some(cm) => cm / WATER_MOLECULE / column(altitudes, &vapour),
            None => standard,
        };
        let depth = |l: &Monochromatic| l.water * WATER_MOLECULE * scale;
        Ok(Some(Constituent {
            name: "water vapour".into(),
            profile: vapour,
            extinction: lights.iter().map(depth).collect(),
            scatterers: vec![],
        }))
    }
}

/// Absorption cross sections of ozone at any temperature.
struct CrossSections([Curve; 3]);

impl CrossSections {
    fn new() -> Result<Self> {
        let table = table!("o3_xsec_1nm.csv")?;
        let curve = |kelvin| table.curve("wavelength_nm", &format!("sigma_{kelvin}K"));
        let [cold, cool, warm] = OZONE_TEMPERATURES;
        Ok(Self([curve(cold)?, curve(cool)?, curve(warm)?]))
    }

    /// cm².
    fn at(&self, wavelength: f64, kelvin: f64) -> f64 {
        let shares = shares(kelvin, &OZONE_TEMPERATURES);
        let parts = shares
            .iter()
            .zip(&self.0)
            .filter(|(share, _)| **share > 0.0);
        parts
            .map(|(share, curve)| share * curve.at(wavelength))
            .sum()
    }
}

/// How much of each of the temperatures `of` makes another, K.
fn shares(temperature: f64, of: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; of.len()];
    let last = of.len() - 1;
    if last == 0 {
        return vec![1.0];
    }
    let t = temperature.clamp(of[0], of[last]);
    let upper = of.partition_point(|&node| node <= t).clamp(1, last);
    let share = (t - of[upper - 1]) / (of[upper] - of[upper - 1]);
    (out[upper - 1], out[upper]) = (1.0 - share, share);
    out
}

/// Profile normalised to its largest value, and the factor from cm² to m⁻¹ there.
fn density(per_cm3: &Curve, altitudes: &[f64]) -> (Vec<f64>, f64) {
    let n: Vec<f64> = altitudes
        .iter()
        .map(|z| per_cm3.log_at(z / 1000.0))
        .collect();
    let max = n.iter().cloned().fold(0.0, f64::max);
    (n.iter().map(|v| v / max).collect(), max * 100.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ozone_is_a_mixture_of_neighbouring_temperatures() {
        let shares = |kelvin| shares(kelvin, &OZONE_TEMPERATURES);
        assert_eq!(shares(200.0), [1.0, 0.0, 0.0]);
        assert_eq!(shares(233.0), [0.5, 0.5, 0.0]);
        assert_eq!(shares(243.0), [0.0, 1.0, 0.0]);
        assert_eq!(shares(268.0), [0.0, 0.5, 0.5]);
        assert_eq!(shares(300.0), [0.0, 0.0, 1.0]);
    }

    #[test]
    fn any_temperature_can_stand_alone() {
        assert_eq!(shares(250.0, &[230.0]), [1.0]);
        let sections = CrossSections::new().unwrap();
        let [a, b] = [223.0, 243.0].map(|kelvin| sections.at(330.0, kelvin));
        assert!((sections.at(330.0, 233.0) / (0.5 * (a + b)) - 1.0).abs() < 1e-12);
        assert!(a < b);
    }
}

//! What the traced air amounts to as coefficients, so that other models can have the same.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use super::Result;
use crate::peers::WAVELENGTHS;
use crate::peers::lanes::Lanes;
use crate::peers::medium::{Medium, ParticlePhase};
use crate::peers::shell::Shell;

/// Altitude of the densest ozone and half the width of its layer in the models of coefficients, m.
const OZONE_LAYER: [f64; 2] = [25e3, 15e3];
/// Where the air ends in the published programs of Bruneton and of Blender, whose steps are made for that, m.
pub const LOW_TOP: f64 = 60e3;
/// Columns of the CSV file.
const COLUMNS: [&str; 8] = [
    "wavelength nm",
    "molecules m⁻¹",
    "molecules depth",
    "ozone depth",
    "particles m⁻¹",
    "particles depth",
    "particles scattering share",
    "particles mean cosine",
];

/// The air at one wavelength: at the ground (m⁻¹), and vertical optical depths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtWavelength([f64; COLUMNS.len()]);

impl AtWavelength {
    fn ratio(&self, over: usize, under: usize) -> f64 {
        self.0[over] / self.0[under]
    }
}

/// The air at all wavelengths that are compared.
#[derive(Clone, Debug)]
pub struct Air {
    rows: Vec<AtWavelength>,
    planet: f64,
    top: f64,
}

impl Air {
    /// Sums up a JSON atmosphere as `welkin-fit atmosphere` writes it.
    ///
    /// # Errors
    /// Where a field is missing or of another form.
    pub fn from_json(text: &str) -> Result<Self> {
        let air: Value = serde_json::from_str(text)?;
        let altitudes = numbers(&air["altitude_m"])?;
        let species = air["species"].as_array().ok_or("species: not a list")?;
        let row = |(i, nm): (usize, f64)| at_wavelength(species, &altitudes, i, nm);
        let wavelengths = numbers(&air["wavelength_nm"])?;
        Ok(Self {
            rows: wavelengths
                .into_iter()
                .enumerate()
                .map(row)
                .collect::<Result<_>>()?,
            planet: number(&air["planet_radius_m"])?,
            top: number(&air["toa_altitude_m"])?,
        })
    }

    /// The table as CSV.
    pub fn csv(&self) -> String {
        let planet = format!("# planet {} m, top {} m\n", self.planet, self.top);
        let row = |row: &AtWavelength| row.0.map(|v| format!("{v:.6e}")).join(",");
        let rows: Vec<String> = self.rows.iter().map(row).collect();
        format!("{planet}{}\n{}\n", COLUMNS.join(","), rows.join("\n"))
    }

    /// Reads what [`Air::csv`] wrote.
    ///
    /// # Errors
    /// Where the file or a number in it cannot be read.
    pub fn read(path: &Path) -> Result<Self> {
        let text = fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
        Self::parse(&text).map_err(|e| format!("{}: {e}", path.display()).into())
    }

    fn parse(text: &str) -> Result<Self> {
        let (first, rows) = text.split_once('\n').ok_or("no rows")?;
        let size = |name: &str| -> Result<f64> {
            let mut words = first.split([' ', ',']).skip_while(|w| *w != name);
            Ok(words.nth(1).ok_or("no planet")?.parse()?)
        };
        let row = |line: &str| -> Result<AtWavelength> {
            let cells: Vec<f64> = line
                .split(',')
                .map(str::parse)
                .collect::<std::result::Result<_, _>>()?;
            let row = cells.try_into().map_err(|_| "a row has other columns")?;
            Ok(AtWavelength(row))
        };
        Ok(Self {
            rows: rows.lines().skip(1).map(row).collect::<Result<_>>()?,
            planet: size("planet")?,
            top: size("top")?,
        })
    }

    /// Over which molecules and particles thin out by e, m: depth over extinction at the ground.
    fn heights(&self) -> [f64; 2] {
        [
            self.mean(|row| row.ratio(2, 1)),
            self.mean(|row| row.ratio(5, 4)),
        ]
    }

    fn mean(&self, value: impl Fn(&AtWavelength) -> f64) -> f64 {
        self.rows.iter().map(value).sum::<f64>() / self.rows.len() as f64
    }

    /// Over ground of an albedo: exponential air with the same optical depths, scale heights and mean cosine.
    ///
    /// # Errors
    /// Unless the wavelengths are those that are compared.
    pub fn medium(&self, albedo: f32) -> Result<Medium<8>> {
        let rows: &[AtWavelength; 8] = self.rows.as_slice().try_into()?;
        if rows.map(|row| row.0[0]) != WAVELENGTHS {
            return Err("the air is that of other wavelengths".into());
        }
        let [molecules, particles] = self.heights();
        let lanes = |value: &dyn Fn(&AtWavelength) -> f64| {
            Lanes(rows.each_ref().map(|row| value(row) as f32))
        };
        Ok(Medium {
            shell: Shell {
                bottom: self.planet,
                top: self.planet + self.top,
            },
            rayleigh: lanes(&|row| row.0[2] / molecules),
            rayleigh_height: molecules,
            mie_scattering: lanes(&|row| row.0[5] * row.0[6] / particles),
            mie_extinction: lanes(&|row| row.0[5] / particles),
            mie_height: particles,
            g: self.mean(|row| row.0[7]) as f32,
            phase: ParticlePhase::HenyeyGreenstein,
            ozone: lanes(&|row| row.0[3] / OZONE_LAYER[1]),
            ozone_layer: OZONE_LAYER,
            albedo,
            sun_radius: welkin::SOLAR_ANGULAR_RADIUS,
        })
    }

    /// The same as a JSON atmosphere that `welkin-fit trace` reads.
    ///
    /// # Errors
    /// As [`Air::medium`].
    pub fn exponential(&self, albedo: f32) -> Result<Value> {
        self.medium(albedo)?;
        let [molecules, particles] = self.heights();
        let altitudes: Vec<f64> = (0..100)
            .map(|i| 100.0 * f64::from(i))
            .chain((0..=180).map(|i| 10e3 + 500.0 * f64::from(i)))
            .collect();
        let profile = |column: usize, shape: &dyn Fn(f64) -> f64| -> Vec<Vec<f64>> {
            let at = |row: &AtWavelength| {
                altitudes
                    .iter()
                    .map(|&h| row.0[column] * shape(h))
                    .collect()
            };
            self.rows.iter().map(at).collect()
        };
        let thin = |height: f64| move |h: f64| (-h / height).exp() / height;
        let tent =
            |h: f64| (1.0 - (h - OZONE_LAYER[0]).abs() / OZONE_LAYER[1]).max(0.0) / OZONE_LAYER[1];
        let share: Vec<f64> = self.rows.iter().map(|row| row.0[6]).collect();
        let wavelengths: Vec<f64> = self.rows.iter().map(|row| row.0[0]).collect();
        Ok(json!({
            "id": "exponential air",
            "wavelength_nm": wavelengths,
            "planet_radius_m": self.planet,
            "altitude_m": altitudes,
            "toa_altitude_m": self.top,
            "ground_albedo": f64::from(albedo),
            "sun_elevation_deg": 20.0,
            "species": [
                {"name": "molecules", "kind": "rayleigh", "single_scattering_albedo": 1.0, "depolarisation": 0.0,
                 "extinction_per_m": profile(2, &thin(molecules))},
                {"name": "particles", "kind": "henyey_greenstein", "single_scattering_albedo": share,
                 "g": self.mean(|row| row.0[7]), "extinction_per_m": profile(5, &thin(particles))},
                {"name": "ozone", "kind": "absorber", "extinction_per_m": profile(3, &tent)},
            ],
        }))
    }
}

fn number(value: &Value) -> Result<f64> {
    Ok(value
        .as_f64()
        .ok_or_else(|| format!("{value} is not a number"))?)
}

fn numbers(value: &Value) -> Result<Vec<f64>> {
    value
        .as_array()
        .ok_or("not a list")?
        .iter()
        .map(number)
        .collect()
}

/// A number, or one per wavelength.
fn one_of(value: &Value, i: usize) -> Result<f64> {
    number(if value.is_array() { &value[i] } else { value })
}

/// Sums over the species.
fn at_wavelength(species: &[Value], altitudes: &[f64], i: usize, nm: f64) -> Result<AtWavelength> {
    let mut row = [0.0; COLUMNS.len()];
    row[0] = nm;
    for species in species {
        let extinction = numbers(&species["extinction_per_m"][i])?;
        let depth = column(altitudes, &extinction);
        match species["kind"].as_str() {
            Some("rayleigh") => {
                row[1] += extinction[0];
                row[2] += depth;
            }
            Some("absorber") => row[3] += depth,
            Some("henyey_greenstein") => {
                let scattered = depth * one_of(&species["single_scattering_albedo"], i)?;
                row[4] += extinction[0];
                row[5] += depth;
                row[6] += scattered;
                row[7] += scattered * one_of(&species["g"], i)?;
            }
            kind => return Err(format!("species of kind {kind:?}").into()),
        }
    }
    row[7] /= row[6];
    row[6] /= row[5];
    Ok(AtWavelength(row))
}

fn column(altitudes: &[f64], profile: &[f64]) -> f64 {
    let pairs = altitudes.windows(2).zip(profile.windows(2));
    pairs
        .map(|(z, p)| 0.5 * (p[0] + p[1]) * (z[1] - z[0]))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn air() -> Air {
        Air::read(&crate::book::root().join("docs/evidence/air.csv")).unwrap()
    }

    #[test]
    fn it_is_written_and_read_again() {
        let air = air();
        assert_eq!(Air::parse(&air.csv()).unwrap().rows, air.rows);
        assert!(Air::parse("# nothing\n").is_err() && Air::parse("").is_err());
    }

    #[test]
    fn the_exponential_air_has_the_same_depths() {
        let air = air();
        let again = Air::from_json(&air.exponential(0.2).unwrap().to_string()).unwrap();
        for (a, b) in air.rows.iter().zip(&again.rows) {
            for column in [2, 3, 5, 6] {
                assert!(
                    (a.0[column] / b.0[column] - 1.0).abs() < 2e-3,
                    "{a:?} {b:?}"
                );
            }
        }
        let [molecules, particles, ozone] = air.medium(0.2).unwrap().vertical();
        for (k, row) in air.rows.iter().enumerate() {
            assert!((f64::from(molecules.0[k]) / row.0[2] - 1.0).abs() < 1e-4);
            assert!((f64::from(particles.0[k]) / row.0[5] - 1.0).abs() < 1e-4);
            assert!((f64::from(ozone.0[k]) / row.0[3] - 1.0).abs() < 1e-4);
        }
    }
}

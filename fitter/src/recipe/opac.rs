//! The particles of OPAC (Hess, Koepke and Schult 1998) and its mixtures of them.

use super::error::{RecipeError, field};
use super::file::PhaseFunctions;
use crate::atmosphere::table::{Curve, Table};
use crate::particles::opac::Spheres;
use anyhow::Result;

/// Particles that do not take up water; the droplets of fog are wet as they are.
const DRY: [&str; 7] = ["inso", "soot", "minm", "miam", "micm", "mitr", "fogr"];
/// Particles that grow with the humidity.
const HYGROSCOPIC: [&str; 4] = ["waso", "ssam", "sscm", "suso"];
/// Relative humidities of the tables, percent.
const HUMIDITIES: [f64; 8] = [0.0, 50.0, 70.0, 80.0, 90.0, 95.0, 98.0, 99.0];

macro_rules! table {
    ($name:literal) => {
        Table::parse($name, include_str!(concat!("../../data/", $name)))
    };
}

/// A particle of one kind, by wavelength.
pub struct Component {
    /// Logarithm of the wavelength against the extinction cross section, m².
    extinction: Curve,
    albedo: Curve,
    asymmetry: Curve,
    spheres: Option<Spheres>,
}

impl Component {
    /// Particles of this name at a relative humidity (percent, 0..99).
    pub fn new(place: &str, name: &str, humidity: f64, phase: PhaseFunctions) -> Result<Self> {
        let spheres = match phase {
            PhaseFunctions::HenyeyGreenstein => None,
            PhaseFunctions::Mie => Spheres::new(name, humidity)?,
        };
        let with = |component: Self| Self {
            spheres,
            ..component
        };
        if DRY.contains(&name) {
            return Self::row(&table!("opac_dry.csv")?, name, &Blend::only()).map(with);
        }
        if HYGROSCOPIC.contains(&name) {
            let (table, blend) = (table!("opac_hygroscopic.csv")?, Blend::at(humidity));
            return Self::row(&table, name, &blend).map(with);
        }
        let known = [&DRY[..], &HYGROSCOPIC[..]].concat().join(", ");
        Err(field(
            place,
            format!("there are no particles {name:?}, only {known}"),
        )
        .into())
    }

    fn row(table: &Table, name: &str, blend: &Blend) -> Result<Self> {
        let wavelengths = blend.of(&table.column("wavelength_nm")?, |a, b, _| a.max(b));
        let column = |what: &str| table.column(&format!("{name}_{what}"));
        let linear = |a: f64, b: f64, t: f64| a + t * (b - a);
        let logarithmic = |a: f64, b: f64, t: f64| (a.ln() + t * (b / a).ln()).exp();
        let logs = wavelengths.iter().map(|w| w.ln()).collect();
        Ok(Self {
            extinction: Curve::new(logs, blend.of(&column("ext")?, logarithmic))?,
            albedo: Curve::new(wavelengths.clone(), blend.of(&column("ssa")?, linear))?,
            asymmetry: Curve::new(wavelengths, blend.of(&column("g_use")?, linear))?,
            spheres: None,
        })
    }

    /// Extinction cross section, m².
    pub fn extinction(&self, wavelength: f64) -> f64 {
        self.extinction.log_at(wavelength.ln())
    }

    /// Single-scattering albedo.
    pub fn albedo(&self, wavelength: f64) -> f64 {
        self.albedo.at(wavelength)
    }

    /// Asymmetry of the Henyey-Greenstein function that stands for its phase function.
    pub fn asymmetry(&self, wavelength: f64) -> f64 {
        self.asymmetry.at(wavelength)
    }

    /// The spheres whose scattering matrices count instead of that function.
    pub fn spheres(&self) -> Option<&Spheres> {
        self.spheres.as_ref()
    }
}

/// Two blocks of rows of a table, one for each of two humidities, and where between them.
struct Blend {
    blocks: usize,
    lower: usize,
    upper: usize,
    t: f64,
}

impl Blend {
    fn only() -> Self {
        Self {
            blocks: 1,
            lower: 0,
            upper: 0,
            t: 0.0,
        }
    }

    fn at(humidity: f64) -> Self {
        let last = HUMIDITIES.len() - 1;
        let upper = HUMIDITIES
            .partition_point(|&h| h <= humidity)
            .clamp(1, last);
        let (a, b) = (HUMIDITIES[upper - 1], HUMIDITIES[upper]);
        Self {
            blocks: HUMIDITIES.len(),
            lower: upper - 1,
            upper,
            t: ((humidity - a) / (b - a)).clamp(0.0, 1.0),
        }
    }

    fn of(&self, column: &[f64], mix: impl Fn(f64, f64, f64) -> f64) -> Vec<f64> {
        let rows = column.len() / self.blocks;
        let block = |i: usize| &column[i * rows..(i + 1) * rows];
        let pairs = block(self.lower).iter().zip(block(self.upper));
        pairs.map(|(&a, &b)| mix(a, b, self.t)).collect()
    }
}

/// Particles per cm³ at sea level.
type Mixture = &'static [(&'static str, f64)];

/// The aerosol types of OPAC, Table 4 of the paper.
const MIXTURES: [(&str, Mixture); 11] = [
    ("continental_clean", &[("waso", 2600.0), ("inso", 0.15)]),
    (
        "continental_average",
        &[("waso", 7000.0), ("inso", 0.4), ("soot", 8300.0)],
    ),
    (
        "continental_polluted",
        &[("waso", 15_700.0), ("inso", 0.6), ("soot", 34_300.0)],
    ),
    (
        "urban",
        &[("waso", 28_000.0), ("inso", 1.5), ("soot", 130_000.0)],
    ),
    (
        "desert",
        &[
            ("waso", 2000.0),
            ("minm", 269.5),
            ("miam", 30.5),
            ("micm", 0.142),
        ],
    ),
    (
        "maritime_clean",
        &[("waso", 1500.0), ("ssam", 20.0), ("sscm", 3.2e-3)],
    ),
    (
        "maritime_polluted",
        &[
            ("waso", 3800.0),
            ("ssam", 20.0),
            ("sscm", 3.2e-3),
            ("soot", 5180.0),
        ],
    ),
    (
        "maritime_tropical",
        &[("waso", 590.0), ("ssam", 10.0), ("sscm", 1.3e-3)],
    ),
    (
        "arctic",
        &[
            ("waso", 1300.0),
            ("inso", 0.01),
            ("ssam", 1.9),
            ("soot", 5300.0),
        ],
    ),
    (
        "antarctic",
        &[("suso", 42.9), ("ssam", 0.047), ("mitr", 0.0053)],
    ),
    // Background of the free troposphere, extrapolated to sea level.
    (
        "free_troposphere",
        &[("waso", 438.0), ("inso", 1.24e-3), ("soot", 292.0)],
    ),
];

/// The mixture of this name.
pub fn mixture(place: &str, name: &str) -> Result<Mixture, RecipeError> {
    let found = MIXTURES.iter().find(|(known, _)| *known == name);
    let known = || MIXTURES.map(|(known, _)| known).join(", ");
    let missing = || {
        field(
            place,
            format!("there is no mixture {name:?}, only {}", known()),
        )
    };
    Ok(found.ok_or_else(missing)?.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn humidity_between_those_of_the_table_is_between() {
        let extinction = |h| {
            Component::new("", "waso", h, PhaseFunctions::default())
                .unwrap()
                .extinction(550.0)
        };
        assert!(
            (extinction(75.0) / (extinction(70.0) * extinction(80.0)).sqrt() - 1.0).abs() < 1e-9
        );
        let mut last = 0.0;
        for h in [0.0, 30.0, 50.0, 65.0, 80.0, 89.0, 97.0, 99.0] {
            let now = extinction(h);
            assert!(now > last, "{h} %");
            last = now;
        }
    }

    /// Both come from the same tables, one by way of every 20 nm; beyond 1 µm, where those are coarse, they differ
    /// between their wavelengths.
    #[test]
    fn particles_are_those_of_the_models_air() {
        let table = table!("opac_channels.csv").unwrap();
        for (name, humidity) in [("waso", 50.0), ("inso", 0.0), ("soot", 0.0)] {
            let component = Component::new("", name, humidity, PhaseFunctions::default()).unwrap();
            for nm in [320.0, 440.0, 550.0, 700.0, 1000.0, 2000.0] {
                let curve = |what: &str| table.curve("wavelength_nm", &format!("{name}_{what}"));
                let ext = curve("ext_m2").unwrap().log_at(nm);
                assert!(
                    (component.extinction(nm) / ext - 1.0).abs() < 1e-4,
                    "{name} {nm}"
                );
                let ssa = curve("ssa").unwrap().at(nm);
                assert!((component.albedo(nm) - ssa).abs() < 1e-3, "{name} {nm}");
                let g = curve("g_use").unwrap().at(nm);
                assert!((component.asymmetry(nm) - g).abs() < 2e-3, "{name} {nm}");
            }
        }
    }
}

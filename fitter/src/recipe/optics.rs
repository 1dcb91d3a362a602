//! How the particles of a layer scatter, per unit of its profile.

use super::columns::Functions;
use super::error::{RecipeError, field};
use super::file::{Columns, Layer, PhaseFunctions};
use super::opac::{Component, mixture};
use crate::atmosphere::matrix::{Elements, Matrix};
use crate::atmosphere::table::Curve;
use crate::atmosphere::{Phase, Scatterer};
use anyhow::Result;
use std::sync::Arc;

/// Per cm³, in m⁻³.
const PER_CM3: f64 = 1e6;
/// Extinction coefficient of 1 km⁻¹, m⁻¹.
const PER_KM: f64 = 1e-3;

/// The particles of a layer.
pub enum Optics {
    /// Particles of OPAC with their numbers per cm³.
    Components(Vec<(String, f64, Component)>),
    /// A table.
    Own(Own),
}

/// Particles of which only the table is known.
pub struct Own {
    place: String,
    range: [f64; 2],
    extinction: Curve,
    albedo: Curve,
    phase: OwnPhase,
}

enum OwnPhase {
    Asymmetry(Curve),
    Tabulated(PhaseTable),
}

/// Phase functions at several wavelengths.
struct PhaseTable {
    angles: Vec<f64>,
    /// nm, and the elements at each angle.
    lanes: Vec<(f64, Vec<Elements>)>,
}

impl Optics {
    /// Those of the layer at `place`; `humidity` (percent) is that of the air about it, `phase` how OPAC's scatter.
    pub fn new(
        place: &str,
        layer: &Layer,
        (humidity, phase): (f64, PhaseFunctions),
    ) -> Result<Self> {
        if let Some(columns) = &layer.optics {
            return Ok(Self::Own(Own::new(place, columns, layer.phase.as_ref())?));
        }
        let humidity = layer.humidity_percent.unwrap_or(humidity);
        let numbers: Vec<(String, f64)> = match (&layer.mixture, &layer.particles_per_cm3) {
            (Some(name), _) => mixture(&format!("{place}.mixture"), name)?
                .iter()
                .map(|&(name, number)| (name.to_owned(), number))
                .collect(),
            (None, numbers) => numbers
                .iter()
                .flatten()
                .map(|(k, v)| (k.clone(), *v))
                .collect(),
        };
        let place = format!("{place}.particles_per_cm3");
        let parts = numbers.into_iter().map(|(name, number)| {
            let component = Component::new(&place, &name, humidity, phase)?;
            Ok((name, number, component))
        });
        Ok(Self::Components(parts.collect::<Result<_>>()?))
    }

    /// Refuses wavelengths (nm) that a table of the recipe's own does not have.
    pub fn reaches(&self, wavelengths: &[f64]) -> Result<(), RecipeError> {
        match self {
            Self::Components(_) => Ok(()),
            Self::Own(own) => own.reaches(wavelengths),
        }
    }

    /// What scatters where the profile is 1, at wavelengths in nm.
    pub fn scatterers(&self, wavelengths: &[f64]) -> Result<Vec<Scatterer>> {
        match self {
            Self::Components(parts) => {
                let parts = parts.iter().filter(|part| part.1 > 0.0);
                let one = |(name, number, component): &(String, f64, Component)| {
                    particles(name, *number, component, wavelengths)
                };
                parts.map(one).collect()
            }
            Self::Own(own) => Ok(vec![own.scatterer(wavelengths)?]),
        }
    }
}

fn particles(
    name: &str,
    number: f64,
    component: &Component,
    wavelengths: &[f64],
) -> Result<Scatterer> {
    let each = |of: &dyn Fn(f64) -> f64| wavelengths.iter().map(|&w| of(w)).collect::<Vec<f64>>();
    let extinction = |w: f64| number * PER_CM3 * component.extinction(w);
    Ok(Scatterer {
        name: name.to_owned(),
        phase: match component.spheres() {
            Some(spheres) => spheres.phase(wavelengths)?,
            None => Phase::HenyeyGreenstein {
                g: each(&|w| component.asymmetry(w)),
            },
        },
        scattering: each(&|w| extinction(w) * component.albedo(w)),
        extinction: each(&extinction),
    })
}

impl Own {
    fn new(place: &str, columns: &Columns, phase: Option<&Columns>) -> Result<Self, RecipeError> {
        let at = format!("{place}.optics");
        let table = Functions::new(&at, columns, "wavelength_nm")?;
        let known = ["extinction", "single_scattering_albedo", "asymmetry"];
        table.only(|name| known.contains(&name))?;
        let phase = match phase {
            Some(_) if table.has("asymmetry") => {
                return Err(field(
                    at,
                    "asymmetry and a phase function exclude each other",
                ));
            }
            Some(columns) => OwnPhase::Tabulated(PhaseTable::new(place, columns)?),
            None => OwnPhase::Asymmetry(table.curve("asymmetry", -0.99, 0.99)?),
        };
        Ok(Self {
            range: table.range(),
            extinction: table.curve("extinction", 0.0, 1e6)?,
            albedo: table.curve("single_scattering_albedo", 0.0, 1.0)?,
            phase,
            place: at,
        })
    }

    fn reaches(&self, wavelengths: &[f64]) -> Result<(), RecipeError> {
        let [from, to] = self.range;
        match wavelengths.iter().find(|w| !(from..=to).contains(*w)) {
            Some(w) => {
                let what = format!("{w} nm is outside the table, {from}..{to} nm");
                Err(field(&self.place, what))
            }
            None => Ok(()),
        }
    }

    fn scatterer(&self, wavelengths: &[f64]) -> Result<Scatterer> {
        self.reaches(wavelengths)?;
        let each = |curve: &Curve| {
            wavelengths
                .iter()
                .map(|&w| curve.at(w))
                .collect::<Vec<f64>>()
        };
        let extinction: Vec<f64> = each(&self.extinction).iter().map(|e| e * PER_KM).collect();
        let albedo = each(&self.albedo);
        Ok(Scatterer {
            name: "own".into(),
            phase: match &self.phase {
                OwnPhase::Asymmetry(g) => Phase::HenyeyGreenstein { g: each(g) },
                OwnPhase::Tabulated(table) => table.phase(wavelengths)?,
            },
            scattering: extinction.iter().zip(&albedo).map(|(e, a)| e * a).collect(),
            extinction,
        })
    }
}

impl PhaseTable {
    /// Columns `p11_550`, and if they are known `r12_550` = P12/P11 and `r33_550`, for each wavelength in nm.
    fn new(place: &str, columns: &Columns) -> Result<Self, RecipeError> {
        let place = format!("{place}.phase");
        let table = Functions::new(&place, columns, "angle_deg")?;
        let Columns::Inline(all) = columns else {
            return Err(field(place, "the table has not been read"));
        };
        let wavelength = |name: &str, of: &str| name.strip_prefix(of)?.parse::<f64>().ok();
        table.only(|name| {
            ["p11_", "r12_", "r33_"]
                .iter()
                .any(|of| wavelength(name, of).is_some())
        })?;
        let mut lanes = vec![];
        for name in all.keys().filter(|name| name.starts_with("p11_")) {
            let nm = wavelength(name, "p11_").unwrap_or_default();
            lanes.push((nm, Self::lane(&table, &name["p11_".len()..])?));
        }
        lanes.sort_by(|a, b| a.0.total_cmp(&b.0));
        if lanes.is_empty() {
            return Err(field(place, "no column like p11_550"));
        }
        let angles = table.column("angle_deg")?.to_vec();
        let out = Self { angles, lanes };
        let resampled = Matrix::resample(&out.angles, &out.rows(&[550.0]));
        resampled.map_err(|e| field(place, e.to_string()))?;
        Ok(out)
    }

    fn lane(table: &Functions, nm: &str) -> Result<Vec<Elements>, RecipeError> {
        let least = f64::MIN_POSITIVE;
        let p11 = table.curve(&format!("p11_{nm}"), least, 1e12)?;
        let ratio = |of: &str| {
            let name = format!("{of}_{nm}");
            table
                .has(&name)
                .then(|| table.curve(&name, -1.0, 1.0))
                .transpose()
        };
        let (r12, r33) = (ratio("r12")?, ratio("r33")?);
        let at = |curve: &Option<Curve>, angle| curve.as_ref().map_or(0.0, |c| c.at(angle));
        let angles = p11.nodes().iter();
        Ok(angles
            .map(|&a| [p11.at(a).ln(), at(&r12, a), at(&r33, a)])
            .collect())
    }

    /// Linear in wavelength, constant beyond the ends.
    fn rows(&self, wavelengths: &[f64]) -> Vec<Vec<Elements>> {
        let between = |w: &f64| {
            let above = self.lanes.partition_point(|lane| lane.0 <= *w);
            let (lower, upper) = (above.saturating_sub(1), above.min(self.lanes.len() - 1));
            let ((from, a), (to, b)) = (&self.lanes[lower], &self.lanes[upper]);
            let t = if upper > lower {
                (w - from) / (to - from)
            } else {
                0.0
            };
            let pairs = a.iter().zip(b);
            pairs
                .map(|(a, b)| std::array::from_fn(|e| a[e] + t * (b[e] - a[e])))
                .collect()
        };
        wavelengths.iter().map(between).collect()
    }

    fn phase(&self, wavelengths: &[f64]) -> Result<Phase> {
        let matrix = Matrix::resample(&self.angles, &self.rows(wavelengths))?;
        Ok(Phase::Tabulated(Arc::new(matrix)))
    }
}

//! Global horizontal irradiance as a thermopile pyranometer sees it, 300..2500 nm.
//!
//! The direct part is own optical depths with the absorption bands; the diffuse part is the model's sky to 1100 nm and
//! beyond, where it is about 1 % of all, once scattered light.

use super::site::Sun;
use crate::atmosphere::absorption_bands::{AbsorptionBands, Term};
use crate::atmosphere::table::Table;
use crate::atmosphere::{Atmosphere, Particles, Phase, real_at};
use crate::column::{ColumnIntegrator, Columns, planet};
use anyhow::Result;
use std::f64::consts::PI;
use welkin::{Conditions, Model};

/// Width of a band, nm.
const BAND: f64 = 10.0;
const FIRST: f64 = 300.0;
const LAST: f64 = 2500.0;
/// Where the model's sky ends here, nm.
const MODEL_LAST: f64 = 1100.0;

/// W m⁻² on a horizontal plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Irradiance {
    /// Of the sun.
    pub direct: f64,
    /// Of the sky to 1100 nm.
    pub diffuse: f64,
    /// Of the sky beyond.
    pub diffuse_beyond: f64,
}

impl Irradiance {
    /// All of it.
    pub fn global(&self) -> f64 {
        self.direct + self.sky()
    }

    /// Without the sun.
    pub fn sky(&self) -> f64 {
        self.diffuse + self.diffuse_beyond
    }
}

/// The air and the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Air {
    /// m.
    pub visibility: f64,
    /// Of the ground.
    pub albedo: f64,
    /// Of the instrument, m.
    pub altitude: f64,
    /// Water vapour in the way of the sun, relative to the 1.42 cm of the US standard atmosphere.
    pub water: f64,
}

struct Cell {
    wavelength: f64,
    /// Outside the air at 1 AU, W m⁻² in the band.
    outside: f64,
    terms: Vec<Term>,
}

/// Computes irradiance.
pub struct Broadband<'a> {
    model: &'a Model,
    cells: Vec<Cell>,
}

impl<'a> Broadband<'a> {
    /// For a model.
    pub fn new(model: &'a Model) -> Result<Self> {
        let table = Table::parse(
            "solar_irradiance_1nm.csv",
            include_str!("../../data/solar_irradiance_1nm.csv"),
        )?;
        let solar = table.curve("wavelength_nm", "g173")?;
        let bands = AbsorptionBands::new()?;
        let count = ((LAST - FIRST) / BAND).round() as usize;
        let cells = (0..count).map(|i| {
            let from = FIRST + BAND * i as f64;
            let wavelength = from + 0.5 * BAND;
            let nanometres = (0..BAND as usize).map(|k| solar.at(from + 0.5 + k as f64));
            Cell {
                wavelength,
                outside: nanometres.sum(),
                terms: bands.terms(wavelength),
            }
        });
        Ok(Self {
            model,
            cells: cells.collect(),
        })
    }

    /// Under a sun above the horizon.
    pub fn irradiance(&self, sun: &Sun, air: &Air) -> Result<Irradiance> {
        let (direct, beyond) = self.through(sun, air)?;
        let level = sun.intensity * sun.elevation.sin();
        Ok(Irradiance {
            direct: level * direct,
            diffuse: sun.intensity * self.diffuse(sun, air)?,
            diffuse_beyond: level * beyond,
        })
    }

    /// On a plane towards the sun at 1 AU: direct, and once scattered beyond the model's wavelengths.
    fn through(&self, sun: &Sun, air: &Air) -> Result<(f64, f64)> {
        let lights: Vec<_> = self
            .cells
            .iter()
            .flat_map(|cell| cell.terms.iter().map(|term| term.light))
            .collect();
        let all = real_at(air.visibility, &lights, Particles::HenyeyGreenstein)?;
        let mu = sun.elevation.sin();
        let length = planet(&all).ray(air.altitude, sun.elevation).length;
        let columns = ColumnIntegrator::new(&all).along(air.altitude, mu, length);
        let (mut direct, mut beyond) = (0.0, 0.0);
        let mut w = 0;
        for cell in &self.cells {
            for term in &cell.terms {
                let light = cell.outside * term.weight;
                let depths = Depths::of(&all, &columns, w, air.water);
                direct += light * depths.through();
                if cell.wavelength > MODEL_LAST {
                    beyond += light * depths.scattered_on();
                }
                w += 1;
            }
        }
        Ok((direct, beyond))
    }

    /// The model's sky over a horizontal plane at 1 AU, to 1100 nm.
    fn diffuse(&self, sun: &Sun, air: &Air) -> Result<f64> {
        let conditions = Conditions {
            solar_elevation: sun.elevation,
            solar_azimuth: 0.0,
            visibility: air.visibility,
            albedo: air.albedo,
            altitude: air.altitude,
        };
        let sky = self.model.sky(&conditions)?;
        let spectrum = self.model.spectral_interpolation()?;
        let mut sums = vec![0.0; self.cells.len()];
        let mut nodes = vec![0.0; self.model.wavelengths().len()];
        for (direction, weight) in around(conditions.sun_direction()) {
            sky.relative_radiance(direction, &mut nodes)?;
            for (sum, cell) in sums.iter_mut().zip(&self.cells) {
                if cell.wavelength < MODEL_LAST {
                    *sum += weight * f64::from(spectrum.between(&nodes, cell.wavelength)?);
                }
            }
        }
        let light = sums.iter().zip(&self.cells);
        Ok(light.map(|(sum, cell)| sum * cell.outside).sum())
    }
}

/// Optical depths on the way to the sun at one light.
struct Depths {
    all: f64,
    /// Depth of scattering, and the share of it that goes on forwards.
    scattering: Vec<[f64; 2]>,
}

impl Depths {
    fn of(air: &Atmosphere, columns: &Columns, w: usize, water: f64) -> Self {
        let mut depths = Self {
            all: 0.0,
            scattering: vec![],
        };
        for (constituent, column) in air.constituents.iter().zip(columns) {
            let amount = match constituent.name.as_str() {
                "water vapour" => water * column,
                _ => *column,
            };
            depths.all += amount * constituent.extinction[w];
            for scatterer in &constituent.scatterers {
                let forwards = match &scatterer.phase {
                    Phase::HenyeyGreenstein { g } => forward_share(g[w]),
                    _ => 0.5,
                };
                depths
                    .scattering
                    .push([amount * scatterer.scattering[w], forwards]);
            }
        }
        depths
    }

    fn through(&self) -> f64 {
        (-self.all).exp()
    }

    /// What scatters once and goes on, where little does.
    fn scattered_on(&self) -> f64 {
        let scattering: f64 = self.scattering.iter().map(|s| s[0]).sum();
        let on: f64 = self.scattering.iter().map(|s| s[0] * s[1]).sum();
        match scattering > 0.0 {
            true => self.through() * scattering.exp_m1() * on / scattering,
            false => 0.0,
        }
    }
}

/// Share of light that a Henyey-Greenstein phase function scatters by less than 90°.
fn forward_share(g: f64) -> f64 {
    match g.abs() < 1e-6 {
        true => 0.5,
        false => (1.0 - g * g) / (2.0 * g) * (1.0 / (1.0 - g) - 1.0 / (1.0 + g * g).sqrt()),
    }
}

/// Directions of the sky, densest around the sun, with solid angle times cosine from the zenith.
fn around(sun: [f64; 3]) -> Vec<([f32; 3], f64)> {
    const RINGS: usize = 32;
    const SPOKES: usize = 24;
    // The sun has no azimuth.
    let across = [sun[2], 0.0, -sun[0]];
    let mut out = vec![];
    for ring in 0..RINGS {
        let edge = |i: usize| PI * (i as f64 / RINGS as f64).powi(2);
        let (inner, outer) = (edge(ring), edge(ring + 1));
        let solid = (inner.cos() - outer.cos()) * 2.0 * PI / SPOKES as f64;
        let (s, c) = (0.5 * (inner + outer)).sin_cos();
        for spoke in 0..SPOKES {
            let (y, x) = ((spoke as f64 + 0.5) * 2.0 * PI / SPOKES as f64).sin_cos();
            let v: [f64; 3] = std::array::from_fn(|j| {
                c * sun[j] + s * (x * across[j] + y * f64::from(u8::from(j == 1)))
            });
            if v[2] > 0.0 {
                out.push((v.map(|v| v as f32), solid * v[2]));
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forward_shares_are_integrals() {
        for g in [1e-9, 0.3, 0.7, -0.4] {
            let n = 20_000;
            let sum: f64 = (0..n)
                .map(|i| (f64::from(i) + 0.5) / f64::from(n))
                .map(|mu| 0.5 * (1.0 - g * g) / (1.0 + g * g - 2.0 * g * mu).powf(1.5))
                .sum();
            assert!((sum / f64::from(n) - forward_share(g)).abs() < 1e-4, "{g}");
        }
    }

    #[test]
    fn directions_make_a_hemisphere() {
        for elevation in [0.2, 0.8, 1.5f64] {
            let sun = [elevation.cos(), 0.0, elevation.sin()];
            let sum: f64 = around(sun).iter().map(|d| d.1).sum();
            assert!((sum / PI - 1.0).abs() < 0.01, "{elevation}: {sum}");
        }
    }
}

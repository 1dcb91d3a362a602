//! What makes a measured sky differ from that of grey ground and given air around 750 nm: the red edge of vegetation,
//! absorption bands, and more, less or no particles. Solved without noise over the directions of a scan.

use super::model_sky::{between, direction};
use super::pattern;
use crate::atmosphere::absorption_bands::{AbsorptionBands, Term};
use crate::atmosphere::{Atmosphere, Monochromatic, Particles, VISIBILITIES, real_at};
use crate::dataset::Store;
use crate::successive_orders::scattered_source::Sun;
use crate::successive_orders::{Gatherer, Medium, NW, SOLAR_ANGULAR_RADIUS, Settings, solve};
use anyhow::{Context, Result, ensure};
use rayon::prelude::*;
use welkin::geometry::Side;

/// nm.
const WAVELENGTHS: [f64; 14] = [
    400.0, 450.0, 500.0, 550.0, 600.0, 650.0, 680.0, 700.0, 720.0, 735.0, 750.0, 765.0, 780.0,
    800.0,
];
/// From here on with absorption bands in a column of their own, nm.
const BANDS_FROM: f64 = 690.0;
/// Albedos that are solved for: dark vegetation and its ground, of the model's default, bright vegetation.
const ALBEDOS: [f32; 3] = [0.05, 0.2, 0.5];
/// Between which vegetation turns bright, nm.
const RED_EDGE: [f64; 2] = [690.0, 740.0];
/// Directions nearer to the sun are left out, rad.
const AROUND_SUN: f64 = 0.17;

/// Mean of the logarithm of radiance over the directions, relative to the same air over a ground of albedo 0.05.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// nm.
    pub wavelength: f64,
    /// Over vegetation.
    pub vegetation: f64,
    /// Over a ground of 0.2.
    pub grey: f64,
    /// In the haziest air of the model.
    pub hazy: f64,
    /// In its clearest.
    pub clear: f64,
    /// In air without particles: no clear sky is darker by day away from the sun.
    pub molecules: f64,
    /// With the absorption bands of water vapour and oxygen, 10 nm wide; 1 where they were not looked at.
    pub bands: f64,
}

/// Albedo of vegetation: 0.05 up to 690 nm, 0.5 from 740 nm, linear between.
pub fn vegetation(wavelength: f64) -> f64 {
    let [from, to] = RED_EDGE;
    let share = ((wavelength - from) / (to - from)).clamp(0.0, 1.0);
    let [dark, _, bright] = ALBEDOS.map(f64::from);
    dark + share * (bright - dark)
}

/// Solves, or takes from `store` what was solved before.
pub fn rows(store: &Store, solar_elevation: f64, visibility: f64) -> Result<Vec<Row>> {
    ensure!(
        (0.05..1.5).contains(&solar_elevation),
        "the sun must stand 3° to 86° high"
    );
    let beside: Vec<_> = WAVELENGTHS.map(Monochromatic::beside_lines).into();
    let solved = |name: &str, visibility: f64, particles: bool, lights: &[Monochromatic]| {
        let key = format!("near-infrared-{name}");
        let values = store.unit(&key, || sky(visibility, particles, lights, solar_elevation))?;
        ensure!(!values.is_empty(), "no light in {name}");
        Ok(Solved { values })
    };
    let reference = solved("reference", visibility, true, &beside)?;
    let hazy = solved("hazy", VISIBILITIES[0], true, &beside)?;
    let clear = solved("clear", VISIBILITIES[5], true, &beside)?;
    let molecules = solved("molecules", visibility, false, &beside)?;
    let bands = bands(&|name, lights| solved(name, visibility, true, lights))?;
    let row = |w: usize, wavelength: f64| {
        let over = |other: &Solved| other.mean(w, 0) - reference.mean(w, 0);
        Row {
            wavelength,
            vegetation: (reference.over(w, vegetation(wavelength)) - reference.mean(w, 0)).exp(),
            grey: (reference.mean(w, 1) - reference.mean(w, 0)).exp(),
            hazy: over(&hazy).exp(),
            clear: over(&clear).exp(),
            molecules: over(&molecules).exp(),
            bands: bands[w].map_or(1.0, |mean| (mean - reference.mean(w, 0)).exp()),
        }
    };
    Ok(WAVELENGTHS
        .into_iter()
        .enumerate()
        .map(|(w, nm)| row(w, nm))
        .collect())
}

/// Radiance by direction, albedo and light.
struct Solved {
    values: Vec<f32>,
}

impl Solved {
    fn directions(&self) -> usize {
        self.values.len() / (ALBEDOS.len() * NW)
    }

    fn at(&self, direction: usize, albedo: usize, w: usize) -> f64 {
        f64::from(self.values[(direction * ALBEDOS.len() + albedo) * NW + w])
    }

    /// Mean logarithm over the directions.
    fn mean(&self, w: usize, albedo: usize) -> f64 {
        let all = (0..self.directions()).map(|d| self.at(d, albedo, w).ln());
        all.sum::<f64>() / self.directions() as f64
    }

    /// The same over another ground: what a ground adds is A x / (1 − A s), and two albedos tell x and s.
    fn over(&self, w: usize, albedo: f64) -> f64 {
        let [a, b, c] = ALBEDOS.map(f64::from);
        let mut sum = 0.0;
        for d in 0..self.directions() {
            let [la, lb, lc] = [0, 1, 2].map(|k| self.at(d, k, w));
            // Through three points: (p + q A) / (1 − s A).
            let s = ((lb - la) / (b - a) - (lc - lb) / (c - b))
                / ((b * lb - a * la) / (b - a) - (c * lc - b * lb) / (c - b));
            let q = ((lb - la) - s * (b * lb - a * la)) / (b - a);
            let p = la * (1.0 - s * a) - q * a;
            sum += ((p + q * albedo) / (1.0 - s * albedo)).ln();
        }
        sum / self.directions() as f64
    }
}

/// The mean logarithm with absorption bands at every wavelength that has any.
fn bands(
    solved: &impl Fn(&str, &[Monochromatic]) -> Result<Solved>,
) -> Result<[Option<f64>; WAVELENGTHS.len()]> {
    let absorption = AbsorptionBands::new()?;
    let mut terms: Vec<(usize, Term)> = vec![];
    for (w, &nm) in WAVELENGTHS.iter().enumerate() {
        if nm >= BANDS_FROM {
            terms.extend(absorption.terms(nm).into_iter().map(|term| (w, term)));
        }
    }
    let mut sums: [Vec<f64>; WAVELENGTHS.len()] = Default::default();
    for (set, part) in terms.chunks(NW).enumerate() {
        let lights: Vec<_> = part.iter().map(|(_, term)| term.light).collect();
        let solved = solved(&format!("bands-{set}"), &lights)?;
        for (i, (w, term)) in part.iter().enumerate() {
            sums[*w].resize(solved.directions(), 0.0);
            for (d, sum) in sums[*w].iter_mut().enumerate() {
                *sum += term.weight * solved.at(d, 0, i);
            }
        }
    }
    Ok(sums.map(|sums| {
        let mean = sums.iter().map(|v| v.ln()).sum::<f64>() / sums.len() as f64;
        (!sums.is_empty()).then_some(mean)
    }))
}

/// Radiance in the directions of a scan that are not too near to the sun, which is in the azimuth 0.
fn sky(
    visibility: f64,
    particles: bool,
    lights: &[Monochromatic],
    solar_elevation: f64,
) -> Result<Vec<f32>> {
    let mut lights = lights.to_vec();
    lights.resize(NW, *lights.last().context("no lights")?);
    let air = air(visibility, particles, &lights)?;
    let medium = Medium::new(air, SOLAR_ANGULAR_RADIUS)?;
    let light = solve(&medium, Settings::COARSE, &|_| {});
    let gatherer = Gatherer::new(&medium, &light, 2.0);
    let places = (0..pattern::SAMPLES).filter_map(pattern::named);
    let sun = direction(solar_elevation, 0.0);
    let views: Vec<[f64; 2]> = places
        .map(|angles| angles.map(f64::to_radians))
        .filter(|&[azimuth, elevation]| between(direction(elevation, azimuth), sun) > AROUND_SUN)
        .collect();
    let rows = views.par_iter().map(|&[azimuth, elevation]| {
        let path = gatherer.path(0.0, elevation, Side::Up);
        let (height, level) = solar_elevation.sin_cos();
        let sun = Sun {
            elevation: (level, height),
            azimuth: (azimuth.cos(), azimuth.sin()),
        };
        ALBEDOS
            .iter()
            .flat_map(|&albedo| {
                let stokes = gatherer.stokes(&path, elevation.sin(), &sun, albedo);
                stokes[0].to_vec()
            })
            .collect::<Vec<f32>>()
    });
    Ok(rows.collect::<Vec<_>>().concat())
}

fn air(visibility: f64, particles: bool, lights: &[Monochromatic]) -> Result<Atmosphere> {
    let mut air = real_at(visibility, lights, Particles::HenyeyGreenstein)?;
    if !particles {
        // Gases scatter in one way at most.
        air.constituents.retain(|c| c.scatterers.len() <= 1);
    }
    Ok(air)
}

/// One line per wavelength.
pub fn csv(rows: &[Row]) -> String {
    let mut out = String::from(
        "wavelength_nm,vegetation,albedo_0.2,visibility_20_km,visibility_131.8_km,molecules_only,absorption_bands\n",
    );
    for row in rows {
        out += &format!(
            "{},{:.3},{:.3},{:.3},{:.3},{:.3},{:.3}\n",
            row.wavelength, row.vegetation, row.grey, row.hazy, row.clear, row.molecules, row.bands
        );
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vegetation_has_an_edge() {
        let near = |nm, albedo: f64| (vegetation(nm) - albedo).abs() < 1e-7;
        assert!(near(400.0, 0.05) && near(690.0, 0.05) && near(740.0, 0.5) && near(900.0, 0.5));
        assert!(near(715.0, 0.275));
    }

    #[test]
    fn a_ground_between_is_exact() {
        let light = |a: f64| (2.0 + 0.7 * a / (1.0 - 0.1 * a)) as f32;
        let mut values = vec![0.0; ALBEDOS.len() * NW];
        for (k, &albedo) in ALBEDOS.iter().enumerate() {
            values[k * NW + 3] = light(f64::from(albedo));
        }
        let solved = Solved { values };
        for albedo in [0.05, 0.1, 0.35, 0.5] {
            let truth = f64::from(light(albedo)).ln();
            assert!((solved.over(3, albedo) - truth).abs() < 1e-6, "{albedo}");
        }
    }
}

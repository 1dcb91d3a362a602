//! The air before the reference spectra of ASTM G173: direct and global irradiance under their conditions.

use super::cells::Cell;
use super::training::lights;
use crate::atmosphere::absorption_bands::AbsorptionBands;
use crate::atmosphere::table::{Curve, Table};
use crate::atmosphere::{Monochromatic, Particles, VISIBILITIES, real, real_at};
use crate::column::ColumnIntegrator;
use crate::dataset::Store;
use crate::progress::bar;
use crate::successive_orders::scattered_source::Sun;
use crate::successive_orders::{Gatherer, Medium, NW, SOLAR_ANGULAR_RADIUS, Settings, solve};
use anyhow::{Context, Result};
use rayon::prelude::*;
use std::f64::consts::PI;
use welkin::geometry::Side;

/// Zenith angle of the sun: air mass 1.5.
const ZENITH: f64 = 48.19;
/// Aerosol optical depth at 500 nm.
const DEPTH: f64 = 0.084;
/// Tilt of the plane towards the sun, degrees.
const TILT: f64 = 37.0;
/// Albedo of light soil, roughly: at 300 nm and shorter, at 1000 nm and longer, linear between.
const ALBEDO: [f32; 2] = [0.1, 0.4];
/// Half the field of view of what counts as direct, degrees.
const CIRCUMSOLAR: f64 = 2.9;
/// Width of the bands that are compared, nm.
const BAND: f64 = 40.0;
/// Distance of the wavelengths in a band, nm.
const STEP: f64 = 10.0;
/// Longest wavelength, nm.
const LONGEST: f64 = 2500.0;
/// Bands with less light than this share of that outside the air are too dark to compare.
pub const DARK: f64 = 0.02;

/// Irradiance in a band, W m⁻² nm⁻¹.
#[derive(Clone, Copy, Debug)]
pub struct Band {
    /// nm.
    pub from: f64,
    /// Outside the air.
    pub outside: f64,
    /// Reference and own: direct normal with the light within 2.9° of the sun.
    pub direct: [f64; 2],
    /// Reference and own: on the tilted plane.
    pub global: [f64; 2],
}

/// Own direct and global irradiance, relative to that outside the air.
#[derive(Clone, Copy, Debug, Default)]
struct Light {
    direct: f64,
    global: f64,
}

/// Compares in bands of 40 nm from 300 nm to `longest` (nm, at most 2500); solved lights are kept in `store`.
pub fn compare(store: &Store, longest: f64) -> Result<Vec<Band>> {
    let table = Table::parse("astm_g173.csv", include_str!("../../data/astm_g173.csv"))?;
    let column = |name: &str| table.curve("wavelength_nm", name);
    let reference = [
        column("extraterrestrial")?,
        column("direct")?,
        column("global_tilted")?,
    ];
    let bands = AbsorptionBands::new()?;
    let count = ((longest.clamp(300.0 + BAND, LONGEST) - 300.0) / STEP) as usize;
    let cells: Vec<Cell> = (0..count)
        .map(|i| 300.0 + STEP * (i as f64 + 0.5))
        .map(|wavelength| Cell {
            wavelength,
            terms: bands.terms(wavelength),
        })
        .collect();
    let own = solved(store, &cells)?;
    let per_band = (BAND / STEP) as usize;
    let rows = cells.chunks(per_band).zip(own.chunks(per_band));
    Ok(rows
        .map(|(cells, own)| band(&reference, cells, own))
        .collect())
}

fn band([outside, direct, global]: &[Curve; 3], cells: &[Cell], own: &[Light]) -> Band {
    let from = cells[0].wavelength - 0.5 * STEP;
    let n = (STEP * cells.len() as f64) as usize;
    let nanometres = || (0..n).map(|i| from + 0.5 + i as f64);
    let mean = |curve: &Curve| nanometres().map(|nm| curve.at(nm)).sum::<f64>() / n as f64;
    // The sun has lines; the air has none within a cell.
    let lit = |share: fn(&Light) -> f64| {
        let cell = |nm: f64| ((nm - from) / STEP) as usize;
        let light =
            nanometres().map(|nm| outside.at(nm) * share(&own[cell(nm).min(own.len() - 1)]));
        light.sum::<f64>() / n as f64
    };
    Band {
        from,
        outside: mean(outside),
        direct: [mean(direct), lit(|l| l.direct)],
        global: [mean(global), lit(|l| l.global)],
    }
}

/// The visibility whose aerosol has the optical depth.
fn visibility() -> Result<f64> {
    let depth = |v: f64| -> Result<f64> {
        let air = real(v, &[500.0])?;
        let aerosol = air
            .constituents
            .iter()
            .enumerate()
            .filter(|(_, c)| c.scatterers.len() > 1);
        Ok(aerosol.map(|(k, _)| air.vertical_optical_depth(k, 0)).sum())
    };
    let (mut hazy, mut clear) = (VISIBILITIES[0], VISIBILITIES[5]);
    for _ in 0..40 {
        let middle = 2.0 / (1.0 / hazy + 1.0 / clear);
        *(if depth(middle)? > DEPTH {
            &mut hazy
        } else {
            &mut clear
        }) = middle;
    }
    Ok(clear)
}

/// A set that is not full, as the last one is, is another one than the full one.
fn unit_name(set: usize, lights: usize) -> String {
    match lights {
        NW => format!("g173-{set}"),
        _ => format!("g173-{set}-{lights}"),
    }
}

fn solved(store: &Store, cells: &[Cell]) -> Result<Vec<Light>> {
    let (visibility, lights) = (visibility()?, lights(cells));
    let sets = lights.chunks(NW);
    let progress = bar(sets.len(), "solving");
    let mut terms = vec![];
    for (set, part) in sets.enumerate() {
        let values = store.unit(&unit_name(set, part.len()), || {
            irradiances(visibility, part)
        })?;
        terms.extend(values.chunks_exact(2).take(part.len()).map(|v| Light {
            direct: f64::from(v[0]),
            global: f64::from(v[1]),
        }));
        progress.inc(1);
    }
    progress.finish();
    let mut terms = terms.into_iter();
    let mut mean = |cell: &Cell| {
        let parts = cell.terms.iter().zip(terms.by_ref());
        parts.fold(Light::default(), |sum, (term, light)| Light {
            direct: sum.direct + term.weight * light.direct,
            global: sum.global + term.weight * light.global,
        })
    };
    Ok(cells.iter().map(&mut mean).collect())
}

/// Direct and global irradiance of at most [`NW`] lights, one after another.
fn irradiances(visibility: f64, part: &[Monochromatic]) -> Result<Vec<f32>> {
    let mut lights = part.to_vec();
    lights.resize(NW, *part.last().context("no lights")?);
    let air = real_at(visibility, &lights, Particles::HenyeyGreenstein)?;
    let medium = Medium::new(air, SOLAR_ANGULAR_RADIUS)?;
    let settings = Settings::COARSE;
    let light = solve(&medium, settings, &|_| {});
    let gatherer = Gatherer::new(&medium, &light, 2.0);
    let mu = ZENITH.to_radians().cos();
    let top = medium.atmosphere.top();
    let length = crate::column::planet(&medium.atmosphere)
        .ray(0.0, mu.asin())
        .length;
    let columns = ColumnIntegrator::new(&medium.atmosphere).along(0.0, mu, length.min(10.0 * top));
    let direct = medium.transmittance(&columns);
    let reddish = std::array::from_fn(|w| ((lights[w].wavelength - 300.0) / 700.0).clamp(0.0, 1.0));
    let (sky, aureole, level) = diffuse(&gatherer, &reddish);
    let incidence = (ZENITH - TILT).to_radians().cos();
    let below = 0.5 * (1.0 - TILT.to_radians().cos());
    let mut out = vec![];
    for w in 0..NW {
        let horizontal = f64::from(direct[w]) * mu + level[w];
        let [blue, red] = ALBEDO.map(f64::from);
        let ground = (blue + reddish[w] * (red - blue)) * horizontal * below;
        out.push(direct[w] + aureole[w] as f32);
        out.push((f64::from(direct[w]) * incidence + sky[w] + ground) as f32);
    }
    Ok(out)
}

type Sum = [f64; NW];

/// Irradiance by the sky, where light of the ground counts between its two albedos: on the tilted plane, of what is within 2.9° of the sun on a plane across it, and on the
/// ground.
fn diffuse(gatherer: &Gatherer, reddish: &Sum) -> (Sum, Sum, Sum) {
    let sun = [ZENITH.to_radians().sin(), 0.0, ZENITH.to_radians().cos()];
    let tilt = [TILT.to_radians().sin(), 0.0, TILT.to_radians().cos()];
    let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let radiance = |v: [f64; 3]| -> Sum {
        let elevation = v[2].asin();
        let path = gatherer.path(0.0, elevation, Side::Up);
        let azimuth = v[1].atan2(v[0]);
        let sun = Sun {
            elevation: (sun[0], sun[2]),
            azimuth: (azimuth.cos(), azimuth.sin()),
        };
        let [dark, bright] = ALBEDO.map(|albedo| gatherer.stokes(&path, v[2], &sun, albedo)[0]);
        std::array::from_fn(|w| {
            let [dark, bright] = [dark[w], bright[w]].map(f64::from);
            dark + reddish[w] * (bright - dark)
        })
    };
    // Around the sun, densest there: t³ of the angle.
    const RINGS: usize = 40;
    const SPOKES: usize = 24;
    let across = [sun[2], 0.0, -sun[0]];
    let rings: Vec<(Sum, Sum, Sum)> = (0..RINGS)
        .into_par_iter()
        .map(|i| {
            let (a, b) = (i as f64 / RINGS as f64, (i + 1) as f64 / RINGS as f64);
            let (inner, outer) = (PI * a.powi(3), PI * b.powi(3));
            let solid = (inner.cos() - outer.cos()) * 2.0 * PI / SPOKES as f64;
            let angle = 0.5 * (inner + outer);
            let mut out = ([0.0; NW], [0.0; NW], [0.0; NW]);
            for k in 0..SPOKES {
                let (s, c) = ((k as f64 + 0.5) / SPOKES as f64 * 2.0 * PI).sin_cos();
                let side = |j: usize| c * across[j] + s * [0.0, 1.0, 0.0][j];
                let v: [f64; 3] =
                    std::array::from_fn(|j| angle.cos() * sun[j] + angle.sin() * side(j));
                if v[2] <= 0.0 {
                    continue;
                }
                let light = radiance(v);
                let near = angle < CIRCUMSOLAR.to_radians();
                for (w, l) in light.into_iter().enumerate() {
                    let l = l * solid;
                    out.0[w] += l * dot(v, tilt).max(0.0);
                    out.1[w] += if near { l * angle.cos() } else { 0.0 };
                    out.2[w] += l * v[2];
                }
            }
            out
        })
        .collect();
    let zero = ([0.0; NW], [0.0; NW], [0.0; NW]);
    rings.into_iter().fold(zero, |mut sum, part| {
        for w in 0..NW {
            sum.0[w] += part.0[w];
            sum.1[w] += part.1[w];
            sum.2[w] += part.2[w];
        }
        sum
    })
}

/// One line per band.
pub fn csv(bands: &[Band]) -> String {
    let mut out = String::from(
        "from_nm,to_nm,outside,direct_reference,direct,direct_ratio,global_reference,global,global_ratio\n",
    );
    for b in bands {
        let ratio = |[reference, own]: [f64; 2]| own / reference;
        out += &format!(
            "{},{},{:.5},{:.5},{:.5},{:.4},{:.5},{:.5},{:.4}\n",
            b.from,
            b.from + BAND,
            b.outside,
            b.direct[0],
            b.direct[1],
            ratio(b.direct),
            b.global[0],
            b.global[1],
            ratio(b.global)
        );
    }
    out
}

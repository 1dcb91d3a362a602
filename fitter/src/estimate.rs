//! The tables of the estimates that fields are relative to. Format specification, section 6.10.

use crate::column::{ColumnIntegrator, planet};
use crate::successive_orders::grid::{SOLAR_UNITS, TENSOR, sun_taps};
use crate::successive_orders::parts::Part;
use crate::successive_orders::{LightField, Medium, NW, PER_SPHERE, Spectrum};
use crate::units::Solved;
use std::f64::consts::FRAC_PI_2;
use welkin::estimate::Estimates;
use welkin::format::{Estimate, EstimateView, MAX_ESTIMATE_CONSTITUENTS};

/// Estimates: one per kind of single scattering, the last of diffuse light.
pub const ESTIMATES: usize = 4;
/// The estimate that each field of a tensor is relative to.
pub const OF_FIELD: [usize; crate::successive_orders::FIELDS] = [0, 1, 2, 3, 3];

/// Altitudes at which rays have stops, m: about the inversion, the end of the aerosol, the ozone layer.
const LEVELS: [f64; 15] = [
    0.0, 1e3, 2e3, 3e3, 5e3, 8e3, 12e3, 17e3, 24e3, 30e3, 36e3, 43e3, 51e3, 60e3, 75e3,
];
/// Altitudes of sun rays that graze the Earth, m: from the edge of the shadow to where they are hardly dimmed.
const RINGS: [f32; 4] = [0.0, 3e3, 8e3, 16e3];
const ANGLES: usize = 32;
/// Angles from the horizon are dense below this, rad.
const BEND: f64 = 0.1;
const SUNS: usize = 36;
const SUN_LOWEST: f64 = -0.31;
const SUN_WIDTH: f64 = 0.08;
const DENSITIES: usize = 321;
/// Columns of less air are none, m.
const THIN: f64 = 1e-3;
/// Light counts as at least this share of that under the best sun at the same level: what the solver has put out would
/// make steps.
const FAINTEST: f32 = 1e-10;

/// The tables, from the air and light of a visibility in the middle: what differs at others is left to the fields.
pub fn tables(solved: &[Solved]) -> Estimate {
    let Solved { medium, light, .. } = &solved[solved.len() / 2];
    let top = medium.atmosphere.top();
    let inner = LEVELS.into_iter().filter(|&z| z < top);
    let levels: Vec<f64> = inner.chain([top]).collect();
    Estimate {
        angles: ANGLES,
        suns: SUNS,
        sun_lowest: SUN_LOWEST as f32,
        sun_width: SUN_WIDTH as f32,
        ring: RINGS.to_vec(),
        scatters: (0..ESTIMATES).map(|q| scatterers(medium, q)).collect(),
        albedo: (0..ESTIMATES).flat_map(|q| albedos(medium, q)).collect(),
        density: densities(medium, top),
        column: levels.iter().flat_map(|&z| columns(medium, z)).collect(),
        light: levels.iter().flat_map(|&z| mean_light(light, z)).collect(),
        level: levels.into_iter().map(|z| z as f32).collect(),
    }
}

/// The estimates at the visibility of `medium`.
pub fn prepare(tables: &Estimate, medium: &Medium) -> Estimates {
    let wide = |part: &Part| part.extinction.map(f64::from);
    let extinction: Vec<f64> = medium.parts.iter().flat_map(wide).collect();
    let planet = planet(&medium.atmosphere);
    let bytes = tables.encode(medium.parts.len(), NW, planet.top);
    let bytes = bytes.expect("tables that the format takes");
    let view = EstimateView::new(&bytes, medium.parts.len(), NW, planet.top);
    Estimates::new(planet, &view.expect("what was written"), &extinction)
}

/// What a part scatters in an estimate.
fn scattering(part: &Part, q: usize) -> Spectrum {
    let particles = |belongs: &dyn Fn(usize) -> bool, first: Spectrum| -> Spectrum {
        let all = part.aerosols.iter().filter(|a| belongs(a.kind));
        all.fold(first, |sum, a| {
            std::array::from_fn(|w| sum[w] + a.scattering[w])
        })
    };
    match q {
        0 => part.rayleigh,
        1 => particles(&|kind| kind == 0, [0.0; NW]),
        2 => particles(&|kind| kind == 1, [0.0; NW]),
        _ => particles(&|_| true, part.rayleigh),
    }
}

fn scatterers(medium: &Medium, q: usize) -> u32 {
    let bit = |(k, part): (usize, &Part)| {
        let any = scattering(part, q).iter().any(|&s| s > 0.0);
        u32::from(any) << k
    };
    medium.parts.iter().enumerate().map(bit).sum()
}

fn albedos(medium: &Medium, q: usize) -> Vec<f32> {
    let share = |part: &Part| {
        let scattering = scattering(part, q);
        std::array::from_fn::<f32, NW, _>(|w| match part.extinction[w] > 0.0 {
            true => (scattering[w] / part.extinction[w]).min(1.0),
            false => 0.0,
        })
    };
    medium.parts.iter().flat_map(share).collect()
}

fn row(value: impl Fn(usize) -> f32, parts: usize) -> [f32; MAX_ESTIMATE_CONSTITUENTS] {
    std::array::from_fn(|k| if k < parts { value(k) } else { 0.0 })
}

fn densities(medium: &Medium, top: f64) -> Vec<f32> {
    let altitude = |i: usize| top * (i as f64 / (DENSITIES - 1) as f64).powi(2);
    let at = |i: usize| {
        let profiles = medium.profiles(altitude(i));
        row(|k| profiles[k], medium.parts.len())
    };
    (0..DENSITIES).flat_map(at).collect()
}

fn columns(medium: &Medium, altitude: f64) -> Vec<f32> {
    let planet = planet(&medium.atmosphere);
    let integrator = ColumnIntegrator::new(&medium.atmosphere);
    let dip = planet.dip(altitude);
    let at = |i: usize| {
        let (x, range) = (i as f64 / (ANGLES - 1) as f64, FRAC_PI_2 + dip);
        let elevation = x * BEND * range / (range + BEND - x * range) - dip;
        let length = planet.ray(altitude, elevation.max(-dip + 1e-12)).length;
        let columns = integrator.along(altitude, elevation.sin(), length);
        row(|k| columns[k].max(THIN).ln() as f32, medium.parts.len())
    };
    (0..ANGLES).flat_map(at).collect()
}

/// ln of the mean radiance of scattered light.
fn mean_light(light: &LightField, altitude: f64) -> Vec<f32> {
    let moments = &light.sky;
    let (low, high) = ((SUN_LOWEST / SUN_WIDTH).asinh(), (1.0 / SUN_WIDTH).asinh());
    let at = |i: usize| {
        let x = low + (high - low) * i as f64 / (SUNS - 1) as f64;
        let (suns, weights) = sun_taps((SUN_WIDTH * x.sinh()).min(1.0));
        let mut sum = [0.0; NW];
        for (a, share) in moments.altitude_stencil(altitude).taps() {
            for (&s, weight) in suns.iter().zip(weights) {
                let node = moments.node(a, s);
                for w in 0..NW {
                    let trace: f32 = node[..TENSOR - 1].iter().map(|row| row[w]).sum();
                    sum[w] += share as f32 * weight * trace;
                }
            }
        }
        sum.map(|trace| trace * PER_SPHERE / SOLAR_UNITS)
    };
    let rows: Vec<Spectrum> = (0..SUNS).map(at).collect();
    let least: Spectrum = std::array::from_fn(|w| {
        let brightest = rows
            .iter()
            .map(|row| row[w])
            .fold(f32::MIN_POSITIVE, f32::max);
        FAINTEST * brightest
    });
    let logarithm =
        |row: Spectrum| std::array::from_fn::<f32, NW, _>(|w| row[w].max(least[w]).ln());
    rows.into_iter().flat_map(logarithm).collect()
}

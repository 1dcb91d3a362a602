//! A model against the unbiased tracer where it was fitted to nothing: between its altitudes, suns and wavelengths, and
//! between the nodes of an axis of the recipe.

use super::axis::Axis;
use crate::air::Air;
use crate::assess::Quantiles;
use crate::atmosphere::Monochromatic;
use crate::atmosphere::absorption_bands::AbsorptionBands;
use crate::dataset::Grid;
use crate::progress::stage;
use crate::tracer::{Options, Query, Tracer};
use crate::units::Plan;
use anyhow::Result;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt;
use welkin::{Conditions, Model};

/// Wavelengths that are judged, nm: none is a node, and gases absorb little there.
const WAVELENGTHS: [f64; 14] = [
    315.0, 338.0, 360.0, 405.0, 450.0, 490.0, 530.0, 565.0, 592.0, 625.0, 670.0, 780.0, 860.0,
    1050.0,
];
/// Relative standard error of the tracer that is enough.
const NOISE: f64 = 0.01;
/// Values with more noise than this tell nothing.
const TOO_NOISY: f64 = 3.0 * NOISE;
/// Suns below are not judged, rad: noise takes too long.
const LOWEST_SUN: f64 = -8.0 / 180.0 * PI;
/// Radiance below (sr⁻¹) does not count.
const DARK: f64 = 1e-10;
const SEED: u64 = 22;

/// An error and where it was made.
#[derive(Clone, Copy, Debug)]
struct Error {
    /// Model over tracer − 1.
    relative: f64,
    /// Relative standard error of the tracer.
    noise: f64,
    solar_elevation: f64,
    /// Angle to the sun, rad.
    to_sun: f64,
    /// Angle from the horizon, rad.
    from_horizon: f64,
    /// Whether the air is between two nodes of an axis.
    is_between: bool,
}

/// Errors of a model.
pub struct Judgement(Vec<Error>);

/// How much is judged.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// Random lines of sight.
    pub lines: usize,
    /// Most walks of the tracer per batch of each.
    pub walks: usize,
}

/// Judges `model` by random lines of sight through the air of `plan`, and, where it has the nodes of `axis`, as many
/// between each two of them.
pub fn judge(model: &Model, plan: &Plan, axis: Option<&Axis>, extent: Extent) -> Result<Judgement> {
    let count = extent.lines;
    let wavelengths = wavelengths(model)?;
    let mut out = vec![];
    let nodes = plan.grid.visibilities.iter();
    let at_nodes = nodes.map(|&visibility| (visibility, plan.air.clone()));
    let between = axis.map_or(Ok(vec![]), Axis::between)?;
    let airs: Vec<(f64, Air)> = at_nodes.chain(between).collect();
    let progress = stage(count * airs.len(), "judging by the tracer");
    for (v, (visibility, air)) in airs.iter().enumerate() {
        let visibility = *visibility;
        let is_between = v >= plan.grid.visibilities.len();
        let beside = |&nm: &f64| Monochromatic::beside_lines(nm);
        let lights: Vec<Monochromatic> = wavelengths.iter().map(beside).collect();
        let tracer = Tracer::new(&air.at(visibility, &lights)?, Options::default())?;
        for i in 0..count {
            let seed = SEED + 1000 * v as u64 + i as u64;
            let line = Line::random(&plan.grid, model, seed);
            let query = line.query();
            let walks = tracer.samples_for(&query, NOISE, line.albedo, 2 * seed)?;
            let traced = tracer.estimate(&query, walks.min(extent.walks), 2 * seed + 1)?;
            let sky = model.sky(&line.conditions(visibility))?;
            for (w, &nm) in wavelengths.iter().enumerate() {
                let truth = traced.radiance(line.albedo, w);
                let [light, noise] = [truth.stokes[0], truth.error[0]];
                if light > DARK && noise < TOO_NOISY * light {
                    let got = f64::from(sky.relative_radiance_at(line.direction(), nm)?);
                    out.push(Error {
                        is_between,
                        ..line.error(model, got / light - 1.0, noise / light)
                    });
                }
            }
            progress.inc(1);
        }
    }
    progress.finish();
    Ok(Judgement(out))
}

/// Those of [`WAVELENGTHS`] that the model reaches and no lines are near.
fn wavelengths(model: &Model) -> Result<Vec<f64>> {
    let bands = AbsorptionBands::new()?;
    let [first, last] = model.wavelength_range()?;
    let clear = |nm: &f64| bands.terms(*nm).iter().all(|t| t.light.is_beside_lines());
    let inside = WAVELENGTHS
        .into_iter()
        .filter(|nm| (first..=last).contains(nm));
    Ok(inside.filter(clear).collect())
}

/// A line of sight.
#[derive(Clone, Copy, Debug)]
struct Line {
    altitude: f64,
    /// Elevation and azimuth from the sun, rad.
    view: [f64; 2],
    sun: f64,
    albedo: f64,
}

impl Line {
    /// A third of the directions go anywhere, a third close to the sun, a third close to the horizon; half of the suns
    /// are low.
    fn random(grid: &Grid, model: &Model, seed: u64) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let mut uniform = || (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
        let [low, high] =
            [grid.altitudes[0], grid.altitudes[grid.altitudes.len() - 1]].map(f64::cbrt);
        let altitude = (low + uniform() * (high - low)).powi(3);
        let [lowest, highest] = grid.elevation_range();
        let lowest = lowest.max(LOWEST_SUN).min(highest);
        let high = match seed % 2 {
            0 => highest,
            _ => highest.min(12f64.to_radians()).max(lowest),
        };
        let sun = lowest + uniform() * (high - lowest);
        let horizon = -model.head().planet.dip(altitude);
        let [a, b] = [uniform(), uniform()];
        let view = match seed / 2 % 3 {
            0 => [(2.0 * a - 1.0).asin(), PI * b],
            1 => near_sun(sun, 0.35 * a * a + 0.01, 2.0 * PI * b),
            _ => [horizon + 0.15 * a * a + 0.002, PI * b],
        };
        // From the ground nothing is seen below the horizon.
        let least = if altitude < 1.0 {
            horizon + 0.002
        } else {
            -FRAC_PI_2
        };
        Self {
            altitude,
            view: [view[0].max(least), view[1]],
            sun,
            albedo: uniform(),
        }
    }

    fn query(&self) -> Query {
        Query {
            altitude: self.altitude,
            view_zenith: FRAC_PI_2 - self.view[0],
            view_azimuth: self.view[1],
            sun_elevation: self.sun,
            distance: None,
        }
    }

    fn conditions(&self, visibility: f64) -> Conditions {
        Conditions {
            solar_elevation: self.sun,
            solar_azimuth: 0.0,
            visibility,
            albedo: self.albedo,
            altitude: self.altitude,
        }
    }

    fn direction(&self) -> [f32; 3] {
        unit(self.view).map(|x| x as f32)
    }

    fn error(&self, model: &Model, relative: f64, noise: f64) -> Error {
        let [view, sun] = [unit(self.view), unit([self.sun, 0.0])];
        let cosine: f64 = view.iter().zip(sun).map(|(a, b)| a * b).sum();
        Error {
            relative,
            noise,
            solar_elevation: self.sun,
            to_sun: cosine.clamp(-1.0, 1.0).acos(),
            from_horizon: (self.view[0] + model.head().planet.dip(self.altitude)).abs(),
            is_between: false,
        }
    }
}

fn unit([elevation, azimuth]: [f64; 2]) -> [f64; 3] {
    let (se, ce) = elevation.sin_cos();
    let (sa, ca) = azimuth.sin_cos();
    [ce * ca, ce * sa, se]
}

/// Elevation and azimuth of a direction `angle` from the sun, towards `position` from the vertical.
fn near_sun(sun: f64, angle: f64, position: f64) -> [f64; 2] {
    let (ss, cs) = sun.sin_cos();
    let (sa, ca) = angle.sin_cos();
    let (sp, cp) = position.sin_cos();
    let z = ca * ss + sa * cp * cs;
    let along = ca * cs - sa * cp * ss;
    [z.clamp(-1.0, 1.0).asin(), (sa * sp).atan2(along).abs()]
}

/// A name, and what belongs under it.
type Class = (&'static str, fn(&Error) -> bool);

const CLASSES: [Class; 7] = [
    ("all", |_| true),
    ("sun above 12°", |e| e.solar_elevation > 12f64.to_radians()),
    ("sun 0..12°", |e| {
        (0.0..=12f64.to_radians()).contains(&e.solar_elevation)
    }),
    ("sun below 0°", |e| e.solar_elevation < 0.0),
    ("within 10° of the sun", |e| e.to_sun < 10f64.to_radians()),
    ("within 3° of the horizon", |e| {
        e.from_horizon < 3f64.to_radians()
    }),
    ("between values of the axis", |e| e.is_between),
];

impl Judgement {
    /// Quantiles of |model/tracer − 1|.
    pub fn quantiles(&self) -> Option<Quantiles> {
        Quantiles::of(self.0.iter().map(|e| e.relative.abs()))
    }
}

impl fmt::Display for Judgement {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        writeln!(
            f,
            "the model against the unbiased tracer, between nodes (noise of the tracer included): what its errors are\n{:<26}{:>8}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}",
            "", "values", "median", "p95", "p99", "max", "mean", "noise"
        )?;
        for (name, belongs) in CLASSES {
            let class: Vec<&Error> = self.0.iter().filter(|e| belongs(e)).collect();
            let count = class.len() as f64;
            let mean = class.iter().map(|e| e.relative).sum::<f64>() / count;
            let noise = Quantiles::of(class.iter().map(|e| e.noise));
            let errors = Quantiles::of(class.iter().map(|e| e.relative.abs()));
            if let (Some(q), Some(noise)) = (errors, noise) {
                let [median, p95, p99, max, mean, noise] =
                    [q.median, q.p95, q.p99, q.max, mean, noise.median].map(|v| 100.0 * v);
                writeln!(
                    f,
                    "{name:<26}{:>8}{median:>8.2}%{p95:>8.2}%{p99:>8.2}%{max:>8.1}%{mean:>+8.2}%{noise:>8.2}%",
                    q.count
                )?;
            }
        }
        Ok(())
    }
}

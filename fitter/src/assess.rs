//! How far a model is from held-out traced radiance.

use crate::dataset::Sample;
use anyhow::Result;
use serde::Serialize;
use std::f64::consts::FRAC_PI_2;
use welkin::{Conditions, Model};

/// Median, 95th, 99th percentile and largest relative error of a class of directions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quantiles {
    /// Number of values.
    pub count: usize,
    /// Half of the errors are smaller.
    pub median: f64,
    /// 95 of 100 errors are smaller.
    pub p95: f64,
    /// 99 of 100 errors are smaller.
    pub p99: f64,
    /// The largest error.
    pub max: f64,
}

/// A relative error and where it was made.
#[derive(Clone, Copy, Debug)]
pub struct Error {
    /// |model − truth| / truth.
    pub relative: f64,
    /// The same with its sign.
    pub signed: f64,
    /// nm.
    pub wavelength: f64,
    /// Solar elevation, rad.
    pub solar_elevation: f64,
    /// Angle from the geometric horizon, rad.
    pub from_horizon: f64,
    /// Angle to the sun, rad.
    pub to_sun: f64,
}

/// A name, and what belongs under it.
pub type Class = (&'static str, fn(&Error) -> bool);

/// Directions of the sphere and suns that are reported apart.
pub const CLASSES: [Class; 13] = [
    ("all", |_| true),
    ("day (sun > 0°)", |e| e.solar_elevation > 0.0),
    ("twilight", |e| e.solar_elevation <= 0.0),
    ("day, 300..760 nm", |e| {
        e.solar_elevation > 0.0 && e.wavelength <= 760.0
    }),
    ("twilight, 300..760 nm", |e| {
        e.solar_elevation <= 0.0 && e.wavelength <= 760.0
    }),
    ("sun −12..−8°", |e| e.solar_elevation < -0.1396),
    ("sun −8..−4.2°", |e| {
        (-0.1396..-0.0733).contains(&e.solar_elevation)
    }),
    ("sun −4.2..0°", |e| {
        (-0.0733..0.0).contains(&e.solar_elevation)
    }),
    ("… away from the sun", |e| {
        (-0.0733..0.0).contains(&e.solar_elevation) && e.to_sun > FRAC_PI_2
    }),
    ("… to 760 nm", |e| {
        (-0.0733..0.0).contains(&e.solar_elevation) && e.to_sun > FRAC_PI_2 && e.wavelength <= 760.0
    }),
    ("sun 0..12°", |e| (0.0..0.21).contains(&e.solar_elevation)),
    ("within 15° of the sun", |e| e.to_sun < 0.262),
    ("within 2° of the horizon", |e| e.from_horizon < 0.0349),
];

impl Quantiles {
    /// Of `errors`; `None` if there are none.
    pub fn of(errors: impl Iterator<Item = f64>) -> Option<Self> {
        let mut sorted: Vec<f64> = errors.collect();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().checked_sub(1)?;
        let at = |q: f64| sorted[(q * last as f64).round() as usize];
        Some(Self {
            count: last + 1,
            median: at(0.5),
            p95: at(0.95),
            p99: at(0.99),
            max: at(1.0),
        })
    }
}

/// Truth below (sr⁻¹) does not count.
const DARK: f64 = 1e-12;

/// Errors of `model` at `samples` for all wavelengths. Directions in which the truth is exactly zero must be zero in
/// the model and do not count.
pub fn errors(model: &Model, visibility: f64, samples: &[Sample]) -> Result<Vec<Error>> {
    let mut out = vec![];
    let mut row = vec![];
    let mut previous: Option<(Conditions, welkin::Sky)> = None;
    for sample in samples {
        let conditions = Conditions {
            solar_elevation: sample.solar_elevation,
            solar_azimuth: 0.0,
            visibility,
            albedo: sample.albedo,
            altitude: sample.altitude,
        };
        let sky = match previous.take() {
            Some((same, sky)) if same == conditions => sky,
            _ => model.sky(&conditions)?,
        };
        row.resize(sky.wavelengths().len(), 0.0f32);
        sky.relative_radiance(sample.direction(), &mut row)?;
        let place = place(model.head().planet, &sky, sample);
        let light = row.iter().zip(sample.radiance).zip(sky.wavelengths());
        for ((got, want), &wavelength) in light {
            if want > DARK {
                out.push(Error {
                    relative: (f64::from(*got) / want - 1.0).abs(),
                    signed: f64::from(*got) / want - 1.0,
                    wavelength,
                    ..place
                });
            } else {
                anyhow::ensure!(want > 0.0 || *got == 0.0, "light where there is none");
            }
        }
        previous = Some((conditions, sky));
    }
    Ok(out)
}

fn place(planet: welkin::geometry::Planet, sky: &welkin::Sky, sample: &Sample) -> Error {
    let sun = sky.sun_direction();
    let d = sample.direction();
    let cosine: f32 = sun.iter().zip(d).map(|(a, b)| a * b).sum();
    Error {
        relative: 0.0,
        signed: 0.0,
        wavelength: 0.0,
        solar_elevation: sample.solar_elevation,
        from_horizon: planet.ray(sample.altitude, sample.view_elevation).angle,
        to_sun: f64::from(cosine.clamp(-1.0, 1.0)).acos(),
    }
}

/// One line per class with errors in percent.
pub fn table(errors: &[Error]) -> String {
    let mut out = format!(
        "{:<26}{:>9}{:>9}{:>9}{:>9}{:>10}\n",
        "", "values", "median", "p95", "p99", "max"
    );
    for (name, belongs) in CLASSES {
        let class = errors.iter().filter(|e| belongs(e)).map(|e| e.relative);
        if let Some(q) = Quantiles::of(class) {
            out += &format!(
                "{name:<26}{:>9}{:>8.3}%{:>8.3}%{:>8.3}%{:>9.3}%\n",
                q.count,
                100.0 * q.median,
                100.0 * q.p95,
                100.0 * q.p99,
                100.0 * q.max
            );
        }
    }
    out
}

/// Bands of solar elevation (degrees) that are reported apart.
const BANDS: [(f64, f64); 8] = [
    (-12.0, -8.0),
    (-8.0, -4.2),
    (-4.2, -2.0),
    (-2.0, 0.0),
    (0.0, 3.0),
    (3.0, 12.0),
    (12.0, 40.0),
    (40.0, 90.0),
];

/// Median / 99th percentile in percent by visibility (m) and altitude (m) down, band of solar elevation across.
pub fn band_table(rows: &[(f64, f64, Vec<Error>)]) -> String {
    let mut out = format!("{:>8} {:>9}", "V, km", "h, m");
    for (low, high) in BANDS {
        out += &format!("{:>15}", format!("{low}..{high}°"));
    }
    for (visibility, altitude, errors) in rows {
        out += &format!("\n{:>8.1} {altitude:>9}", visibility / 1e3);
        for (low, high) in BANDS {
            let inside = |e: &&Error| (low..high).contains(&e.solar_elevation.to_degrees());
            let band = errors.iter().filter(inside).map(|e| e.relative);
            out += &match Quantiles::of(band) {
                Some(q) => format!(
                    "{:>15}",
                    format!("{:.2} / {:.2}", 100.0 * q.median, 100.0 * q.p99)
                ),
                None => format!("{:>15}", "-"),
            };
        }
    }
    out + "\n"
}

/// Bands of solar elevation (degrees) about the edge of the Earth's shadow.
pub const EDGE_SUNS: [(f64, f64); 5] = [
    (-2.0, -0.5),
    (-4.0, -2.0),
    (-6.0, -4.0),
    (-8.0, -6.0),
    (-12.0, -8.0),
];
/// Bands of solar elevation (degrees) of all skies.
pub const SUNS: [(f64, f64); 5] = [
    (12.0, 90.0),
    (0.0, 12.0),
    (-4.2, 0.0),
    (-8.0, -4.2),
    (-12.0, -8.0),
];
/// Bands of wavelength (nm).
const WAVELENGTHS: [(f64, f64); 5] = [
    (300.0, 340.0),
    (340.0, 500.0),
    (500.0, 640.0),
    (640.0, 760.0),
    (760.0, 1101.0),
];

/// Errors by altitude (m) × solar elevation × wavelength, and of all altitudes: median, p95, p99, max and mean with its
/// sign, in percent, as CSV.
pub fn place_table(rows: &[(f64, Vec<Error>)], suns: &[(f64, f64)]) -> String {
    let mut out = String::from("altitude,sun,wavelengths,values,median,p95,p99,max,mean\n");
    let mut line = |name: String, errors: &[&Error]| {
        if let Some(q) = Quantiles::of(errors.iter().map(|e| e.relative)) {
            let mean = errors.iter().map(|e| e.signed).sum::<f64>() / errors.len() as f64;
            let [median, p95, p99, max, mean] =
                [q.median, q.p95, q.p99, q.max, mean].map(|v| 100.0 * v);
            out += &format!(
                "{name},{},{median:.2},{p95:.2},{p99:.2},{max:.1},{mean:.2}\n",
                q.count
            );
        }
    };
    let visible = |e: &&&Error| e.wavelength <= 760.0;
    for (altitude, errors) in rows {
        for &band in suns {
            let class = under(errors.iter().collect(), band);
            for (short, long) in WAVELENGTHS {
                let inside = |e: &&&Error| (short..long).contains(&e.wavelength);
                let inside: Vec<&Error> = class.iter().filter(inside).copied().collect();
                let (low, high) = band;
                line(format!("{altitude},{low}..{high},{short}..{long}"), &inside);
            }
        }
    }
    let all: Vec<&Error> = rows.iter().flat_map(|(_, errors)| errors).collect();
    let seen: Vec<&Error> = all.iter().filter(visible).copied().collect();
    for &(low, high) in suns {
        let class = under(seen.clone(), (low, high));
        line(format!("all,{low}..{high},300..760"), &class);
    }
    line("all,all,300..760".to_owned(), &seen);
    line("all,all,all".to_owned(), &all);
    out
}

/// Those under suns of a band of elevations, degrees.
fn under(mut errors: Vec<&Error>, (low, high): (f64, f64)) -> Vec<&Error> {
    errors.retain(|e| (low..high).contains(&e.solar_elevation.to_degrees()));
    errors
}

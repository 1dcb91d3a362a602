//! The visibility with which the model gives the global irradiance that a pyranometer logged.

use super::broadband::{Air, Broadband, Irradiance};
use super::capture_time::CaptureTime;
use super::error::MeasuredError;
use super::pyranometer::{Log, files};
use super::site::{Site, Sun};
use anyhow::{Result, ensure};
use std::path::Path;

/// Lowest sun that is compared, rad: below, a pyranometer's error with the angle of incidence is large.
const LOWEST: f64 = 0.17;

/// The median of a log.
#[derive(Clone, Copy, Debug)]
pub struct Reading {
    /// The middle of the log.
    pub time: CaptureTime,
    /// Then.
    pub sun: Sun,
    /// W m⁻².
    pub measured: f64,
}

/// The logs at a path under a sun that is high enough, in their order; and how many others there were.
pub fn readings(path: &Path, site: &Site) -> Result<(Vec<Reading>, usize)> {
    let mut out = vec![];
    let files = files(path)?;
    for file in &files {
        let (time, measured) = Log::read(file)?.median();
        let sun = site.sun(&time)?;
        if sun.elevation >= LOWEST && measured > 0.0 {
            out.push(Reading {
                time,
                sun,
                measured,
            });
        }
    }
    if out.is_empty() {
        let detail =
            "no log of light under a sun of 10° or more; is --utc-offset that of its clock?";
        return Err(MeasuredError::incomplete(path, detail).into());
    }
    let low = files.len() - out.len();
    Ok((out, low))
}

/// What was found.
#[derive(Clone, Debug)]
pub struct GlobalFit {
    /// m.
    pub visibility: f64,
    /// Measured over model.
    pub scale: f64,
    /// Root of the mean square of ln (measured / (scale · model)).
    pub rms: f64,
    /// Of the model, for every reading.
    pub irradiance: Vec<Irradiance>,
}

/// Fits the visibility between the ends (m) by golden section, with a factor or without.
pub fn fit(
    broadband: &Broadband,
    readings: &[Reading],
    air: &Air,
    [hazy, clear]: [f64; 2],
    free_scale: bool,
) -> Result<GlobalFit> {
    ensure!(
        !free_scale || readings.len() > 1,
        "one reading cannot tell a factor from a visibility"
    );
    let at = |x: f64| {
        let visibility = x.exp().clamp(hazy, clear);
        judge(broadband, readings, &Air { visibility, ..*air }, free_scale)
    };
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let (mut low, mut high) = (hazy.ln(), clear.ln());
    let mut inner = [high - golden * (high - low), low + golden * (high - low)];
    let mut errors = [at(inner[0])?.rms, at(inner[1])?.rms];
    while high - low > 1e-3 {
        if errors[0] < errors[1] {
            high = inner[1];
            inner = [high - golden * (high - low), inner[0]];
            errors = [at(inner[0])?.rms, errors[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + golden * (high - low)];
            errors = [errors[1], at(inner[1])?.rms];
        }
    }
    at(0.5 * (low + high))
}

/// How near a visibility is.
pub fn judge(
    broadband: &Broadband,
    readings: &[Reading],
    air: &Air,
    free_scale: bool,
) -> Result<GlobalFit> {
    let irradiance: Vec<Irradiance> = readings
        .iter()
        .map(|reading| broadband.irradiance(&reading.sun, air))
        .collect::<Result<_>>()?;
    let pairs = readings.iter().zip(&irradiance);
    let errors: Vec<f64> = pairs
        .map(|(reading, light)| (reading.measured / light.global()).ln())
        .collect();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let level = if free_scale { mean } else { 0.0 };
    let square = errors.iter().map(|e| (e - level).powi(2)).sum::<f64>();
    Ok(GlobalFit {
        visibility: air.visibility,
        scale: level.exp(),
        rms: (square / errors.len() as f64).sqrt(),
        irradiance,
    })
}

/// One line per reading: what the model says, and what was measured over it, also if its sky were so much darker.
pub fn csv(readings: &[Reading], fit: &GlobalFit, sky_factor: f64) -> String {
    let mut out = String::from(
        "time,sun_elevation_deg,measured,model,direct,diffuse_to_1100_nm,diffuse_beyond,measured_over_model,with_darker_sky\n",
    );
    for (reading, light) in readings.iter().zip(&fit.irradiance) {
        let model = fit.scale * light.global();
        let darker = fit.scale * (light.direct + sky_factor * light.sky());
        out += &format!(
            "{},{:.2},{:.1},{model:.1},{:.1},{:.1},{:.1},{:.4},{:.4}\n",
            reading.time.clock(),
            reading.sun.elevation.to_degrees(),
            reading.measured,
            light.direct,
            light.diffuse,
            light.diffuse_beyond,
            reading.measured / model,
            reading.measured / darker,
        );
    }
    out
}

/// What changes of the air and the ground do to global and diffuse irradiance, in percent, for one reading.
pub fn effects(broadband: &Broadband, sun: &Sun, air: &Air, ends: [f64; 2]) -> Result<String> {
    let reference = broadband.irradiance(sun, air)?;
    let changes = [
        (
            "visibility, lowest",
            Air {
                visibility: ends[0],
                ..*air
            },
        ),
        (
            "visibility, highest",
            Air {
                visibility: ends[1],
                ..*air
            },
        ),
        (
            "water vapour, half",
            Air {
                water: 0.5 * air.water,
                ..*air
            },
        ),
        (
            "water vapour, 1.5 times",
            Air {
                water: 1.5 * air.water,
                ..*air
            },
        ),
        (
            "albedo 0",
            Air {
                albedo: 0.0,
                ..*air
            },
        ),
        (
            "albedo 0.5",
            Air {
                albedo: 0.5,
                ..*air
            },
        ),
    ];
    let mut out = String::from("change,global_percent,diffuse_percent\n");
    for (name, changed) in changes {
        let light = broadband.irradiance(sun, &changed)?;
        let percent = |now: f64, before: f64| 100.0 * (now / before - 1.0);
        out += &format!(
            "\"{name}\",{:+.2},{:+.1}\n",
            percent(light.global(), reference.global()),
            percent(light.sky(), reference.sky()),
        );
    }
    Ok(out)
}

//! Errors of models along traced lines of sight.

use super::lines::{Line, Place};
use super::{ALBEDO, Traced};
use crate::assess::Quantiles;
use anyhow::{Context, Result, ensure};
use std::fmt::Write;
use welkin::{Conditions, Model, PolarisationFrame, Stokes};

/// An error and where it was made.
struct Error {
    line: Line,
    /// Model over tracer − 1.
    relative: f64,
    /// Model − tracer of the degree of linear polarisation.
    degree: f64,
    /// Relative standard error of the tracer.
    noise: f64,
    /// Index of the wavelength.
    lane: usize,
}

type Class = (&'static str, fn(&Line) -> bool);

const CLASSES: [Class; 7] = [
    ("0.3..0.5° from the sun", |l| near(l, 0.0, 0.6)),
    ("1..2°", |l| near(l, 0.6, 2.5)),
    ("3..5°", |l| near(l, 2.5, 6.0)),
    ("7..10°", |l| near(l, 6.0, 10.1)),
    ("sky within 60°", |l| {
        l.place == Place::Sky && l.to_sun() <= 1.05
    }),
    ("sky 60..120°", |l| {
        l.place == Place::Sky && (1.05..2.09).contains(&l.to_sun())
    }),
    ("sky beyond", |l| {
        l.place == Place::Sky && l.to_sun() >= 2.09
    }),
];

fn near(line: &Line, from: f64, to: f64) -> bool {
    line.place == Place::Aureole && (from..to).contains(&line.to_sun().to_degrees())
}

/// Refuses a model that cannot be judged at wavelengths (nm) under suns (rad), before anything is traced for it.
pub fn check(model: &Model, wavelengths: &[f64], suns: &[f64]) -> Result<()> {
    lanes(model, wavelengths)?;
    let [low, high] = model.solar_elevation_range().map(f64::to_degrees);
    for sun in suns {
        let degrees = sun.to_degrees();
        // The conversion of units rounds.
        ensure!(
            (low - 1e-9..=high + 1e-9).contains(&degrees),
            "its suns stand at {low:.1}..{high:.1} degrees, none at {degrees:.1}"
        );
        model.polarised_sky(&conditions(model, *sun))?;
    }
    Ok(())
}

/// Where the model has its nodes at wavelengths in nm.
fn lanes(model: &Model, wavelengths: &[f64]) -> Result<Vec<usize>> {
    let own = model.wavelengths();
    let index = |nm: &f64| {
        let found = own.iter().position(|node| node == nm);
        found.with_context(|| {
            let nodes: Vec<String> = own.iter().map(f64::to_string).collect();
            format!("has no node at {nm} nm, only at {}", nodes.join(", "))
        })
    };
    wavelengths.iter().map(index).collect()
}

fn conditions(model: &Model, sun: f64) -> Conditions {
    Conditions {
        solar_elevation: sun,
        solar_azimuth: 0.0,
        visibility: model.head().visibilities[0],
        albedo: ALBEDO,
        altitude: 0.0,
    }
}

/// Intensity and degree of linear polarisation of a model along a line, at its nodes of wavelengths in nm.
pub fn evaluate(model: &Model, line: &Line, wavelengths: &[f64]) -> Result<Vec<[f64; 2]>> {
    let nodes = lanes(model, wavelengths)?;
    let sky = model.polarised_sky(&conditions(model, line.sun))?;
    let mut light = vec![Stokes::default(); model.wavelengths().len()];
    sky.relative_stokes(line.direction(), PolarisationFrame::Vertical, &mut light)?;
    let of = |&w: &usize| {
        let [i, q, u] = [light[w].i, light[w].q, light[w].u].map(f64::from);
        [i, q.hypot(u) / i]
    };
    Ok(nodes.iter().map(of).collect())
}

/// Degree of linear polarisation of traced light.
pub fn degree([i, q, u]: [f64; 3]) -> f64 {
    q.hypot(u) / i
}

/// Errors of a model in a part of the sky.
pub struct Row {
    /// The model.
    pub model: String,
    /// The part of the sky, or the wavelength.
    pub part: String,
    /// Number of values.
    pub values: usize,
    /// Of |radiance over traced radiance − 1|: median, 95th percentile, largest; then its mean with sign and the noise
    /// of the tracer.
    pub radiance: [f64; 5],
    /// Of the difference of the degree of linear polarisation: median, 95th percentile.
    pub polarisation: [f64; 2],
}

/// Errors of models with names, by place and by wavelength (nm).
pub fn rows(
    models: &[(String, Model)],
    traced: &[Traced],
    wavelengths: &[f64],
) -> Result<Vec<Row>> {
    let mut out = vec![];
    for (name, model) in models {
        let errors = errors(model, traced, wavelengths)?;
        let mut add = |part: String, belongs: &dyn Fn(&Error) -> bool| {
            let chosen: Vec<&Error> = errors.iter().filter(|e| belongs(e)).collect();
            out.extend(row(name, part, &chosen));
        };
        for (class, belongs) in CLASSES {
            add(class.into(), &|e| belongs(&e.line));
        }
        for (lane, nm) in wavelengths.iter().enumerate() {
            let near = |e: &Error| e.lane == lane && e.line.place == Place::Aureole;
            add(format!("{nm} nm, within 10°"), &near);
            let far = |e: &Error| e.lane == lane && e.line.place == Place::Sky;
            add(format!("{nm} nm, sky beyond"), &far);
        }
    }
    Ok(out)
}

/// The rows as text.
pub fn table(rows: &[Row]) -> Result<String> {
    let mut out = String::new();
    let mut last = "";
    for row in rows {
        if row.model != last {
            writeln!(
                out,
                "{}\n{:<24}{:>7}{:>9}{:>9}{:>9}{:>9}{:>9}{:>11}{:>9}",
                row.model,
                "radiance, polarisation",
                "values",
                "median",
                "p95",
                "max",
                "mean",
                "noise",
                "DoP median",
                "p95"
            )?;
            last = &row.model;
        }
        let [median, p95, max, mean, noise] = row.radiance.map(|v| 100.0 * v);
        let [dop, dop95] = row.polarisation;
        writeln!(
            out,
            "{:<24}{:>7}{median:>8.2}%{p95:>8.2}%{max:>8.1}%{mean:>+8.2}%{noise:>8.2}%{dop:>11.4}{dop95:>9.4}",
            row.part, row.values
        )?;
    }
    Ok(out)
}

/// The rows as CSV.
pub fn csv(rows: &[Row]) -> Result<Vec<u8>> {
    let mut out = csv::Writer::from_writer(vec![]);
    out.write_record([
        "model",
        "part of the sky",
        "median, %",
        "p95, %",
        "max, %",
        "mean, %",
        "noise, %",
        "polarisation, median",
        "p95",
    ])?;
    for row in rows {
        let radiance = row.radiance.map(|v| format!("{:.2}", 100.0 * v));
        let polarisation = row.polarisation.map(|v| format!("{v:.4}"));
        let name = [row.model.clone(), row.part.clone()];
        out.write_record(name.iter().chain(&radiance).chain(&polarisation))?;
    }
    Ok(out.into_inner().map_err(|e| e.into_error())?)
}

fn errors(model: &Model, traced: &[Traced], wavelengths: &[f64]) -> Result<Vec<Error>> {
    let mut out = vec![];
    for Traced { line, light } in traced {
        let ours = evaluate(model, line, wavelengths)?;
        for (lane, (truth, [intensity, polarisation])) in light.iter().zip(ours).enumerate() {
            let i = truth.stokes[0];
            if i > 0.0 {
                out.push(Error {
                    line: *line,
                    relative: intensity / i - 1.0,
                    degree: polarisation - degree(truth.stokes),
                    noise: truth.error[0] / i,
                    lane,
                });
            }
        }
    }
    Ok(out)
}

fn row(model: &str, part: String, errors: &[&Error]) -> Option<Row> {
    let of = |value: &dyn Fn(&Error) -> f64| Quantiles::of(errors.iter().map(|e| value(e)));
    let (relative, noise) = (of(&|e| e.relative.abs())?, of(&|e| e.noise)?);
    let degree = of(&|e| e.degree.abs())?;
    let mean = errors.iter().map(|e| e.relative).sum::<f64>() / errors.len() as f64;
    Some(Row {
        model: model.to_owned(),
        part,
        values: relative.count,
        radiance: [
            relative.median,
            relative.p95,
            relative.max,
            mean,
            noise.median,
        ],
        polarisation: [degree.median, degree.p95],
    })
}

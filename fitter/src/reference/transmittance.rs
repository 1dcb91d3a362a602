//! Optical depths along straight lines (`transmittance_*.json`).

use super::verdict::{Comparison, Limits, Verdict};
use crate::atmosphere::json::Case;
use crate::tracer::{Options, Query, Tracer};
use anyhow::{Context, Result, bail, ensure};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Largest error allowed, of max(1, τ).
const TOLERANCE: f64 = 1e-6;

#[derive(Deserialize)]
struct File {
    cases: Vec<Line>,
}

#[derive(Deserialize)]
struct Line {
    atm: String,
    alt_m: f64,
    view_zenith_deg: f64,
    distance_m: f64,
    end: String,
    tau: f64,
}

impl Line {
    fn query(&self) -> Result<Query> {
        Ok(Query {
            altitude: self.alt_m,
            view_zenith: self.view_zenith_deg.to_radians(),
            view_azimuth: 0.0,
            sun_elevation: 0.0,
            distance: match self.end.as_str() {
                "finite" => Some(self.distance_m),
                "ground" | "space" => None,
                other => bail!("end \"{other}\" is none of finite, ground, space"),
            },
        })
    }
}

/// Judges the file at `path`, with the atmospheres of `sky_*.json` beside it. z is scaled so that 4.5 is the tolerance.
pub fn judge(path: &Path) -> Result<Verdict> {
    let name = || path.display().to_string();
    let text = std::fs::read_to_string(path).with_context(name)?;
    let file: File = serde_json::from_str(&text).with_context(name)?;
    let mut tracers = BTreeMap::new();
    let mut comparisons = vec![];
    for (i, line) in file.cases.iter().enumerate() {
        if !tracers.contains_key(&line.atm) {
            let case = Case::read(&path.with_file_name(format!("sky_{}.json", line.atm)))?;
            let tracer = Tracer::new(&case.atmosphere, Options::default())?;
            tracers.insert(line.atm.clone(), tracer);
        }
        let query = line
            .query()
            .with_context(|| format!("{} cases[{i}]", path.display()))?;
        comparisons.push(Comparison {
            reference: line.tau,
            uncertainty: TOLERANCE / 4.5 * line.tau.max(1.0),
            ours: tracers[&line.atm].optical_depth(&query)?[0],
            error: 0.0,
            intensity: line.tau.max(1.0),
        });
    }
    ensure!(!comparisons.is_empty(), "{} has no cases", path.display());
    Ok(Verdict {
        case: "transmittance".into(),
        quantity: "tau".into(),
        comparisons,
        limits: Limits {
            z: 4.5,
            chi2: 1.6,
            bias: TOLERANCE,
        },
    })
}

//! Plane-parallel slabs (`pp_*.json`), as thin shells of a very large planet.

use super::traced_lines::{Effort, trace_all};
use super::verdict::{Comparison, Limits, Verdict};
use crate::atmosphere::{Atmosphere, Constituent, Phase, Scatterer};
use crate::tracer::{Options, Query, Radiance, Tracer, VisibleGround};
use anyhow::{Context, Result, bail, ensure};
use serde::Deserialize;
use std::path::Path;

/// At these dimensions the curvature changes paths at the most slanting directions of the tables (cosine 0.02) by 1e-5.
const RADIUS: f64 = 1e11;
const THICKNESS: f64 = 100.0;

/// A row of the published Rayleigh tables, with the slab it belongs to.
#[derive(Deserialize)]
struct RayleighRow {
    source: String,
    depol: f64,
    tau: f64,
    sun_zenith_deg: f64,
    albedo: f64,
    #[serde(flatten)]
    sight: SightRow,
}

#[derive(Deserialize)]
struct SightRow {
    level: String,
    view_zenith_deg: f64,
    view_azimuth_deg: f64,
    #[serde(rename = "I")]
    i: f64,
    #[serde(rename = "Q")]
    q: Option<f64>,
    #[serde(rename = "U")]
    u: Option<f64>,
    sigma: f64,
}

#[derive(Deserialize)]
struct RayleighFile {
    rows: Vec<RayleighRow>,
}

#[derive(Deserialize)]
struct HenyeyGreensteinCase {
    tau: f64,
    ssa: f64,
    g: f64,
    sun_zenith_deg: f64,
    albedo: f64,
    rows: Vec<SightRow>,
}

#[derive(Deserialize)]
struct HenyeyGreensteinFile {
    cases: Vec<HenyeyGreensteinCase>,
}

/// A homogeneous slab over a Lambertian ground.
struct Slab {
    name: String,
    tau: f64,
    single_scattering_albedo: f64,
    phase: Phase,
    sun_zenith_deg: f64,
    albedo: f64,
    bias: f64,
}

impl Slab {
    fn atmosphere(&self) -> Atmosphere {
        let extinction = self.tau / THICKNESS;
        Atmosphere {
            planet_radius: RADIUS,
            altitudes: vec![0.0, THICKNESS],
            wavelengths: vec![550.0],
            constituents: vec![Constituent {
                name: self.name.clone(),
                profile: vec![1.0, 1.0],
                extinction: vec![extinction],
                scatterers: vec![Scatterer {
                    name: self.name.clone(),
                    phase: self.phase.clone(),
                    extinction: vec![extinction],
                    scattering: vec![extinction * self.single_scattering_albedo],
                }],
            }],
        }
    }

    fn query(&self, row: &SightRow) -> Result<Query> {
        let altitude = match row.level.as_str() {
            "top" => THICKNESS,
            "bottom" => 0.0,
            other => bail!("level \"{other}\" is neither top nor bottom"),
        };
        Ok(Query {
            altitude,
            view_zenith: row.view_zenith_deg.to_radians(),
            view_azimuth: row.view_azimuth_deg.to_radians(),
            sun_elevation: (90.0 - self.sun_zenith_deg).to_radians(),
            distance: None,
        })
    }

    fn judge(&self, rows: &[&SightRow], effort: Effort) -> Result<Vec<Verdict>> {
        let queries = rows
            .iter()
            .enumerate()
            .map(|(i, row)| {
                self.query(row)
                    .with_context(|| format!("{} row {i}", self.name))
            })
            .collect::<Result<Vec<_>>>()?;
        let options = Options {
            visible_ground: VisibleGround::Lit,
            ..Options::default()
        };
        let tracer = Tracer::new(&self.atmosphere(), options)?;
        let results = trace_all(&tracer, options, &queries, self.albedo, effort)?;
        let verdicts = ["I", "Q", "U"].into_iter().enumerate();
        Ok(verdicts
            .filter_map(|(c, name)| self.verdict(c, name, rows, &results))
            .collect())
    }

    fn verdict(
        &self,
        c: usize,
        name: &str,
        rows: &[&SightRow],
        results: &[Radiance],
    ) -> Option<Verdict> {
        let pairs = rows.iter().zip(results);
        let comparisons: Option<Vec<_>> = pairs
            .map(|(row, result)| {
                let reference = [Some(row.i), row.q, row.u][c]?;
                Some(Comparison {
                    reference,
                    uncertainty: row.sigma.hypot(1e-3 * row.i),
                    ours: result.stokes[c],
                    error: result.error[c],
                    intensity: row.i,
                })
            })
            .collect();
        Some(Verdict {
            case: self.name.clone(),
            quantity: name.to_owned(),
            comparisons: comparisons?,
            limits: Limits {
                z: 4.5,
                chi2: 1.6,
                bias: self.bias,
            },
        })
    }
}

fn read<T: for<'a> Deserialize<'a>>(path: &Path) -> Result<T> {
    let name = || path.display().to_string();
    let text = std::fs::read_to_string(path).with_context(name)?;
    serde_json::from_str(&text).with_context(name)
}

/// Judges published Rayleigh tables: every `stride`th row.
pub fn rayleigh(path: &Path, stride: usize, effort: Effort) -> Result<Vec<Verdict>> {
    let file: RayleighFile = read(path)?;
    let key = |r: &RayleighRow| {
        (
            r.source.clone(),
            [r.depol, r.tau, r.sun_zenith_deg, r.albedo],
        )
    };
    let mut verdicts = vec![];
    let mut left: Vec<&RayleighRow> = file.rows.iter().step_by(stride.max(1)).collect();
    while let Some(first) = left.first().copied() {
        let (same, others) = left
            .into_iter()
            .partition(|r| std::ptr::eq(*r, first) || key(r) == key(first));
        left = others;
        let slab = Slab {
            name: format!("{} tau {}", first.source, first.tau),
            tau: first.tau,
            single_scattering_albedo: 1.0,
            phase: Phase::Rayleigh {
                depolarisation: vec![first.depol],
            },
            sun_zenith_deg: first.sun_zenith_deg,
            albedo: first.albedo,
            bias: 1e-3,
        };
        let same: Vec<&RayleighRow> = same;
        let sights: Vec<&SightRow> = same.iter().map(|r| &r.sight).collect();
        verdicts.extend(slab.judge(&sights, effort)?);
    }
    ensure!(!verdicts.is_empty(), "{} has no rows", path.display());
    Ok(verdicts)
}

/// Judges Henyey-Greenstein slabs: every `stride`th row.
pub fn henyey_greenstein(path: &Path, stride: usize, effort: Effort) -> Result<Vec<Verdict>> {
    let file: HenyeyGreensteinFile = read(path)?;
    let mut verdicts = vec![];
    for case in &file.cases {
        let slab = Slab {
            name: format!("HG slab tau {} g {}", case.tau, case.g),
            tau: case.tau,
            single_scattering_albedo: case.ssa,
            phase: Phase::HenyeyGreenstein { g: vec![case.g] },
            sun_zenith_deg: case.sun_zenith_deg,
            albedo: case.albedo,
            bias: 1.5e-3,
        };
        let rows: Vec<&SightRow> = case.rows.iter().step_by(stride.max(1)).collect();
        verdicts.extend(slab.judge(&rows, effort)?);
    }
    ensure!(!verdicts.is_empty(), "{} has no cases", path.display());
    Ok(verdicts)
}

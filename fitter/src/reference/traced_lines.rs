//! Tracing the lines of sight of a reference file.

use crate::atmosphere::json::Case;
use crate::tracer::{Options, Orders, Query, Radiance, Tracer};
use anyhow::{Context, Result};
use rayon::prelude::*;

/// How much effort a comparison is given.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Standard error of I to aim at, relative to I.
    pub target_error: f64,
    /// Seed.
    pub seed: u64,
}

/// The query of row `i` of `case`.
pub fn query(case: &Case, i: usize) -> Result<Query> {
    let query = Query {
        altitude: case.value(i, "obs_alt_m")?,
        view_zenith: case.value(i, "view_zenith_deg")?.to_radians(),
        view_azimuth: case.value(i, "view_azimuth_deg")?.to_radians(),
        sun_elevation: case.sun_elevation_deg.to_radians(),
        distance: None,
    };
    let check = query.check(case.atmosphere.top());
    check.with_context(|| format!("{} rows[{i}]", case.id))?;
    Ok(query)
}

/// Traces every row of `case`.
pub fn trace(case: &Case, options: Options, effort: Effort) -> Result<Vec<Radiance>> {
    let queries = (0..case.rows.len())
        .map(|i| query(case, i))
        .collect::<Result<Vec<_>>>()?;
    let tracer = Tracer::new(&case.atmosphere, options)?;
    trace_all(&tracer, options, &queries, case.albedo, effort)
}

/// Traces `queries` at the tracer's first wavelength over a ground of the given albedo.
pub fn trace_all(
    tracer: &Tracer,
    options: Options,
    queries: &[Query],
    albedo: f64,
    effort: Effort,
) -> Result<Vec<Radiance>> {
    queries
        .par_iter()
        .enumerate()
        .map(|(i, query)| {
            let seed = effort.seed.wrapping_add(i as u64);
            let samples = match options.orders {
                Orders::Single => 0,
                Orders::All => tracer.samples_for(query, effort.target_error, albedo, seed)?,
            };
            Ok(tracer.estimate(query, samples, seed)?.radiance(albedo, 0))
        })
        .collect()
}

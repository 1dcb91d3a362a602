//! From atmospheres to a model file, in work units that resume.

use crate::assess::{self, Error, Quantiles};
use crate::atmosphere::{Atmosphere, real};
use crate::dataset::{Grid, Sample, Store, Tensor, WAVELENGTHS, trace_tensor, truth};
use crate::decompose::{ElevationScale, Fit, Options, channel_weights, chunk_geometry, fit};
use crate::finite;
use crate::orders::{FIELDS, Gatherer, LightField, Medium, NW, SUN_RADIUS, Settings, solve};
use crate::pack::{Air, head};
use anyhow::{Context, Result};
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;
use std::path::Path;
use welkin::Model;
use welkin::format::{Chunk, ColumnTable, Head, Payload, encode, replace_file};

/// What to build and how well.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The grid.
    pub grid: Grid,
    /// Components per chunk, sweeps, seed.
    pub options: Options,
    /// Resolution of the solver.
    pub settings: Settings,
    /// Held-out view directions and suns per chunk.
    pub held_out: [usize; 2],
}

impl Default for Plan {
    fn default() -> Self {
        Self {
            grid: Grid::default(),
            options: Options {
                rank: 64,
                sweeps: 1500,
                seed: 1,
            },
            settings: Settings::default(),
            held_out: [160, 24],
        }
    }
}

impl Plan {
    /// What the light fields depend on.
    pub fn light_key(&self) -> String {
        format!("{UNIT_VERSION} {:?} {WAVELENGTHS:?}", self.settings)
    }

    /// What the traced tensors and samples depend on.
    pub fn key(&self) -> String {
        let axes = Grid {
            altitudes: vec![],
            visibilities: vec![],
            ..self.grid.clone()
        };
        format!(
            "{} {UNIT_VERSION} {axes:?} {:?}",
            self.light_key(),
            self.held_out
        )
    }

    /// Work units in the folder `work`.
    pub fn store(&self, work: &Path) -> Result<Store> {
        Store::open(work, self.key())
    }
}

/// Length of ray segments when view rays are gathered, relative to the finest.
const FINENESS: f64 = 1.0;
/// Changes whenever the physics or the layout of the units does.
const UNIT_VERSION: u32 = 3;

/// A visibility, solved.
pub struct Solved {
    /// Its value, m.
    pub visibility: f64,
    /// Its air.
    pub medium: Medium,
    /// Its light field.
    pub light: LightField,
}

/// Traced data and its fit.
struct Fitted {
    altitude: usize,
    visibility: usize,
    fit: Fit,
    truth: Vec<Sample>,
}

/// Builds the model file `out`, keeping units in `work`; returns a report.
pub fn build(plan: &Plan, work: &Path, out: &Path) -> Result<String> {
    let store = plan.store(work)?;
    let started = std::time::Instant::now();
    let solved = solve_all(plan, work)?;
    let traced = trace_all(plan, &store, &solved)?;
    let tracing = started.elapsed();
    let scale = reference_scale(plan, &solved, &traced);
    let fitted = fit_all(plan, &store, &solved, traced, &scale)?;
    let fitting = started.elapsed() - tracing;
    let (bytes, errors) = assemble(plan, &solved, &fitted, &scale)?;
    replace_file(out, &bytes).with_context(|| format!("cannot write {}", out.display()))?;
    Ok(format!(
        "{}\n{}\n{} bytes in {}\ntracing {:.0} s, fitting {:.0} s\n",
        chunk_table(plan, &fitted, &errors),
        assess::table(&errors.concat()),
        bytes.len(),
        out.display(),
        tracing.as_secs_f64(),
        fitting.as_secs_f64(),
    ))
}

fn bar(length: usize, what: &str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg:<28} {wide_bar} {pos}/{len} {eta}");
    let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length as u64)
        .with_style(style)
        .with_message(what.to_owned())
}

/// The light fields of all visibilities of the grid, from their units in `work` or solved now.
pub fn solve_all(plan: &Plan, work: &Path) -> Result<Vec<Solved>> {
    plan.grid
        .visibilities
        .iter()
        .map(|&v| solve_one(plan, work, v))
        .collect()
}

/// The light field of a visibility (m), from its unit in `work` or solved now.
pub fn solve_one(plan: &Plan, work: &Path, visibility: f64) -> Result<Solved> {
    let store = Store::open(work, plan.light_key())?;
    let medium = Medium::new(real(visibility, &WAVELENGTHS)?, SUN_RADIUS)?;
    let progress = bar(100, &format!("light field {:.1} km", visibility / 1e3));
    let values = store.unit(&format!("light-{visibility}"), || {
        let tell = |share: f64| progress.set_position((100.0 * share) as u64);
        Ok(solve(&medium, plan.settings, &tell).to_values())
    })?;
    progress.finish();
    let light = LightField::from_values(&values).context("a light field of another size")?;
    Ok(Solved {
        visibility,
        medium,
        light,
    })
}

/// Traced radiance for conditions that need not be on the grid: held-out samples for each of `altitudes` (m) at `visibility` (m).
pub fn between_nodes(
    plan: &Plan,
    work: &Path,
    visibility: f64,
    altitudes: &[f64],
) -> Result<Vec<(f64, Vec<Sample>)>> {
    let store = plan.store(work)?;
    let solved = solve_one(plan, work, visibility)?;
    let gatherer = Gatherer::new(&solved.medium, &solved.light, FINENESS);
    let sample = |&altitude: &f64| {
        let seed = (visibility + altitude) as u64;
        let samples = held_out(plan, &store, &gatherer, &solved, altitude, seed)?;
        Ok((altitude, samples))
    };
    altitudes.iter().map(sample).collect()
}

/// The atmosphere of a visibility (m) and traced samples for the judge: every direction has two suns of its own.
pub fn judged_samples(
    plan: &Plan,
    work: &Path,
    visibility: f64,
    altitudes: &[f64],
    directions: usize,
) -> Result<(Atmosphere, Vec<Sample>)> {
    let solved = solve_one(plan, work, visibility)?;
    let gatherer = Gatherer::new(&solved.medium, &solved.light, FINENESS);
    let one = |altitude: f64, seed: u64| truth(&gatherer, &solved.light, altitude, [1, 2], seed);
    let samples = altitudes
        .iter()
        .flat_map(|&h| (0..directions as u64).flat_map(move |i| one(h, 1000 * i + h as u64)))
        .collect();
    Ok((real(visibility, &WAVELENGTHS)?, samples))
}

fn held_out(
    plan: &Plan,
    store: &Store,
    gatherer: &Gatherer,
    solved: &Solved,
    altitude: f64,
    seed: u64,
) -> Result<Vec<Sample>> {
    let values = store.unit(&format!("truth-{}-{altitude}", solved.visibility), || {
        let samples = truth(gatherer, &solved.light, altitude, plan.held_out, seed);
        Ok(samples.iter().flat_map(Sample::to_values).collect())
    })?;
    Ok(Sample::from_values(&values))
}

/// Tensor and held-out samples of every chunk, visibility-major.
fn trace_all(plan: &Plan, store: &Store, solved: &[Solved]) -> Result<Vec<(Tensor, Vec<Sample>)>> {
    let grid = &plan.grid;
    let chunks = solved.len() * grid.altitudes.len();
    let progress = bar(chunks, "tracing");
    let mut out = vec![];
    for s in solved {
        let gatherer = Gatherer::new(&s.medium, &s.light, FINENESS);
        for (a, altitude) in grid.altitudes.iter().enumerate() {
            let name = format!("{}-{altitude}", s.visibility);
            let values = store.unit(&format!("tensor-{name}"), || {
                Ok(trace_tensor(&gatherer, grid, a).values)
            })?;
            let shape = tensor_shape(grid);
            let seed = (s.visibility + altitude) as u64;
            let samples = held_out(plan, store, &gatherer, s, *altitude, seed)?;
            out.push((Tensor { shape, values }, samples));
            progress.inc(1);
        }
    }
    progress.finish();
    Ok(out)
}

fn tensor_shape(grid: &Grid) -> [usize; 4] {
    let views = grid.up.0.len() + grid.down.0.len();
    [
        views,
        grid.phi.len(),
        grid.elevation_axis().len(),
        FIELDS * NW,
    ]
}

/// S from the lowest altitude of the middle visibility.
fn reference_scale(
    plan: &Plan,
    solved: &[Solved],
    traced: &[(Tensor, Vec<Sample>)],
) -> ElevationScale {
    let v = solved.len() / 2;
    let medium = &solved[v].medium;
    let planet = crate::column::planet(&medium.atmosphere);
    let geometry = chunk_geometry(medium, planet, &plan.grid, 0);
    ElevationScale::new(&traced[v * plan.grid.altitudes.len()].0, &geometry, medium)
}

fn fit_all(
    plan: &Plan,
    store: &Store,
    solved: &[Solved],
    traced: Vec<(Tensor, Vec<Sample>)>,
    scale: &ElevationScale,
) -> Result<Vec<Fitted>> {
    let progress = bar(traced.len(), "fitting");
    let settings = format!("{:?} {scale:?}", plan.options);
    let settings = crc32fast::hash(settings.as_bytes());
    let altitudes = plan.grid.altitudes.len();
    let out = traced
        .into_par_iter()
        .enumerate()
        .map(|(i, (tensor, truth))| {
            let (visibility, altitude) = (i / altitudes, i % altitudes);
            let s = &solved[visibility];
            let name = format!(
                "fit-{}-{}-{settings:08x}",
                s.visibility, plan.grid.altitudes[altitude]
            );
            let values = store.unit(&name, || {
                Ok(fit_one(plan, s, &tensor, altitude, scale).to_values())
            })?;
            let fit = Fit::from_values(&values, &plan.grid, plan.options.rank, FIELDS * NW)
                .context("a fit of another size")?;
            progress.inc(1);
            Ok(Fitted {
                altitude,
                visibility,
                fit,
                truth,
            })
        })
        .collect();
    progress.finish();
    out
}

fn fit_one(
    plan: &Plan,
    s: &Solved,
    tensor: &Tensor,
    altitude: usize,
    scale: &ElevationScale,
) -> Fit {
    let gatherer = Gatherer::new(&s.medium, &s.light, FINENESS);
    let geometry = chunk_geometry(&s.medium, gatherer.planet(), &plan.grid, altitude);
    let weights = channel_weights(tensor, &gatherer, &plan.grid, altitude);
    fit(
        tensor,
        &geometry,
        &s.medium,
        &plan.grid,
        scale,
        &weights,
        plan.options,
    )
}

/// Encodes the file twice: once to measure the errors of its chunks, once with them.
fn assemble(
    plan: &Plan,
    solved: &[Solved],
    fitted: &[Fitted],
    scale: &ElevationScale,
) -> Result<(Vec<u8>, Vec<Vec<Error>>)> {
    let airs: Vec<Air> = solved
        .iter()
        .map(|s| Air::new(&s.medium, s.light.spherical_albedo))
        .collect();
    let gatherer = Gatherer::new(&solved[0].medium, &solved[0].light, FINENESS);
    let mut head = head(&plan.grid, &airs, &gatherer, scale, "{}".into())?;
    let mut chunks = chunks(plan, solved, fitted)?;
    let model = Model::from_bytes(encode(&head, &chunks)?)?;
    let mut all = vec![];
    for (chunk, f) in chunks
        .iter_mut()
        .filter(|c| matches!(c.payload, Payload::Radiance(_)))
        .zip(fitted)
    {
        let errors = assess::errors(&model, solved[f.visibility].visibility, &f.truth)?;
        if let Some(q) = Quantiles::of(errors.iter().map(|e| e.relative)) {
            chunk.error_median = q.median as f32;
            chunk.error_p99 = q.p99 as f32;
        }
        all.push(errors);
    }
    head.metadata = metadata(plan, &head, &all);
    Ok((encode(&head, &chunks)?, all))
}

/// Radiance chunks in the order of `fitted`, then columns, then what finite distances need.
fn chunks(plan: &Plan, solved: &[Solved], fitted: &[Fitted]) -> Result<Vec<Chunk>> {
    let radiance = fitted.iter().map(|f| Chunk {
        altitude: Some(f.altitude),
        visibility: Some(f.visibility),
        error_median: 0.0,
        error_p99: 0.0,
        payload: Payload::Radiance(f.fit.factors.clone()),
    });
    let medium = &solved[0].medium;
    let planet = crate::column::planet(&medium.atmosphere);
    let columns = (0..plan.grid.altitudes.len()).map(|a| {
        let geometry = chunk_geometry(medium, planet, &plan.grid, a);
        let values = geometry.coefficients(plan.grid.up.0, plan.grid.down.0);
        Chunk {
            altitude: Some(a),
            visibility: None,
            error_median: 0.0,
            error_p99: 0.0,
            payload: Payload::Column(ColumnTable { values }),
        }
    });
    Ok(radiance
        .chain(columns)
        .chain(finite::chunks(solved)?)
        .collect())
}

fn metadata(plan: &Plan, head: &Head, errors: &[Vec<Error>]) -> String {
    let all = errors.concat();
    let classes: serde_json::Map<String, serde_json::Value> = assess::CLASSES
        .iter()
        .filter_map(|(name, belongs)| {
            let q = Quantiles::of(all.iter().filter(|e| belongs(e)).map(|e| e.relative))?;
            Some(((*name).to_owned(), serde_json::to_value(q).ok()?))
        })
        .collect();
    serde_json::json!({
        "title": "Clear sky of the US standard atmosphere with OPAC continental aerosol",
        "generator": concat!("welkin-fit ", env!("CARGO_PKG_VERSION")),
        "atmosphere": {
            "air": "AFGL US standard 1986; Rayleigh scattering: Bodhaine et al. 1999; ozone: Gorshelev et al. 2014, 223 K",
            "aerosol": "OPAC water-soluble (50 % humidity), insoluble, soot (Hess et al. 1998), Henyey-Greenstein",
            "sun": "ASTM G173-03 extraterrestrial",
            "planet_radius_m": head.planet.radius,
        },
        "method": "single scattering by quadrature, multiple scattering by successive orders with polarised Rayleigh scattering",
        "solver": format!("{:?}", plan.settings),
        "fit": { "rank": plan.options.rank, "sweeps": plan.options.sweeps, "seed": plan.options.seed },
        "relative_error_held_out": classes,
    })
    .to_string()
}

fn chunk_table(plan: &Plan, fitted: &[Fitted], errors: &[Vec<Error>]) -> String {
    let mut out = format!(
        "{:>10} {:>9} {:>10} {:>9} {:>9} {:>9} {:>9} {:>9}\n",
        "visibility", "altitude", "condition", "residual", "median", "p95", "p99", "max"
    );
    for (f, errors) in fitted.iter().zip(errors) {
        if let Some(q) = Quantiles::of(errors.iter().map(|e| e.relative)) {
            out += &format!(
                "{:>7.1} km {:>7} m {:>10.1} {:>8.3}% {:>8.3}% {:>8.3}% {:>8.3}% {:>8.2}%\n",
                plan.grid.visibilities[f.visibility] / 1e3,
                plan.grid.altitudes[f.altitude],
                f.fit.condition,
                100.0 * f.fit.error,
                100.0 * q.median,
                100.0 * q.p95,
                100.0 * q.p99,
                100.0 * q.max
            );
        }
    }
    out
}

//! From work units to a model file.

use crate::assess::{self, Error, Quantiles};
use crate::dataset::{Sample, Store};
use crate::decompose::{self, Chunk, Fit, Options};
use crate::estimate;
use crate::finite;
use crate::fitting::{Fitting, unit_name};
use crate::pack::{self, AirTables, PackedBasis};
use crate::progress::{stage, whole};
use crate::report;
use crate::round_trip;
use crate::spectrum;
use crate::successive_orders::{FIELDS, NW};
use crate::units::{Between, Plan, Solved};
use crate::{polarimetry, polarise};
use anyhow::{Context, Result};
use rayon::prelude::*;
use std::path::Path;
use std::time::Instant;
use welkin::Model;
use welkin::estimate::Estimates;
use welkin::format::{self, Estimate, Head, Payload, encode};
use welkin::output::{Target, write};

/// A chunk of the model before it is packed.
pub(crate) struct Traced {
    altitude: usize,
    visibility: usize,
    chunk: Chunk,
    truth: Vec<Sample>,
}

/// Builds the model file `out`, keeping units in `work`; returns a report.
pub fn build(plan: &Plan, fitting: Fitting, work: &Path, out: &Target) -> Result<String> {
    out.check()?;
    let store = plan.store(work)?;
    let started = Instant::now();
    let solved = solve_all(plan, work)?;
    let (tables, estimates) = estimates(&solved);
    let traced = trace_all(plan, &store, (&solved, &estimates))?;
    let tracing = started.elapsed();
    let (chunks, places) = split(traced);
    let fit = fit_all(plan, fitting, &store, &chunks)?;
    let media = (solved.as_slice(), estimates.as_slice());
    let polarisation = fit_polarisation(plan, fitting, &store, media, &chunks, &places)?;
    let fitting_time = started.elapsed() - tracing;
    let (mut head, mut file) = radiance_file(plan, &solved, tables, &places, &fit)?;
    let pack = || spectrum::pack(plan, work, &solved);
    let spectrum = match plan.between {
        // Has a bar of its own.
        Between::Learned(_) => pack(),
        Between::Default | Between::Nothing => whole("between the wavelengths", pack),
    };
    if let Some(spectrum) = spectrum? {
        head.xyz = spectrum.xyz;
        let spectrum = format::Chunk::new(None, None, Payload::Spectrum(spectrum.spectrum));
        file.insert(1, spectrum);
    }
    check_rounding(plan, &chunks, &places, &fit, &file)?;
    file.extend(whole("finite segments", || finite::chunks(&solved))?);
    file.extend(polarisation);
    let (bytes, errors, polarimetry) = assemble(plan, fitting, head, file, &places)?;
    write(&[(out, &bytes)]).context("cannot write the model")?;
    let rows: Vec<report::Row> = places
        .iter()
        .enumerate()
        .map(|(k, p)| report::Row {
            visibility: plan.grid.visibilities[p.visibility],
            altitude: plan.grid.altitudes[p.altitude],
            condition: fit.condition(&chunks[k], k),
            errors: &errors[k],
        })
        .collect();
    Ok(format!(
        "the fit against the light that was solved, relative errors of radiance, by chunk\n{}\n\
         the same, by what is seen\n{}\n\
         the fit against the light that was solved, errors of the degree and the angle of polarisation\n{}\n\
         {} bytes in {}\ntracing {:.0} s, fitting {:.0} s\n",
        report::chunk_table(&rows),
        assess::table(&errors.concat()),
        polarimetry::table(&polarimetry),
        bytes.len(),
        out,
        tracing.as_secs_f64(),
        fitting_time.as_secs_f64(),
    ))
}

/// Where a chunk belongs and what it is judged by.
pub(crate) struct Place {
    pub altitude: usize,
    pub visibility: usize,
    pub truth: Vec<Sample>,
}

pub(crate) fn split(traced: Vec<Traced>) -> (Vec<Chunk>, Vec<Place>) {
    let parts = traced.into_iter().map(|t| {
        let place = Place {
            altitude: t.altitude,
            visibility: t.visibility,
            truth: t.truth,
        };
        (t.chunk, place)
    });
    parts.unzip()
}

pub(crate) fn solve_all(plan: &Plan, work: &Path) -> Result<Vec<Solved>> {
    let solve = |&visibility: &f64| {
        let progress = stage(100, &format!("light field {:.1} km", visibility / 1e3));
        let tell = |share: f64| progress.set_position((100.0 * share) as u64);
        let solved = plan.solve(work, visibility, &tell);
        progress.finish();
        solved
    };
    plan.grid.visibilities.iter().map(solve).collect()
}

/// The tables of the estimates, and the estimates at each visibility.
pub(crate) fn estimates(solved: &[Solved]) -> (Estimate, Vec<Estimates>) {
    let tables = estimate::tables(solved);
    let prepare = |s: &Solved| estimate::prepare(&tables, &s.medium);
    let estimates = solved.iter().map(prepare).collect();
    (tables, estimates)
}

/// Chunks in the order of the file: altitude by altitude, so that a range of altitudes is one piece of the file.
pub(crate) fn trace_all(
    plan: &Plan,
    store: &Store,
    (solved, estimates): (&[Solved], &[Estimates]),
) -> Result<Vec<Traced>> {
    let altitudes = plan.grid.altitudes.len();
    let progress = stage(altitudes * solved.len(), "tracing");
    let mut out = vec![];
    for altitude in 0..altitudes {
        for (visibility, s) in solved.iter().enumerate() {
            let tensor = plan.tensor(store, s, altitude)?;
            let seed = (altitude * solved.len() + visibility) as u64;
            out.push(Traced {
                altitude,
                visibility,
                chunk: Chunk::new(
                    &tensor,
                    (&s.gatherer(), &estimates[visibility]),
                    &plan.grid,
                    altitude,
                    seed,
                ),
                truth: plan.held_out(store, s, plan.grid.altitudes[altitude])?,
            });
            progress.inc(1);
        }
    }
    progress.finish();
    Ok(out)
}

/// Fits each group of nodes by components of its own and joins them.
pub(crate) fn fit_all(
    plan: &Plan,
    fitting: Fitting,
    store: &Store,
    chunks: &[Chunk],
) -> Result<Fit> {
    let [plain, strong] = plan.coverage.groups();
    let fit = fit_group(plan, (&plain, fitting.options), fitting, store, chunks)?;
    if strong.is_empty() {
        return Ok(fit);
    }
    let other = fit_group(plan, (&strong, fitting.strong()), fitting, store, chunks)?;
    Ok(fit.join(&other))
}

fn fit_group(
    plan: &Plan,
    (nodes, options): (&[usize], Options),
    fitting: Fitting,
    store: &Store,
    chunks: &[Chunk],
) -> Result<Fit> {
    let name =
        |what: &str, refinements: usize| unit_name(what, &plan.grid, nodes, options, refinements);
    let read = |values: Vec<f32>| {
        let fit = Fit::from_values(&values, &plan.grid, options.rank, chunks.len(), FIELDS * NW);
        fit.context("a fit of another size")
    };
    let first = || -> Result<Vec<f32>> {
        let progress = stage(options.sweeps, "decomposing");
        let tell = |sweep: usize, rms: f64| {
            progress.set_position(sweep as u64 + 1);
            progress.set_message(format!("decomposing, rms {:.3} %", 100.0 * rms));
        };
        let fit = decompose::decompose_all(chunks, nodes, options, &tell);
        progress.finish();
        Ok(fit.to_values())
    };
    let values = store.unit(&name("decomposition", 0), first)?;
    let refine = || -> Result<Vec<f32>> {
        let mut fit = read(values)?;
        let progress = stage(fitting.refinements, "refining");
        decompose::refine_all(chunks, nodes, &mut fit, fitting.refinements, &|sweep| {
            progress.set_position(sweep as u64);
        });
        progress.finish();
        Ok(fit.to_values())
    };
    read(store.unit(&name("refinement", fitting.refinements), refine)?)
}

fn fit_polarisation(
    plan: &Plan,
    fitting: Fitting,
    store: &Store,
    media: (&[Solved], &[Estimates]),
    chunks: &[Chunk],
    places: &[Place],
) -> Result<Vec<format::Chunk>> {
    if fitting.polarisation.rank == 0 {
        return Ok(vec![]);
    }
    let places: Vec<polarise::Place> = places.iter().map(|p| (p.altitude, p.visibility)).collect();
    let [plain, strong] = plan.coverage.groups();
    let group = |nodes: &[usize], options: Options| {
        polarise::fit(plan, (nodes, options), store, media, chunks, &places)
    };
    let mut fit = group(&plain, fitting.polarisation)?;
    if !strong.is_empty() {
        fit = fit.join(&group(&strong, fitting.strong_polarisation())?);
    }
    Ok(polarise::file_chunks(plan, &fit, &places))
}

/// Encodes the file twice: once to measure the errors of its chunks, once with them.
fn assemble(
    plan: &Plan,
    fitting: Fitting,
    mut head: Head,
    mut file: Vec<format::Chunk>,
    places: &[Place],
) -> Result<Assembled> {
    let model = Model::from_bytes(encode(&head, &file)?)?;
    let visibility = |p: &Place| plan.grid.visibilities[p.visibility];
    let progress = stage(places.len(), "measuring the fit");
    let errors = places
        .par_iter()
        .map(|p| assess::errors(&model, visibility(p), &p.truth))
        .inspect(|_| progress.inc(1))
        .collect::<Result<Vec<_>>>()?;
    progress.finish();
    let progress = stage(places.len(), "measuring the polarisation");
    let polarimetry = match model.is_polarised() {
        true => places
            .par_iter()
            .map(|p| polarimetry::errors(&model, visibility(p), &p.truth))
            .inspect(|_| progress.inc(1))
            .collect::<Result<Vec<_>>>()?,
        false => vec![],
    };
    progress.finish();
    let relative = errors.iter().map(|e| e.iter().map(|e| e.relative));
    let radiance = |payload: &Payload| matches!(payload, Payload::Radiance(_));
    note(&mut file, radiance, relative);
    let degree = polarimetry.iter().map(|e| e.iter().map(|e| e.degree));
    let polarisation = |payload: &Payload| matches!(payload, Payload::Polarisation(_));
    note(&mut file, polarisation, degree);
    head.metadata = report::metadata(plan, fitting, &head, &errors, &polarimetry.concat());
    Ok((encode(&head, &file)?, errors, polarimetry.concat()))
}

/// The bytes of a file, the errors of its radiance chunks and of its polarisation.
type Assembled = (Vec<u8>, Vec<Vec<Error>>, Vec<polarimetry::Error>);

/// Notes errors in the chunks with some payload, in their order.
fn note(
    file: &mut [format::Chunk],
    payload: impl Fn(&Payload) -> bool,
    errors: impl Iterator<Item = impl Iterator<Item = f64>>,
) {
    let chunks = file.iter_mut().filter(|c| payload(&c.payload));
    for (chunk, errors) in chunks.zip(errors) {
        if let Some(q) = Quantiles::of(errors) {
            chunk.error_median = q.median as f32;
            chunk.error_p99 = q.p99 as f32;
        }
    }
}

/// Refuses chunks that half precision spoils.
fn check_rounding(
    plan: &Plan,
    chunks: &[Chunk],
    places: &[Place],
    fit: &Fit,
    file: &[format::Chunk],
) -> Result<()> {
    // As the fit has it: the file says each kind of particles by its lobes.
    let shared = PackedBasis::new(&plan.grid, &fit.basis).radiance();
    let radiance: Vec<_> = file
        .iter()
        .filter_map(|c| match &c.payload {
            Payload::Radiance(factors) => Some(factors),
            _ => None,
        })
        .collect();
    let progress = stage(radiance.len(), "checking the rounding");
    let outcome = radiance.par_iter().enumerate().try_for_each(|(k, packed)| {
        progress.inc(1);
        let fitted = (&fit.own[k], &fit.basis);
        let outcome = round_trip::check(&plan.grid, &chunks[k], fitted, (packed, &shared));
        let [altitude, visibility] = [
            plan.grid.altitudes[places[k].altitude],
            plan.grid.visibilities[places[k].visibility],
        ];
        outcome.with_context(|| format!("chunk at {altitude} m, visibility {visibility} m"))
    });
    progress.finish();
    outcome
}

/// The head, and the basis and the estimates, then for each altitude its radiance chunks.
pub(crate) fn radiance_file(
    plan: &Plan,
    solved: &[Solved],
    tables: Estimate,
    places: &[Place],
    fit: &Fit,
) -> Result<(Head, Vec<format::Chunk>)> {
    let air = |s: &Solved| AirTables::new(&s.medium, s.light.spherical_albedo);
    let airs: Vec<AirTables> = solved.iter().map(air).collect();
    let head = pack::head(plan, &airs, &solved[0].gatherer(), "{}".into())?;
    let basis = PackedBasis::new(&plan.grid, &fit.basis);
    let kinds = &solved[0].medium.kinds;
    let shared = Payload::RadianceBasis(pack::by_lobes(basis.radiance(), kinds));
    let mut out = vec![
        format::Chunk::new(None, None, shared),
        format::Chunk::new(None, None, Payload::Estimate(tables)),
    ];
    for (k, place) in places.iter().enumerate() {
        let a = place.altitude;
        let factors = basis.radiance_chunk(&plan.grid, &fit.own[k]);
        out.push(format::Chunk::new(
            Some(a),
            Some(place.visibility),
            Payload::Radiance(factors),
        ));
    }
    Ok((head, out))
}

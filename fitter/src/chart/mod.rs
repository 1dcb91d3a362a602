//! Bytes and evaluation time against held-out error for several ways to represent the same traced chunks.

mod chunk_axes;
mod cost;
mod dense;
mod draw;
mod log;
mod paper;
mod point;
mod unrounded_fit;

pub use draw::{csv, svg};

use crate::assess::{self, Quantiles};
use crate::build::{Place, estimates, fit_all, radiance_file, solve_all, split, trace_all};
use crate::dataset::{Sample, Store};
use crate::decompose::{Chunk, Fit, Options, decompose_nested};
use crate::fitting::Fitting;
use crate::progress::bar;
use crate::successive_orders::{FIELDS, NW};
use crate::units::{Plan, Solved};
use anyhow::{Context, Result, ensure};
use chunk_axes::{Frame, Look};
use cost::{Components, nanoseconds};
use dense::Uncompressed;
use log::Logarithmic;
use paper::Paper;
pub use point::Point;
use std::path::Path;
use unrounded_fit::Single;
use welkin::Model;
use welkin::format::{Estimate, encode};

/// All nodes.
const ALL: [usize; NW] = {
    let mut all = [0; NW];
    let mut n = 0;
    while n < NW {
        all[n] = n;
        n += 1;
    }
    all
};

/// What is compared.
#[derive(Clone, Debug)]
pub struct Ranks {
    /// Ranks of fits whose chunks have all factors of their own.
    pub own: Vec<usize>,
    /// Ranks of fits whose chunks share the factors of azimuth and channel.
    pub shared: Vec<usize>,
    /// Ranks of fits in the log domain.
    pub log: Vec<usize>,
    /// Tiers, each a fit of what the tiers before it leave; azimuth and channel are shared.
    pub nested: Vec<Vec<usize>>,
}

/// Everything that the schemes are given.
struct Bench {
    plan: Plan,
    fitting: Fitting,
    store: Store,
    solved: Vec<Solved>,
    tables: Estimate,
    chunks: Vec<Chunk>,
    places: Vec<Place>,
    frames: Vec<Frame>,
    /// Chunks of a whole model, which share the shared factors.
    sharers: usize,
}

/// The field of multiply scattered light.
const DIFFUSE: usize = 3;

/// Compares the schemes on the chunks of `plan`, and `model`, if it has them, at the same samples.
pub fn chart(
    plan: &Plan,
    fitting: Fitting,
    ranks: &Ranks,
    work: &Path,
    model: Option<&Model>,
) -> Result<Vec<Point>> {
    let bench = Bench::new(plan, fitting, work)?;
    let mut points = bench.per_chunk(&ranks.log)?;
    for &rank in &ranks.own {
        points.push(bench.own(rank)?);
        report(&points);
    }
    for &rank in &ranks.shared {
        for refinements in [0, fitting.refinements] {
            let fit = bench.shared(rank, refinements)?;
            let scheme = match refinements {
                0 => "CPD, shared azimuth and channels",
                _ => "the same, refined",
            };
            points.push(bench.of_shared(scheme, rank.to_string(), &fit)?);
            report(&points);
            if refinements > 0 {
                points.push(bench.single(&fit)?);
                report(&points);
            }
        }
    }
    for tiers in &ranks.nested {
        points.push(bench.nested(tiers)?);
        report(&points);
    }
    if let Some(model) = model {
        points.push(bench.model(model)?);
        report(&points);
    }
    Ok(points)
}

fn report(points: &[Point]) {
    if let Some(p) = points.last() {
        eprintln!(
            "{} {}: {:.0} bytes, median {:.3} %, p99 {:.2} %",
            p.scheme,
            p.rank,
            p.bytes,
            100.0 * p.error.median,
            100.0 * p.error.p99
        );
    }
}

impl Bench {
    fn new(plan: &Plan, fitting: Fitting, work: &Path) -> Result<Self> {
        let store = plan.store(work)?;
        let solved = solve_all(plan, work)?;
        let (tables, estimates) = estimates(&solved);
        let traced = trace_all(plan, &store, (&solved, &estimates))?;
        let (chunks, places) = split(traced);
        let frame = |p: &Place| {
            let v = p.visibility;
            Frame::new(&solved[v], &estimates[v], &plan.grid, p.altitude)
        };
        let whole = Plan::default().grid;
        Ok(Self {
            plan: plan.clone(),
            fitting,
            store,
            frames: places.iter().map(frame).collect(),
            tables,
            sharers: whole.altitudes.len() * whole.visibilities.len(),
            solved,
            chunks,
            places,
        })
    }

    /// The schemes that have no model file: the tensor itself, the paper's, the log domain.
    fn per_chunk(&self, log: &[usize]) -> Result<Vec<Point>> {
        let mut errors = vec![vec![]; 2 + log.len()];
        let mut bytes = vec![0.0; errors.len()];
        let mut times = vec![None; errors.len()];
        let progress = bar(self.chunks.len(), "tensor, paper, log domain");
        for ((chunk, frame), place) in self.chunks.iter().zip(&self.frames).zip(&self.places) {
            let source = Uncompressed::new(chunk, frame);
            bytes[0] += 2.0 * chunk.values().len() as f64;
            errors[0].extend(uncompressed_errors(&source, chunk, frame, &place.truth));
            let paper = Paper::new(&source, chunk, frame);
            let queries: Vec<_> = place.truth.iter().map(|s| paper.query(s)).collect();
            let values = queries.iter().map(|q| paper.radiance(q));
            errors[1].extend(relative(&place.truth, values));
            bytes[1] += paper.bytes() as f64;
            let time = nanoseconds(&queries[..TIMED], |q| paper.radiance(q));
            times[1] = least(times[1], time);
            for (k, &rank) in log.iter().enumerate() {
                let options = self.options(rank);
                let fit = Logarithmic::new(chunk, frame, options);
                let (error, time) = logarithmic_errors(&fit, chunk, frame, &place.truth);
                errors[2 + k].extend(error);
                bytes[2 + k] += fit.bytes() as f64;
                times[2 + k] = least(times[2 + k], time);
            }
            progress.inc(1);
        }
        progress.finish();
        let names = ["traced tensor, splines", "paper: SVD per configuration"].map(str::to_owned);
        let names = names
            .into_iter()
            .chain(log.iter().map(|_| "CPD of logarithms, own factors".into()));
        let ranks = ["—".to_owned(), paper::RANK.to_string()].into_iter();
        let ranks = ranks.chain(log.iter().map(usize::to_string));
        let mut points = vec![];
        for (k, (scheme, rank)) in names.zip(ranks).enumerate() {
            points.push(Point {
                scheme,
                rank,
                bytes: bytes[k] / self.chunks.len() as f64,
                nanoseconds: times[k],
                error: quantiles(errors[k].iter().copied())?,
            });
            report(&points);
        }
        Ok(points)
    }

    fn options(&self, rank: usize) -> Options {
        Options {
            rank,
            ..self.fitting.options
        }
    }

    fn fitting(&self, rank: usize, refinements: usize) -> Fitting {
        Fitting {
            options: self.options(rank),
            refinements,
            ..self.fitting
        }
    }

    /// Every chunk decomposed by itself.
    fn own(&self, rank: usize) -> Result<Point> {
        let mut errors = vec![];
        for (k, place) in self.places.iter().enumerate() {
            let mut plan = self.plan.clone();
            plan.grid.altitudes = vec![self.plan.grid.altitudes[place.altitude]];
            plan.grid.visibilities = vec![self.plan.grid.visibilities[place.visibility]];
            let chunk = &self.chunks[k..=k];
            let fit = fit_all(&plan, self.fitting(rank, 0), &self.store, chunk)?;
            let only = [Place {
                altitude: 0,
                visibility: 0,
                truth: place.truth.clone(),
            }];
            let solved = &self.solved[place.visibility..=place.visibility];
            errors.extend(held_out(&plan, (solved, &self.tables), &only, &fit)?);
        }
        let [own, shared] = self.sizes(rank);
        self.point(
            "CPD, own factors",
            rank.to_string(),
            own + shared,
            rank,
            errors,
        )
    }

    fn shared(&self, rank: usize, refinements: usize) -> Result<Fit> {
        let fitting = self.fitting(rank, refinements);
        fit_all(&self.plan, fitting, &self.store, &self.chunks)
    }

    /// What rounding to half precision costs.
    fn single(&self, fit: &Fit) -> Result<Point> {
        let mut errors = vec![];
        for (k, place) in self.places.iter().enumerate() {
            let single = Single::new(&self.chunks[k], &self.frames[k], &fit.own[k], &fit.basis);
            let values = place
                .truth
                .iter()
                .map(|s| single.radiance(&look(s), s.albedo as f32));
            errors.extend(relative(&place.truth, values));
        }
        let rank = fit.basis.rank;
        let [own, shared] = self.sizes(rank);
        let bytes = 2.0 * (own + shared / self.sharers as f64);
        let scheme = "the same, in single precision";
        self.point(scheme, rank.to_string(), bytes, rank, errors)
    }

    fn nested(&self, tiers: &[usize]) -> Result<Point> {
        let total = tiers.iter().sum();
        let options = self.fitting.options;
        let grid = &self.plan.grid;
        let what = format!(
            "{tiers:?} {options:?} {:?} {:?}",
            grid.altitudes, grid.visibilities
        );
        let name = format!("nested-{total}-{:08x}", crc32fast::hash(what.as_bytes()));
        let fit = || Ok(decompose_nested(&self.chunks, &ALL, tiers, options).to_values());
        let values = self.store.unit(&name, fit)?;
        let fit = Fit::from_values(&values, grid, total, self.chunks.len(), FIELDS * NW);
        let fit = fit.context("a fit of another size")?;
        let names: Vec<String> = tiers.iter().map(usize::to_string).collect();
        self.of_shared("shared, nested tiers", names.join("+"), &fit)
    }

    fn of_shared(&self, scheme: &str, name: String, fit: &Fit) -> Result<Point> {
        let errors = held_out(&self.plan, (&self.solved, &self.tables), &self.places, fit)?;
        let rank = fit.basis.rank;
        let [own, shared] = self.sizes(rank);
        let bytes = own + shared / self.sharers as f64;
        self.point(scheme, name, bytes, rank, errors)
    }

    /// A whole model at the same samples.
    fn model(&self, model: &Model) -> Result<Point> {
        let mut errors = vec![];
        for place in &self.places {
            let visibility = self.plan.grid.visibilities[place.visibility];
            let found = assess::errors(model, visibility, &place.truth)?;
            errors.extend(found.iter().map(|e| e.relative));
        }
        let radiance = model
            .directory()
            .iter()
            .filter(|e| e.kind == welkin::format::Kind::Radiance);
        let (count, sum) = radiance.fold((0, 0), |(n, sum), e| (n + 1, sum + e.length));
        let basis = model
            .directory()
            .iter()
            .filter(|e| e.kind == welkin::format::Kind::RadianceBasis);
        let basis: usize = basis.map(|e| e.length).sum();
        ensure!(count > 0, "the model has no radiance");
        Ok(Point {
            scheme: "the whole model".into(),
            rank: format!("{count} chunks"),
            bytes: (sum + basis) as f64 / count as f64,
            nanoseconds: None,
            error: quantiles(errors.into_iter())?,
        })
    }

    /// Bytes of a chunk's own factors and of the shared ones.
    fn sizes(&self, rank: usize) -> [f64; 2] {
        let [views, phis, elevations] = self.chunks[0].sites;
        let own = 2 * (views + elevations) * rank + 4 * rank + 2 * elevations * NW;
        [own as f64, (2 * (phis + FIELDS * NW) * rank) as f64]
    }

    fn point(
        &self,
        scheme: &str,
        name: String,
        bytes: f64,
        rank: usize,
        errors: Vec<f64>,
    ) -> Result<Point> {
        Ok(Point {
            scheme: scheme.to_owned(),
            rank: name,
            bytes,
            nanoseconds: Some(self.time(rank)),
            error: quantiles(errors.into_iter())?,
        })
    }

    /// Nanoseconds per query of one chunk with `rank` components.
    fn time(&self, rank: usize) -> f64 {
        let sites = self.chunks[0].sites;
        let table = |rows: usize| (0..rows * rank).map(|i| (i % 13) as f32 * 0.1).collect();
        let components = Components {
            rank,
            modes: sites.map(table),
            channel: table(FIELDS * NW),
        };
        let share = [[0.2; NW]; FIELDS];
        let places: Vec<chunk_axes::Place> = self.places[0].truth[..TIMED]
            .iter()
            .map(|s| self.frames[0].place(&look(s)))
            .collect();
        nanoseconds(&places, |place| components.radiance(place, &share))
    }
}

/// Queries per timed round.
const TIMED: usize = 1000;

fn least(before: Option<f64>, now: f64) -> Option<f64> {
    Some(before.map_or(now, |b| b.min(now)))
}

fn quantiles(errors: impl Iterator<Item = f64>) -> Result<Quantiles> {
    Quantiles::of(errors).context("no held-out samples")
}

fn look(sample: &Sample) -> Look {
    Look {
        view: sample.view_elevation,
        azimuth: sample.view_azimuth,
        sun: sample.solar_elevation,
    }
}

/// Errors of a model file with these factors, rounded as in the file.
fn held_out(
    plan: &Plan,
    (solved, tables): (&[Solved], &Estimate),
    places: &[Place],
    fit: &Fit,
) -> Result<Vec<f64>> {
    let (head, file) = radiance_file(plan, solved, tables.clone(), places, fit)?;
    let model = Model::from_bytes(encode(&head, &file)?)?;
    let mut out = vec![];
    for place in places {
        let visibility = plan.grid.visibilities[place.visibility];
        let errors = assess::errors(&model, visibility, &place.truth)?;
        out.extend(errors.iter().map(|e| e.relative));
    }
    Ok(out)
}

/// Relative errors where there is light.
fn relative(truth: &[Sample], values: impl Iterator<Item = [f32; NW]>) -> Vec<f64> {
    let pairs = truth.iter().zip(values);
    let cells = pairs.flat_map(|(s, v)| s.radiance.into_iter().zip(v));
    cells
        .filter(|(want, _)| *want > 0.0)
        .map(|(want, got)| (f64::from(got) / want - 1.0).abs())
        .collect()
}

fn uncompressed_errors(
    source: &Uncompressed,
    chunk: &Chunk,
    frame: &Frame,
    truth: &[Sample],
) -> Vec<f64> {
    let mut previous: Option<(f64, dense::Slice)> = None;
    let values = truth.iter().map(|sample| {
        let look = look(sample);
        let slice = match previous.take() {
            Some((sun, slice)) if sun == look.sun => slice,
            _ => source.under(&frame.place(&look).elevation),
        };
        let [black, white] = slice.radiance(chunk, frame, &look);
        previous = Some((look.sun, slice));
        std::array::from_fn(|w| {
            let ground = chunk.interreflection(w, sample.albedo as f32);
            black[w] as f32 + ground * white[w] as f32
        })
    });
    relative(truth, values)
}

fn logarithmic_errors(
    fit: &Logarithmic,
    chunk: &Chunk,
    frame: &Frame,
    truth: &[Sample],
) -> (Vec<f64>, f64) {
    let query = |sample: &Sample| {
        let ground = std::array::from_fn(|w| chunk.interreflection(w, sample.albedo as f32));
        (frame.place(&look(sample)), ground)
    };
    let queries: Vec<(chunk_axes::Place, [f32; NW])> = truth.iter().map(query).collect();
    let values = truth.iter().zip(&queries).map(|(sample, (place, ground))| {
        let scale = frame.scale(&look(sample))[DIFFUSE];
        let radiance = fit.radiance(place, ground);
        std::array::from_fn(|w| radiance[w] * scale[w])
    });
    let errors = relative(truth, values);
    let time = nanoseconds(&queries[..TIMED], |(place, ground)| {
        fit.radiance(place, ground)
    });
    (errors, time)
}

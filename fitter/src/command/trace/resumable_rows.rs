//! The work of a run, row by row. What is done is kept, so that an interrupted run goes on where it was.

use super::rows::Row;
use anyhow::{Result, ensure};
use indicatif::{ParallelProgressIterator, ProgressBar, ProgressStyle};
use rayon::prelude::*;
use std::time::Instant;
use welkin_fitter::dataset::Store;
use welkin_fitter::tracer::{PILOT, Tracer};

/// I, Q, U, their standard errors, and the transmittance, at one wavelength.
pub type Answer = [f64; 7];

/// What is to be done.
pub struct Work<'a> {
    /// The tracer.
    pub tracer: &'a Tracer,
    /// The lines of sight.
    pub rows: &'a [Row],
    /// Relative standard error of I to aim at.
    pub target_error: f64,
    /// Limit of time.
    pub max_seconds: Option<f64>,
    /// Samples per batch of every row, instead of what the error needs.
    pub samples: Option<usize>,
    /// Seed of the first row.
    pub seed: u64,
    /// Where finished work is kept.
    pub store: Option<Store>,
}

impl Work<'_> {
    /// Answers by row and wavelength.
    pub fn answers(&self) -> Result<Vec<Vec<Answer>>> {
        let samples = self.plan()?;
        self.rows
            .par_iter()
            .zip(samples)
            .enumerate()
            .progress_with(bar(self.rows.len(), "trace"))
            .map(|(i, (row, samples))| {
                let numbers = self.kept(&format!("row-{i}"), || {
                    let seed = self.seed.wrapping_add(i as u64);
                    let estimate = self.tracer.estimate(&row.query, samples, seed)?;
                    let answer = |w: usize| {
                        let r = estimate.radiance(row.albedo, w);
                        let numbers = r.stokes.into_iter().chain(r.error);
                        numbers.chain([estimate.transmittance(w)])
                    };
                    Ok((0..estimate.wavelengths()).flat_map(answer).collect())
                })?;
                Ok(numbers.as_chunks().0.to_vec())
            })
            .collect()
    }

    /// Samples per batch of each row, cut down in proportion if they would take too long.
    fn plan(&self) -> Result<Vec<usize>> {
        if let Some(samples) = self.samples {
            return Ok(vec![samples; self.rows.len()]);
        }
        let pilots = self
            .rows
            .par_iter()
            .enumerate()
            .progress_with(bar(self.rows.len(), "pilot"))
            .map(|(i, row)| self.kept(&format!("pilot-{i}"), || self.pilot(i, row)))
            .collect::<Result<Vec<_>>>()?;
        let wanted = || pilots.iter().map(|pilot| pilot[0]);
        let Some(limit) = self.max_seconds else {
            return Ok(wanted().map(|n| n as usize).collect());
        };
        ensure!(
            limit.is_finite() && limit > 0.0,
            "--max-seconds {limit} is not positive"
        );
        // Kept, because it depends on the clock and the rows that are done followed it.
        let plan = self.kept("plan", || {
            let threads = rayon::current_num_threads() as f64;
            let spent = pilots.iter().map(|pilot| pilot[1]).sum::<f64>() / threads;
            let per_sample = spent / (self.rows.len() * PILOT) as f64;
            let needed = per_sample * wanted().sum::<f64>();
            let cut = ((limit - spent).max(0.05 * limit) / needed).min(1.0);
            Ok(wanted().map(|n| (n * cut).floor().max(1.0)).collect())
        })?;
        Ok(plan.into_iter().map(|n| n as usize).collect())
    }

    /// Samples that a row wants, and the seconds that it took to find out.
    fn pilot(&self, i: usize, row: &Row) -> Result<Vec<f64>> {
        let start = Instant::now();
        let seed = self.seed.wrapping_add(i as u64);
        let samples = self
            .tracer
            .samples_for(&row.query, self.target_error, row.albedo, seed)?;
        Ok(vec![samples as f64, start.elapsed().as_secs_f64()])
    }

    fn kept(&self, name: &str, compute: impl FnOnce() -> Result<Vec<f64>>) -> Result<Vec<f64>> {
        match &self.store {
            Some(store) => store.unit_f64(name, compute),
            None => compute(),
        }
    }
}

fn bar(length: usize, what: &'static str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg} {bar:40} {pos}/{len} {eta}");
    ProgressBar::new(length as u64)
        .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
        .with_message(what)
}

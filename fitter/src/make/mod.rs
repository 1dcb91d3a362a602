//! From a recipe to a model: what a scene needs of it, built and judged.
//!
//! Data flow: [`Recipe`], [`Axis`] and [`Scene`] → [`Quality`] → [`Plan`] → [`build()`] → [`judge`].

mod axis;
pub mod judge;
mod quality;
mod scene;

pub use axis::Axis;
pub use quality::Quality;
pub use scene::{Bands, Scene};

use crate::air::Air;
use crate::build::build;
use crate::fitting::Fitting;
use crate::recipe::Recipe;
use crate::round_trip::RoundingExceedsFit;
use crate::units::Plan;
use anyhow::{Context, Result};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::time::Instant;
use welkin::Model;
use welkin::format::{Payload, Selection, crop, encode, extend, unpack};
use welkin::output::{Target, write};

/// What is to be made.
#[derive(Clone, Debug)]
pub struct Request {
    /// The air.
    pub recipe: Recipe,
    /// A number of the recipe that the model keeps as an axis, if any.
    pub axis: Option<Axis>,
    /// Where the model is used.
    pub scene: Scene,
    /// How good it is.
    pub quality: Quality,
}

impl Request {
    /// What is traced, and how it is fitted.
    pub fn plan(&self) -> Result<(Plan, Fitting)> {
        let air = match &self.axis {
            Some(axis) => axis.air(),
            None => Air::of(self.recipe.clone())?,
        };
        let (mut plan, fitting) = self.quality.plan(air);
        self.scene.narrow(&mut plan.grid)?;
        plan.grid.check()?;
        Ok((plan, fitting))
    }

    /// What it will take, in words.
    pub fn estimate(&self) -> Result<String> {
        let (plan, fitting) = self.plan()?;
        let cores = rayon::current_num_threads();
        let seconds = self.quality.core_seconds(&plan, fitting) / cores as f64;
        Ok(format!(
            "{}, {}, {}: about {} on {}",
            count(plan.grid.altitudes.len(), "altitude"),
            count(plan.grid.visibilities.len(), "air"),
            count(plan.grid.elevation_sites().len(), "sun"),
            count((seconds / 60.0).ceil() as usize, "minute"),
            count(cores, "core")
        ))
    }

    /// Makes the model file `out`, keeping work units in the folder `work`; returns a report.
    pub fn make(&self, work: &Path, out: &Target) -> Result<String> {
        out.check()?;
        let started = Instant::now();
        let (plan, fitting) = self.plan()?;
        fs::create_dir_all(work).with_context(|| format!("cannot create {}", work.display()))?;
        let path = work.join("whole.welkin");
        let mut report = fitted(&plan, fitting, work, &Target::new(&path))?;
        let bytes = fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
        let bytes = match self.scene.bands {
            Bands::All => bytes,
            Bands::Rgb => colours_only(&bytes)?,
        };
        let bytes = match self.axis.as_ref().and_then(Axis::chunk) {
            Some(chunk) => extend(&bytes, &[chunk])?,
            None => bytes,
        };
        let model = Model::from_bytes(bytes.clone())?;
        // Whoever interrupts the judgement has the model.
        write(&[(out, &bytes)]).context("cannot write the model")?;
        let judgement = judge::judge(&model, &plan, self.axis.as_ref(), self.quality.judged());
        let judgement = judgement.with_context(|| format!("{out} is made, but not judged"))?;
        writeln!(report, "{judgement}")?;
        writeln!(
            report,
            "{} bytes in {out}, {:.0} s in all",
            bytes.len(),
            started.elapsed().as_secs_f64()
        )?;
        Ok(report)
    }
}

/// So many of something.
fn count(number: usize, what: &str) -> String {
    let plural = if number == 1 { "" } else { "s" };
    format!("{number} {what}{plural}")
}

/// Builds with fewer components, where so many cancel each other that half precision spoils them: of few altitudes and
/// suns.
fn fitted(plan: &Plan, mut fitting: Fitting, work: &Path, out: &Target) -> Result<String> {
    /// Fewer would be too few for any sky.
    const LEAST: usize = 12;
    loop {
        let built = build(plan, fitting, work, out);
        let spoilt = |e: &anyhow::Error| e.downcast_ref::<RoundingExceedsFit>().is_some();
        match built {
            Err(error) if spoilt(&error) && fitting.options.rank > LEAST => {
                fitting.options.rank = (fitting.options.rank * 3 / 4).max(LEAST);
            }
            built => return built,
        }
    }
}

/// The file without all wavelengths that colours do not need, and without what lies between them.
fn colours_only(bytes: &[u8]) -> Result<Vec<u8>> {
    let (mut head, mut chunks) = unpack(bytes)?;
    let seen = |w: &usize| head.xyz[*w] != [0.0; 3];
    let wavelengths: Vec<usize> = (0..head.wavelengths.len()).filter(seen).collect();
    chunks.retain(|chunk| !matches!(chunk.payload, Payload::Spectrum(_)));
    let selection = Selection {
        wavelengths,
        ..Selection::all(&head)
    };
    crop(&mut head, &mut chunks, &selection)?;
    Ok(encode(&head, &chunks)?)
}

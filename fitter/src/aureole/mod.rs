//! Models beside the tracer where phase functions show: about the sun, and in the polarisation of the whole sky.
//!
//! Data flow: [`lines::all`] → [`trace`] through air with scattering matrices → [`judge::rows`] of models in it.

pub mod cost;
pub mod judge;
pub mod lines;

use crate::dataset::VISIBLE;
use crate::progress::bar;
use crate::recipe::Recipe;
use crate::tracer::{Options, Query, Radiance, Tracer};
use anyhow::{Context, Result, ensure};
use lines::Line;
use std::f64::consts::FRAC_PI_2;

/// Albedo of the ground.
pub const ALBEDO: f64 = 0.2;

/// A line of sight with its light by wavelength.
#[derive(Clone, Debug)]
pub struct Traced {
    /// The line of sight.
    pub line: Line,
    /// Its light.
    pub light: Vec<Radiance>,
}

/// Indices of the model's nodes at wavelengths in nm, none of them in a line of gases.
pub fn nodes(wavelengths: &[f64]) -> Result<Vec<usize>> {
    let index = |nm: &f64| {
        let at = |node: &crate::atmosphere::Monochromatic| {
            node.wavelength == *nm && node.is_beside_lines()
        };
        let known = VISIBLE.nodes.iter().filter(|n| n.is_beside_lines());
        let known: Vec<String> = known.map(|n| n.wavelength.to_string()).collect();
        VISIBLE
            .nodes
            .iter()
            .position(at)
            .with_context(|| format!("{nm} nm is not one of {}", known.join(", ")))
    };
    wavelengths.iter().map(index).collect()
}

/// Traces `lines` on the ground through the air of `recipe`, to a relative standard error of `noise`, by no more than
/// `most` walks per batch.
pub fn trace(
    recipe: &Recipe,
    (nodes, lines): (&[usize], &[Line]),
    (noise, most): (f64, usize),
) -> Result<Vec<Traced>> {
    ensure!(noise > 0.0 && noise < 1.0, "noise {noise} is outside 0..1");
    let lights: Vec<_> = nodes.iter().map(|&w| VISIBLE.nodes[w]).collect();
    let tracer = Tracer::new(&recipe.air(&lights)?, Options::default())?;
    let progress = bar(lines.len(), "tracing the sky");
    let one = |(i, line): (usize, &Line)| {
        let query = Query {
            altitude: 0.0,
            view_zenith: FRAC_PI_2 - line.view[0],
            view_azimuth: line.view[1],
            sun_elevation: line.sun,
            distance: None,
        };
        let seed = 2 * i as u64;
        let walks = tracer.samples_for(&query, noise, ALBEDO, seed)?.min(most);
        let estimate = tracer.estimate(&query, walks, seed + 1)?;
        progress.inc(1);
        Ok(Traced {
            line: *line,
            light: (0..nodes.len())
                .map(|w| estimate.radiance(ALBEDO, w))
                .collect(),
        })
    };
    let out = lines.iter().enumerate().map(one).collect();
    progress.finish();
    out
}

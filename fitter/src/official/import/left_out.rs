//! How far an imported model is from a file between the solar elevations that it was imported from.

use super::judge::{self, Error};
use crate::assess::Quantiles;
use crate::official::layout::Node;
use crate::official::{Observer, OfficialData};
use anyhow::{Context, Result};
use rayon::prelude::*;
use welkin::Model;

/// What was found there.
#[derive(Clone, Debug)]
pub struct LeftOut {
    /// Relative errors of the model.
    pub imported: Quantiles,
    /// Those of the official interpolation between the same suns.
    pub interpolated: Quantiles,
    /// Both by class, in percent.
    pub report: String,
}

/// Compares with the skies of `whole` under suns that `part`, a selection of it, leaves out: the model that `part`
/// became, and the official interpolation of `part`, each in `count` directions per sky.
///
/// # Errors
/// If a file cannot be read, the model does not reach a condition, or nothing was left out.
pub fn compare(
    whole: &OfficialData,
    part: &OfficialData,
    model: &Model,
    count: usize,
) -> Result<LeftOut> {
    let elevations = &whole.header().axes.elevations;
    let kept = &part.header().axes.elevations;
    let nodes: Vec<_> = whole
        .header()
        .nodes()
        .filter(|node| !kept.contains(&elevations[node.elevation]))
        .collect();
    let imported = |node: Node| {
        let ours = judge::of_model(whole, model, node)?;
        judge::against_stored(whole, node, count, |direction, _| ours(direction))
    };
    let interpolated = |node: Node| {
        let axes = &whole.header().axes;
        let observer = Observer {
            viewpoint: [0.0, 0.0, axes.altitudes[node.altitude]],
            raised: 0.0,
            solar_elevation: elevations[node.elevation].to_radians(),
            solar_azimuth: 0.0,
        };
        let visibility = 1e3 * axes.visibilities[node.visibility];
        let theirs = part.sky(&observer, visibility, axes.albedos[node.albedo])?;
        judge::against_stored(whole, node, count, |direction, side| {
            Ok(theirs.beside_horizon(direction, side)?)
        })
    };
    let all = |errors: &(dyn Fn(_) -> Result<Vec<Error>> + Sync)| -> Result<Vec<Error>> {
        let skies = nodes.par_iter().map(|node| errors(*node));
        Ok(skies.collect::<Result<Vec<_>>>()?.concat())
    };
    let (imported, interpolated) = (all(&imported)?, all(&interpolated)?);
    let quantiles = |errors: &[Error]| {
        let quantiles = Quantiles::of(errors.iter().map(|e| e.relative));
        quantiles.context("no light under the suns that were left out")
    };
    Ok(LeftOut {
        report: judge::table("left out, this model", &imported)
            + &judge::table("left out, official", &interpolated),
        imported: quantiles(&imported)?,
        interpolated: quantiles(&interpolated)?,
    })
}

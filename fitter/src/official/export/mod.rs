//! From a model of welkin to a file that the official code reads.

pub mod breaks;
mod directions;
mod factorise;
mod judge;
mod plan;
mod polarisation;
mod radiance;
mod transmittance;

use super::angles::Frame;
use super::error::OfficialError;
use super::layout::{Header, Node};
use super::tables::{PolarisationTables, RadianceTables};
use super::{OfficialData, Writer};
use crate::progress::bar;
use anyhow::{Context, Result};
pub use plan::Plan;
use polarisation::PolarisedLook;
use radiance::Look;
use rayon::prelude::*;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use welkin::{Bands, Model, PolarisationFrame, Stokes};

/// Writes `out`, which appears when it is whole; gives a report of its errors. Nothing stays of what fails.
///
/// # Errors
/// If the plan is beyond the model, or the file cannot be written.
pub fn export(model: &Model, plan: &Plan, out: &Path) -> Result<String> {
    let header = plan.header();
    header.check()?;
    let bands = plan.bands(model)?;
    let part = temporary(out)?;
    let written = write(model, plan, &header, &bands, &part);
    let report = written.and_then(|bytes| {
        let data = OfficialData::open(&part)?;
        let report = judge::report(&data, model, &bands, plan)?;
        fs::rename(&part, out)?;
        Ok(format!("{report}{bytes} bytes\n"))
    });
    if report.is_err() {
        // Whatever there is of it.
        let _ = fs::remove_file(&part);
    }
    report
}

fn temporary(out: &Path) -> Result<PathBuf> {
    welkin::output::check(out)?;
    let name = out.file_name().context("the target has no name")?;
    let mut name = name.to_os_string();
    name.push(format!(".{}.part", std::process::id()));
    Ok(out.with_file_name(name))
}

fn write(model: &Model, plan: &Plan, header: &Header, bands: &Bands, path: &Path) -> Result<u64> {
    let file = BufWriter::with_capacity(1 << 20, File::create(path)?);
    let mut writer = Writer::new(file, header.clone())?;
    let nodes: Vec<Node> = header.nodes().collect();
    let suns = header.axes.elevations.len();
    let progress = bar(nodes.len(), "radiance");
    for group in nodes.chunks(suns) {
        let tables: Vec<Vec<RadianceTables>> = group
            .par_iter()
            .map(|node| radiance_tables(model, plan, header, bands, *node))
            .collect::<Result<_>>()?;
        tables
            .iter()
            .flatten()
            .try_for_each(|t| writer.radiance(t))?;
        progress.inc(group.len() as u64);
    }
    progress.finish();
    let progress = bar(plan.transmittance_altitudes.len(), "transmittance");
    writer.transmittance(&transmittance::transmittance(
        model,
        (bands, header.channels),
        &plan.transmittance_altitudes,
        &header.axes.visibilities,
        &|| progress.inc(1),
    )?)?;
    progress.finish();
    if plan.polarisation_rank > 0 {
        let breaks = breaks::polarisation(plan.polarisation_rank);
        writer.polarisation(&breaks)?;
        let progress = bar(nodes.len(), "polarisation");
        for group in nodes.chunks(suns) {
            let tables: Vec<Vec<PolarisationTables>> = group
                .par_iter()
                .map(|node| polarisation_tables(model, plan, header, bands, *node))
                .collect::<Result<_>>()?;
            let mut tables = tables.iter().flatten();
            tables.try_for_each(|t| writer.polarisation_tables(t))?;
            progress.inc(group.len() as u64);
        }
        progress.finish();
    }
    let (file, bytes) = writer.finish()?;
    let file = file
        .into_inner()
        .map_err(|e| OfficialError::Write(e.into_error()))?;
    file.sync_all()?;
    Ok(bytes)
}

fn radiance_tables(
    model: &Model,
    plan: &Plan,
    header: &Header,
    bands: &Bands,
    node: Node,
) -> Result<Vec<RadianceTables>> {
    let viewpoint = plan.viewpoint(header, node);
    let frame = Frame::new(&plan.observer(&viewpoint))?;
    let look = Look::new(&viewpoint, &frame)?;
    let sky = model.band_sky(&plan.conditions(header, node), bands)?;
    let directions = single(&look.directions);
    let mut radiance = vec![0.0; directions.len() * bands.count()];
    sky.radiance_batch(&directions, &mut radiance)?;
    Ok(look.tables(&header.breaks, &radiance, bands.count())?)
}

fn polarisation_tables(
    model: &Model,
    plan: &Plan,
    header: &Header,
    bands: &Bands,
    node: Node,
) -> Result<Vec<PolarisationTables>> {
    let breaks = breaks::polarisation(plan.polarisation_rank);
    let viewpoint = plan.viewpoint(header, node);
    let frame = Frame::new(&plan.observer(&viewpoint))?;
    let look = PolarisedLook::new(&viewpoint, &frame, &breaks)?;
    let sky = model.polarised_band_sky(&plan.conditions(header, node), bands)?;
    let mut degree = vec![];
    let mut light = vec![Stokes::default(); bands.count()];
    for direction in single(&look.directions) {
        sky.stokes(direction, PolarisationFrame::SunAligned, &mut light)?;
        degree.extend(light.iter().map(Stokes::signed_degree));
    }
    Ok(look.tables(&breaks, &degree, bands.count())?)
}

fn single(directions: &[[f64; 3]]) -> Vec<[f32; 3]> {
    let narrow = |d: &[f64; 3]| d.map(|v| v as f32);
    directions.iter().map(narrow).collect()
}

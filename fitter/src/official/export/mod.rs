//! From a model of welkin to a file that the official code reads.

pub mod breaks;
mod directions;
mod factorise;
mod judge;
mod polarisation;
mod radiance;
mod transmittance;

use super::angles::{Frame, Observer};
use super::error::OfficialError;
use super::evaluate::OfficialSky;
use super::layout::{Axes, Channels, Header, Node};
use super::tables::{PolarisationTables, RadianceTables};
use super::{OfficialData, Writer};
use crate::progress::bar;
use anyhow::{Context, Result};
use polarisation::PolarisedLook;
use radiance::{Look, Viewpoint};
use rayon::prelude::*;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use welkin::{Bands, Conditions, Model, PolarisationFrame, Response, Stokes};

/// What is exported.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Conditions of the skies; altitudes are those that the file names.
    pub axes: Axes,
    /// Wavelengths.
    pub channels: Channels,
    /// Components of the radiance.
    pub rank: usize,
    /// Components of the polarisation; 0 leaves it out.
    pub polarisation_rank: usize,
    /// Altitudes of the transmittance, m.
    pub transmittance_altitudes: Vec<f64>,
    /// What observers are raised by before the file is asked, m: the sky that it has at an altitude is that of the model
    /// so much below.
    pub raised: f64,
}

impl Default for Plan {
    /// The published ground-level grid.
    fn default() -> Self {
        Self {
            axes: Axes {
                visibilities: breaks::VISIBILITIES.to_vec(),
                albedos: breaks::ALBEDOS.to_vec(),
                altitudes: vec![0.0],
                elevations: breaks::ELEVATIONS.to_vec(),
            },
            channels: Channels {
                count: 11,
                start: 320.0,
                width: 40.0,
            },
            rank: 9,
            polarisation_rank: 0,
            transmittance_altitudes: breaks::ALTITUDES.to_vec(),
            raised: 0.0,
        }
    }
}

impl Plan {
    fn header(&self) -> Header {
        Header {
            axes: self.axes.clone(),
            channels: self.channels,
            breaks: breaks::radiance(self.rank),
        }
    }

    /// The means over the bins.
    fn bands(&self, model: &Model) -> Result<Bands> {
        let responses = (0..self.channels.count).map(|c| {
            let start = self.channels.start + c as f64 * self.channels.width;
            let ends = [start, start + self.channels.width];
            Ok(Response::table(&ends, &[1.0, 1.0])?.normalised())
        });
        let responses = responses.collect::<Result<Vec<_>>>()?;
        let within = "the channels must lie within the wavelengths of the model";
        model.bands(&responses).context(within)
    }

    /// Where a stored sky is seen from.
    fn viewpoint(&self, header: &Header, node: Node) -> Viewpoint {
        Viewpoint {
            altitude: (header.axes.altitudes[node.altitude] - self.raised).max(0.0),
            solar_elevation: header.axes.elevations[node.elevation].to_radians(),
        }
    }

    /// A stored sky as that observer is shown it.
    fn stored_sky<'a>(&self, data: &'a OfficialData, node: Node) -> Result<OfficialSky<'a>> {
        let viewpoint = self.viewpoint(data.header(), node);
        Ok(data.stored_sky_of(node, &self.observer(&viewpoint))?)
    }

    /// The observer who is shown that sky.
    fn observer(&self, viewpoint: &Viewpoint) -> Observer {
        Observer {
            viewpoint: [0.0, 0.0, viewpoint.altitude],
            raised: self.raised,
            solar_elevation: viewpoint.solar_elevation,
            solar_azimuth: 0.0,
        }
    }

    fn conditions(&self, header: &Header, node: Node) -> Conditions {
        let viewpoint = self.viewpoint(header, node);
        Conditions {
            altitude: viewpoint.altitude,
            visibility: 1e3 * header.axes.visibilities[node.visibility],
            albedo: header.axes.albedos[node.albedo],
            solar_elevation: viewpoint.solar_elevation,
            solar_azimuth: 0.0,
        }
    }
}

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

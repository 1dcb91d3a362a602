//! What an export is made of.

use super::breaks;
use super::radiance::Viewpoint;
use crate::official::OfficialData;
use crate::official::angles::Observer;
use crate::official::evaluate::OfficialSky;
use crate::official::layout::{Axes, Channels, Header, Node};
use anyhow::{Context, Result};
use welkin::{Bands, Conditions, Model, Response};

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
    pub(super) fn header(&self) -> Header {
        Header {
            axes: self.axes.clone(),
            channels: self.channels,
            breaks: breaks::radiance(self.rank),
        }
    }

    /// The means over the bins.
    pub(super) fn bands(&self, model: &Model) -> Result<Bands> {
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
    pub(super) fn viewpoint(&self, header: &Header, node: Node) -> Viewpoint {
        Viewpoint {
            altitude: (header.axes.altitudes[node.altitude] - self.raised).max(0.0),
            solar_elevation: header.axes.elevations[node.elevation].to_radians(),
        }
    }

    /// A stored sky as that observer is shown it.
    pub(super) fn stored_sky<'a>(
        &self,
        data: &'a OfficialData,
        node: Node,
    ) -> Result<OfficialSky<'a>> {
        let viewpoint = self.viewpoint(data.header(), node);
        Ok(data.stored_sky_of(node, &self.observer(&viewpoint))?)
    }

    /// The observer who is shown that sky.
    pub(super) fn observer(&self, viewpoint: &Viewpoint) -> Observer {
        Observer {
            viewpoint: [0.0, 0.0, viewpoint.altitude],
            raised: self.raised,
            solar_elevation: viewpoint.solar_elevation,
            solar_azimuth: 0.0,
        }
    }

    pub(super) fn conditions(&self, header: &Header, node: Node) -> Conditions {
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

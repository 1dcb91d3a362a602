//! The official model exactly as its formulas have it: multilinear between the skies that are stored.

use super::angles::{Angles, Frame, Observer, Vector};
use super::between::Between;
use super::error::{OfficialError, Result};
use super::layout::Node;
use super::read::OfficialData;
use super::tables::{Place, PolarisationTables, RadianceTables};
use std::f64::consts::{FRAC_PI_2, PI};
use welkin::geometry::Side;

/// Below the geometric horizon, the ramp of the emphasis is over after this, rad.
const RAMP: f64 = 0.5 * PI / 180.0;

/// The last break before an angle.
fn before(breaks: &[f64], angle: f64) -> f64 {
    let below = breaks.iter().rev().find(|b| **b < angle - 1e-9);
    below.copied().unwrap_or(breaks[0])
}

/// A sky of the official model: all conditions but the view direction are set.
pub struct OfficialSky<'a> {
    data: &'a OfficialData,
    frame: Frame,
    corners: Vec<(Node, f64)>,
    /// `[corner][channel]`.
    radiance: Vec<Vec<RadianceTables>>,
}

/// The same of the degree of polarisation.
pub struct OfficialPolarisation<'a> {
    data: &'a OfficialData,
    frame: Frame,
    corners: Vec<(Node, f64)>,
    tables: Vec<Vec<PolarisationTables>>,
}

impl OfficialData {
    /// The sky for an observer, a visibility (m) and a ground albedo; conditions beyond the data count as the nearest
    /// there are.
    ///
    /// # Errors
    /// [`OfficialError`] if a condition is not finite or the data cannot be read.
    pub fn sky(
        &self,
        observer: &Observer,
        visibility: f64,
        albedo: f64,
    ) -> Result<OfficialSky<'_>> {
        let frame = Frame::new(observer)?;
        let corners = corners(self, &frame, visibility, albedo)?;
        let channels = self.header().channels.count;
        let tables = |(node, _): &(Node, f64)| {
            let channels = 0..channels;
            channels.map(|c| self.radiance_tables(*node, c)).collect()
        };
        let radiance = corners.iter().map(tables).collect::<Result<_>>()?;
        Ok(OfficialSky {
            data: self,
            frame,
            corners,
            radiance,
        })
    }

    /// A sky as it is stored, of an observer above the origin under a sun at azimuth 0, not raised.
    ///
    /// # Errors
    /// As [`OfficialData::radiance_tables`].
    pub fn stored_sky(&self, node: Node) -> Result<OfficialSky<'_>> {
        self.stored_sky_of(node, &self.stored_observer(node))
    }

    /// A stored sky as an observer is shown it.
    ///
    /// # Errors
    /// As [`OfficialData::sky`].
    pub fn stored_sky_of(&self, node: Node, observer: &Observer) -> Result<OfficialSky<'_>> {
        let mut frame = Frame::new(observer)?;
        // Not by way of a cosine, which could say of a sun on the horizon that it is below.
        frame.solar_elevation = self.header().axes.elevations[node.elevation].to_radians();
        let channels = 0..self.header().channels.count;
        let tables = channels.map(|c| self.radiance_tables(node, c));
        Ok(OfficialSky {
            data: self,
            frame,
            corners: vec![(node, 1.0)],
            radiance: vec![tables.collect::<Result<_>>()?],
        })
    }

    /// The degree of polarisation as it is stored.
    ///
    /// # Errors
    /// As [`OfficialData::polarisation_tables`].
    pub fn stored_polarisation(&self, node: Node) -> Result<OfficialPolarisation<'_>> {
        let channels = 0..self.header().channels.count;
        let tables = channels.map(|c| self.polarisation_tables(node, c));
        Ok(OfficialPolarisation {
            data: self,
            frame: Frame::new(&self.stored_observer(node))?,
            corners: vec![(node, 1.0)],
            tables: vec![tables.collect::<Result<_>>()?],
        })
    }

    fn stored_observer(&self, node: Node) -> Observer {
        let axes = &self.header().axes;
        Observer {
            viewpoint: [0.0, 0.0, axes.altitudes[node.altitude]],
            raised: 0.0,
            solar_elevation: axes.elevations[node.elevation].to_radians(),
            solar_azimuth: 0.0,
        }
    }

    /// The degree of polarisation of the same.
    ///
    /// # Errors
    /// As [`OfficialData::sky`]; [`OfficialError::Missing`] if the file has none.
    pub fn polarised(
        &self,
        observer: &Observer,
        visibility: f64,
        albedo: f64,
    ) -> Result<OfficialPolarisation<'_>> {
        let frame = Frame::new(observer)?;
        let corners = corners(self, &frame, visibility, albedo)?;
        let channels = self.header().channels.count;
        let tables = |(node, _): &(Node, f64)| {
            let channels = 0..channels;
            channels
                .map(|c| self.polarisation_tables(*node, c))
                .collect()
        };
        let tables = corners.iter().map(tables).collect::<Result<_>>()?;
        Ok(OfficialPolarisation {
            data: self,
            frame,
            corners,
            tables,
        })
    }
}

impl OfficialSky<'_> {
    /// Radiance in every channel, W m⁻² sr⁻¹ nm⁻¹.
    ///
    /// # Errors
    /// [`OfficialError::Direction`].
    pub fn radiance(&self, direction: Vector) -> Result<Vec<f64>> {
        Ok(self.at(&self.frame.angles(direction)?))
    }

    /// Radiance in every channel, with the emphasis of a direction at least half a degree above or below the geometric
    /// horizon: without the ramp that tables make of the step there.
    ///
    /// # Errors
    /// [`OfficialError::Direction`].
    pub fn beside_horizon(&self, direction: Vector, side: Side) -> Result<Vec<f64>> {
        let mut angles = self.frame.angles(direction)?;
        let alpha = angles.alpha(self.frame.solar_elevation);
        let breaks = &self.data.header().breaks.emphasis;
        angles.zero = match side {
            Side::Up => angles.zero.min(before(breaks, FRAC_PI_2)),
            Side::Down => angles.zero.max(FRAC_PI_2 + RAMP),
        };
        Ok(self.sum(&angles, alpha))
    }

    /// Memory of its tables.
    pub fn bytes(&self) -> usize {
        let tables = self.radiance.iter().flatten();
        tables.map(RadianceTables::bytes).sum()
    }

    fn at(&self, angles: &Angles) -> Vec<f64> {
        self.sum(angles, angles.alpha(self.frame.solar_elevation))
    }

    fn sum(&self, angles: &Angles, alpha: f64) -> Vec<f64> {
        let breaks = &self.data.header().breaks;
        let places = [
            Place::new(&breaks.sun, angles.gamma),
            Place::new(&breaks.zenith, alpha),
            Place::new(&breaks.emphasis, angles.zero),
        ];
        let mut sum = vec![0.0; self.data.header().channels.count];
        for ((_, weight), tables) in self.corners.iter().zip(&self.radiance) {
            for (sum, tables) in sum.iter_mut().zip(tables) {
                *sum += weight * tables.at(breaks, places);
            }
        }
        sum
    }
}

impl OfficialPolarisation<'_> {
    /// Degree of polarisation in every channel: positive across the plane of view and sun.
    ///
    /// # Errors
    /// [`OfficialError::Direction`]; [`OfficialError::Missing`].
    pub fn degree(&self, direction: Vector) -> Result<Vec<f64>> {
        let Some(breaks) = self.data.polarisation() else {
            return Err(OfficialError::Missing(super::error::Section::Polarisation));
        };
        let angles = self.frame.angles(direction)?;
        let places = [
            Place::new(&breaks.sun, angles.gamma),
            Place::new(&breaks.zenith, angles.zero),
        ];
        let mut sum = vec![0.0; self.data.header().channels.count];
        for ((_, weight), tables) in self.corners.iter().zip(&self.tables) {
            for (sum, tables) in sum.iter_mut().zip(tables) {
                *sum -= weight * tables.at(breaks, places);
            }
        }
        Ok(sum)
    }
}

/// The stored skies around the conditions, at most sixteen, and their weights.
fn corners(
    data: &OfficialData,
    frame: &Frame,
    visibility: f64,
    albedo: f64,
) -> Result<Vec<(Node, f64)>> {
    for (what, value) in [("the visibility", visibility), ("the albedo", albedo)] {
        if !value.is_finite() {
            return Err(OfficialError::Condition(what));
        }
    }
    let axes = &data.header().axes;
    let elevation = frame.solar_elevation.to_degrees();
    let mut out = vec![];
    for (v, by_visibility) in Between::new(&axes.visibilities, visibility / 1e3).corners() {
        for (a, by_albedo) in Between::new(&axes.albedos, albedo).corners() {
            for (h, by_altitude) in Between::new(&axes.altitudes, frame.altitude).corners() {
                for (e, by_elevation) in Between::new(&axes.elevations, elevation).corners() {
                    let node = Node {
                        visibility: v,
                        albedo: a,
                        altitude: h,
                        elevation: e,
                    };
                    out.push((node, by_visibility * by_albedo * by_altitude * by_elevation));
                }
            }
        }
    }
    Ok(out)
}

//! The degree of polarisation of one sky in all channels.

use super::directions::directions;
use super::factorise::{Factors, Point};
use super::radiance::{Viewpoint, by_component};
use crate::official::angles::Frame;
use crate::official::error::{OfficialError, Result};
use crate::official::layout::PolarisationBreaks;
use crate::official::tables::{Place, PolarisationTables};

/// Directions per sky.
const DIRECTIONS: usize = 6000;
/// Sweeps for the first channel, and for those that start from their neighbour.
const SWEEPS: [usize; 2] = [16, 5];

/// What the directions of a sky are to the tables of the polarisation.
pub struct PolarisedLook {
    /// The directions.
    pub directions: Vec<[f64; 3]>,
    places: Vec<[Place; 2]>,
}

impl PolarisedLook {
    /// Of a sky.
    ///
    /// # Errors
    /// [`OfficialError::Direction`].
    pub fn new(viewpoint: &Viewpoint, frame: &Frame, breaks: &PolarisationBreaks) -> Result<Self> {
        let directions = directions(viewpoint.altitude, viewpoint.solar_elevation, DIRECTIONS);
        let place = |d: &[f64; 3]| {
            let angles = frame.angles(*d)?;
            Ok([
                Place::new(&breaks.sun, angles.gamma),
                Place::new(&breaks.zenith, angles.zero),
            ])
        };
        Ok(Self {
            places: directions.iter().map(place).collect::<Result<_>>()?,
            directions,
        })
    }

    /// Tables of every channel from signed degrees `[direction][channel]`, positive across the plane of view and sun.
    ///
    /// # Errors
    /// [`OfficialError::Value`] for degrees that are not finite.
    pub fn tables(
        &self,
        breaks: &PolarisationBreaks,
        degree: &[f32],
        channels: usize,
    ) -> Result<Vec<PolarisationTables>> {
        if let Some(bad) = degree.iter().find(|d| !d.is_finite()) {
            return Err(OfficialError::value(
                crate::official::Section::Polarisation,
                "a degree",
                format!("got {bad}"),
            ));
        }
        let mut factors = Factors::start(breaks.rank, &breaks.sun, breaks.zenith.len());
        let mut out = vec![];
        for c in 0..channels {
            let points = self
                .places
                .iter()
                .enumerate()
                .map(|(i, [sun, zenith])| Point {
                    sun: *sun,
                    zenith: *zenith,
                    factor: 1.0,
                    // The file holds the degree with the opposite sign.
                    value: -f64::from(degree[i * channels + c]),
                    weight: 1.0,
                });
            let points: Vec<Point> = points.collect();
            factors.improve(&points, SWEEPS[usize::from(c > 0)]);
            out.push(PolarisationTables {
                sun: by_component(&factors.sun, breaks.rank),
                zenith: by_component(&factors.zenith, breaks.rank),
            });
        }
        Ok(out)
    }
}

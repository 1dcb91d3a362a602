//! Skies as small tables: a query costs little more than reading them.
//!
//! `frame` turns directions into coordinates, `spline` coordinates into taps, `table` sums; `bake` makes the tables, a `surface` for
//! each side of the horizon, and `quality` chooses their size by comparing at `sites`; `degrees` and `turn` add polarisation; `spectral`, `colour`, `polarised` and the two of `hero`
//! are the public faces.
#![allow(clippy::needless_range_loop)] // As in `lanes`.

mod bake;
mod batch;
mod colour;
mod degrees;
mod frame;
mod hero;
mod hero_stokes;
mod irradiance;
mod lattice;
mod polarised;
mod quality;
mod sampler;
mod sites;
mod spectral;
mod spline;
mod surface;
mod table;
mod turn;

pub use batch::Directions;
pub use colour::BakedColour;
pub use polarised::BakedPolarisedSky;
pub use quality::BakeError;
pub use sampler::{Part, Sample, SkySampler};
pub use spectral::BakedSky;

use crate::conditions::Conditions;
use crate::error::{Error, Result};
use crate::format::Head;
use crate::sky::Sky;
use bake::Channels;
use frame::Frame;
use table::Table;

/// Most bytes that a baked sky of a model holds on the heap.
pub(crate) fn largest_bytes(channels: crate::Channels, head: &Head) -> usize {
    let n = head.wavelengths.len();
    match channels {
        crate::Channels::Spectral => quality::largest_table(n, 16) + spectral::axis_bytes(head),
        crate::Channels::Colour => quality::largest_table(3, 4),
        crate::Channels::Stokes => {
            largest_bytes(crate::Channels::Spectral, head) + degrees::largest_table(n)
        }
    }
}

/// What baked skies have in common.
#[derive(Clone, Debug)]
struct Baked<const N: usize> {
    conditions: Conditions,
    frame: Frame,
    table: Table<N>,
    error: BakeError,
}

/// Smallest relative error that the largest table keeps for most skies.
const LEAST_TOLERANCE: f64 = 3e-4;

/// The one rule for what may be asked of baking, for those who bake and those who plan to.
pub(crate) fn check_tolerance(tolerance: f64) -> Result<()> {
    if tolerance >= LEAST_TOLERANCE && tolerance.is_finite() {
        return Ok(());
    }
    Err(Error::OutOfRange {
        parameter: "tolerance",
        value: tolerance,
        min: LEAST_TOLERANCE,
        max: f64::MAX,
        unit: "",
    })
}

impl<const N: usize> Baked<N> {
    fn new(sky: &Sky, channels: &impl Channels<N>, tolerance: f64) -> Result<Self> {
        check_tolerance(tolerance)?;
        let frame = Frame::new(sky);
        let (table, error) = bake::table(sky, channels, &frame, tolerance)?;
        Ok(Self {
            conditions: *sky.conditions(),
            frame,
            table,
            error,
        })
    }

    fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        let moved = self.conditions.with_solar_azimuth(azimuth)?;
        self.conditions = moved;
        self.frame.turn(&moved);
        Ok(())
    }
}

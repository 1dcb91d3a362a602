//! Skies as small tables: a query costs little more than reading them.
//!
//! `coordinates` turns directions into places in tables, `spline` those into taps, `spline_table` sums. `fill` makes
//! the tables, a `hemisphere_spline` for each side of the horizon, and `grid_choice` their sizes, by the loops of
//! `refinement`, which compare at `comparison_sites`; `polarisation_table` and `frame_rotation` add polarisation.
//! `batch` has the one loop over directions, and `baked_spectral`, `baked_colour`, `baked_polarised` and the two of
//! `hero` are the public faces.
#![allow(clippy::needless_range_loop)] // As in `lanes`.

mod baked_colour;
mod baked_polarised;
mod baked_spectral;
mod batch;
mod comparison_sites;
mod coordinates;
mod fill;
mod frame_rotation;
mod grid_choice;
mod grid_nodes;
mod hemisphere_spline;
mod hero_stokes;
mod hero_wavelengths;
mod irradiance;
mod polarisation_table;
mod refinement;
mod sampler;
mod spline;
mod spline_size;
mod spline_table;

pub use baked_colour::BakedColourSky;
pub use baked_polarised::BakedPolarisedSky;
pub use baked_spectral::BakedSky;
pub use batch::Directions;
pub use grid_choice::BakeError;
pub use sampler::{Part, Sample, SkySampler};

use crate::conditions::Conditions;
use crate::error::{Error, Result};
use crate::format::Head;
use crate::kernel::simd::dispatch;
use crate::sky::Sky;
use batch::{Each, One, Sink};
use coordinates::Frame;
use fill::Channels;
use spline_table::Table;

/// Most bytes that a baked sky of a model holds on the heap.
pub(crate) fn largest_bytes(channels: crate::Channels, head: &Head) -> usize {
    let n = head.wavelengths.len();
    match channels {
        crate::Channels::Spectral => {
            grid_choice::largest_table(n, 16) + baked_spectral::axis_bytes(head)
        }
        crate::Channels::Colour => grid_choice::largest_table(3, 4),
        crate::Channels::Stokes => {
            largest_bytes(crate::Channels::Spectral, head) + polarisation_table::largest_table(n)
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
        let (table, error) = fill::table(sky, channels, &frame, tolerance)?;
        Ok(Self {
            conditions: *sky.conditions(),
            frame,
            table,
            error,
        })
    }

    /// Looks up one direction.
    #[inline(always)]
    fn one(&self, direction: [f32; 3], sink: impl Sink<N>) -> Result<()> {
        dispatch(One {
            frame: &self.frame,
            table: &self.table,
            direction,
            sink,
        })
    }

    /// Looks up many directions, which were checked.
    #[inline(always)]
    fn each(&self, directions: &Directions, sink: impl Sink<N>) -> Result<()> {
        dispatch(Each {
            frame: &self.frame,
            table: &self.table,
            directions: *directions,
            sink,
        })
    }

    fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        let moved = self.conditions.with_solar_azimuth(azimuth)?;
        self.conditions = moved;
        self.frame.turn(&moved);
        Ok(())
    }
}

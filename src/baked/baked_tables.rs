//! What baked skies have in common.

use super::batch::{Directions, Each, One, Sink};
use super::coordinates::LocalFrame;
use super::fill::{self, Channels};
use super::grid_choice::BakeError;
use super::spline_table::Table;
use crate::conditions::Conditions;
use crate::error::{Error, Result};
use crate::kernel::simd::dispatch;
use crate::sky::Sky;

/// What baked skies have in common.
#[derive(Clone, Debug)]
pub(super) struct Baked<const N: usize> {
    pub conditions: Conditions,
    pub frame: LocalFrame,
    pub table: Table<N>,
    pub error: BakeError,
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
    pub fn new(sky: &Sky, channels: &impl Channels<N>, tolerance: f64) -> Result<Self> {
        check_tolerance(tolerance)?;
        let frame = LocalFrame::new(sky);
        let (table, error) = fill::table(sky, channels, &frame, tolerance)?;
        Ok(Self {
            conditions: *sky.conditions(),
            frame,
            table,
            error,
        })
    }

    /// With tables of the same sizes, whose error is not measured again.
    pub fn like(&self, sky: &Sky, channels: &impl Channels<N>) -> Self {
        Self {
            conditions: *sky.conditions(),
            frame: LocalFrame::new(sky),
            table: fill::table_of(sky, channels, self.table.grid),
            error: self.error,
        }
    }

    /// Looks up one direction.
    #[inline(always)]
    pub fn one(&self, direction: [f32; 3], sink: impl Sink<N>) -> Result<()> {
        dispatch(One {
            frame: &self.frame,
            table: &self.table,
            direction,
            sink,
        })
    }

    /// Looks up many directions, which were checked.
    #[inline(always)]
    pub fn each(&self, directions: &Directions, sink: impl Sink<N>) -> Result<()> {
        dispatch(Each {
            frame: &self.frame,
            table: &self.table,
            directions: *directions,
            sink,
        })
    }

    pub fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        let moved = self.conditions.with_solar_azimuth(azimuth)?;
        self.conditions = moved;
        self.frame.turn(&moved);
        Ok(())
    }
}

//! What a query asks, and where it stands on the axes of a model.

use super::contraction::{self, Components};
use super::head_view::HeadView;
use super::neighbours::Nodes;
use crate::conditions::{Conditions, grounded};
use crate::error::{Error, Result};
use crate::estimate::Sightline;
use crate::format::BasisView;
use crate::geometry::Ray;
use crate::kernel::axis::Taps;
#[cfg(not(feature = "std"))]
use crate::kernel::real::Real;
use crate::kernel::simd::Instructions;
use crate::phase_function::SunAngle;

/// Taps on every axis.
pub(super) struct QueryCoordinates {
    pub altitudes: Nodes,
    pub visibilities: Nodes,
    /// Angle from the horizon, and solar elevation.
    pub curve: [Taps; 2],
    pub phi: Taps,
    /// What the azimuth counts.
    pub fade: f64,
    pub ray: Ray,
    pub line: Sightline,
    pub angle: SunAngle,
    pub albedo: f64,
}

/// What is asked, checked.
pub(super) struct Question {
    pub conditions: Conditions,
    /// The view direction as it came, and with length 1.
    pub view: [f64; 3],
    pub unit: [f64; 3],
}

impl Question {
    pub fn new(head: &HeadView, conditions: &Conditions, direction: [f32; 3]) -> Result<Self> {
        let conditions = checked(head, conditions)?;
        let [x, y, z] = direction;
        let [x, y, z] = [f64::from(x), f64::from(y), f64::from(z)];
        let square = x * x + y * y + z * z;
        if !(square > 0.0 && square.is_finite()) {
            return Err(Error::Direction { got: direction });
        }
        let shrink = 1.0 / square.sqrt();
        Ok(Self {
            conditions,
            view: [x, y, z],
            unit: [x * shrink, y * shrink, z * shrink],
        })
    }
}

impl QueryCoordinates {
    /// Turns the components towards the azimuth.
    #[inline(always)]
    pub fn turn<I: Instructions>(&self, instructions: I, basis: &BasisView, sum: &mut Components) {
        match self.fade < 1.0 {
            true => contraction::multiply(sum, &contraction::faded(basis, self.phi, self.fade)),
            false => contraction::turn(instructions, basis, &self.phi, sum),
        }
    }
}

/// Conditions within the axes; a relative excess of 1e-9 is rounding and gets clamped.
fn checked(head: &HeadView, conditions: &Conditions) -> Result<Conditions> {
    let ends = |axis: &[zerocopy::little_endian::F64]| [axis[0].get(), axis[axis.len() - 1].get()];
    let check = |parameter, value: f64, [min, max]: [f64; 2], unit| {
        let slack = 1e-9 * min.abs().max(max.abs()).min(1e12);
        match value.is_finite() && value >= min - slack && value <= max + slack {
            true => Ok(value.clamp(min, max)),
            false => Err(Error::OutOfRange {
                parameter,
                value,
                min,
                max,
                unit,
            }),
        }
    };
    let axis = &head.elevation;
    Ok(Conditions {
        solar_elevation: check(
            "solar_elevation",
            conditions.solar_elevation,
            [axis.min, axis.max],
            "rad",
        )?,
        solar_azimuth: check(
            "solar_azimuth",
            conditions.solar_azimuth,
            [f64::MIN, f64::MAX],
            "rad",
        )?,
        visibility: check(
            "visibility",
            conditions.visibility,
            ends(head.visibilities),
            "m",
        )?,
        albedo: check("albedo", conditions.albedo, [0.0, 1.0], "")?,
        altitude: check(
            "altitude",
            grounded(conditions.altitude),
            ends(head.altitudes),
            "m",
        )?,
    })
}

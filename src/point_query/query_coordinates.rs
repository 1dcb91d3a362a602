//! Where a query stands on the axes of a model.

use super::contraction::{self, Components};
use super::head_view::HeadView;
use super::neighbours::{Axis, Interpolation, Nodes};
use crate::azimuth_fade::azimuthal;
use crate::conditions::{Conditions, grounded};
use crate::error::{Error, Result};
use crate::format::BasisView;
use crate::geometry::{Ray, Side};
use crate::kernel::axis::{Ends, Taps, alpha_coordinate, chord, spline};
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
    /// The same, coarser.
    pub chord: [Taps<2>; 2],
    pub phi: Taps,
    /// What the azimuth counts.
    pub fade: f64,
    pub ray: Ray,
    pub angle: SunAngle,
    pub albedo: f64,
}

/// What is asked, checked.
pub(super) struct Question {
    conditions: Conditions,
    /// The view direction as it came, and with length 1.
    view: [f64; 3],
    unit: [f64; 3],
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
    #[inline(always)]
    pub fn new(
        head: &HeadView,
        [altitudes, visibilities]: &[Axis; 2],
        suns: [f64; 2],
        interpolation: Interpolation,
        question: &Question,
    ) -> Self {
        let [over_altitude, over_visibility] = interpolation.curves();
        let Question {
            conditions,
            view: [x, y, z],
            unit,
        } = question;
        let dip = head.planet.dip(conditions.altitude);
        let elevation = z.atan2((x * x + y * y).sqrt());
        let ray = head
            .planet
            .ray_with_dip(conditions.altitude, dip, elevation, unit[2]);
        let (intervals, exponent) = head.alpha[usize::from(ray.side == Side::Down)];
        let alpha = alpha_coordinate(ray.angle, ray.range, intervals, exponent);
        let (sine, cosine) = conditions.solar_azimuth.sin_cos();
        let (sun_z, sun_r) = conditions.solar_elevation.sin_cos();
        let [across, along] = [(x * sine - y * cosine).abs(), x * cosine + y * sine];
        // Plus zero: at the zenith the sum can be -0, of which the arc tangent is half a turn.
        let phi = (across as f32).atan2(along as f32 + 0.0);
        let phi = head.phi_intervals as f64 * f64::from(phi) / core::f64::consts::PI;
        let axis = &head.elevation;
        let sun = axis.coordinate_between(suns, conditions.solar_elevation);
        Self {
            altitudes: altitudes.around(conditions.altitude.cbrt(), over_altitude),
            visibilities: visibilities.around(1.0 / conditions.visibility, over_visibility),
            curve: [
                spline(alpha, intervals, Ends::Free),
                spline(sun, axis.intervals, Ends::Free),
            ],
            chord: [chord(alpha, intervals), chord(sun, axis.intervals)],
            phi: spline(phi, head.phi_intervals, Ends::Mirrored),
            fade: azimuthal(sun_r),
            angle: SunAngle::between(*unit, [sun_r * cosine, sun_r * sine, sun_z]),
            ray,
            albedo: conditions.albedo,
        }
    }

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

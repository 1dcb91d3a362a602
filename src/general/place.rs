//! Where a query stands on the axes of a model.

use super::head::HeadView;
use crate::axis::{Ends, Stencil, Taps, alpha_coordinate, hermite, linear, spline};
use crate::conditions::Conditions;
use crate::error::{Error, Result};
use crate::geometry::{Ray, Side};
use crate::phase::SunAngle;
#[cfg(not(feature = "std"))]
use crate::real::Real;

/// Taps on every axis.
pub(super) struct Place {
    pub altitudes: Stencil,
    pub visibilities: Stencil,
    pub visibilities_linear: Stencil,
    pub elevation: Taps,
    pub alpha: Taps,
    pub phi: Taps,
    pub ray: Ray,
    pub angle: SunAngle,
    pub albedo: f64,
}

impl Place {
    pub fn new(
        head: &HeadView,
        altitudes: &[f64],
        conditions: &Conditions,
        direction: [f32; 3],
    ) -> Result<Self> {
        let conditions = checked(head, conditions)?;
        let [x, y, z] = direction.map(f64::from);
        let horizontal = x * x + y * y;
        let square = horizontal + z * z;
        if !(square > 0.0 && square.is_finite()) {
            return Err(Error::Direction { got: direction });
        }
        let shrink = 1.0 / square.sqrt();
        let unit = [x * shrink, y * shrink, z * shrink];
        let dip = head.planet.dip(conditions.altitude);
        let elevation = z.atan2(horizontal.sqrt());
        let ray = head
            .planet
            .ray_with_dip(conditions.altitude, dip, elevation, unit[2]);
        let (intervals, exponent) = head.alpha[usize::from(ray.side == Side::Down)];
        let alpha = alpha_coordinate(ray.angle, ray.range, intervals, exponent);
        let (sine, cosine) = conditions.solar_azimuth.sin_cos();
        let (sun_z, sun_r) = conditions.solar_elevation.sin_cos();
        let phi = (x * sine - y * cosine).abs().atan2(x * cosine + y * sine);
        let phi = head.phi_intervals as f64 * phi / core::f64::consts::PI;
        let inverse = 1.0 / conditions.visibility;
        let axis = &head.elevation;
        Ok(Self {
            altitudes: hermite(
                &altitudes[..head.altitudes.len()],
                conditions.altitude.cbrt(),
            ),
            visibilities: at_visibility(head, inverse, hermite),
            visibilities_linear: at_visibility(head, inverse, linear),
            elevation: spline(
                axis.coordinate(conditions.solar_elevation),
                axis.intervals,
                Ends::Free,
            ),
            alpha: spline(alpha, intervals, Ends::Free),
            phi: spline(phi, head.phi_intervals, Ends::Mirrored),
            angle: SunAngle::between(unit, [sun_r * cosine, sun_r * sine, sun_z]),
            ray,
            albedo: conditions.albedo,
        })
    }
}

/// Weights among the visibilities around one: no more than four count.
fn at_visibility(
    head: &HeadView,
    inverse: f64,
    weights: impl Fn(&[f64], f64) -> Stencil,
) -> Stencil {
    let all = head.visibilities;
    let above = all
        .partition_point(|v| 1.0 / v.get() >= inverse)
        .clamp(1, all.len().max(2) - 1);
    let first = above.saturating_sub(2);
    let window = &all[first..(above + 2).min(all.len())];
    let mut nodes = [0.0; 4];
    for (node, v) in nodes.iter_mut().zip(window) {
        *node = 1.0 / v.get();
    }
    let mut stencil = weights(&nodes[..window.len()], inverse);
    stencil.first += first;
    stencil
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
        altitude: check("altitude", conditions.altitude, ends(head.altitudes), "m")?,
    })
}

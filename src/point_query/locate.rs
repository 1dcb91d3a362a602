//! Where a question stands on the axes of a model.

use super::opened::PointQuery;
use super::query_coordinates::{QueryCoordinates, Question};
use crate::azimuth_fade::azimuthal;
use crate::estimate::Sightline;
use crate::geometry::Side;
use crate::kernel::axis::{Ends, alpha_coordinate, spline};
#[cfg(not(feature = "std"))]
use crate::kernel::real::Real;
use crate::phase_function::SunAngle;

impl PointQuery<'_> {
    #[inline(always)]
    pub(super) fn coordinates(&self, question: &Question) -> QueryCoordinates {
        let (head, [altitudes, visibilities]) = (&self.head, &self.axes);
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
        let horizontal = (x * x + y * y).sqrt();
        let shrink = if horizontal > 0.0 {
            1.0 / horizontal
        } else {
            0.0
        };
        let line = Sightline {
            altitude: conditions.altitude,
            ray: [unit[2], (unit[0] * unit[0] + unit[1] * unit[1]).sqrt()],
            side: ray.side,
            sun: [sun_z, sun_r],
            azimuth: along * shrink,
        };
        let phi = head.phi_intervals as f64 * f64::from(phi) / core::f64::consts::PI;
        let axis = &head.elevation;
        let sun = axis.coordinate_between(self.suns, conditions.solar_elevation);
        QueryCoordinates {
            altitudes: altitudes.around(conditions.altitude.cbrt(), self.interpolation),
            visibilities: visibilities.around(1.0 / conditions.visibility, self.interpolation),
            curve: [
                spline(alpha, intervals, Ends::Free),
                spline(sun, axis.intervals, Ends::Free),
            ],
            phi: spline(phi, head.phi_intervals, Ends::Mirrored),
            fade: azimuthal(sun_r),
            angle: SunAngle::between(*unit, [sun_r * cosine, sun_r * sine, sun_z]),
            ray,
            line,
            albedo: conditions.albedo,
        }
    }
}

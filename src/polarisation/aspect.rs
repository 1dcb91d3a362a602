//! How a view direction stands to the sun and to the axes of polarisation. Format specification, section 7.5.

use crate::error::{Error, Result};

/// Where the axis `e1` of positive Q stands; `e2 = w × e1` with `w` the view direction.
///
/// No choice of axes is smooth all over the sphere. Where an axis is undefined, the next simpler one takes its place:
/// `e1` horizontal for [`Frame::SunAligned`] towards the sun and away from it, the vertical frame for a [`Frame::Axis`]
/// along the view direction. At the zenith and nadir, the vertical plane is the one of the sun. Degrees of polarisation
/// do not depend on the axes and are smooth there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Frame {
    /// `e1` lies in the vertical plane and points up, so `e2` points to the right.
    #[default]
    Vertical,
    /// `e1` is perpendicular to the plane of view direction and sun: light that air scattered once has Q > 0 and U = 0.
    SunAligned,
    /// `e1` is the part of this vector that is perpendicular to the view direction: the up vector of a camera, or an
    /// axis of a local frame in which Mueller matrices are given.
    Axis([f32; 3]),
}

/// Squared sine below which two directions count as parallel.
const PARALLEL: f64 = 1e-12;

/// A view direction seen from the sun.
pub(super) struct Aspect {
    /// Sine and cosine of its elevation.
    elevation: (f64, f64),
    /// Sine and cosine of its azimuth; the sun's at the poles.
    azimuth: (f64, f64),
    /// Sine of its azimuth less that of the sun.
    pub sine: f64,
    /// Cosine of the sun's elevation.
    level: f64,
    /// The sun's direction along `e1` and `e2` of the vertical frame.
    sun: [f64; 2],
}

impl Aspect {
    /// Of a direction that is neither zero nor infinite, under a sun in a direction of unit length with the azimuth
    /// `sun_azimuth` (sine and cosine).
    pub fn new(direction: [f32; 3], sun: [f64; 3], sun_azimuth: (f64, f64)) -> Self {
        let [x, y, z] = direction.map(f64::from);
        let horizontal = x.hypot(y);
        let length = horizontal.hypot(z);
        let (sa, ca) = if horizontal > 0.0 {
            (y / horizontal, x / horizontal)
        } else {
            sun_azimuth
        };
        let (ss, cs) = sun_azimuth;
        Self::of(
            (z / length, horizontal / length),
            (sa, ca),
            (sa * cs - ca * ss, ca * cs + sa * ss),
            sun,
        )
    }

    /// Of a direction with this cosine and sine of its elevation and the azimuth `phi` from the sun.
    pub fn along((ce, se): (f64, f64), phi: f64, sun: [f64; 3]) -> Self {
        Self::of((se, ce), phi.sin_cos(), phi.sin_cos(), sun)
    }

    fn of(
        (se, ce): (f64, f64),
        azimuth: (f64, f64),
        (sine, cosine): (f64, f64),
        sun: [f64; 3],
    ) -> Self {
        let level = sun[0].hypot(sun[1]);
        Self {
            elevation: (se, ce),
            azimuth,
            sine,
            level,
            sun: [ce * sun[2] - se * level * cosine, level * sine],
        }
    }

    /// What Q and U of singly scattered light in the vertical frame are per unit of `D`.
    pub fn single(&self) -> [f64; 2] {
        let [p1, p2] = self.sun;
        [p2 * p2 - p1 * p1, -2.0 * p1 * p2]
    }

    /// As [`Aspect::single`], with U over the sine of the azimuth from the sun.
    pub fn single_even(&self) -> [f64; 2] {
        let [p1, p2] = self.sun;
        [p2 * p2 - p1 * p1, -2.0 * p1 * self.level]
    }

    /// Cosine and sine of twice the angle from the vertical frame to `frame`.
    ///
    /// # Errors
    /// [`Error::Direction`] for an axis that is zero or not finite.
    pub fn turn(&self, frame: Frame) -> Result<(f64, f64)> {
        let [p1, p2] = self.sun;
        match frame {
            Frame::Vertical => Ok((1.0, 0.0)),
            // e1 = w × sun.
            Frame::SunAligned => Ok(double([-p2, p1]).unwrap_or((-1.0, 0.0))),
            Frame::Axis(axis) => {
                let across = self.across(axis);
                let unit = across.ok_or(Error::Direction { got: axis })?;
                Ok(double(unit).unwrap_or((1.0, 0.0)))
            }
        }
    }

    /// A vector, shrunk to unit length, along `e1` and `e2`.
    fn across(&self, vector: [f32; 3]) -> Option<[f64; 2]> {
        let [x, y, z] = vector.map(f64::from);
        let length = x.hypot(y).hypot(z);
        let ((se, ce), (sa, ca)) = (self.elevation, self.azimuth);
        let e1 = ce * z - se * (ca * x + sa * y);
        let e2 = sa * x - ca * y;
        (length > 0.0 && length.is_finite()).then(|| [e1 / length, e2 / length])
    }
}

/// Cosine and sine of twice the angle of a vector from the first axis; `None` if it is too short to tell.
fn double([x, y]: [f64; 2]) -> Option<(f64, f64)> {
    let square = x * x + y * y;
    (square > PARALLEL).then(|| ((x * x - y * y) / square, 2.0 * x * y / square))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sun(elevation: f64, azimuth: f64) -> ([f64; 3], (f64, f64)) {
        let ((se, ce), (sa, ca)) = (elevation.sin_cos(), azimuth.sin_cos());
        ([ce * ca, ce * sa, se], (sa, ca))
    }

    fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
        core::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
    }

    #[test]
    fn the_sun_aligned_axis_is_perpendicular_to_direction_and_sun() {
        let (s, azimuth) = sun(0.4, 1.1);
        for direction in [[0.3f32, -0.5, 0.6], [-0.2, 0.1, -0.9], [1.0, 0.0, 0.0]] {
            let aspect = Aspect::new(direction, s, azimuth);
            let axis = cross(direction.map(f64::from), s).map(|v| v as f32);
            let (c, t) = aspect.turn(Frame::Axis(axis)).unwrap();
            let (c2, t2) = aspect.turn(Frame::SunAligned).unwrap();
            assert!((c - c2).abs() < 1e-6 && (t - t2).abs() < 1e-6);
            // Singly scattered light is then all in Q.
            let [q, u] = aspect.single();
            assert!(c2 * q + t2 * u > 0.0 && (c2 * u - t2 * q).abs() < 1e-12);
        }
    }

    #[test]
    fn up_is_the_vertical_frame_and_undefined_axes_fall_back() {
        let (s, azimuth) = sun(0.4, 1.1);
        let aspect = Aspect::new([0.3, -0.5, 0.6], s, azimuth);
        let (c, t) = aspect.turn(Frame::Axis([0.0, 0.0, 2.0])).unwrap();
        assert!((c - 1.0).abs() < 1e-12 && t.abs() < 1e-12);
        assert!(aspect.turn(Frame::Axis([0.0; 3])).is_err());
        assert!(aspect.turn(Frame::Axis([f32::NAN, 0.0, 1.0])).is_err());
        let parallel = aspect.turn(Frame::Axis([0.3, -0.5, 0.6])).unwrap();
        assert_eq!(parallel, (1.0, 0.0));
        let at_sun = Aspect::new(s.map(|v| v as f32), s, azimuth);
        assert_eq!(at_sun.turn(Frame::SunAligned).unwrap(), (-1.0, 0.0));
        let zenith = Aspect::new([0.0, 0.0, 1.0], s, azimuth);
        assert!(zenith.turn(Frame::SunAligned).unwrap().0 < -0.999);
    }
}

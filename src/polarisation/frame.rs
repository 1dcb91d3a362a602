//! How a view direction stands to the sun and to the axes of polarisation. Format specification, section 7.5.

use crate::error::{Error, Result};

/// Where the axis `e1` of positive Q stands; `e2 = w × e1` with `w` the view direction.
///
/// No choice of axes is smooth all over the sphere. Where an axis is undefined, the next simpler one takes its place:
/// `e1` horizontal for [`PolarisationFrame::SunAligned`] towards the sun and away from it, the vertical frame for a
/// [`PolarisationFrame::Axis`] along the view direction. At the zenith and nadir, the vertical plane is the one of the
/// sun. Degrees of polarisation do not depend on the axes and are smooth there.
///
/// ```
/// use welkin::{Conditions, Model, PolarisationFrame};
///
/// let sky = Model::default_model()?.polarised_sky(&Conditions::default())?;
/// let stokes = |frame| sky.stokes_at([0.1, 0.5, 0.6], frame, 550.0);
/// let vertical = stokes(PolarisationFrame::Vertical)?;
/// let camera = stokes(PolarisationFrame::Axis([0.0, 0.2, 1.0]))?; // its up vector
/// // Another frame, the same light.
/// assert_eq!(vertical.i, camera.i);
/// assert!((vertical.degree() - camera.degree()).abs() < 1e-5);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum PolarisationFrame {
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
pub(crate) const PARALLEL: f64 = 1e-12;

/// The axes of a vertical frame, and the sun seen from it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Plane {
    /// Unit vectors: up in the vertical plane of the view direction, and to the right.
    axes: [[f64; 3]; 2],
    /// The sun's direction along them.
    pub sun: [f64; 2],
}

impl Plane {
    /// Of a view direction at a place with this zenith, under a sun; all of unit length.
    pub fn new(view: [f64; 3], zenith: [f64; 3], sun: [f64; 3]) -> Self {
        let rise = dot(view, zenith);
        let up = part_across(zenith, view);
        // Vertical views are in the plane of the sun: their up points away from it at the zenith, towards it at the
        // nadir.
        let up = up.or_else(|| Some(part_across(sun, view)?.map(|v| -v * rise.signum())));
        let smallest = (0..3).min_by(|&a, &b| view[a].abs().total_cmp(&view[b].abs()));
        let any = core::array::from_fn(|k| f64::from(u8::from(Some(k) == smallest)));
        let e1 = up.or_else(|| part_across(any, view)).unwrap_or(any);
        let axes = [e1, cross(view, e1)];
        let sun = axes.map(|axis| dot(axis, sun));
        Self { axes, sun }
    }

    /// What Q and U of singly scattered light in the vertical frame are per unit of `D`.
    pub fn single(&self) -> [f64; 2] {
        let [p1, p2] = self.sun;
        [p2 * p2 - p1 * p1, -2.0 * p1 * p2]
    }

    /// Cosine and sine of twice the angle from the vertical frame to `frame`.
    ///
    /// # Errors
    /// [`Error::Direction`] for an axis that is zero or not finite.
    pub fn turn(&self, frame: PolarisationFrame) -> Result<(f64, f64)> {
        let [p1, p2] = self.sun;
        match frame {
            PolarisationFrame::Vertical => Ok((1.0, 0.0)),
            // e1 = w × sun.
            PolarisationFrame::SunAligned => Ok(double([-p2, p1]).unwrap_or((-1.0, 0.0))),
            PolarisationFrame::Axis(axis) => {
                let [x, y, z] = axis.map(f64::from);
                let length = x.hypot(y).hypot(z);
                if !(length > 0.0 && length.is_finite()) {
                    return Err(Error::Direction { got: axis });
                }
                let across = self.axes.map(|e| dot(e, [x, y, z]) / length);
                Ok(double(across).unwrap_or((1.0, 0.0)))
            }
        }
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

/// The part of a unit vector that is perpendicular to another, of unit length; `None` if it is too short to tell.
fn part_across(vector: [f64; 3], view: [f64; 3]) -> Option<[f64; 3]> {
    let along = dot(vector, view);
    let part: [f64; 3] = core::array::from_fn(|k| vector[k] - along * view[k]);
    let square = dot(part, part);
    (square > PARALLEL).then(|| part.map(|v| v / square.sqrt()))
}

/// A view direction of a sky seen from its sun.
pub(super) struct Aspect {
    pub plane: Plane,
    /// Sine of its azimuth less that of the sun.
    pub sine: f64,
    /// Cosine of the sun's elevation.
    level: f64,
}

impl Aspect {
    /// Of a direction that is neither zero nor infinite, under a sun in a direction of unit length with the azimuth
    /// `sun_azimuth` (sine and cosine).
    pub fn new(direction: [f32; 3], sun: [f64; 3], sun_azimuth: (f64, f64)) -> Self {
        let [x, y, z] = direction.map(f64::from);
        let horizontal = x.hypot(y);
        let length = horizontal.hypot(z);
        let azimuth = if horizontal > 0.0 {
            (y / horizontal, x / horizontal)
        } else {
            sun_azimuth
        };
        Self::of((z / length, horizontal / length), azimuth, sun, sun_azimuth)
    }

    /// Of a direction with this cosine and sine of its elevation and the azimuth `phi` from a sun at this elevation
    /// (rad).
    pub fn along((ce, se): (f64, f64), phi: f64, sun: f64) -> Self {
        let sun = [sun.cos(), 0.0, sun.sin()];
        Self::of((se, ce), phi.sin_cos(), sun, (0.0, 1.0))
    }

    fn of((se, ce): (f64, f64), (sa, ca): (f64, f64), sun: [f64; 3], (ss, cs): (f64, f64)) -> Self {
        let (sine, cosine) = (sa * cs - ca * ss, ca * cs + sa * ss);
        let level = sun[0].hypot(sun[1]);
        let axes = [[-se * ca, -se * sa, ce], [sa, -ca, 0.0]];
        let sun = [ce * sun[2] - se * level * cosine, level * sine];
        Self {
            plane: Plane { axes, sun },
            sine,
            level,
        }
    }

    /// As [`Plane::single`], with U over the sine of the azimuth from the sun.
    pub fn single_even(&self) -> [f64; 2] {
        let [p1, p2] = self.plane.sun;
        [p2 * p2 - p1 * p1, -2.0 * p1 * self.level]
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

    #[test]
    fn the_sun_aligned_axis_is_perpendicular_to_direction_and_sun() {
        let (s, azimuth) = sun(0.4, 1.1);
        for direction in [[0.3f32, -0.5, 0.6], [-0.2, 0.1, -0.9], [1.0, 0.0, 0.0]] {
            let aspect = Aspect::new(direction, s, azimuth);
            let axis = cross(direction.map(f64::from), s).map(|v| v as f32);
            let (c, t) = aspect.plane.turn(PolarisationFrame::Axis(axis)).unwrap();
            let (c2, t2) = aspect.plane.turn(PolarisationFrame::SunAligned).unwrap();
            assert!((c - c2).abs() < 1e-6 && (t - t2).abs() < 1e-6);
            // Singly scattered light is then all in Q.
            let [q, u] = aspect.plane.single();
            assert!(c2 * q + t2 * u > 0.0 && (c2 * u - t2 * q).abs() < 1e-12);
        }
    }

    #[test]
    fn up_is_the_vertical_frame_and_undefined_axes_fall_back() {
        let (s, azimuth) = sun(0.4, 1.1);
        let aspect = Aspect::new([0.3, -0.5, 0.6], s, azimuth);
        let (c, t) = aspect
            .plane
            .turn(PolarisationFrame::Axis([0.0, 0.0, 2.0]))
            .unwrap();
        assert!((c - 1.0).abs() < 1e-12 && t.abs() < 1e-12);
        assert!(
            aspect
                .plane
                .turn(PolarisationFrame::Axis([0.0; 3]))
                .is_err()
        );
        assert!(
            aspect
                .plane
                .turn(PolarisationFrame::Axis([f32::NAN, 0.0, 1.0]))
                .is_err()
        );
        let parallel = aspect
            .plane
            .turn(PolarisationFrame::Axis([0.3, -0.5, 0.6]))
            .unwrap();
        assert_eq!(parallel, (1.0, 0.0));
        let at_sun = Aspect::new(s.map(|v| v as f32), s, azimuth);
        assert_eq!(
            at_sun.plane.turn(PolarisationFrame::SunAligned).unwrap(),
            (-1.0, 0.0)
        );
        let zenith = Aspect::new([0.0, 0.0, 1.0], s, azimuth);
        assert!(zenith.plane.turn(PolarisationFrame::SunAligned).unwrap().0 < -0.999);
    }

    #[test]
    fn planes_from_vectors_are_those_from_angles() {
        let zenith = [0.0, 0.0, 1.0];
        for (elevation, azimuth) in [(0.4, 1.1), (-0.2, 3.0), (1.5, -2.0)] {
            let (s, angles) = sun(elevation, azimuth);
            for direction in [
                [0.3, -0.5, 0.6],
                [-0.2, 0.1, -0.9],
                [0.0, 0.0, 1.0],
                [0.0, 0.0, -1.0],
            ] {
                let length = dot(direction, direction).sqrt();
                let plane = Plane::new(direction.map(|v| v / length), zenith, s);
                let aspect = Aspect::new(direction.map(|v| v as f32), s, angles);
                let pairs = plane
                    .axes
                    .iter()
                    .flatten()
                    .zip(aspect.plane.axes.iter().flatten());
                pairs
                    .chain(plane.sun.iter().zip(&aspect.plane.sun))
                    .for_each(|(a, b)| {
                        assert!((a - b).abs() < 1e-6, "{plane:?} {:?}", aspect.plane);
                    });
            }
        }
        // The sun at the zenith, too: any axes will do.
        let plane = Plane::new(zenith, zenith, zenith);
        assert!((dot(plane.axes[0], plane.axes[0]) - 1.0).abs() < 1e-12);
        assert_eq!(plane.single(), [0.0, 0.0]);
    }
}

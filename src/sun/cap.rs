//! The disc as a cap of the sphere of directions, of which the geometric horizon may hide the lower part.
//!
//! In Lambert's azimuthal equal-area projection around its centre, lengths in chords from centre to limb: the disc is
//! the unit disc exactly, equal areas are equal solid angles, and lines of equal elevation are as good as parabolas.

use core::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI};

use crate::conditions::Conditions;
use crate::geometry::SOLAR_ANGULAR_RADIUS;

/// Share of the radius by which draws keep off the limb, and by which their density reaches beyond the disc: 7e-7 rad.
/// Directions in single precision that are turned to another frame and back are off by up to 4e-7 rad.
pub(super) const MARGIN: f64 = 1.5e-4;

/// A place in the projection: to the left of an observer who faces the sun, and up.
pub(super) type Place = [f64; 2];

/// The disc of the sun at some place of the sky.
#[derive(Clone, Debug)]
pub(super) struct Cap {
    centre: [f64; 3],
    left: [f64; 3],
    up: [f64; 3],
    /// Chord from the centre to the limb.
    chord: f64,
    /// Elevations of the centre and of the geometric horizon, rad.
    elevation: f64,
    lowest: f64,
    /// Where the geometric horizon crosses the vertical through the centre, −1..=1.
    horizon: f64,
    /// What is drawn from lies above this; at or below the horizon everywhere.
    floor: f64,
    /// The area of what is drawn from.
    area: f64,
    /// Lines of equal elevation are y = y₀ + ½ bend x².
    bend: f64,
}

/// The disc's own axes and what is drawn from; see [`Cap`].
pub(super) struct Shape {
    pub left: [f64; 3],
    pub up: [f64; 3],
    pub chord: f64,
    pub floor: f64,
    pub area: f64,
}

impl Cap {
    /// The sun over a geometric horizon that lies `dip` (rad) below the horizontal.
    pub fn new(conditions: &Conditions, dip: f64) -> Self {
        let elevation = conditions.solar_elevation;
        let ((sz, cz), (sa, ca)) = (elevation.sin_cos(), conditions.solar_azimuth.sin_cos());
        let half = 0.5 * SOLAR_ANGULAR_RADIUS;
        let horizon = ((0.5 * (-dip - elevation)).sin() / half.sin()).clamp(-1.0, 1.0);
        // Near the zenith the air is the same all over the disc.
        let bend = match elevation.abs() < FRAC_PI_3 {
            true => 2.0 * half.sin() * elevation.tan(),
            false => 0.0,
        };
        let floor = horizon + 0.5 * bend.min(0.0) * (1.0 - horizon * horizon);
        Self {
            centre: [cz * ca, cz * sa, sz],
            left: [-sa, ca, 0.0],
            up: [-sz * ca, -sz * sa, cz],
            chord: 2.0 * half.sin(),
            elevation,
            lowest: -dip,
            horizon,
            floor,
            area: segment(angle(floor)),
            bend,
        }
    }

    /// What a graphics processor is told.
    pub fn shape(&self) -> Shape {
        Shape {
            left: self.left,
            up: self.up,
            chord: self.chord,
            floor: self.floor,
            area: self.area,
        }
    }

    pub fn centre(&self) -> [f64; 3] {
        self.centre
    }

    /// Whether any of the disc is above the geometric horizon.
    pub fn is_visible(&self) -> bool {
        self.horizon < 1.0
    }

    /// Elevation of the geometric horizon, rad.
    pub fn lowest(&self) -> f64 {
        self.lowest
    }

    /// Lowest and highest elevation of what is visible, rad.
    pub fn band(&self) -> [f64; 2] {
        let top = (self.elevation + SOLAR_ANGULAR_RADIUS).min(FRAC_PI_2);
        [
            (self.elevation - SOLAR_ANGULAR_RADIUS)
                .max(self.lowest)
                .min(top),
            top,
        ]
    }

    /// Solid angle of the whole disc, sr.
    pub fn solid_angle(&self) -> f64 {
        PI * self.chord * self.chord
    }

    /// Squared distance of a unit vector from the centre; at most 1 on the disc. A chord is exact where a cosine is
    /// not.
    pub fn square(&self, unit: [f64; 3]) -> f64 {
        let squares = (0..3).map(|i| (unit[i] - self.centre[i]).powi(2));
        squares.sum::<f64>() / (self.chord * self.chord)
    }

    /// Unit vector towards a place.
    pub fn direction(&self, [x, y]: Place) -> [f64; 3] {
        let square = self.chord * self.chord * (x * x + y * y);
        let (along, across) = (1.0 - 0.5 * square, (1.0 - 0.25 * square).max(0.0).sqrt());
        let [x, y] = [x, y].map(|v| self.chord * across * v);
        core::array::from_fn(|i| along * self.centre[i] + x * self.left[i] + y * self.up[i])
    }

    /// Whether draws can give this unit vector, or what becomes of one by rounding.
    pub fn covers(&self, unit: [f64; 3]) -> bool {
        let height: f64 = (0..3).map(|i| unit[i] * self.up[i]).sum();
        self.is_visible()
            && self.square(unit) <= (1.0 + MARGIN) * (1.0 + MARGIN)
            && height >= (self.floor - 2.0 * MARGIN) * self.chord
    }

    /// Solid angle that is drawn from, sr: that of the visible part, and at most 1e-4 of the disc more.
    pub fn drawn_solid_angle(&self) -> f64 {
        self.area * self.chord * self.chord
    }

    /// Maps the unit square to the visible part, uniformly in solid angle: upright, then across. What would fall into
    /// the outermost [`MARGIN`] is moved to its inner edge.
    pub fn draw(&self, [a, b]: [f64; 2]) -> [f64; 3] {
        let theta = segment_angle((1.0 - a) * self.area);
        let (x, y) = theta.sin_cos();
        let x = (2.0 * b - 1.0) * x;
        let square = x * x + y * y;
        let shrink = match square > (1.0 - MARGIN) * (1.0 - MARGIN) {
            true => (1.0 - MARGIN) / square.sqrt(),
            false => 1.0,
        };
        self.direction([shrink * x, shrink * y])
    }

    /// The visible part as lines of equal elevation: the angle whose cosine is their y₀ goes from 0 to this.
    pub fn last_line(&self) -> f64 {
        angle(self.horizon)
    }

    /// The line of equal elevation whose y₀ is the cosine of an angle.
    pub fn line(&self, theta: f64) -> Line<'_> {
        let (height, middle) = theta.sin_cos();
        Line {
            cap: self,
            middle,
            height,
            half: height / (1.0 + self.bend * middle).sqrt(),
        }
    }

    /// The angles of the lines on which the edge of the half-space above a plane meets the limb, if it does.
    pub fn lines_at_edge(&self, normal: [f64; 3]) -> Option<[f64; 2]> {
        let dot = |v: [f64; 3]| (0..3).map(|i| v[i] * normal[i]).sum::<f64>();
        let [along, left, up] = [self.centre, self.left, self.up].map(dot);
        let square = self.chord * self.chord;
        let across = self.chord * (1.0 - 0.25 * square).sqrt();
        let cosine = -(1.0 - 0.5 * square) * along / (across * left.hypot(up));
        // NaN where the plane faces the sun.
        if cosine.is_nan() || cosine.abs() >= 1.0 {
            return None;
        }
        let (turn, open) = (left.atan2(up), cosine.acos());
        Some([turn - open, turn + open].map(|turn| {
            let (x, y) = turn.sin_cos();
            angle(y - 0.5 * self.bend * x * x)
        }))
    }
}

/// What the disc has of a line of equal elevation.
pub(super) struct Line<'a> {
    cap: &'a Cap,
    /// y where x = 0.
    middle: f64,
    /// √(1 − y₀²).
    pub height: f64,
    /// Half the length.
    pub half: f64,
}

impl Line<'_> {
    /// rad.
    pub fn elevation(&self) -> f64 {
        let z = self.cap.direction([0.0, self.middle])[2];
        z.clamp(-1.0, 1.0).asin()
    }

    /// Unit vector towards the place with this x.
    pub fn direction(&self, x: f64) -> [f64; 3] {
        self.cap
            .direction([x, self.middle + 0.5 * self.cap.bend * x * x])
    }
}

/// The angle with this cosine, bounded to −1..=1; exact near 0.
fn angle(cosine: f64) -> f64 {
    2.0 * (0.5 * (1.0 - cosine.clamp(-1.0, 1.0))).sqrt().asin()
}

/// Area of the segment of the unit disc beyond a chord at cos θ.
fn segment(theta: f64) -> f64 {
    let double = 2.0 * theta;
    match double < 0.1 {
        // Without the cancellation.
        true => {
            let square = double * double;
            double * square / 12.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0))
        }
        false => 0.5 * (double - double.sin()),
    }
}

/// The inverse of [`segment`].
fn segment_angle(area: f64) -> f64 {
    let area = area.clamp(0.0, PI);
    let small = area.min(PI - area);
    // Kepler's equation with eccentricity 1: e − sin e = 2 · area; its series, refined twice by Newton's rule.
    let s = (12.0 * small).cbrt();
    let square = s * s;
    let series = 1.0 / 1400.0 + square * (1.0 / 25_200.0 + square * (43.0 / 17_248_000.0));
    let mut e = s * (1.0 + square * (1.0 / 60.0 + square * series));
    if e > 0.05 {
        for _ in 0..2 {
            let (sine, cosine) = e.sin_cos();
            e -= (e - sine - 2.0 * small) / (1.0 - cosine);
        }
    }
    let theta = 0.5 * e;
    if area > small { PI - theta } else { theta }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cap(elevation: f64, dip: f64) -> Cap {
        let conditions = Conditions {
            solar_elevation: elevation,
            solar_azimuth: 2.3,
            ..Conditions::default()
        };
        Cap::new(&conditions, dip)
    }

    #[test]
    fn segments_invert() {
        assert!((segment(PI) - PI).abs() < 1e-15 && segment(0.0) == 0.0);
        for i in 0..=10_000 {
            let theta = PI * (f64::from(i) / 10_000.0).powi(2);
            let got = segment_angle(segment(theta));
            assert!(
                (got - theta).abs() < 1e-6 * theta.max(1e-9),
                "{theta} {got}"
            );
        }
        assert!((segment(0.05 - 1e-12) / segment(0.05 + 1e-12) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn lines_have_one_elevation() {
        for (elevation, dip) in [(0.0, 0.0), (-0.067, 0.0686), (0.5, 0.03), (-0.9, 0.9)] {
            let cap = cap(elevation, dip);
            for i in 1..20 {
                let line = cap.line(f64::from(i) / 20.0 * cap.last_line());
                for x in [-1.0, -0.4, 0.7] {
                    let direction = line.direction(x * line.half);
                    let off = direction[2].asin() - line.elevation();
                    assert!(off.abs() < 2e-5 * SOLAR_ANGULAR_RADIUS, "{elevation} {off}");
                    assert!(cap.square(direction) < 1.0 + 2e-5);
                }
                let end = cap.square(line.direction(line.half));
                assert!((end - 1.0).abs() < 5e-5, "{elevation} {end}");
            }
        }
    }

    #[test]
    fn draws_are_on_what_is_visible() {
        for (elevation, dip) in [(0.0, 0.0), (-0.067, 0.0686), (0.5, 0.03), (-0.0046, 0.0)] {
            let cap = cap(elevation, dip);
            for i in 0..=400 {
                let u = [i / 20, i % 20].map(|i| f64::from(i) / 20.0);
                let direction = cap.draw(u);
                let inside = cap.square(direction).sqrt();
                assert!(inside <= 1.0 - MARGIN + 1e-9 && cap.covers(direction));
                let low = direction[2].asin() + dip;
                assert!(
                    low > -2.0 * MARGIN * SOLAR_ANGULAR_RADIUS,
                    "{elevation} {u:?} {low}"
                );
            }
        }
        assert!(!cap(-0.1, 0.09).is_visible());
    }
}

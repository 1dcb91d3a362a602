//! Straight segments above a spherical planet.

use super::layers::Line;
use crate::error::{Error, Result};
use crate::geometry::Planet;

/// A point in the world frame, m: the origin on the ground, +z up there.
pub(crate) type Point = [f64; 3];

/// A directed segment, in terms of its line's closest approach to the planet's centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    pub line: Line,
    /// Distance of the start from the tangent point, negative before it, m.
    pub from: f64,
    pub length: f64,
    /// Unit vector from start to end.
    pub direction: [f64; 3],
    /// Start relative to the planet's centre, m.
    pub start: [f64; 3],
}

impl Segment {
    #[inline(always)]
    pub fn between(planet: &Planet, a: Point, b: Point) -> Result<Self> {
        let a = checked(a)?;
        let b = checked(b)?;
        let way: [f64; 3] = core::array::from_fn(|i| b[i] - a[i]);
        let length = dot(way, way).sqrt();
        let direction = if length > 0.0 {
            let per_metre = 1.0 / length;
            way.map(|v| v * per_metre)
        } else {
            [0.0, 0.0, 1.0]
        };
        Ok(Self::along(planet, a, direction, length))
    }

    /// In a direction (a vector of any length) up to a distance, m.
    pub fn of_length(planet: &Planet, a: Point, direction: [f64; 3], length: f64) -> Result<Self> {
        let a = checked(a)?;
        let unit = unit(direction)?;
        checked(core::array::from_fn(|i| a[i] + length * unit[i]))?;
        Ok(Self::along(planet, a, unit, length))
    }

    /// To the top of the atmosphere, or to the ground where the line meets it: then the second value is true. A point
    /// on the ground or under it is met at once by lines that go down, and never by others.
    pub fn to_end(planet: &Planet, a: Point, direction: [f64; 3]) -> Result<(Self, bool)> {
        let a = checked(a)?;
        let unit = unit(direction)?;
        let endless = Self::along(planet, a, unit, 0.0);
        let lowest = endless.line.lowest;
        let reach = |w: f64| (w - lowest) * (2.0 * planet.radius);
        if lowest < 0.0 && endless.from < 0.0 {
            // Without the difference of two long ways. From the ground or under it, down is the ground at once.
            let height = squared_altitude(planet, a).max(0.0) * (2.0 * planet.radius);
            let length = height / (reach(0.0).sqrt() - endless.from);
            return Ok((Self::along(planet, a, unit, length), true));
        }
        let top = reach(planet.squared_altitude(planet.top));
        let length = (top.max(0.0).sqrt() - endless.from).max(0.0);
        Ok((Self::along(planet, a, unit, length), false))
    }

    #[inline(always)]
    fn along(planet: &Planet, a: Point, direction: [f64; 3], length: f64) -> Self {
        let start = [a[0], a[1], a[2] + planet.radius];
        let from = dot(start, direction);
        let per_diameter = 0.5 / planet.radius;
        let line = Line {
            lowest: squared_altitude(planet, a) - from * from * per_diameter,
        };
        Self {
            line,
            from,
            length,
            direction,
            start,
        }
    }

    /// Unit vector away from the planet's centre at the start.
    pub fn zenith(&self) -> [f64; 3] {
        let radius = dot(self.start, self.start).sqrt();
        match radius > 0.0 {
            true => self.start.map(|v| v / radius),
            false => [0.0, 0.0, 1.0],
        }
    }

    /// At a distance from the tangent point, relative to the planet's centre, m.
    #[inline(always)]
    pub fn point(&self, s: f64) -> Point {
        let way = s - self.from;
        core::array::from_fn(|i| self.start[i] + way * self.direction[i])
    }

    pub fn to(&self) -> f64 {
        self.from + self.length
    }
}

/// r² − R² over the diameter, without the cancellation of the squares.
#[inline(always)]
fn squared_altitude(planet: &Planet, a: Point) -> f64 {
    dot(a, a) * (0.5 / planet.radius) + a[2]
}

#[inline(always)]
pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Farther out there is nothing, and squares stay exact enough.
const FARTHEST: f64 = 1e9;

#[inline(always)]
fn unit(direction: [f64; 3]) -> Result<[f64; 3]> {
    let square = dot(direction, direction);
    if square > 0.0 && square.is_finite() {
        return Ok(direction.map(|v| v / square.sqrt()));
    }
    let got = direction.map(|v| v as f32);
    Err(Error::Direction { got })
}

fn checked(point: Point) -> Result<Point> {
    if point.iter().all(|v| v.abs() <= FARTHEST) {
        return Ok(point);
    }
    Err(Error::Point { got: point })
}

//! Sunlight at a point: how high the disc stands above the planet's edge, and the air that it crosses.

use core::f32::consts::PI;

use crate::air::{Amounts, Layers, Line};
use crate::geometry::Planet;
use crate::math::{LANES, exp};

/// Angular radius of the sun, rad: 0.2667°.
const SUN_RADIUS: f64 = 0.004_654_793;

/// Sunlight at a point.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sunlight {
    /// How many radii the sun's centre stands above the geometric horizon.
    pub rise: f32,
    /// Columns towards the centroid of the visible share of the disc, m; towards the horizon where none is visible.
    pub columns: Amounts,
}

/// Columns towards the sun, tabulated around where it stands.
#[derive(Clone, Debug)]
pub(crate) struct Beam {
    /// Lowest and highest angle above the geometric horizon in the table, rad.
    range: [f64; 2],
    top: f64,
    /// Vectors per node.
    quads: usize,
    /// Logarithms, `[altitude][angle][vector]`.
    columns: Vec<[f32; LANES]>,
}

/// How far the sun's local elevation may be from that of the scene, rad.
const REACH: f64 = 0.06;
/// Angles above the horizon, ever closer towards the lowest.
const ANGLES: usize = 64;
/// Altitudes, ever closer towards the ground.
const ALTITUDES: usize = 121;
/// Added to columns before the logarithm, m: less is nothing.
const NOTHING: f32 = 1e-3;

impl Beam {
    pub fn new(layers: &Layers, elevation: f64) -> Self {
        let planet = layers.planet();
        let low = (elevation - REACH).max(0.0);
        let high = (elevation + REACH + planet.dip(planet.top)).max(low + REACH);
        let mut columns = Vec::with_capacity(ALTITUDES * ANGLES * layers.quads);
        for i in 0..ALTITUDES {
            let h = planet.top * share(i, ALTITUDES).powi(2);
            for j in 0..ANGLES {
                let angle = low + (high - low) * share(j, ANGLES).powi(2);
                let node = towards(layers, h, (angle - planet.dip(h)).sin());
                let logarithm = |c: f32| (c + NOTHING).ln();
                columns.extend(node.0[..layers.quads].iter().map(|row| row.map(logarithm)));
            }
        }
        Self {
            range: [low, high],
            top: planet.top,
            quads: layers.quads,
            columns,
        }
    }

    pub fn bytes(&self) -> usize {
        size_of_val(self.columns.as_slice())
    }

    /// Sunlight at altitude `h` (m) of a sun whose centre stands `sine` above the horizontal plane.
    #[inline(always)]
    pub fn at(&self, layers: &Layers, h: f64, sine: f64) -> Sunlight {
        let planet = layers.planet();
        let dip = dip(&planet, h.max(0.0));
        let rise = ((sine.asin() + dip) / SUN_RADIUS) as f32;
        let angle = f64::from(visible_rise(rise)) * SUN_RADIUS;
        let tabulated = h <= self.top && (self.range[0]..=self.range[1]).contains(&angle);
        let columns = match tabulated {
            true => self.columns(h, angle),
            false => towards(layers, h, (angle - dip).sin()),
        };
        Sunlight { rise, columns }
    }

    #[inline(always)]
    fn columns(&self, h: f64, angle: f64) -> Amounts {
        let [low, high] = self.range;
        let u = (h.max(0.0) / self.top).sqrt() as f32 * (ALTITUDES - 1) as f32;
        let v = ((angle - low) / (high - low)).sqrt() as f32 * (ANGLES - 1) as f32;
        let (i, j) = (
            (u as usize).min(ALTITUDES - 2),
            (v as usize).min(ANGLES - 2),
        );
        let (t, s) = (u - i as f32, v - j as f32);
        let node =
            |i: usize, j: usize| &self.columns[(i * ANGLES + j) * self.quads..][..self.quads];
        let corners = [
            node(i, j),
            node(i, j + 1),
            node(i + 1, j),
            node(i + 1, j + 1),
        ];
        let weights = [(1.0 - t) * (1.0 - s), (1.0 - t) * s, t * (1.0 - s), t * s];
        let mut columns = Amounts::default();
        for (q, column) in columns.0[..self.quads].iter_mut().enumerate() {
            for (corner, weight) in corners.iter().zip(weights) {
                for (column, corner) in column.iter_mut().zip(&corner[q]) {
                    *column += weight * corner;
                }
            }
            for column in column.iter_mut() {
                *column = exp(*column);
            }
        }
        columns
    }
}

/// Angle of the geometric horizon below the horizontal, rad, to 1e-8 up to 200 km.
#[inline(always)]
fn dip(planet: &Planet, h: f64) -> f64 {
    let square = h * (2.0 * planet.radius + h) / (planet.radius * planet.radius);
    if square > 0.06 {
        return planet.dip(h);
    }
    // The series of the arc tangent.
    let series = 1.0 - square * (1.0 / 3.0 - square * (0.2 - square * (1.0 / 7.0 - square / 9.0)));
    square.sqrt() * series
}

fn share(i: usize, count: usize) -> f64 {
    i as f64 / (count - 1) as f64
}

/// Columns from altitude `h` (m) to space in a direction with this sine of its elevation.
fn towards(layers: &Layers, h: f64, sine: f64) -> Amounts {
    let planet = layers.planet();
    let diameter = 2.0 * planet.radius;
    let from = (planet.radius + h) * sine;
    let line = Line {
        lowest: planet.squared_altitude(h) - from * from / diameter,
    };
    let top = (planet.squared_altitude(planet.top) - line.lowest) * diameter;
    let to = top.max(0.0).sqrt();
    layers.columns(line, from, to.max(from))
}

/// How many radii the centroid of what is seen of the disc stands above a straight edge.
#[inline(always)]
fn visible_rise(rise: f32) -> f32 {
    if rise >= 1.0 {
        return rise;
    }
    let chord = (1.0 - rise * rise).max(0.0);
    let share = visible_share(rise);
    if rise <= -0.999 {
        return 0.0;
    }
    rise + 2.0 / 3.0 * chord * chord.sqrt() / (PI * share)
}

/// Share of a disc above a straight edge, for a centre `rise` radii above the edge.
fn visible_share(rise: f32) -> f32 {
    let rise = rise.clamp(-1.0, 1.0);
    0.5 + (rise * (1.0 - rise * rise).sqrt() + rise.asin()) / PI
}

/// Integral of the visible share up to `rise`.
fn accumulated_share(rise: f32) -> f32 {
    let x = rise.clamp(-1.0, 1.0);
    let root = (1.0 - x * x).sqrt();
    let inside = 0.5 * x + (root - root * root * root / 3.0 + x * x.asin()) / PI;
    inside + (rise - 1.0).max(0.0)
}

/// Mean share of the disc that is visible between two places.
#[inline(always)]
pub(crate) fn mean_share(a: f32, b: f32) -> f32 {
    if a.min(b) >= 1.0 {
        return 1.0;
    }
    if a.max(b) <= -1.0 {
        return 0.0;
    }
    let step = b - a;
    match step.abs() < 1e-2 {
        true => visible_share(0.5 * (a + b)),
        false => ((accumulated_share(b) - accumulated_share(a)) / step).clamp(0.0, 1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_the_disc_has_its_centroid_at_four_thirds_over_pi() {
        assert!((visible_share(0.0) - 0.5).abs() < 1e-6);
        assert!((visible_rise(0.0) - 4.0 / (3.0 * PI)).abs() < 1e-6);
        assert!(visible_share(0.999_999) > 0.999 && visible_share(-0.999_999) < 1e-3);
        assert!((visible_rise(-0.9985)).abs() < 2e-3);
    }

    #[test]
    fn mean_shares_are_means() {
        for (a, b) in [
            (-3.0, 0.5),
            (2.0, -0.2),
            (-0.3, 0.4),
            (-5.0, 9.0),
            (0.1, 0.105),
        ] {
            let n = 10_000;
            let at = |i: i32| visible_share(a + (b - a) * (i as f32 + 0.5) / n as f32);
            let mean = (0..n).map(at).sum::<f32>() / n as f32;
            assert!((mean_share(a, b) - mean).abs() < 1e-3, "{a} {b}");
        }
    }
}

//! Sunlight at a point: the share of the disc above the planet's edge, and the air that it crosses.

use core::f64::consts::PI;

use crate::air::{Amounts, Layers, Line};
use crate::math::{LANES, exp};

/// Angular radius of the sun, rad: 0.2667°.
pub(crate) const SUN_RADIUS: f64 = 0.004_654_793;

/// Sunlight at a point.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sunlight {
    /// Share of the disc that is above the horizon.
    pub share: f32,
    /// Columns towards the centroid of that share, m.
    pub columns: Amounts,
}

/// Columns towards the sun, tabulated around where it stands.
#[derive(Clone, Debug)]
pub(crate) struct Beam {
    /// Lowest and highest angle above the geometric horizon in the table, rad.
    range: [f64; 2],
    /// Logarithms, `[altitude][angle]`.
    columns: Vec<Amounts>,
}

/// How far the sun's local elevation may be from that of the scene, rad.
const REACH: f64 = 0.06;
/// Angles above the horizon, ever closer towards the lowest.
const ANGLES: usize = 64;
/// Altitudes, ever closer towards the ground.
const ALTITUDES: usize = 81;
/// Highest altitude in the table, m.
const TOP: f64 = 20_000.0;
/// Added to columns before the logarithm, m: less is nothing.
const NOTHING: f32 = 1e-3;

impl Beam {
    pub fn new(layers: &Layers, elevation: f64) -> Self {
        let planet = layers.planet();
        let low = (elevation - REACH).max(0.0);
        let high = (elevation + REACH + planet.dip(TOP)).max(low + REACH);
        let node = |i: usize, j: usize| {
            let h = TOP * share(i, ALTITUDES).powi(2);
            let angle = low + (high - low) * share(j, ANGLES).powi(2);
            let mut node = towards(layers, h, (angle - planet.dip(h)).sin());
            let columns = node.0.as_flattened_mut();
            columns.iter_mut().for_each(|c| *c = (*c + NOTHING).ln());
            node
        };
        let nodes = (0..ALTITUDES).flat_map(|i| (0..ANGLES).map(move |j| (i, j)));
        Self {
            range: [low, high],
            columns: nodes.map(|(i, j)| node(i, j)).collect(),
        }
    }

    pub fn bytes(&self) -> usize {
        size_of_val(self.columns.as_slice())
    }

    /// Sunlight at altitude `h` (m) of a sun whose centre stands `sine` above the horizontal plane.
    #[inline]
    pub fn at(&self, layers: &Layers, h: f64, sine: f64) -> Sunlight {
        let dip = layers.planet().dip(h.max(0.0));
        let angle = sine.asin() + dip;
        let x = angle / SUN_RADIUS;
        if x <= -1.0 {
            return Sunlight::default();
        }
        let (share, rise) = if x < 1.0 { visible_disc(x) } else { (1.0, 0.0) };
        let angle = (angle + rise * SUN_RADIUS).max(0.0);
        let tabulated = h <= TOP && (self.range[0]..=self.range[1]).contains(&angle);
        Sunlight {
            share: share as f32,
            columns: match tabulated {
                true => self.columns(layers.quads, h, angle),
                false => towards(layers, h, (angle - dip).sin()),
            },
        }
    }

    #[inline(always)]
    fn columns(&self, quads: usize, h: f64, angle: f64) -> Amounts {
        let [low, high] = self.range;
        let u = (h.max(0.0) / TOP).sqrt() as f32 * (ALTITUDES - 1) as f32;
        let v = ((angle - low) / (high - low)).sqrt() as f32 * (ANGLES - 1) as f32;
        let (i, j) = (
            (u as usize).min(ALTITUDES - 2),
            (v as usize).min(ANGLES - 2),
        );
        let (t, s) = (u - i as f32, v - j as f32);
        let node = |i: usize, j: usize| &self.columns[i * ANGLES + j];
        let corners = [
            node(i, j),
            node(i, j + 1),
            node(i + 1, j),
            node(i + 1, j + 1),
        ];
        let weights = [(1.0 - t) * (1.0 - s), (1.0 - t) * s, t * (1.0 - s), t * s];
        let mut columns = Amounts::default();
        for q in 0..quads {
            let mut sum = [0.0; LANES];
            for (corner, weight) in corners.iter().zip(weights) {
                sum = core::array::from_fn(|i| sum[i] + weight * corner.0[q][i]);
            }
            columns.0[q] = core::array::from_fn(|i| exp(sum[i]));
        }
        columns
    }
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

/// Share of a disc above a straight edge, and by how many radii the centroid of that share stands above the disc's centre, for a
/// centre `x` radii above the edge, −1 < x < 1.
fn visible_disc(x: f64) -> (f64, f64) {
    let chord = 1.0 - x * x;
    let root = chord.sqrt();
    let share = 0.5 + (x * root + x.asin()) / PI;
    (share, 2.0 / 3.0 * chord * root / (PI * share.max(1e-12)))
}

#[cfg(test)]
mod tests {
    use super::visible_disc;

    #[test]
    fn half_the_disc_has_its_centroid_at_four_thirds_over_pi() {
        let (share, rise) = visible_disc(0.0);
        assert!((share - 0.5).abs() < 1e-12);
        assert!((rise - 4.0 / (3.0 * core::f64::consts::PI)).abs() < 1e-12);
        assert!(visible_disc(0.999_999).0 > 0.999 && visible_disc(-0.999_999).0 < 1e-3);
    }
}

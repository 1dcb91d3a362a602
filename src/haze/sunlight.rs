//! Sunlight at a point: the share of the disc above the planet's edge, and the air that it crosses.

use core::f64::consts::PI;

use crate::air::{Amounts, Layers, Line};

/// Angular radius of the sun, rad: 0.2667°.
pub(crate) const SUN_RADIUS: f64 = 0.004_654_793;

/// Sunlight at a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sunlight {
    /// Share of the disc that is above the horizon.
    pub share: f32,
    /// Columns towards the centroid of that share, m.
    pub columns: Amounts,
}

impl Sunlight {
    /// Of a sun whose centre stands `sine` above the horizontal plane at altitude `h` (m).
    #[inline]
    pub fn at(layers: &Layers, h: f64, sine: f64) -> Self {
        let planet = layers.planet();
        let (mut share, mut towards) = (1.0, sine);
        // Above its own radius no altitude lets the planet hide any of the sun.
        if sine < SUN_RADIUS {
            let dip = planet.dip(h.max(0.0));
            let angle = sine.asin() + dip;
            let x = angle / SUN_RADIUS;
            if x <= -1.0 {
                return Self {
                    share: 0.0,
                    columns: Amounts::default(),
                };
            }
            if x < 1.0 {
                let (visible, rise) = visible_disc(x);
                share = visible;
                towards = ((angle + rise * SUN_RADIUS).max(0.0) - dip).sin();
            }
        }
        let diameter = 2.0 * planet.radius;
        let from = (planet.radius + h) * towards;
        let line = Line {
            lowest: planet.squared_altitude(h) - from * from / diameter,
        };
        let top = (planet.squared_altitude(planet.top) - line.lowest) * diameter;
        let to = top.max(0.0).sqrt();
        Self {
            share: share as f32,
            columns: layers.columns(line, from, to.max(from)),
        }
    }
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

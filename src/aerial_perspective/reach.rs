//! How far from where it was prepared an aerial perspective holds.

use super::source_table::reach;
use crate::error::{Error, Result};
use crate::geometry::Planet;
use crate::transmittance::Segment;

/// A cone around the vertical of the origin, from the planet's centre. A segment with both ends in it is in it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// Half its opening, rad.
    pub angle: f64,
    /// Squared tangent of that.
    slope: f64,
}

impl Reach {
    pub fn new(planet: &Planet) -> Self {
        let angle = reach(planet);
        Self {
            angle,
            slope: angle.tan().powi(2),
        }
    }

    /// Whether all air of a segment is within reach.
    #[inline(always)]
    pub fn check(&self, planet: &Planet, segment: &Segment) -> Result<()> {
        let end = segment.point(segment.to());
        match self.holds(segment.start) && self.holds(end) {
            true => Ok(()),
            false => self.check_air(planet, segment),
        }
    }

    /// Beyond the air there is nothing to be wrong about.
    #[cold]
    fn check_air(&self, planet: &Planet, segment: &Segment) -> Result<()> {
        let diameter = 2.0 * planet.radius;
        let square = (planet.squared_altitude(planet.top) - segment.line.lowest) * diameter;
        let half = square.max(0.0).sqrt();
        let ends = [segment.from.max(-half), segment.to().min(half)];
        if ends[0] >= ends[1] {
            return Ok(());
        }
        for [x, y, z] in ends.map(|s| segment.point(s)) {
            if !self.holds([x, y, z]) {
                return Err(Error::Reach {
                    got: [x, y, z - planet.radius],
                    reach: self.angle,
                });
            }
        }
        Ok(())
    }

    /// Of a point relative to the planet's centre.
    #[inline(always)]
    fn holds(&self, [x, y, z]: [f64; 3]) -> bool {
        z > 0.0 && x * x + y * y <= self.slope * z * z
    }
}

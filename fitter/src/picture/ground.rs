//! What the ground looks like.

use crate::tracer::solids::Reflectance;
use glam::DVec3;

/// The pattern on the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// None.
    Plain,
    /// Squares of the albedo and of a fifth of it.
    Checker,
    /// Dark lines, a twentieth of the cell wide.
    Grid,
}

/// A Lambertian ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Its pattern.
    pub pattern: Pattern,
    /// Albedo of its bright parts.
    pub albedo: f64,
    /// Length of the pattern's cells, m.
    pub cell: f64,
}

impl Ground {
    /// What a point (planet-centred) reflects. The pattern is laid out by the distances ahead and to the left.
    pub fn at(&self, point: DVec3) -> Reflectance {
        let radius = point.length();
        let place = [point.x, point.y].map(|v| radius * v.atan2(point.z) / self.cell);
        let dark = match self.pattern {
            Pattern::Plain => false,
            Pattern::Checker => (place[0].floor() + place[1].floor()).rem_euclid(2.0) >= 1.0,
            Pattern::Grid => place.iter().any(|v| v.rem_euclid(1.0) < 0.05),
        };
        Reflectance::grey(if dark { 0.2 * self.albedo } else { self.albedo })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_repeat() {
        let at = |pattern, x: f64, y: f64| {
            let ground = Ground {
                pattern,
                albedo: 0.5,
                cell: 1000.0,
            };
            ground.at(DVec3::new(x, y, 6_371_000.0)).at(550.0)
        };
        assert_eq!(at(Pattern::Plain, 1.0, 1.0), 0.5);
        assert_eq!(at(Pattern::Checker, 10.0, 10.0), 0.5);
        assert_eq!(at(Pattern::Checker, -10.0, 10.0), 0.1);
        assert_eq!(at(Pattern::Checker, -10.0, -10.0), 0.5);
        assert_eq!(at(Pattern::Grid, 10.0, 500.0), 0.1);
        assert_eq!(at(Pattern::Grid, 500.0, 500.0), 0.5);
    }
}

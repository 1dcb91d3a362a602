//! Rays between two spheres: a point is its distance `r` from the centre, a direction the cosine `mu` of its zenith
//! angle there. Lengths in metres.

/// Ground and top of the air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shell {
    /// Radius of the ground.
    pub bottom: f64,
    /// Radius at which the air ends.
    pub top: f64,
}

impl Shell {
    /// Length of the tangent from the ground to the top.
    pub fn horizon(&self) -> f64 {
        self.tangent(self.top)
    }

    /// Distance from `r` to where a line touches the ground.
    pub fn tangent(&self, r: f64) -> f64 {
        ((r - self.bottom) * (r + self.bottom)).max(0.0).sqrt()
    }

    /// `r` of a point whose tangent is that long.
    pub fn radius_of_tangent(&self, tangent: f64) -> f64 {
        tangent.hypot(self.bottom).clamp(self.bottom, self.top)
    }

    /// How far it is to the top.
    pub fn to_top(&self, r: f64, mu: f64) -> f64 {
        let above = (self.top - r) * (self.top + r);
        let (along, root) = (r * mu, ((r * mu).powi(2) + above).max(0.0).sqrt());
        // The form without cancellation of the two that are the same.
        match along > 0.0 && root + along > 0.0 {
            true => (above / (root + along)).max(0.0),
            false => (root - along).max(0.0),
        }
    }

    /// How far it is to the ground of a ray that meets it.
    pub fn to_ground(&self, r: f64, mu: f64) -> f64 {
        let below = (r - self.bottom) * (r + self.bottom);
        let root = ((r * mu).powi(2) - below).max(0.0).sqrt();
        let sum = root - r * mu;
        match sum > 0.0 {
            true => (below / sum).max(0.0),
            false => 0.0,
        }
    }

    /// Whether a ray meets the ground.
    pub fn meets_ground(&self, r: f64, mu: f64) -> bool {
        mu < 0.0 && (r * mu).powi(2) >= (r - self.bottom) * (r + self.bottom)
    }

    /// To the ground or to the top.
    pub fn to_end(&self, r: f64, mu: f64, ground: bool) -> f64 {
        match ground {
            true => self.to_ground(r, mu),
            false => self.to_top(r, mu),
        }
    }

    /// `r` and `mu` after a distance.
    pub fn advanced(&self, r: f64, mu: f64, distance: f64) -> (f64, f64) {
        let there = (distance * distance + 2.0 * r * mu * distance + r * r).sqrt();
        let mu = ((r * mu + distance) / there).clamp(-1.0, 1.0);
        (there.clamp(self.bottom, self.top), mu)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EARTH: Shell = Shell {
        bottom: 6.36e6,
        top: 6.42e6,
    };

    #[test]
    fn distances_are_those_of_straight_lines() {
        let r = EARTH.bottom + 10e3;
        assert!((EARTH.to_top(r, 1.0) - 50e3).abs() < 1e-6);
        assert!((EARTH.to_ground(r, -1.0) - 10e3).abs() < 1e-6);
        for mu in [-1.0, -0.5, -0.06, 0.0, 0.3, 1.0] {
            let ground = EARTH.meets_ground(r, mu);
            let (end, _) = EARTH.advanced(r, mu, EARTH.to_end(r, mu, ground));
            let expected = if ground { EARTH.bottom } else { EARTH.top };
            assert!((end - expected).abs() < 1e-6, "{mu}: {end}");
        }
        assert!((EARTH.radius_of_tangent(EARTH.tangent(r)) - r).abs() < 1e-6);
    }

    #[test]
    fn the_horizon_is_where_the_tangent_is() {
        let r = EARTH.bottom + 3e3;
        let horizon = -EARTH.tangent(r) / r;
        assert!(EARTH.meets_ground(r, horizon - 1e-9));
        assert!(!EARTH.meets_ground(r, horizon + 1e-9));
    }
}

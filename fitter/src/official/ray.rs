//! Lines through the air.

use super::angles::PLANET_RADIUS;
use super::transmittance::TOP;

/// A line from a stored altitude.
pub struct Ray {
    /// Altitude, m.
    pub altitude: f64,
    /// Zenith angle, rad.
    pub theta: f64,
    /// Length, m; infinite to the end of the air or to the ground.
    pub length: f64,
}

impl Ray {
    /// Where it ends, in a frame whose origin is on the ground below its start: at its length, on the ground or at the
    /// top.
    pub fn end(&self) -> [f64; 3] {
        let (sine, cosine) = self.theta.sin_cos();
        let r = PLANET_RADIUS + self.altitude;
        let half = |radius: f64| (radius * radius - r * r * sine * sine).max(0.0).sqrt();
        let nearest = -r * cosine;
        let whole = match nearest > 0.0 && r * sine < PLANET_RADIUS {
            true => nearest - half(PLANET_RADIUS),
            false => nearest + half(PLANET_RADIUS + TOP),
        };
        let length = whole.min(self.length);
        [sine * length, 0.0, self.altitude + cosine * length]
    }
}

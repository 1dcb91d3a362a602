//! Things in the air: what walks may meet besides air and plain ground.

use glam::DVec3;

/// Wavelengths (nm) for which a [`Reflectance`] is given: blue, green, red.
const NODES: [f64; 3] = [450.0, 550.0, 610.0];

/// Lambertian reflectance in red, green and blue, linear in wavelength between 450, 550 and 610 nm and constant beyond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reflectance(pub [f64; 3]);

impl Reflectance {
    /// The same at all wavelengths.
    pub fn grey(value: f64) -> Self {
        Self([value; 3])
    }

    /// Its value at a wavelength (nm).
    pub fn at(&self, nm: f64) -> f64 {
        let [red, green, blue] = self.0;
        let between = |from: f64, to: f64, a: f64, b: f64| {
            let t = ((nm - from) / (to - from)).clamp(0.0, 1.0);
            a + t * (b - a)
        };
        if nm < NODES[1] {
            between(NODES[0], NODES[1], blue, green)
        } else {
            between(NODES[1], NODES[2], green, red)
        }
    }
}

/// Where a ray meets a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray, m.
    pub distance: f64,
    /// Unit normal on the ray's side.
    pub normal: DVec3,
    /// What the surface reflects.
    pub reflectance: Reflectance,
}

/// Opaque Lambertian surfaces in planet-centred coordinates (m). z points from the planet's centre to the observer.
pub trait Solids: Sync {
    /// The first surface that a ray meets before `limit`.
    fn hit(&self, origin: DVec3, direction: DVec3, limit: f64) -> Option<Hit>;

    /// Whether a ray meets any.
    fn blocks(&self, origin: DVec3, direction: DVec3) -> bool;

    /// What the planet's ground reflects at a point of it.
    fn ground(&self, point: DVec3) -> Reflectance;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reflectances_are_interpolated() {
        let r = Reflectance([0.9, 0.5, 0.1]);
        for (nm, value) in [
            (400.0, 0.1),
            (450.0, 0.1),
            (500.0, 0.3),
            (550.0, 0.5),
            (580.0, 0.7),
            (700.0, 0.9),
        ] {
            assert!((r.at(nm) - value).abs() < 1e-12, "{nm}");
        }
    }
}

//! Where along a ray the nodes of its distance stand: closer together near the camera and in the lower air.

use crate::geometry::{Planet, Side};

/// How far rays go on beyond ground and air, m, so that none ends where it begins.
const BEYOND: f64 = 20.0;
/// w up to which nodes crowd in the lower air, m, and how they do towards the camera: what gives p99 ≤ 0.5 % of light
/// from the ground to 30 km with suns down to −4° (`bash shaders/check`).
const HAZE: f64 = 12e3;
const NEARNESS: f64 = 20.0;

/// The rays from a camera. With `w = h + h²/2R`, a parabola of the distance `s`, and `p = √(w + HAZE)`, nodes stand at
/// even steps of `log2(1 + NEARNESS · m(s) / m(end))`, where `m = ½ ∫ p⁻³ ds` is a closed expression.
#[derive(Clone, Copy, Debug)]
pub(super) struct RayNodes {
    planet: Planet,
    /// w of the camera, m.
    height: f64,
    /// z of the geometric horizon.
    horizon: f64,
}

/// What [`AerialHeader`](super::aerial_buffers::AerialHeader) has of them.
pub(super) struct Measure {
    pub height: f64,
    pub top: f64,
    pub bend: f64,
    pub steepness: f64,
    pub haze: f64,
    pub nearness: f64,
    pub per_stretch: f64,
}

/// What the distances of a ray depend on.
#[derive(Clone, Copy, Debug)]
struct Way {
    /// Growth of `w` at the camera.
    rise: f64,
    end: f64,
}

impl RayNodes {
    pub fn new(planet: Planet, altitude: f64, horizon: f64) -> Self {
        Self {
            planet,
            height: planet.squared_altitude(altitude),
            horizon,
        }
    }

    pub fn measure(&self) -> Measure {
        Measure {
            height: self.height,
            top: self.planet.squared_altitude(self.planet.top),
            bend: self.bend(),
            steepness: self.steepness(),
            haze: HAZE,
            nearness: NEARNESS,
            per_stretch: 1.0 / (1.0 + NEARNESS).log2(),
        }
    }

    /// Distances of the nodes of so many intervals, m, from 0 to the end of the ray.
    pub fn distances(&self, side: Side, z: f64, intervals: usize) -> Vec<f64> {
        let way = self.way(side, z);
        let whole = self.measured(way, way.end);
        let share = |k: usize| {
            let stretch = (1.0 + NEARNESS).powf(k as f64 / intervals as f64);
            (stretch - 1.0) / NEARNESS
        };
        (0..=intervals)
            .map(|k| self.distance(way, share(k) * whole))
            .collect()
    }

    fn bend(&self) -> f64 {
        0.5 / self.planet.radius
    }

    /// r / R of the camera.
    fn steepness(&self) -> f64 {
        (1.0 + 4.0 * self.bend() * self.height).sqrt()
    }

    /// Of the ray at this cosine from the vertical.
    fn way(&self, side: Side, z: f64) -> Way {
        let (bend, steepness) = (self.bend(), self.steepness());
        let rise = z * steepness;
        let end = match side {
            Side::Down => {
                let root = ((z - self.horizon) * (z + self.horizon)).max(0.0).sqrt();
                // On the ground, along it.
                let slope = (root - z).max(f64::MIN_POSITIVE);
                2.0 * self.height / (slope * steepness)
            }
            Side::Up => {
                let room = self.planet.squared_altitude(self.planet.top) - self.height;
                let root = (rise * rise + 4.0 * bend * room).max(0.0).sqrt();
                (root - rise) / (2.0 * bend)
            }
        };
        Way {
            rise,
            end: end.max(0.0) + BEYOND,
        }
    }

    /// m up to a distance.
    fn measured(&self, way: Way, s: f64) -> f64 {
        let start = self.height + HAZE;
        let p = start.sqrt();
        let q = (start + s * (way.rise + s * self.bend()))
            .max(0.5 * HAZE)
            .sqrt();
        let u = s / (p + q);
        u / (p * q * (1.0 - self.bend() * u * u))
    }

    /// The distance that has this m, by bisection.
    fn distance(&self, way: Way, m: f64) -> f64 {
        let [mut low, mut high] = [0.0, way.end];
        for _ in 0..f64::MANTISSA_DIGITS {
            let middle = 0.5 * (low + high);
            match self.measured(way, middle) < m {
                true => low = middle,
                false => high = middle,
            }
        }
        0.5 * (low + high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EARTH: Planet = Planet {
        radius: 6.378e6,
        top: 100e3,
    };

    fn nodes(altitude: f64) -> RayNodes {
        RayNodes::new(EARTH, altitude, -EARTH.dip(altitude).sin())
    }

    #[test]
    fn the_measure_is_the_integral() {
        for (altitude, side, z) in [
            (2.0, Side::Up, 0.0),
            (2.0, Side::Up, 1.0),
            (30e3, Side::Up, -0.09),
            (30e3, Side::Down, -0.1),
            (30e3, Side::Down, -1.0),
        ] {
            let nodes = nodes(altitude);
            let way = nodes.way(side, z);
            let density = |s: f64| {
                let w = nodes.height + s * (way.rise + s * nodes.bend());
                0.5 * (w + HAZE).powf(-1.5)
            };
            const STEPS: usize = 20_000;
            let end = way.end - BEYOND;
            let step = end / STEPS as f64;
            let sum: f64 = (0..STEPS).map(|i| density((i as f64 + 0.5) * step)).sum();
            let off = nodes.measured(way, end) / (sum * step) - 1.0;
            assert!(off.abs() < 1e-6, "{altitude} {z}: {off}");
        }
    }

    #[test]
    fn nodes_go_from_the_camera_to_the_end_of_the_ray() {
        for (altitude, side, z) in [
            (0.0, Side::Up, 0.0),
            (0.0, Side::Down, -1e-9),
            (0.0, Side::Down, -1.0),
            (3e3, Side::Up, 0.5),
            (30e3, Side::Down, -0.2),
            (200e3, Side::Up, 1.0),
        ] {
            let nodes = nodes(altitude);
            let (distances, way) = (nodes.distances(side, z, 40), nodes.way(side, z));
            assert!(distances[0] < 1e-6 && (distances[40] / way.end - 1.0).abs() < 1e-9);
            assert!(distances.is_sorted_by(|a, b| a < b), "{altitude} {z}");
            let length = EARTH.ray(altitude, z.asin()).length;
            if altitude < EARTH.top && z != -1e-9 {
                let off = way.end - BEYOND - length;
                assert!(off.abs() < 1e-6 * length + 1e-3, "{altitude} {z}: {off}");
            }
        }
    }
}

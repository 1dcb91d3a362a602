//! Sunlight in the atmosphere: exact, and as a coarse table that only steers sampling.

use super::medium::Medium;
use super::shell_crossings::Line;
use glam::DVec3;

const HEIGHTS: usize = 64;
const ANGLES: usize = 96;
/// Wavelength lanes that steer sampling.
pub const GUIDES: usize = 3;

impl<const N: usize> Medium<N> {
    /// Transmittance from `point` to the sun; `None` in the planet's shadow.
    pub fn sunlight(&self, point: DVec3, sun: DVec3) -> Option<[f64; N]> {
        let line = Line::new(point, sun);
        if line.start < 0.0 && line.tangent2 < self.radius * self.radius {
            return None;
        }
        Some(self.transmittance(&self.columns_to_space(&line)))
    }

    /// The wavelength lanes that steer sampling: first, middle and last.
    pub fn guides(&self) -> Vec<usize> {
        let mut lanes = vec![0, self.active / 2, self.active - 1];
        lanes.dedup();
        lanes
    }
}

/// Optical depth to the sun at the guiding wavelengths, by altitude and horizon-relative sun angle.
pub struct SunGuide {
    radius: f64,
    thickness: f64,
    depth: Vec<[f64; GUIDES]>,
}

impl SunGuide {
    /// Tabulates `medium`.
    pub fn new<const N: usize>(medium: &Medium<N>) -> Self {
        let (radius, thickness) = (medium.radius, medium.top - medium.radius);
        let lanes = medium.guides();
        let mut depth = Vec::with_capacity(HEIGHTS * ANGLES);
        for i in 0..HEIGHTS {
            let x = i as f64 / (HEIGHTS - 1) as f64;
            let r = radius + thickness * x * x;
            let horizon = horizon_cosine(radius, r);
            for j in 0..ANGLES {
                let y = j as f64 / (ANGLES - 1) as f64;
                let mu = (horizon + (1.0 - horizon) * y.powi(4)).clamp(-1.0, 1.0);
                let sun = DVec3::new((1.0 - mu * mu).max(0.0).sqrt(), 0.0, mu);
                let line = Line::new(DVec3::new(0.0, 0.0, r), sun);
                let tau = medium.extinction_of(&medium.columns_to_space(&line));
                depth.push(std::array::from_fn(|g| {
                    tau[lanes[g.min(lanes.len() - 1)]].min(600.0)
                }));
            }
        }
        Self {
            radius,
            thickness,
            depth,
        }
    }

    /// Approximate optical depth at radius `r` under a sun at zenith cosine `mu`; `None` in the shadow.
    pub fn depth(&self, r: f64, mu: f64) -> Option<[f64; GUIDES]> {
        let horizon = horizon_cosine(self.radius, r);
        let y = (mu - horizon) / (1.0 - horizon);
        if y < 0.0 {
            return None;
        }
        let x = ((r - self.radius) / self.thickness).clamp(0.0, 1.0).sqrt();
        let (i, u) = split(x, HEIGHTS);
        let (j, v) = split(y.sqrt().sqrt(), ANGLES);
        let at = |i: usize, j: usize| &self.depth[i * ANGLES + j];
        let (a, b, c, d) = (at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1));
        Some(std::array::from_fn(|g| {
            let low = a[g] + v * (b[g] - a[g]);
            let high = c[g] + v * (d[g] - c[g]);
            low + u * (high - low)
        }))
    }
}

/// Zenith cosine of the geometric horizon seen from radius `r`.
fn horizon_cosine(radius: f64, r: f64) -> f64 {
    let q = (radius / r).min(1.0);
    -(1.0 - q * q).sqrt()
}

fn split(x: f64, n: usize) -> (usize, f64) {
    let x = x.min(1.0) * (n - 1) as f64;
    let i = (x as usize).min(n - 2);
    (i, x - i as f64)
}

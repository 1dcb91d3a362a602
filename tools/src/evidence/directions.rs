//! Where models are compared: directions above the horizon, dense at it and about the sun's meridian, on one side of
//! which the sky is as on the other.

use std::fmt::Write as _;

use super::cases::Case;

/// Zenith angles, degrees.
const ZENITHS: [f64; 11] = [
    5.0, 15.0, 25.0, 35.0, 45.0, 55.0, 65.0, 75.0, 82.0, 86.0, 89.0,
];
/// Azimuths from the sun, degrees.
const AZIMUTHS: [f64; 8] = [5.0, 15.0, 30.0, 60.0, 90.0, 120.0, 150.0, 175.0];

/// A direction and the part of the sky that it stands for.
#[derive(Clone, Copy, Debug)]
pub struct Site {
    /// From the zenith, degrees.
    pub zenith: f64,
    /// From the sun, degrees.
    pub azimuth: f64,
    /// Solid angle, sr; those of all sites make up half the sky.
    pub weight: f64,
}

impl Site {
    /// The unit vector, the sun over +x.
    pub fn direction(&self) -> [f32; 3] {
        let (r, z) = self.zenith.to_radians().sin_cos();
        let (y, x) = self.azimuth.to_radians().sin_cos();
        [r * x, r * y, z].map(|v| v as f32)
    }

    /// Degrees from a sun at an elevation in degrees.
    pub fn from_sun(&self, elevation: f64) -> f64 {
        let (z, x) = elevation.to_radians().sin_cos();
        let [a, _, c] = self.direction().map(f64::from);
        (a * x + c * z).clamp(-1.0, 1.0).acos().to_degrees()
    }
}

/// All of them.
pub fn sites() -> Vec<Site> {
    let zeniths = cells(&ZENITHS, 90.0);
    let azimuths = cells(&AZIMUTHS, 180.0);
    let mut sites = Vec::new();
    for (zenith, [top, bottom]) in zeniths {
        let height = top.to_radians().cos() - bottom.to_radians().cos();
        for &(azimuth, [from, to]) in &azimuths {
            sites.push(Site {
                zenith,
                azimuth,
                weight: height * (to - from).to_radians(),
            });
        }
    }
    sites
}

/// Each angle with the middles between it and its neighbours.
fn cells(angles: &[f64], end: f64) -> Vec<(f64, [f64; 2])> {
    let middle = |i: usize| 0.5 * (angles[i - 1] + angles[i]);
    let cell = |(i, &angle): (usize, &f64)| {
        let from = if i == 0 { 0.0 } else { middle(i) };
        let to = if i + 1 == angles.len() {
            end
        } else {
            middle(i + 1)
        };
        (angle, [from, to])
    };
    angles.iter().enumerate().map(cell).collect()
}

/// The lines of sight of all suns of a case, as `welkin-fit trace` reads them.
pub fn queries(case: &Case) -> String {
    let mut text =
        String::from("altitude_m,view_zenith_deg,view_azimuth_deg,solar_elevation_deg,albedo\n");
    for sun in case.suns {
        for site in sites() {
            let _ = writeln!(
                text,
                "0,{},{},{sun},{}",
                site.zenith, site.azimuth, case.albedo
            );
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sites_make_up_half_the_sky() {
        let sum: f64 = sites().iter().map(|site| site.weight).sum();
        assert!((sum - std::f64::consts::PI).abs() < 1e-9);
    }

    #[test]
    fn angles_from_the_sun_are_right() {
        let site = Site {
            zenith: 30.0,
            azimuth: 0.0,
            weight: 0.0,
        };
        assert!((site.from_sun(20.0) - 40.0).abs() < 1e-4);
    }
}

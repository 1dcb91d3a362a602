//! Segments under suns, and what exact integrals say about them.

use crate::successive_orders::Gatherer;
use crate::successive_orders::ray_points::trace;
use crate::successive_orders::scattered_source::{Stokes, Sun};
use crate::units::Solved;
use anyhow::{Result, ensure};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::f64::consts::PI;

/// A segment in the vertical frame of its start, with the sun towards azimuth 0.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Index of the visibility.
    pub visibility: usize,
    /// Altitude of the start, m.
    pub altitude: f64,
    /// Elevation and azimuth of the direction, rad.
    pub direction: [f64; 2],
    /// Length, m.
    pub length: f64,
    /// Solar elevation at the start, rad.
    pub sun: f64,
    /// Albedo of the ground.
    pub albedo: f64,
}

/// Length of the segments of the exact integral, relative to the finest of the successive-orders solver.
const FINENESS: f64 = 0.5;

impl Case {
    /// Whether its direction is within 2° of the horizontal.
    pub fn near_horizon(&self) -> bool {
        self.direction[0].abs() <= 2f64.to_radians()
    }

    /// Start and end in the world frame, m.
    pub fn ends(&self) -> [[f64; 3]; 2] {
        let (start, unit) = ([0.0, 0.0, self.altitude], self.unit());
        [
            start,
            std::array::from_fn(|k| start[k] + self.length * unit[k]),
        ]
    }

    /// Unit vector from start to end.
    pub fn unit(&self) -> [f64; 3] {
        let [elevation, azimuth] = self.direction;
        let ((se, ce), (sa, ca)) = (elevation.sin_cos(), azimuth.sin_cos());
        [ce * ca, ce * sa, se]
    }

    /// Exact in-scattered light per unit of solar irradiance, sr⁻¹; I, Q and U in the vertical frame.
    pub fn truth(&self, solved: &Solved) -> Stokes {
        let gatherer = Gatherer::new(&solved.medium, &solved.light, FINENESS);
        let mu = self.direction[0].sin();
        let path = trace(
            &solved.medium,
            self.altitude,
            mu,
            self.length,
            false,
            FINENESS,
        );
        let sun = Sun {
            elevation: (self.sun.cos(), self.sun.sin()),
            azimuth: (self.direction[1].cos(), self.direction[1].sin()),
        };
        gatherer.stokes(&path, mu, &sun, self.albedo as f32)
    }
}

/// `count` random segments for each of the visibilities: 1 m to 300 km, never through the ground; observers up to
/// `highest` (m); half of the directions crowd around the horizontal, half of the suns stand below 0°, and all crowd
/// around it.
///
/// # Errors
/// If hardly any segment is 1 m long: there is no air up to `highest`.
pub fn cases(solved: &[Solved], count: usize, highest: f64, seed: u64) -> Result<Vec<Case>> {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    let mut uniform = || (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    let mut out = vec![];
    for (visibility, one) in solved.iter().enumerate() {
        let planet = crate::column::planet(&one.medium.atmosphere);
        // Some three in four are long enough.
        for _ in 0..100 + 100 * count {
            if out.len() == count * (visibility + 1) {
                break;
            }
            let altitude = highest * uniform().powi(2);
            let t = 2.0 * uniform() - 1.0;
            let elevation = match out.len() % 2 {
                0 => t.powi(3) * 2f64.to_radians(),
                _ => t.asin(),
            };
            let sun = match out.len() / 2 % 2 {
                0 => 60.0 * uniform().powi(2),
                _ => -4.2 * uniform().powf(1.5),
            };
            let length = 10f64.powf(300_000f64.log10() * uniform());
            let whole = planet.ray(altitude, elevation).length;
            let case = Case {
                visibility,
                altitude,
                direction: [elevation, PI * uniform()],
                length: length.min(0.999 * whole),
                sun: sun.to_radians(),
                albedo: uniform(),
            };
            if case.length >= 1.0 {
                out.push(case);
            }
        }
        ensure!(
            out.len() == count * (visibility + 1),
            "no segments of 1 m for observers up to {highest} m"
        );
    }
    Ok(out)
}

//! Runs programs on whatever Vulkan there is, and compares.
#![allow(dead_code)] // Each test uses some of it.

pub mod gpu;
pub mod readme;

use welkin::{Conditions, Model};

/// Directions of all kinds, as they are looked up: in single precision.
pub fn directions(sun: [f32; 3], horizon: f64) -> Vec<[f32; 3]> {
    let mut out = vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], sun, sun.map(|v| -v)];
    let mut add = |z: f64, phi: f64| {
        let flat = (1.0 - z * z).max(0.0).sqrt();
        out.push([flat * phi.cos(), flat * phi.sin(), z].map(|v| v as f32));
    };
    for i in 0..4000 {
        let (share, phi) = (
            (f64::from(i) + 0.5) / 2000.0 - 1.0,
            f64::from(i) * 2.399_963,
        );
        add(share, phi);
        // Beside the geometric horizon, on it, and beside the level.
        add(horizon + share.powi(5) * 0.02, phi);
        if i % 40 == 0 {
            for z in [horizon, horizon + 1e-4, horizon - 1e-4, 0.0, 1e-4, -1e-4] {
                add(z, phi);
            }
            add(1.0 - 1e-7 * share * share, phi);
        }
    }
    // About the sun, and in the vertical plane through it.
    for i in 0..1000 {
        let (r, phi) = (
            0.1 * (f64::from(i) / 1000.0).powi(3),
            f64::from(i) * 2.399_963,
        );
        let d = [r * phi.cos(), r * phi.sin(), r * (3.0 * phi).sin()];
        let near = core::array::from_fn(|k| f64::from(sun[k]) + d[k]);
        out.push(unit(near).map(|v| v as f32));
    }
    out
}

pub fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|v| v * v).sum::<f64>().sqrt();
    v.map(|v| v / length)
}

/// Suns of 40° to a vertical one and to civil twilight, and observers on the ground, on mountains and in balloons.
pub fn scenes() -> Vec<Conditions> {
    let mut out = Vec::new();
    for elevation in [40.0, 90.0, 2.0, -4.0] {
        for altitude in [0.0, 3e3, 30e3] {
            out.push(Conditions {
                solar_elevation: f64::to_radians(elevation),
                solar_azimuth: 0.7,
                altitude,
                ..Conditions::default()
            });
        }
    }
    out
}

/// z of unit vectors to the geometric horizon.
pub fn horizon(conditions: &Conditions) -> f64 {
    let planet = Model::default_model()
        .unwrap()
        .transmittance(40e3)
        .unwrap()
        .planet();
    -planet.dip(conditions.altitude).sin()
}

/// Relative differences.
#[derive(Default)]
pub struct Errors(Vec<f64>);

impl Errors {
    pub fn add(&mut self, got: f32, expected: f32, floor: f32) {
        assert!(got.is_finite(), "{got}, expected {expected}");
        let scale = f64::from(expected.abs().max(floor).max(f32::MIN_POSITIVE));
        self.0.push(f64::from((got - expected).abs()) / scale);
    }

    /// Prints median, p95, p99 and maximum in per cent, and returns the last two as they are.
    pub fn report(mut self, what: &str) -> [f64; 2] {
        self.0.sort_by(f64::total_cmp);
        let at = |share: f64| self.0[((self.0.len() - 1) as f64 * share) as usize];
        let [median, p95, p99, max] = [0.5, 0.95, 0.99, 1.0].map(at);
        let percent = [median, p95, p99, max].map(|v| format!("{:.5}", 100.0 * v));
        println!("{what}: {} %, of {}", percent.join(" / "), self.0.len());
        if readme::is_blessed() {
            readme::record([what.into(), percent.join(" / "), self.0.len().to_string()]);
        }
        [p99, max]
    }
}

//! The same questions in every run.

use welkin::{Conditions, Model};

/// Numbers in 0..1 that fill their space evenly (the R sequence of Roberts).
pub struct Sequence<const N: usize> {
    state: [f64; N],
    step: [f64; N],
}

impl<const N: usize> Default for Sequence<N> {
    fn default() -> Self {
        // The root of x^(N+1) = x + 1.
        let root = (0..64).fold(1.5f64, |x, _| (1.0 + x).powf(1.0 / (N as f64 + 1.0)));
        let step = std::array::from_fn(|i| root.powi(-(i as i32) - 1));
        Self {
            state: [0.5; N],
            step,
        }
    }
}

impl<const N: usize> Sequence<N> {
    /// The next of them.
    pub fn draw(&mut self) -> [f64; N] {
        for (state, step) in self.state.iter_mut().zip(self.step) {
            *state = (*state + step).fract();
        }
        self.state
    }
}

/// A direction that is uniform over the sphere.
pub fn sphere([a, b]: [f64; 2]) -> [f32; 3] {
    let z = 1.0 - 2.0 * a;
    let r = (1.0 - z * z).sqrt();
    let (y, x) = (std::f64::consts::TAU * b).sin_cos();
    [r * x, r * y, z].map(|v| v as f32)
}

/// Conditions anywhere in the model.
pub fn conditions(model: &Model, [a, b, c, d]: [f64; 4]) -> Conditions {
    let between = |[low, high]: [f64; 2], t: f64| low + t * (high - low);
    Conditions {
        solar_elevation: between(model.solar_elevation_range(), a),
        solar_azimuth: 0.0,
        visibility: between(model.visibility_range(), b),
        albedo: c,
        altitude: between(model.altitude_range(), d),
    }
}

/// 95th percentile of relative errors, nothing excluded.
pub fn p95(pairs: impl Iterator<Item = (f32, f32)>) -> f64 {
    let error = |(got, expected): (f32, f32)| match got == expected {
        true => 0.0,
        false => (f64::from(got) / f64::from(expected) - 1.0).abs(),
    };
    let mut errors: Vec<f64> = pairs.map(error).collect();
    errors.sort_by(f64::total_cmp);
    errors[(errors.len() - 1) * 95 / 100]
}

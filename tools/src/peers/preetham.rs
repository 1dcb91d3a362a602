//! Preetham, Shirley and Smits 1999, *A Practical Analytic Model for Daylight*: the five-parameter distribution of
//! Perez et al. 1993 for luminance and both chromaticities, fitted to skies of turbidities 2 to 6.

use super::sky::{Observer, Sky, SkyModel};

/// The model at one turbidity.
#[derive(Clone, Copy, Debug)]
pub struct Preetham {
    /// Optical thickness of molecules and particles over that of molecules.
    pub turbidity: f64,
}

/// Slope and offset over the turbidity of A to E, for Y, x and y (Appendix A.2).
const DISTRIBUTION: [[[f64; 2]; 5]; 3] = [
    [
        [0.1787, -1.4630],
        [-0.3554, 0.4275],
        [-0.0227, 5.3251],
        [0.1206, -2.5771],
        [-0.0670, 0.3703],
    ],
    [
        [-0.0193, -0.2592],
        [-0.0665, 0.0008],
        [-0.0004, 0.2125],
        [-0.0641, -0.8989],
        [-0.0033, 0.0452],
    ],
    [
        [-0.0167, -0.2608],
        [-0.0950, 0.0092],
        [-0.0079, 0.2102],
        [-0.0441, -1.6537],
        [-0.0109, 0.0529],
    ],
];

/// Chromaticity of the zenith: rows are turbidity², turbidity and 1, columns θ³ to 1.
const ZENITH_X: [[f64; 4]; 3] = [
    [0.00166, -0.00375, 0.00209, 0.0],
    [-0.02903, 0.06377, -0.03202, 0.00394],
    [0.11693, -0.21196, 0.06052, 0.25886],
];
const ZENITH_Y: [[f64; 4]; 3] = [
    [0.00275, -0.00610, 0.00317, 0.0],
    [-0.04214, 0.08970, -0.04153, 0.00516],
    [0.15346, -0.26756, 0.06670, 0.26688],
];

impl Preetham {
    /// Luminance (cd m⁻²) and chromaticity x, y of the zenith under a sun at a zenith angle, radians.
    pub fn zenith(&self, sun: f64) -> [f64; 3] {
        let t = self.turbidity;
        let chi = (4.0 / 9.0 - t / 120.0) * (std::f64::consts::PI - 2.0 * sun);
        let kilo = (4.0453 * t - 4.9710) * chi.tan() - 0.2155 * t + 2.4192;
        let chromaticity = |rows: [[f64; 4]; 3]| {
            let row = |[a, b, c, d]: [f64; 4]| ((a * sun + b) * sun + c) * sun + d;
            (row(rows[0]) * t + row(rows[1])) * t + row(rows[2])
        };
        [1e3 * kilo, chromaticity(ZENITH_X), chromaticity(ZENITH_Y)]
    }
}

impl SkyModel for Preetham {
    fn sky(&self, observer: Observer) -> Option<Box<dyn Sky + '_>> {
        let sun = std::f64::consts::FRAC_PI_2 - observer.solar_elevation;
        if observer.solar_elevation < 0.0 {
            return None;
        }
        let zenith = self.zenith(sun);
        let perez =
            DISTRIBUTION.map(|rows| rows.map(|[slope, offset]| slope * self.turbidity + offset));
        let scale = std::array::from_fn(|c| zenith[c] / distribution(&perez[c], 1.0, sun));
        Some(Box::new(PreethamSky {
            perez,
            scale,
            sun: observer.sun(),
        }))
    }

    fn bytes(&self) -> usize {
        size_of::<PreethamSky>()
    }
}

/// Five coefficients for each of Y, x and y.
struct PreethamSky {
    perez: [[f64; 5]; 3],
    scale: [f64; 3],
    sun: [f32; 3],
}

/// Equation 3 of the paper, not normalised.
fn distribution(&[a, b, c, d, e]: &[f64; 5], cosine: f64, gamma: f64) -> f64 {
    let gradation = 1.0 + a * (b / cosine.max(1e-3)).exp();
    gradation * (1.0 + c * (d * gamma).exp() + e * gamma.cos().powi(2))
}

impl Sky for PreethamSky {
    fn xyz(&self, direction: [f32; 3]) -> Option<[f32; 3]> {
        if direction[2] < 0.0 {
            return None;
        }
        let cosine = (0..3).map(|i| direction[i] * self.sun[i]).sum::<f32>();
        let gamma = f64::from(cosine.clamp(-1.0, 1.0)).acos();
        let value =
            |c: usize| self.scale[c] * distribution(&self.perez[c], f64::from(direction[2]), gamma);
        let (luminance, x, y) = (value(0), value(1), value(2));
        Some([luminance * x / y, luminance, luminance * (1.0 - x - y) / y].map(|v| v as f32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::peers::colour::chromaticity;

    #[test]
    fn the_zenith_is_that_of_the_formulas() {
        // By hand at turbidity 2 and 3 with the sun in the zenith: only the last columns count.
        let [_, x, y] = Preetham { turbidity: 2.0 }.zenith(0.0);
        assert!((x - (2.0 * 0.00394 + 0.25886)).abs() < 1e-12);
        assert!((y - (2.0 * 0.00516 + 0.26688)).abs() < 1e-12);
        // (4.0453·3 - 4.9710)·tan((4/9 - 1/40)·π/3) - 0.2155·3 + 2.4192, the sun at 60°.
        let [luminance, ..] = Preetham { turbidity: 3.0 }.zenith(60f64.to_radians());
        assert!((luminance - 5_139.156).abs() < 1e-3, "{luminance}");
    }

    #[test]
    fn the_sky_has_the_zenith_it_is_scaled_to() {
        let model = Preetham { turbidity: 2.5 };
        let sky = model.sky(Observer::on_the_ground(0.6)).unwrap();
        let zenith = model.zenith(std::f64::consts::FRAC_PI_2 - 0.6);
        let xyz = sky.xyz([0.0, 0.0, 1.0]).unwrap();
        let [x, y] = chromaticity(xyz);
        assert!((f64::from(xyz[1]) / zenith[0] - 1.0).abs() < 1e-5);
        assert!((f64::from(x) - zenith[1]).abs() < 1e-5 && (f64::from(y) - zenith[2]).abs() < 1e-5);
    }

    #[test]
    fn it_has_no_twilight_and_nothing_below_the_horizon() {
        let model = Preetham { turbidity: 2.0 };
        assert!(model.sky(Observer::on_the_ground(-0.01)).is_none());
        let sky = model.sky(Observer::on_the_ground(0.3)).unwrap();
        assert!(sky.xyz([0.0, 0.6, -0.8]).is_none());
    }
}

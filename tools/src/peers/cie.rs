//! The fifteen relative luminance distributions of ISO 15469:2004 / CIE S 011, *CIE standard general sky*. They have no
//! colour and no luminance of their own: that of the zenith is given.

use super::sky::{Observer, Sky, SkyModel};

/// Parameters a, b of the gradation and c, d, e of the indicatrix of types 1 to 15 (Table 1 of the standard).
const TYPES: [[f64; 5]; 15] = [
    [4.0, -0.7, 0.0, -1.0, 0.0],
    [4.0, -0.7, 2.0, -1.5, 0.15],
    [1.1, -0.8, 0.0, -1.0, 0.0],
    [1.1, -0.8, 2.0, -1.5, 0.15],
    [0.0, -1.0, 0.0, -1.0, 0.0],
    [0.0, -1.0, 2.0, -1.5, 0.15],
    [0.0, -1.0, 5.0, -2.5, 0.3],
    [0.0, -1.0, 10.0, -3.0, 0.45],
    [-1.0, -0.55, 2.0, -1.5, 0.15],
    [-1.0, -0.55, 5.0, -2.5, 0.3],
    [-1.0, -0.55, 10.0, -3.0, 0.45],
    [-1.0, -0.32, 10.0, -3.0, 0.45],
    [-1.0, -0.32, 16.0, -3.0, 0.3],
    [-1.0, -0.15, 16.0, -3.0, 0.3],
    [-1.0, -0.15, 24.0, -2.8, 0.15],
];

/// One of the types.
#[derive(Clone, Copy, Debug)]
pub struct GeneralSky {
    parameters: [f64; 5],
}

impl GeneralSky {
    /// Type 12: *CIE standard clear sky, low luminance turbidity*.
    pub const CLEAR: usize = 12;

    /// A type by its number, 1 to 15.
    pub fn new(number: usize) -> Option<Self> {
        let parameters = *TYPES.get(number.checked_sub(1)?)?;
        Some(Self { parameters })
    }

    /// Luminance over that of the zenith, at a cosine of the zenith angle and an angle from a sun that has a zenith
    /// angle, radians.
    pub fn relative(&self, cosine: f64, gamma: f64, sun: f64) -> f64 {
        self.gradation(cosine) * self.indicatrix(gamma)
            / (self.gradation(1.0) * self.indicatrix(sun))
    }

    fn gradation(&self, cosine: f64) -> f64 {
        let [a, b, ..] = self.parameters;
        match cosine > 0.0 {
            true => 1.0 + a * (b / cosine).exp(),
            false => 1.0,
        }
    }

    fn indicatrix(&self, gamma: f64) -> f64 {
        let [_, _, c, d, e] = self.parameters;
        let right = (d * std::f64::consts::FRAC_PI_2).exp();
        1.0 + c * ((d * gamma).exp() - right) + e * gamma.cos().powi(2)
    }
}

/// A type with the luminance of the zenith, by the sine of the solar elevation.
pub struct ScaledSky<F> {
    /// The distribution.
    pub sky: GeneralSky,
    /// cd m⁻² for a solar elevation in radians, if it is known.
    pub zenith_luminance: F,
    /// XYZ of grey with Y = 1.
    pub white: [f32; 3],
}

impl<F: Fn(f64) -> Option<f32> + Send + Sync> SkyModel for ScaledSky<F> {
    fn sky(&self, observer: Observer) -> Option<Box<dyn Sky + '_>> {
        if observer.solar_elevation < 0.0 {
            return None;
        }
        Some(Box::new(Scaled {
            sky: self.sky,
            zenith: (self.zenith_luminance)(observer.solar_elevation)?,
            white: self.white,
            sun: observer.sun(),
            sun_zenith: std::f64::consts::FRAC_PI_2 - observer.solar_elevation,
        }))
    }

    fn bytes(&self) -> usize {
        size_of::<GeneralSky>()
    }
}

struct Scaled {
    sky: GeneralSky,
    zenith: f32,
    white: [f32; 3],
    sun: [f32; 3],
    sun_zenith: f64,
}

impl Sky for Scaled {
    fn xyz(&self, direction: [f32; 3]) -> Option<[f32; 3]> {
        if direction[2] < 0.0 {
            return None;
        }
        let cosine = (0..3).map(|i| direction[i] * self.sun[i]).sum::<f32>();
        let gamma = f64::from(cosine.clamp(-1.0, 1.0)).acos();
        let relative = self
            .sky
            .relative(f64::from(direction[2]), gamma, self.sun_zenith);
        Some(self.white.map(|v| v * self.zenith * relative as f32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn type_12_is_the_clear_sky_of_1973() {
        // CIE No. 22: (0.91 + 10·e^(-3γ) + 0.45·cos²γ)·(1 - e^(-0.32/cos Z)) over the same at the zenith, where
        // 1 - e^(-0.32) = 0.274.
        let clear = GeneralSky::new(GeneralSky::CLEAR).unwrap();
        let before = |cosine: f64, gamma: f64, sun: f64| {
            let indicatrix = |g: f64| 0.91 + 10.0 * (-3.0 * g).exp() + 0.45 * g.cos().powi(2);
            indicatrix(gamma) * (1.0 - (-0.32 / cosine).exp()) / (indicatrix(sun) * 0.273_85)
        };
        for (cosine, gamma, sun) in [
            (1.0, 0.7, 0.7),
            (0.3, 0.2, 1.0),
            (0.05, 2.0, 0.6),
            (0.6, 1.5, 1.5),
        ] {
            let (a, b) = (
                clear.relative(cosine, gamma, sun),
                before(cosine, gamma, sun),
            );
            assert!((a / b - 1.0).abs() < 1e-3, "{a} {b}");
        }
    }

    #[test]
    fn overcast_and_uniform_skies_are_as_named() {
        // Type 1 is about Moon and Spencer's: three times as bright in the zenith as at the horizon.
        let overcast = GeneralSky::new(1).unwrap();
        let horizon = overcast.relative(0.0, 1.0, 1.0);
        assert!((horizon - 1.0 / (1.0 + 4.0 * (-0.7f64).exp())).abs() < 1e-12);
        assert!((horizon - 1.0 / 3.0).abs() < 2e-3);
        // Type 5 has the same luminance everywhere.
        let uniform = GeneralSky::new(5).unwrap();
        assert!((uniform.relative(0.2, 2.0, 0.3) - 1.0).abs() < 1e-12);
        assert!(GeneralSky::new(0).is_none() && GeneralSky::new(16).is_none());
    }

    #[test]
    fn every_type_is_1_in_the_zenith_and_bright_nowhere_below_0() {
        for number in 1..=15 {
            let sky = GeneralSky::new(number).unwrap();
            assert!((sky.relative(1.0, 0.8, 0.8) - 1.0).abs() < 1e-12);
            for i in 0..100 {
                let t = f64::from(i) / 100.0;
                assert!(sky.relative(t, 3.0 * t, 1.1) > 0.0, "{number}");
            }
        }
    }
}

//! How far a smaller model is from its source, over skies and directions that stand for all.

use welkin::{Conditions, Model, Sky};

/// Directions per sky.
const DIRECTIONS: usize = 32;

/// The part of the source that the smaller model is for. Metres.
#[derive(Clone, Copy)]
pub struct Scope {
    pub altitudes: [f64; 2],
    pub visibilities: [f64; 2],
}

/// What is compared.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Radiance at every wavelength of the smaller model.
    Spectrum,
    /// CIE XYZ.
    Colour,
}

/// Skies with directions, and what the source says about them.
pub struct Samples {
    conditions: Vec<Conditions>,
    directions: Vec<Vec<[f32; 3]>>,
}

/// Relative differences, sorted.
pub struct Differences(Vec<f64>);

impl Samples {
    /// `skies` skies spread over the scope; another `seed` gives others.
    pub fn new(source: &Model, scope: &Scope, skies: usize, seed: usize) -> Self {
        let within = |[low, high]: [f64; 2], t: f64| low + t * (high - low);
        let mut conditions = Vec::new();
        let mut directions = Vec::new();
        for i in 0..skies {
            let [altitude, visibility, elevation, albedo] = spread(seed + i);
            // Even in the coordinates of interpolation, so that every interval is met.
            conditions.push(Conditions {
                altitude: within(scope.altitudes.map(f64::cbrt), altitude).powi(3),
                visibility: 1.0 / within(scope.visibilities.map(f64::recip), visibility),
                solar_elevation: within(source.solar_elevation_range(), elevation),
                solar_azimuth: 0.0,
                albedo,
            });
            let of_sky = |k| direction(spread(seed + i * DIRECTIONS + k));
            directions.push((0..DIRECTIONS).map(of_sky).collect());
        }
        Self {
            conditions,
            directions,
        }
    }

    /// Calls `visit` with each sky of a model and its directions.
    pub fn skies(
        &self,
        model: &Model,
        mut visit: impl FnMut(usize, &Sky, &[[f32; 3]]) -> welkin::Result<()>,
    ) -> welkin::Result<()> {
        let skies = self.conditions.iter().zip(&self.directions).enumerate();
        for (i, (conditions, directions)) in skies {
            visit(i, &model.sky(conditions)?, directions)?;
        }
        Ok(())
    }

    /// Values of a model, `[sky][direction · component]`. `wavelengths` are indices into those of the model.
    pub fn values(
        &self,
        model: &Model,
        quantity: Quantity,
        wavelengths: &[usize],
    ) -> welkin::Result<Vec<f32>> {
        let mut values = Vec::new();
        let mut row = vec![0.0; model.wavelengths().len()];
        self.skies(model, |_, sky, directions| {
            for &direction in directions {
                match quantity {
                    Quantity::Colour => values.extend(sky.xyz(direction)?),
                    Quantity::Spectrum => {
                        sky.relative_radiance(direction, &mut row)?;
                        values.extend(wavelengths.iter().map(|&w| row[w]));
                    }
                }
            }
            Ok(())
        })?;
        Ok(values)
    }
}

impl Differences {
    /// Where both are zero (ground seen from the ground) there is nothing to compare. Finite: what is not zero where
    /// the source is counts relative to the smallest normal number.
    pub fn between(got: &[f32], expected: &[f32]) -> Self {
        let pairs = got
            .iter()
            .zip(expected)
            .filter(|(g, e)| **g != 0.0 || **e != 0.0);
        let relative = pairs.map(|(&got, &expected)| {
            let (got, expected) = (f64::from(got), f64::from(expected));
            (got - expected).abs() / expected.abs().max(f64::from(f32::MIN_POSITIVE))
        });
        let mut sorted: Vec<f64> = relative.collect();
        sorted.sort_by(f64::total_cmp);
        Self(sorted)
    }

    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// 0 if nothing was compared.
    pub fn quantile(&self, q: f64) -> f64 {
        let last = self.0.len().saturating_sub(1);
        self.0
            .get((q * last as f64).round() as usize)
            .copied()
            .unwrap_or(0.0)
    }
}

/// The `i`-th point of an additive recurrence that fills the unit cube evenly (Roberts 2018, R₄).
fn spread(i: usize) -> [f64; 4] {
    // The positive root of x⁵ = x + 1.
    const PHI: f64 = 1.167_303_978_261_418_7;
    core::array::from_fn(|d| ((i as f64 + 0.5) * PHI.powi(-(d as i32) - 1)).fract())
}

/// Even over the sphere.
fn direction([a, b, ..]: [f64; 4]) -> [f32; 3] {
    let z = 2.0 * a - 1.0;
    let horizontal = (1.0 - z * z).sqrt();
    let (sine, cosine) = (std::f64::consts::TAU * b).sin_cos();
    [horizontal * cosine, horizontal * sine, z].map(|v| v as f32)
}

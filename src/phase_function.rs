//! Phase functions with mean 1 over the sphere. Format specification, section 7.2.

#[cfg(feature = "std")]
use crate::format::{Field, PhaseFunction};
#[cfg(feature = "std")]
use crate::kernel::math::LANES;
#[cfg(not(feature = "std"))]
use crate::kernel::real::Real;

/// The angle γ between view direction and sun, in the two forms that keep their precision.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SunAngle {
    /// cos² γ.
    pub cosine_squared: f32,
    /// 1 − cos γ.
    pub versine: f32,
}

impl SunAngle {
    /// Between two unit vectors.
    pub fn between(a: [f64; 3], b: [f64; 3]) -> Self {
        // Half the squared chord: exact where 1 − a·b cancels.
        Self::from_versine(0.5 * (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>())
    }

    /// From 1 − cos γ.
    pub fn from_versine(versine: f64) -> Self {
        Self {
            cosine_squared: (1.0 - versine).powi(2) as f32,
            versine: versine as f32,
        }
    }

    /// sin(γ/2).
    pub fn half_sine(self) -> f32 {
        (0.5 * self.versine).max(0.0).sqrt().min(1.0)
    }
}

#[cfg(feature = "std")]
/// A phase function with its coefficients for every wavelength, in blocks of [`LANES`].
#[derive(Clone, Debug)]
pub(crate) enum PhaseTable {
    /// `a + b cos² γ`: none and Rayleigh.
    Quadratic(Vec<[[f32; LANES]; 2]>),
    /// `a / (b + c (1 − cos γ))^(3/2)`: Henyey-Greenstein.
    HenyeyGreenstein(Vec<[[f32; LANES]; 3]>),
}

#[cfg(feature = "std")]
impl PhaseTable {
    pub fn new(field: &Field) -> Self {
        let blocks = field.parameter.chunks(LANES);
        match field.phase {
            PhaseFunction::None => {
                Self::Quadratic(blocks.map(|b| lanes(b, |_| [1.0, 0.0])).collect())
            }
            PhaseFunction::Rayleigh => {
                Self::Quadratic(blocks.map(|b| lanes(b, rayleigh)).collect())
            }
            PhaseFunction::HenyeyGreenstein => {
                Self::HenyeyGreenstein(blocks.map(|b| lanes(b, henyey_greenstein)).collect())
            }
        }
    }

    /// Values for one block of wavelengths.
    #[inline(always)]
    pub fn evaluate(&self, block: usize, angle: SunAngle) -> [f32; LANES] {
        match self {
            Self::Quadratic(table) => {
                let [a, b] = &table[block];
                core::array::from_fn(|i| a[i] + b[i] * angle.cosine_squared)
            }
            Self::HenyeyGreenstein(table) => {
                let [a, b, c] = &table[block];
                core::array::from_fn(|i| {
                    let x = (b[i] + c[i] * angle.versine).max(f32::MIN_POSITIVE);
                    a[i] / (x * x.sqrt())
                })
            }
        }
    }

    /// How much of the field is polarised by sin² γ, for one block of wavelengths; `None` for phase functions that do
    /// not polarise.
    #[inline(always)]
    pub fn polarising(&self, block: usize) -> Option<[f32; LANES]> {
        match self {
            // The same ¾Δ: the unpolarised part of Rayleigh scattering is isotropic.
            Self::Quadratic(table) => Some(table[block][1]),
            Self::HenyeyGreenstein(_) => None,
        }
    }

    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Quadratic(table) => size_of_val(table.as_slice()),
            Self::HenyeyGreenstein(table) => size_of_val(table.as_slice()),
        }
    }
}

#[cfg(feature = "std")]
/// Transposes the coefficients of up to [`LANES`] parameters; where parameters are missing, 1 keeps the arithmetic
/// away from underflow, which is slow.
fn lanes<const N: usize>(
    parameters: &[f64],
    coefficients: impl Fn(f64) -> [f64; N],
) -> [[f32; LANES]; N] {
    let mut block = [[1.0; LANES]; N];
    for (lane, &parameter) in parameters.iter().enumerate() {
        for (row, value) in block.iter_mut().zip(coefficients(parameter)) {
            row[lane] = value as f32;
        }
    }
    block
}

pub(crate) fn rayleigh(depolarisation: f64) -> [f64; 2] {
    let delta = (1.0 - depolarisation) / (1.0 + 0.5 * depolarisation);
    [1.0 - 0.25 * delta, 0.75 * delta]
}

pub(crate) fn henyey_greenstein(g: f64) -> [f64; 3] {
    [(1.0 - g) * (1.0 + g), (1.0 - g).powi(2), 2.0 * g]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_over_the_sphere_are_one() {
        for (phase, parameter) in [
            (PhaseFunction::None, 0.0),
            (PhaseFunction::Rayleigh, 0.03),
            (PhaseFunction::HenyeyGreenstein, 0.7),
            (PhaseFunction::HenyeyGreenstein, -0.4),
        ] {
            let table = PhaseTable::new(&Field {
                phase,
                ground: false,
                estimate: 0,
                parameter: vec![parameter],
            });
            let n = 20_000;
            let mean = (0..n)
                .map(|i| 2.0 * (f64::from(i) + 0.5) / f64::from(n))
                .map(SunAngle::from_versine)
                .map(|angle| f64::from(table.evaluate(0, angle)[0]))
                .sum::<f64>()
                / f64::from(n);
            assert!((mean - 1.0).abs() < 1e-5, "{phase:?} {parameter}: {mean}");
        }
    }
}

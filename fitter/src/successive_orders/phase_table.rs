//! Tabulated phase functions for all wavelengths at once, and their smooth part.

use super::lobes::Lobes;
use super::spectra::{DEGREE, NW, Spectrum};
use crate::atmosphere::matrix::{Matrix, NODES, angle, interval};
use crate::particles::lobe_fit::{self, Signs};
use std::f64::consts::PI;
use std::sync::{Arc, LazyLock};

/// The smooth part has the degrees up to the first whole and less and less of those up to the second: what a grid of
/// directions resolves.
const FADING: [usize; 2] = [20, 40];

/// Number of degrees of the smooth part.
const DEGREES: usize = FADING[1] + 1;

/// Cosines of the nodes' angles.
static COSINES: LazyLock<Vec<f64>> = LazyLock::new(|| (0..NODES).map(|i| angle(i).cos()).collect());
/// Legendre polynomials there, `[degree][node]`.
static POLYNOMIALS: LazyLock<Vec<Vec<f64>>> = LazyLock::new(|| polynomials(&COSINES));

/// A function of the scattering angle, by wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct AngleFunction(Vec<Spectrum>);

impl AngleFunction {
    /// The smooth part of a function with these moments.
    fn smooth(moments: &[Spectrum]) -> Self {
        let node = |i: usize| {
            let mut sum = [0.0; NW];
            for (l, moment) in moments.iter().enumerate() {
                let factor = (fade(l) * (2 * l + 1) as f64 * POLYNOMIALS[l][i]) as f32;
                for w in 0..NW {
                    sum[w] += factor * moment[w];
                }
            }
            sum
        };
        Self((0..NODES).map(node).collect())
    }

    /// Value at the cosine of an angle, linear between nodes.
    pub fn at(&self, cosine: f32) -> Spectrum {
        let c = f64::from(cosine).clamp(-1.0, 1.0);
        let i = interval(c.acos());
        let t = ((c - COSINES[i]) / (COSINES[i + 1] - COSINES[i])).clamp(0.0, 1.0) as f32;
        let (a, b) = (&self.0[i], &self.0[i + 1]);
        std::array::from_fn(|w| a[w] + t * (b[w] - a[w]))
    }
}

/// F11 and F12 by scattering angle.
#[derive(Clone, Debug, PartialEq)]
pub struct PhaseTable {
    f11: AngleFunction,
    f12: AngleFunction,
    smooth: AngleFunction,
    /// Mean of F11 times the Legendre polynomial of each degree.
    moments: Vec<Spectrum>,
    keeping: Spectrum,
    matrix: Arc<Matrix>,
}

impl PhaseTable {
    /// From a matrix of [`NW`] wavelengths.
    pub fn new(matrix: Arc<Matrix>) -> Self {
        let element = |e: usize| {
            let node = |i| std::array::from_fn(|w| matrix.at(w, i)[e] as f32);
            AngleFunction((0..NODES).map(node).collect())
        };
        let f11 = element(0);
        let moments: Vec<Spectrum> = (0..DEGREES)
            .map(|l| moment(&POLYNOMIALS[l], &f11))
            .collect();
        Self {
            smooth: AngleFunction::smooth(&moments),
            f12: element(1),
            keeping: keeping(&f11, &element(2)),
            f11,
            moments,
            matrix,
        }
    }

    /// A near sum of at most so many Henyey-Greenstein functions.
    pub fn lobes(&self, most: usize) -> Lobes {
        Lobes::new(&lobe_fit::fit_well(&self.matrix, most))
    }

    /// The nearest sum of so many Henyey-Greenstein functions with weights that are not negative.
    pub fn positive_lobes(&self, count: usize) -> Lobes {
        Lobes::new(&lobe_fit::fit(&self.matrix, count, Signs::Positive))
    }

    /// F11.
    pub fn at(&self, cosine: f32) -> Spectrum {
        self.f11.at(cosine)
    }

    /// F11 without the degrees that a grid of directions does not resolve.
    pub fn smooth(&self, cosine: f32) -> Spectrum {
        self.smooth.at(cosine)
    }

    /// −F12 over the squared sine of the scattering angle: how strongly it polarises.
    pub fn polarising(&self, cosine: f32) -> Spectrum {
        let c = f64::from(cosine);
        let square = ((1.0 - c) * (1.0 + c)).max(1e-9) as f32;
        self.f12.at(cosine).map(|f12| -f12 / square)
    }

    /// The share of scattered light that stays polarised as it was: exactly so for light whose polarisation depends on
    /// direction as that of a dipole. It is the coefficient α₂ of degree two, of which a dipole has 0.6: the mean of
    /// ½ (F22 + F33) d²₂₂ + ½ (F22 − F33) d²₂₋₂, spheres having F22 = F11.
    pub fn keeping(&self) -> &Spectrum {
        &self.keeping
    }

    /// Mean of F11 times the Legendre polynomial of each degree up to [`DEGREE`].
    pub fn moments(&self) -> &[Spectrum] {
        &self.moments[..=DEGREE]
    }
}

/// The smooth part of what a phase function, tabulated or of `lobes`, is beside that of its kind.
pub fn beside(table: Option<&PhaseTable>, lobes: &Lobes, kind: &Lobes) -> AngleFunction {
    let own = |l: usize| match table {
        Some(table) => table.moments[l],
        None => lobes.moment(l),
    };
    let difference = |l: usize| {
        let (own, kind) = (own(l), kind.moment(l));
        std::array::from_fn(|w| own[w] - kind[w])
    };
    let moments: Vec<Spectrum> = (0..DEGREES).map(difference).collect();
    AngleFunction::smooth(&moments)
}

fn keeping(f11: &AngleFunction, f33: &AngleFunction) -> Spectrum {
    let part = |sign: f32| {
        let node =
            |(a, b): (&Spectrum, &Spectrum)| std::array::from_fn(|w| 0.5 * (a[w] + sign * b[w]));
        let mean = AngleFunction(f11.0.iter().zip(&f33.0).map(node).collect());
        let turned = COSINES
            .iter()
            .map(|c| (0.5 * (1.0 + f64::from(sign) * c)).powi(2));
        moment(&turned.collect::<Vec<_>>(), &mean)
    };
    let [forwards, backwards] = [1.0, -1.0].map(part);
    std::array::from_fn(|w| forwards[w] + backwards[w])
}

fn fade(l: usize) -> f64 {
    let [whole, none] = FADING;
    if l <= whole {
        return 1.0;
    }
    let t = (l - whole) as f64 / (none - whole) as f64;
    (0.5 * PI * t).cos().powi(2)
}

/// Legendre polynomials at the nodes, `[degree][node]`.
fn polynomials(cosines: &[f64]) -> Vec<Vec<f64>> {
    let mut out = vec![vec![1.0; cosines.len()], cosines.to_vec()];
    for l in 1..FADING[1] {
        let (a, b) = ((2 * l + 1) as f64, l as f64);
        let next = |i: usize| (a * cosines[i] * out[l][i] - b * out[l - 1][i]) / (b + 1.0);
        let next = (0..cosines.len()).map(next).collect();
        out.push(next);
    }
    out
}

/// ½ ∫ F11 P_l d cos θ, both taken as linear in the cosine between nodes.
fn moment(polynomial: &[f64], f11: &AngleFunction) -> Spectrum {
    let mut sum = [0.0f64; NW];
    for i in 1..NODES {
        let width = COSINES[i - 1] - COSINES[i];
        let [a, b] = [polynomial[i - 1], polynomial[i]].map(|p| width * p / 12.0);
        for (w, sum) in sum.iter_mut().enumerate() {
            let [p, q] = [f11.0[i - 1][w], f11.0[i][w]].map(f64::from);
            *sum += a * (2.0 * p + q) + b * (p + 2.0 * q);
        }
    }
    sum.map(|s| s as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(g: f64) -> PhaseTable {
        let angles: Vec<f64> = (0..=1800).map(|i| 0.1 * f64::from(i)).collect();
        let row = |a: &f64| {
            let c = a.to_radians().cos();
            let p = (1.0 - g * g) / (1.0 + g * g - 2.0 * g * c).powf(1.5);
            [p.ln(), -0.5 * (1.0 - c * c), 0.0]
        };
        let rows: Vec<_> = angles.iter().map(row).collect();
        PhaseTable::new(Arc::new(
            Matrix::resample(&angles, &vec![rows; NW]).unwrap(),
        ))
    }

    #[test]
    fn moments_are_powers() {
        let table = table(0.7);
        for (l, moment) in table.moments().iter().enumerate() {
            let expected = 0.7f32.powi(l as i32);
            assert!((moment[5] - expected).abs() < 2e-4, "{l}: {}", moment[5]);
        }
    }

    #[test]
    fn a_dipole_keeps_what_it_should() {
        let angles: Vec<f64> = (0..=1800).map(|i| 0.1 * f64::from(i)).collect();
        let row = |a: &f64| {
            let c = a.to_radians().cos();
            let square = 1.0 + c * c;
            [
                (0.75 * square).ln(),
                (c * c - 1.0) / square,
                2.0 * c / square,
            ]
        };
        let rows: Vec<_> = angles.iter().map(row).collect();
        let table = PhaseTable::new(Arc::new(
            Matrix::resample(&angles, &vec![rows; NW]).unwrap(),
        ));
        assert!(
            (table.keeping()[3] - 0.6).abs() < 1e-3,
            "{:?}",
            table.keeping()
        );
    }

    #[test]
    fn smooth_functions_are_their_smooth_part() {
        let table = table(0.5);
        for degrees in [0.0f32, 5.0, 40.0, 90.0, 170.0] {
            let c = degrees.to_radians().cos();
            let (whole, smooth) = (table.at(c)[0], table.smooth(c)[0]);
            assert!(
                (whole / smooth - 1.0).abs() < 2e-3,
                "{degrees}: {whole} {smooth}"
            );
        }
    }

    #[test]
    fn the_strength_of_polarisation_has_a_limit_forwards() {
        let table = table(0.5);
        for cosine in [1.0f32, 0.99999, 0.5, -1.0] {
            let ratio = table.polarising(cosine)[0] / table.at(cosine)[0];
            let expected = if cosine.abs() < 1.0 { 0.5 } else { 0.0 };
            assert!((ratio - expected).abs() < 5e-3, "{cosine}: {ratio}");
        }
    }
}

//! Phase functions: values, scattering matrices and sampling.

use super::stokes::Scattering;
use super::tabulated::Tabulated;
use crate::atmosphere::matrix::Matrix;

/// What Henyey-Greenstein aerosols do to polarised light (the published model does not say). Tabulated matrices say it
/// themselves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Aerosol {
    /// Scattered light is natural: the main columns of the outside references, and the default.
    #[default]
    Depolarising,
    /// Q and U are kept in the frame of the scattering plane.
    Preserving,
}

/// One scatterer.
pub struct Lobe<const N: usize> {
    /// Index of the constituent whose profile it follows.
    pub constituent: usize,
    /// Scattering coefficient where the profile is 1, m⁻¹.
    pub scattering: [f64; N],
    kind: Kind<N>,
}

enum Kind<const N: usize> {
    /// With Δ.
    Rayleigh([f64; N]),
    /// With g.
    HenyeyGreenstein([f64; N]),
    Tabulated(Tabulated<N>),
}

impl<const N: usize> Lobe<N> {
    /// Rayleigh scattering with depolarisation ρ: Δ = (1 − ρ) / (1 + ρ/2).
    pub fn rayleigh(constituent: usize, scattering: [f64; N], depolarisation: [f64; N]) -> Self {
        Self {
            constituent,
            scattering,
            kind: Kind::Rayleigh(depolarisation.map(|rho| (1.0 - rho) / (1.0 + 0.5 * rho))),
        }
    }

    /// Henyey-Greenstein scattering.
    pub fn henyey_greenstein(constituent: usize, scattering: [f64; N], g: [f64; N]) -> Self {
        Self {
            constituent,
            scattering,
            kind: Kind::HenyeyGreenstein(g),
        }
    }

    /// Scattering by a tabulated matrix at the wavelengths with the indices `lanes`.
    pub fn tabulated(
        constituent: usize,
        scattering: [f64; N],
        matrix: &Matrix,
        lanes: &[usize],
    ) -> Self {
        Self {
            constituent,
            scattering,
            kind: Kind::Tabulated(Tabulated::new(matrix, lanes)),
        }
    }

    /// Adds `density` times this lobe's scattering matrix at cosine `c`.
    pub fn add(&self, density: f64, c: f64, aerosol: Aerosol, sum: &mut Scattering<N>) {
        match &self.kind {
            Kind::Rayleigh(share) => {
                let (even, odd) = (0.75 * (1.0 + c * c), -0.75 * (1.0 - c * c));
                for w in 0..N {
                    let (s, delta) = (density * self.scattering[w], share[w]);
                    sum.f11[w] += s * (delta * even + 1.0 - delta);
                    sum.f12[w] += s * delta * odd;
                    sum.f22[w] += s * delta * even;
                    sum.f33[w] += s * delta * 1.5 * c;
                }
            }
            Kind::HenyeyGreenstein(g) => {
                for w in 0..N {
                    let p = density * self.scattering[w] * henyey_greenstein(g[w], c);
                    sum.f11[w] += p;
                    if aerosol == Aerosol::Preserving {
                        sum.f22[w] += p;
                        sum.f33[w] += p;
                    }
                }
            }
            Kind::Tabulated(matrix) => {
                matrix.add(&self.scattering.map(|s| density * s), c, sum);
            }
        }
    }

    /// A cosine distributed as F11 at wavelength lane `w`.
    pub fn sample(&self, w: usize, u: f64) -> f64 {
        match &self.kind {
            Kind::HenyeyGreenstein(g) => sample_henyey_greenstein(g[w], u),
            Kind::Rayleigh(share) if u < share[w] => sample_rayleigh(u / share[w]),
            Kind::Rayleigh(share) => 2.0 * (u - share[w]) / (1.0 - share[w]) - 1.0,
            Kind::Tabulated(matrix) => matrix.sample(w, u),
        }
        .clamp(-1.0, 1.0)
    }
}

/// The Henyey-Greenstein function, mean 1.
pub fn henyey_greenstein(g: f64, c: f64) -> f64 {
    let d = 1.0 + g * g - 2.0 * g * c;
    (1.0 - g * g) / (d * d.sqrt())
}

/// A cosine distributed as the Henyey-Greenstein function.
pub fn sample_henyey_greenstein(g: f64, u: f64) -> f64 {
    if g.abs() < 1e-4 {
        // To first order in g, exact enough that the density's error is below g².
        let c = 2.0 * u - 1.0;
        return c + 1.5 * g * (1.0 - c * c);
    }
    let q = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
    (1.0 + g * g - q * q) / (2.0 * g)
}

/// Inverts the distribution function of ¾ (1 + c²) / 2.
fn sample_rayleigh(u: f64) -> f64 {
    let q = 4.0 * u - 2.0;
    let root = (1.0 + q * q).sqrt();
    (q + root).cbrt() + (q - root).cbrt()
}

#[cfg(test)]
mod tests {
    use super::super::random::Stream;
    use super::*;
    use crate::atmosphere::mie;

    /// In bins of the sine of half the scattering angle, which resolve forward peaks.
    fn chi_square(lobe: &Lobe<1>) -> f64 {
        const BINS: usize = 50;
        const SAMPLES: usize = 200_000;
        let mut stream = Stream::new(1, 2, 3);
        let mut counts = [0.0; BINS];
        for _ in 0..SAMPLES {
            let c = lobe.sample(0, stream.uniform());
            let x = (0.5 * (1.0 - c)).sqrt();
            counts[((x * BINS as f64) as usize).min(BINS - 1)] += 1.0;
        }
        let expected = |bin: usize| {
            const STEPS: usize = 400;
            let sum: f64 = (0..STEPS)
                .map(|i| {
                    let x = (bin as f64 + (i as f64 + 0.5) / STEPS as f64) / BINS as f64;
                    let mut f = Scattering::ZERO;
                    lobe.add(1.0, 1.0 - 2.0 * x * x, Aerosol::Depolarising, &mut f);
                    2.0 * x * f.f11[0]
                })
                .sum();
            sum / STEPS as f64 / BINS as f64 * SAMPLES as f64
        };
        (0..BINS)
            .map(|bin| (counts[bin] - expected(bin)).powi(2) / expected(bin))
            .sum::<f64>()
            / (BINS - 1) as f64
    }

    #[test]
    fn samples_follow_the_phase_function() {
        let mut lobes = vec![
            Lobe::rayleigh(0, [1.0], [0.0]),
            Lobe::rayleigh(0, [1.0], [0.03]),
        ];
        for species in ["waso", "inso", "soot"] {
            let matrix = mie::matrix(species, &[450.0]).unwrap();
            lobes.push(Lobe::tabulated(0, [1.0], &matrix, &[0]));
        }
        lobes.extend([-0.5, 0.0, 1e-5, 0.3, 0.8].map(|g| Lobe::henyey_greenstein(0, [1.0], [g])));
        for lobe in &lobes {
            // 49 degrees of freedom: mean 1, standard deviation 0.2.
            assert!(chi_square(lobe) < 1.8, "{}", chi_square(lobe));
        }
    }
}

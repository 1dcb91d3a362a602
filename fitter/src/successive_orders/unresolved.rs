//! Light that aerosols scatter twice, as far as the moments do not resolve it.
//!
//! Moments end at a degree, and towards the horizon their orders end before it. What is missing of twice scattered light
//! is a narrow peak about the sun and the ripple around it. Light of so high degrees is turned so little at a time that
//! it was scattered first on the straight way of the sunlight: its phase function is the product of both, the degrees
//! that the moments have subtracted, and how much there is follows from the columns of air towards the sun.

use super::lobes::Lobe;
use super::moments::{DEGREES, HARMONICS, azimuth_harmonics, order_start, polar_harmonics};
use super::scattered_source::Sun;
use super::spectral_medium::{
    Aerosol, DEGREE, Medium, NW, PER_SPHERE, Spectrum, henyey_greenstein,
};

/// Line integrals ∫ profile · column towards the sun · sunlight · transmittance to the observer (m²) of each pair of
/// constituents that scatter as aerosols.
pub struct TwiceScattered<'a> {
    medium: &'a Medium,
    /// The later and the earlier of each pair.
    pairs: Vec<[usize; 2]>,
    sums: Vec<Spectrum>,
}

impl<'a> TwiceScattered<'a> {
    /// Nothing yet.
    pub fn new(medium: &'a Medium) -> Self {
        let parts = 0..medium.parts.len();
        let parts = parts.filter(|&k| !medium.parts[k].aerosols.is_empty());
        let pairs = parts
            .clone()
            .flat_map(|a| parts.clone().map(move |b| [a, b]));
        let pairs: Vec<[usize; 2]> = pairs.collect();
        Self {
            medium,
            sums: vec![[0.0; NW]; pairs.len()],
            pairs,
        }
    }

    /// Adds a node lit by `sunlight` that came through `columns` (m).
    pub fn add(
        &mut self,
        profiles: &[f32],
        columns: &[f32],
        sunlight: &Spectrum,
        weight: &Spectrum,
    ) {
        for (sum, &[last, first]) in self.sums.iter_mut().zip(&self.pairs) {
            let share = profiles[last] * columns[first];
            for w in 0..NW {
                sum[w] += share * sunlight[w] * weight[w];
            }
        }
    }

    /// Adds the intensity, sr⁻¹, on a ray of zenith cosine `mu`.
    pub fn add_to(&self, out: &mut Spectrum, mu: f64, sun: &Sun) {
        let (resolved, cosine) = (resolved(mu, sun), sun.cosine(mu));
        let aerosols = |k: usize| &self.medium.parts[k].aerosols;
        for (sum, &[last, first]) in self.sums.iter().zip(&self.pairs) {
            for a in aerosols(last) {
                for b in aerosols(first) {
                    add_pair(out, sum, [a, b], cosine, &resolved);
                }
            }
        }
    }
}

fn add_pair(
    out: &mut Spectrum,
    sum: &Spectrum,
    [a, b]: [&Aerosol; 2],
    cosine: f32,
    resolved: &[f32; DEGREE + 1],
) {
    let rate: Spectrum =
        std::array::from_fn(|w| a.scattering[w] * b.scattering[w] * PER_SPHERE * sum[w]);
    for a in a.lobes.iter() {
        for b in b.lobes.iter() {
            add_lobes(out, &rate, [a, b], cosine, resolved);
        }
    }
}

/// Twice by Henyey-Greenstein functions is once by one of the product of their asymmetries.
fn add_lobes(
    out: &mut Spectrum,
    rate: &Spectrum,
    [a, b]: [&Lobe; 2],
    cosine: f32,
    resolved: &[f32; DEGREE + 1],
) {
    let g: Spectrum = std::array::from_fn(|w| a.g[w] * b.g[w]);
    let phase = henyey_greenstein(&g, cosine);
    for w in 0..NW {
        let known = resolved
            .iter()
            .rev()
            .fold(0.0, |sum, term| sum * g[w] + term);
        out[w] += a.weight[w] * b.weight[w] * rate[w] * (phase[w] - known);
    }
}

/// What the moments have of `(2l + 1) P_l` of the angle between a ray and the sun, for each degree l.
fn resolved(mu: f64, sun: &Sun) -> [f32; DEGREE + 1] {
    let (view, light) = (polar_harmonics(mu), polar_harmonics(sun.elevation.1));
    let cosines = azimuth_harmonics(sun.azimuth.0 as f32);
    let mut out = [0.0; DEGREE + 1];
    for (m, cosine) in cosines.into_iter().enumerate() {
        for i in order_start(m)..order_start(m + 1).min(HARMONICS) {
            out[DEGREES[i]] += view[i] * light[i] * cosine / PER_SPHERE;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_smooth_phase_functions_all_is_resolved() {
        let sun = Sun {
            elevation: (0.8, 0.6),
            azimuth: (-0.28, 0.96),
        };
        let (mu, g) = (0.4f64, 0.2f32);
        let terms = resolved(mu, &sun);
        let series = terms.iter().rev().fold(0.0, |sum, term| sum * g + term);
        assert!((series - henyey_greenstein(&[g; NW], sun.cosine(mu))[0]).abs() < 1e-5);
    }
}

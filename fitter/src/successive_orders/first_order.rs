//! Singly scattered sunlight along a ray.

use super::scattered_source::{DARK, Stokes, Sun};
use super::spectral_medium::{Medium, NW, PER_SPHERE, Spectrum, henyey_greenstein};

/// Adds a node lit by `sunlight` to the line integrals ∫ profile · sunlight · transmittance to the observer (m), one
/// per constituent.
pub fn add(profiles: &[f32], sunlight: &Spectrum, weight: &Spectrum, sums: &mut [Spectrum]) {
    for (sum, p) in sums.iter_mut().zip(profiles) {
        for w in 0..NW {
            sum[w] += p * sunlight[w] * weight[w];
        }
    }
}

/// Line integral of Rayleigh scattering, per steradian, without its phase function.
pub fn rayleigh(medium: &Medium, sums: &[Spectrum]) -> Spectrum {
    weighted(medium.parts.iter().map(|part| &part.rayleigh).zip(sums))
}

/// Line integrals of each aerosol species (by its position within the constituents), per steradian, without phase
/// functions.
pub fn aerosol(medium: &Medium, species: usize, sums: &[Spectrum]) -> Spectrum {
    weighted(
        medium
            .parts
            .iter()
            .zip(sums)
            .filter_map(|(part, sum)| Some((&part.aerosols.get(species)?.scattering, sum))),
    )
}

fn weighted<'a>(terms: impl Iterator<Item = (&'a Spectrum, &'a Spectrum)>) -> Spectrum {
    let mut out = [0.0; NW];
    for (coefficient, sum) in terms {
        for w in 0..NW {
            out[w] += PER_SPHERE * coefficient[w] * sum[w];
        }
    }
    out
}

/// Q and U of single Rayleigh scattering with the line integral `dipole`, on a ray of zenith cosine `mu`.
pub fn polarisation(polarising: &Spectrum, dipole: &Spectrum, mu: f64, sun: &Sun) -> [Spectrum; 2] {
    let ((ce, se), (ca, sa)) = (sun.elevation, sun.azimuth);
    let sine = ((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt();
    // Components of the sun's direction along the ray's polarisation axes.
    let (along, across) = ((mu * ce * ca - sine * se) as f32, -(ce * sa) as f32);
    let strength = |w: usize| 0.75 * polarising[w] * dipole[w];
    [
        std::array::from_fn(|w| strength(w) * (across * across - along * along)),
        std::array::from_fn(|w| strength(w) * -2.0 * along * across),
    ]
}

/// Stokes vector of all singly scattered light on a ray of zenith cosine `mu`, from its line integrals.
pub fn stokes(medium: &Medium, sums: &[Spectrum], mu: f64, sun: &Sun) -> Stokes {
    let cosine = sun.cosine(mu);
    let mut out = DARK;
    let dipole = rayleigh(medium, sums);
    [out[1], out[2]] = polarisation(&medium.polarising, &dipole, mu, sun);
    for w in 0..NW {
        let d = medium.polarising[w];
        out[0][w] += dipole[w] * (0.75 * d * (1.0 + cosine * cosine) + 1.0 - d);
    }
    for (part, sum) in medium.parts.iter().zip(sums) {
        for species in &part.aerosols {
            let phase = henyey_greenstein(&species.g, cosine);
            for w in 0..NW {
                out[0][w] += PER_SPHERE * species.scattering[w] * sum[w] * phase[w];
            }
        }
    }
    out
}

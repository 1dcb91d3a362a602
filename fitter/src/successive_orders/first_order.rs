//! Singly scattered sunlight along a ray.

use super::scattered_source::{DARK, Stokes, Sun};
use super::spectral_medium::{Aerosol, Medium, NW, PER_SPHERE, Spectrum, henyey_greenstein};

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

/// Line integral of the particles of a kind, per steradian, without phase functions.
pub fn particles(medium: &Medium, kind: usize, sums: &[Spectrum]) -> Spectrum {
    let all = aerosols(medium, sums).filter(|(aerosol, _)| aerosol.kind == kind);
    weighted(all.map(|(aerosol, sum)| (&aerosol.scattering, sum)))
}

/// What the phase functions of particles add to those of their kinds, at a cosine of the scattering angle.
pub fn beside_kinds(medium: &Medium, sums: &[Spectrum], cosine: f32) -> Spectrum {
    let mut out = [0.0; NW];
    let kinds = medium.kinds.map(|g| henyey_greenstein(&g, cosine));
    for (aerosol, sum) in aerosols(medium, sums).filter(|(a, _)| a.g != medium.kinds[a.kind]) {
        let own = henyey_greenstein(&aerosol.g, cosine);
        for w in 0..NW {
            let light = PER_SPHERE * aerosol.scattering[w] * sum[w];
            out[w] += light * (own[w] - kinds[aerosol.kind][w]);
        }
    }
    out
}

fn aerosols<'a>(
    medium: &'a Medium,
    sums: &'a [Spectrum],
) -> impl Iterator<Item = (&'a Aerosol, &'a Spectrum)> {
    let parts = medium.parts.iter().zip(sums);
    parts.flat_map(|(part, sum)| part.aerosols.iter().map(move |a| (a, sum)))
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
    for (aerosol, sum) in aerosols(medium, sums) {
        let phase = henyey_greenstein(&aerosol.g, cosine);
        for w in 0..NW {
            out[0][w] += PER_SPHERE * aerosol.scattering[w] * sum[w] * phase[w];
        }
    }
    out
}

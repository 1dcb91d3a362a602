//! Singly scattered sunlight along a ray.

use super::parts::Aerosol;
use super::ray_points::Node;
use super::scattered_source::{DARK, Stokes, Sun};
use super::spectra::{NW, PER_SPHERE, Spectrum};
use super::spectral_medium::Medium;

/// Line integrals ∫ profile · sunlight · transmittance to the observer (m), one per constituent.
pub struct LineIntegrals {
    all: Vec<Spectrum>,
    /// Of Q and U, where they differ.
    polarised: Option<Vec<Spectrum>>,
}

impl LineIntegrals {
    /// Nothing yet.
    pub fn new(medium: &Medium) -> Self {
        let zero = || vec![[0.0; NW]; medium.parts.len()];
        Self {
            all: zero(),
            polarised: medium.keeps_polarisation().then(zero),
        }
    }

    /// Adds a node lit by `sunlight`.
    pub fn add(&mut self, profiles: &[f32], sunlight: &Spectrum, node: &Node) {
        add(profiles, sunlight, &node.weight, &mut self.all);
        if let Some(sums) = &mut self.polarised {
            add(profiles, sunlight, &node.polarised_weight(), sums);
        }
    }

    /// Those of the intensity.
    pub fn all(&self) -> &[Spectrum] {
        &self.all
    }

    /// Those of Q and U.
    fn polarised(&self) -> &[Spectrum] {
        self.polarised.as_ref().unwrap_or(&self.all)
    }
}

fn add(profiles: &[f32], sunlight: &Spectrum, weight: &Spectrum, sums: &mut [Spectrum]) {
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

/// What the phase functions of particles add to those of their kinds, at a cosine of the scattering angle; as far as it
/// is smooth where they are tabulated.
pub fn beside_kinds(medium: &Medium, sums: &[Spectrum], cosine: f32) -> Spectrum {
    let mut out = [0.0; NW];
    for (aerosol, sum) in aerosols(medium, sums) {
        let kind = &medium.kinds[aerosol.kind];
        let difference = match &aerosol.beside {
            Some(beside) => beside.at(cosine),
            None if aerosol.lobes == *kind => continue,
            None => {
                let (own, kind) = (aerosol.lobes.at(cosine), kind.at(cosine));
                std::array::from_fn(|w| own[w] - kind[w])
            }
        };
        for w in 0..NW {
            out[w] += PER_SPHERE * aerosol.scattering[w] * sum[w] * difference[w];
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
    polarised(|w| 0.75 * polarising[w] * dipole[w], mu, sun)
}

/// Q and U of light that is polarised across the plane of scattering, by `strength` times the squared sine of the angle.
fn polarised(strength: impl Fn(usize) -> f32, mu: f64, sun: &Sun) -> [Spectrum; 2] {
    let ((ce, se), (ca, sa)) = (sun.elevation, sun.azimuth);
    let sine = ((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt();
    // Components of the sun's direction along the ray's polarisation axes.
    let (along, across) = ((mu * ce * ca - sine * se) as f32, -(ce * sa) as f32);
    [
        std::array::from_fn(|w| strength(w) * (across * across - along * along)),
        std::array::from_fn(|w| strength(w) * -2.0 * along * across),
    ]
}

/// Adds what Q and U of single scattering are beside those of the line integral of Rayleigh scattering: light that
/// particles polarise, and that keeps its polarisation when they scatter it again.
pub fn add_polarised_beside_rayleigh(
    medium: &Medium,
    sums: &LineIntegrals,
    (mu, sun): (f64, &Sun),
    out: &mut Stokes,
) {
    let Some(polarised) = &sums.polarised else {
        return;
    };
    let (kept, dipole) = (rayleigh(medium, polarised), rayleigh(medium, &sums.all));
    let more = std::array::from_fn(|w| kept[w] - dipole[w]);
    let [q, u] = polarisation(&medium.polarising, &more, mu, sun);
    for w in 0..NW {
        out[1][w] += q[w];
        out[2][w] += u[w];
    }
    add_polarised_by_particles(medium, polarised, (mu, sun), out);
}

/// Adds Q and U of single scattering by particles whose scattering matrices are known.
fn add_polarised_by_particles(
    medium: &Medium,
    sums: &[Spectrum],
    (mu, sun): (f64, &Sun),
    out: &mut Stokes,
) {
    let mut strength = [0.0; NW];
    let mut any = false;
    for (aerosol, sum) in aerosols(medium, sums) {
        if let Some(table) = &aerosol.table {
            any = true;
            let polarising = table.polarising(sun.cosine(mu));
            for w in 0..NW {
                strength[w] += PER_SPHERE * aerosol.scattering[w] * sum[w] * polarising[w];
            }
        }
    }
    if any {
        let [q, u] = polarised(|w| strength[w], mu, sun);
        for w in 0..NW {
            out[1][w] += q[w];
            out[2][w] += u[w];
        }
    }
}

/// How sharp phase functions are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Peaks {
    /// As they are.
    Whole,
    /// Tabulated ones without what a grid of directions does not resolve.
    Resolved,
}

/// Stokes vector of all singly scattered light on a ray of zenith cosine `mu`, from its line integrals.
pub fn stokes(
    medium: &Medium,
    integrals: &LineIntegrals,
    (mu, sun): (f64, &Sun),
    peaks: Peaks,
) -> Stokes {
    let (sums, cosine) = (integrals.all(), sun.cosine(mu));
    let mut out = DARK;
    let dipole = rayleigh(medium, sums);
    let kept = rayleigh(medium, integrals.polarised());
    [out[1], out[2]] = polarisation(&medium.polarising, &kept, mu, sun);
    for w in 0..NW {
        let d = medium.polarising[w];
        out[0][w] += dipole[w] * (0.75 * d * (1.0 + cosine * cosine) + 1.0 - d);
    }
    for (aerosol, sum) in aerosols(medium, sums) {
        let phase = match (&aerosol.table, peaks) {
            (None, _) => aerosol.lobes.at(cosine),
            (Some(table), Peaks::Whole) => table.at(cosine),
            (Some(table), Peaks::Resolved) => table.smooth(cosine),
        };
        for w in 0..NW {
            out[0][w] += PER_SPHERE * aerosol.scattering[w] * sum[w] * phase[w];
        }
    }
    add_polarised_by_particles(medium, integrals.polarised(), (mu, sun), &mut out);
    out
}

//! What an atmosphere is made of, as arrays over the wavelengths.

use super::lobes::Lobes;
use super::phase_table::{AngleFunction, PhaseTable};
use super::spectra::{DEGREE, NW, Spectrum, spectrum};
use crate::atmosphere::{Atmosphere, Phase};
use crate::column::MAX_CONSTITUENTS;
use anyhow::{Result, ensure};

/// Most lobes that stand for a tabulated phase function.
pub const LOBES: usize = 5;

/// Particles of a constituent.
pub struct Aerosol {
    /// Scattering coefficient where the profile is 1, m⁻¹.
    pub scattering: Spectrum,
    /// Their phase function, or what is nearest to it.
    pub lobes: Lobes,
    /// Their phase function if it is tabulated.
    pub table: Option<PhaseTable>,
    /// What it is beside that of its kind, as far as it is smooth; none where both are one lobe.
    pub beside: Option<AngleFunction>,
    /// The kind that it counts among, an index into [`Medium::kinds`](super::Medium).
    pub kind: usize,
}

/// One constituent's spectral coefficients.
pub struct Part {
    /// m⁻¹ where the profile is 1.
    pub extinction: Spectrum,
    /// Rayleigh scattering coefficient, m⁻¹ where the profile is 1; zero if there is none.
    pub rayleigh: Spectrum,
    /// Its particles.
    pub aerosols: Vec<Aerosol>,
    /// Σ scattering · moment of the phase function, which is g^l, for each degree l.
    pub legendre: Vec<Spectrum>,
    /// What its particles scatter on polarised as it was, m⁻¹ where the profile is 1; zero without scattering matrices.
    pub keeping: Spectrum,
}

impl Part {
    /// Whether it scatters at all.
    pub fn scatters(&self) -> bool {
        !self.aerosols.is_empty() || self.rayleigh.iter().any(|&s| s > 0.0)
    }
}

/// What an atmosphere of [`NW`] wavelengths is made of, all particles of the first kind, and the polarising share of
/// Rayleigh scattering.
pub(super) fn parts(atmosphere: &Atmosphere) -> Result<(Vec<Part>, Spectrum)> {
    ensure!(
        atmosphere.wavelengths.len() == NW,
        "the solver needs {NW} wavelengths"
    );
    ensure!(
        atmosphere.constituents.len() <= MAX_CONSTITUENTS,
        "too many constituents"
    );
    let mut polarising = [1.0; NW];
    let mut parts = vec![];
    for constituent in &atmosphere.constituents {
        let mut part = Part {
            extinction: spectrum(&constituent.extinction),
            rayleigh: [0.0; NW],
            aerosols: vec![],
            legendre: vec![[0.0; NW]; DEGREE + 1],
            keeping: [0.0; NW],
        };
        for scatterer in &constituent.scatterers {
            let scattering = spectrum(&scatterer.scattering);
            match &scatterer.phase {
                Phase::Rayleigh { depolarisation } => {
                    part.rayleigh = scattering;
                    for (d, rho) in polarising.iter_mut().zip(depolarisation) {
                        *d = ((1.0 - rho) / (1.0 + rho / 2.0)) as f32;
                    }
                }
                Phase::HenyeyGreenstein { g } => {
                    part.aerosols.push(henyey_greenstein_part(
                        scattering,
                        spectrum(g),
                        &mut part.legendre,
                    ));
                }
                Phase::Tabulated(matrix) => {
                    let table = PhaseTable::new(matrix.clone());
                    for (sum, moment) in part.legendre.iter_mut().zip(table.moments()) {
                        for w in 0..NW {
                            sum[w] += scattering[w] * moment[w];
                        }
                    }
                    let kept = scattering.iter().zip(table.keeping());
                    for (sum, (scattering, share)) in part.keeping.iter_mut().zip(kept) {
                        *sum += scattering * share;
                    }
                    part.aerosols.push(Aerosol {
                        scattering,
                        lobes: table.lobes(LOBES),
                        table: Some(table),
                        beside: None,
                        kind: 0,
                    });
                }
            }
        }
        parts.push(part);
    }
    Ok((parts, polarising))
}

/// Adds its moments to `legendre`.
fn henyey_greenstein_part(scattering: Spectrum, g: Spectrum, legendre: &mut [Spectrum]) -> Aerosol {
    for (l, sum) in legendre.iter_mut().enumerate() {
        for w in 0..NW {
            sum[w] += scattering[w] * g[w].powi(l as i32);
        }
    }
    Aerosol {
        scattering,
        lobes: Lobes::one(g),
        table: None,
        beside: None,
        kind: 0,
    }
}

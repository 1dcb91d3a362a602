//! An atmosphere prepared for spectral loops: coefficients as fixed-length arrays over wavelength.

use super::kinds::Kinds;
use super::lobes::Lobes;
use super::phase_table::{AngleFunction, PhaseTable, beside};
use crate::atmosphere::{Atmosphere, Phase};
use crate::column::{Columns, MAX_CONSTITUENTS, SunColumns};
use anyhow::{Result, ensure};

/// Wavelengths that are treated together.
pub const NW: usize = 24;
/// One value per wavelength.
pub type Spectrum = [f32; NW];

/// Highest degree of the spherical harmonics of multiply scattered light.
pub const DEGREE: usize = 12;
/// Angular radius of the sun, rad (0.2667°, as in the published model).
pub const SOLAR_ANGULAR_RADIUS: f64 = 0.004_654_793;

/// Optical depth beyond which nothing passes: products of what would are not normal numbers, with which processors
/// are slow.
const BLACK: f32 = 25.0;

/// Isotropic share of a phase function, per steradian.
pub const PER_SPHERE: f32 = 0.25 * std::f32::consts::FRAC_1_PI;

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
    /// The kind that it counts among, an index into [`Medium::kinds`].
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
}

/// An atmosphere with its sun table.
pub struct Medium {
    /// The atmosphere itself.
    pub atmosphere: Atmosphere,
    /// Per constituent.
    pub parts: Vec<Part>,
    /// Polarising share Δ = (1−ρ)/(1+ρ/2) of Rayleigh scattering.
    pub polarising: Spectrum,
    /// Phase functions of the two kinds of particles that the model tells apart in single scattering.
    pub kinds: [Lobes; 2],
    sun: SunColumns,
    sun_radius: f64,
}

impl Part {
    /// Whether it scatters at all.
    pub fn scatters(&self) -> bool {
        !self.aerosols.is_empty() || self.rayleigh.iter().any(|&s| s > 0.0)
    }
}

impl Medium {
    /// Constituents that absorb and do not scatter: bit k is constituent k.
    pub fn absorbers(&self) -> u16 {
        let bit = |(k, part): (usize, &Part)| u16::from(!part.scatters()) << k;
        self.parts.iter().enumerate().map(bit).sum()
    }

    /// Prepares `atmosphere`, which must have [`NW`] wavelengths, under a sun of angular radius `sun_radius` (rad; 0 is
    /// a point).
    pub fn new(atmosphere: Atmosphere, sun_radius: f64) -> Result<Self> {
        let kinds = Kinds::of([&atmosphere])?;
        Self::in_kinds(atmosphere, sun_radius, &kinds)
    }

    /// The same with kinds of particles that it shares with other air.
    pub fn in_kinds(atmosphere: Atmosphere, sun_radius: f64, kinds: &Kinds) -> Result<Self> {
        let (mut parts, polarising) = parts(&atmosphere)?;
        kinds.assign(&mut parts);
        for aerosol in parts.iter_mut().flat_map(|part| &mut part.aerosols) {
            let (own, kind) = (&aerosol.lobes, &kinds.main[aerosol.kind]);
            if aerosol.table.is_some() || own.count().max(kind.count()) > 1 {
                aerosol.beside = Some(beside(aerosol.table.as_ref(), own, kind));
            }
        }
        Ok(Self {
            sun: SunColumns::new(&atmosphere),
            atmosphere,
            parts,
            polarising,
            kinds: kinds.main.clone(),
            sun_radius,
        })
    }

    /// Profiles of all constituents at `altitude`.
    pub fn profiles(&self, altitude: f64) -> [f32; MAX_CONSTITUENTS] {
        let mut out = [0.0; MAX_CONSTITUENTS];
        for (k, p) in out.iter_mut().enumerate().take(self.parts.len()) {
            *p = self.atmosphere.profile(k, altitude) as f32;
        }
        out
    }

    /// Transmittance for columns along a path.
    pub fn transmittance(&self, columns: &Columns) -> Spectrum {
        self.attenuate(&columns.map(|c| c as f32))
    }

    /// Transmittance from `altitude` to the sun, whose centre stands `mu` above the local horizontal (sine of its
    /// elevation).
    ///
    /// Near the planet's edge it is the share of the disc above the horizon, seen through the air at the centroid of
    /// that share.
    pub fn sunlight(&self, altitude: f64, mu: f64) -> Option<Spectrum> {
        self.sunlight_through(altitude, mu).map(|(light, _)| light)
    }

    /// The same, and the columns (m) that it came through.
    pub fn sunlight_through(
        &self,
        altitude: f64,
        mu: f64,
    ) -> Option<(Spectrum, [f32; MAX_CONSTITUENTS])> {
        let dip = self.sun.planet().dip(altitude);
        let angle = mu.clamp(-1.0, 1.0).asin() + dip;
        let x = angle / self.sun_radius.max(1e-12);
        if x <= -1.0 {
            return None;
        }
        let (share, rise) = if x >= 1.0 {
            (1.0, 0.0)
        } else {
            visible_disc(x)
        };
        let centre = (angle + rise * self.sun_radius).max(0.0);
        let columns = self.sun.at(altitude, centre, dip);
        Some((self.attenuate(&columns).map(|t| t * share as f32), columns))
    }

    fn attenuate(&self, columns: &[f32; MAX_CONSTITUENTS]) -> Spectrum {
        self.sum(columns)
            .map(|t| if t < BLACK { (-t).exp() } else { 0.0 })
    }

    /// Extinction times what there is of each constituent: optical depth of columns, extinction of profiles.
    pub fn sum(&self, constituents: &[f32; MAX_CONSTITUENTS]) -> Spectrum {
        let mut sums = [0.0f32; NW];
        for (part, c) in self.parts.iter().zip(constituents) {
            for (sum, extinction) in sums.iter_mut().zip(&part.extinction) {
                *sum += extinction * c;
            }
        }
        sums
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

/// Share of the solar disc above the horizon, and by how many radii the centroid of that share stands above the disc's
/// centre, for a centre `x` radii above the horizon.
fn visible_disc(x: f64) -> (f64, f64) {
    use std::f64::consts::PI;
    let chord = 1.0 - x * x;
    let share = 0.5 + (x * chord.sqrt() + x.asin()) / PI;
    (share, 2.0 / 3.0 * chord.powf(1.5) / (PI * share.max(1e-12)))
}

/// Narrows a per-wavelength vector.
pub fn spectrum(values: &[f64]) -> Spectrum {
    std::array::from_fn(|w| values[w] as f32)
}

/// Henyey-Greenstein phase function, mean 1, at the cosine `c` of the scattering angle.
pub fn henyey_greenstein(g: &Spectrum, c: f32) -> Spectrum {
    std::array::from_fn(|w| {
        let x = 1.0 + g[w] * g[w] - 2.0 * g[w] * c;
        (1.0 - g[w] * g[w]) / (x * x.sqrt())
    })
}

/// Rayleigh phase function, mean 1, for polarising shares `delta`.
pub fn rayleigh_phase(delta: &Spectrum, c: f32) -> Spectrum {
    delta.map(|d| 0.75 * d * (1.0 + c * c) + 1.0 - d)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_solar_disc_sets_smoothly() {
        assert!((visible_disc(0.0).0 - 0.5).abs() < 1e-12);
        assert!((visible_disc(0.0).1 - 4.0 / (3.0 * std::f64::consts::PI)).abs() < 1e-12);
        assert!(visible_disc(0.999_999).0 > 0.999 && visible_disc(0.999_999).1 < 1e-3);
        assert!(visible_disc(-0.999).0 < 1e-3 && (visible_disc(-0.999).1 - 1.0).abs() < 0.01);
    }
}

//! An atmosphere prepared for spectral loops: coefficients as fixed-length arrays over wavelength.

use super::kinds::Kinds;
use super::lobes::Lobes;
use super::parts::{Part, parts};
use super::phase_table::beside;
use super::spectra::{NW, Spectrum};
use crate::atmosphere::Atmosphere;
use crate::column::{Columns, MAX_CONSTITUENTS, SunColumns};
use anyhow::Result;

/// Angular radius of the sun, rad (0.2667°, as in the published model).
pub const SOLAR_ANGULAR_RADIUS: f64 = 0.004_654_793;

/// Optical depth beyond which nothing passes: products of what would are not normal numbers, with which processors
/// are slow.
const BLACK: f32 = 25.0;

/// Share of the light about a level ray that is polarised as that of the ray, and how it grows with the zenith cosine:
/// chosen by the unbiased tracer (`cargo test --release -p welkin-fitter --test mie polarisation`).
const LEVEL: f64 = 0.45;
const SLOPE: f64 = 1.1;

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

    /// Whether particles scatter polarised light on as such.
    pub fn keeps_polarisation(&self) -> bool {
        self.parts
            .iter()
            .any(|part| part.keeping.iter().any(|&k| k > 0.0))
    }

    /// How much more polarised light than other comes through columns on a ray of this zenith cosine: what particles
    /// scatter on with its polarisation counts as not scattered.
    ///
    /// That takes light from the directions about the ray to be as that of the ray. About a level one half of them are
    /// below the horizon, where it is not.
    pub fn kept_polarised(&self, columns: &Columns, cosine: f64) -> Spectrum {
        let alike = (LEVEL + SLOPE * cosine.abs()).min(1.0);
        let mut sums = [0.0f32; NW];
        for (part, c) in self.parts.iter().zip(columns) {
            let column = (alike * c) as f32;
            for (sum, keeping) in sums.iter_mut().zip(&part.keeping) {
                *sum += keeping * column;
            }
        }
        sums.map(f32::exp)
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

/// Share of the solar disc above the horizon, and by how many radii the centroid of that share stands above the disc's
/// centre, for a centre `x` radii above the horizon.
fn visible_disc(x: f64) -> (f64, f64) {
    use std::f64::consts::PI;
    let chord = 1.0 - x * x;
    let share = 0.5 + (x * chord.sqrt() + x.asin()) / PI;
    (share, 2.0 / 3.0 * chord.powf(1.5) / (PI * share.max(1e-12)))
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

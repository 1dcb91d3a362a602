//! What the air is made of: altitude profiles times spectral coefficients.
//!
//! A [`Constituent`] is one altitude profile. All that shares the profile (the water-soluble, insoluble and soot
//! particles of the boundary layer, say) is one constituent with several [`Scatterer`]s, so that one column density per
//! constituent gives the optical depth at every wavelength.

use super::matrix::Matrix;
use std::sync::Arc;

/// How a scatterer distributes light. Parameters are per wavelength; phase functions have mean 1 over the sphere.
#[derive(Clone, Debug, PartialEq)]
pub enum Phase {
    /// Rayleigh scattering with depolarisation ρ (natural light).
    Rayleigh {
        /// ρ per wavelength.
        depolarisation: Vec<f64>,
    },
    /// Henyey-Greenstein, fully depolarising unless the tracer is told otherwise.
    HenyeyGreenstein {
        /// Asymmetry parameter per wavelength.
        g: Vec<f64>,
    },
    /// A scattering matrix at tabulated angles.
    Tabulated(Arc<Matrix>),
}

/// A scattering part of a constituent.
#[derive(Clone, Debug, PartialEq)]
pub struct Scatterer {
    /// For messages, e.g. "waso".
    pub name: String,
    /// Its phase function.
    pub phase: Phase,
    /// Extinction coefficient per wavelength where the profile is 1, m⁻¹: its part of the constituent's.
    pub extinction: Vec<f64>,
    /// Scattering coefficient per wavelength where the profile is 1, m⁻¹.
    pub scattering: Vec<f64>,
}

/// One altitude profile with its spectral coefficients.
#[derive(Clone, Debug, PartialEq)]
pub struct Constituent {
    /// For messages, e.g. "boundary layer".
    pub name: String,
    /// Profile at the nodes of [`Atmosphere::altitudes`], piecewise linear between them.
    pub profile: Vec<f64>,
    /// Extinction coefficient per wavelength where the profile is 1, m⁻¹.
    pub extinction: Vec<f64>,
    /// Its scattering parts; none for a pure absorber.
    pub scatterers: Vec<Scatterer>,
}

/// Profiles that differ by no more than this, relative, are one.
const SAME: f64 = 1e-12;

impl Constituent {
    /// Takes up what has the same profile.
    pub(crate) fn absorb(&mut self, other: Self) {
        self.name = format!("{} + {}", self.name, other.name);
        for (a, b) in self.extinction.iter_mut().zip(&other.extinction) {
            *a += b;
        }
        self.scatterers.extend(other.scatterers);
    }

    /// Whether it has this shape with altitude.
    pub(crate) fn has_shape(&self, profile: &[f64]) -> bool {
        let pairs = self.profile.iter().zip(profile);
        pairs.into_iter().all(|(a, b)| (a - b).abs() <= SAME * a)
    }
}

/// A spherically symmetric atmosphere above a Lambertian ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Atmosphere {
    /// Planet radius, m.
    pub planet_radius: f64,
    /// Nodes of all profiles, m: 0 first, top of the atmosphere last, strictly increasing.
    pub altitudes: Vec<f64>,
    /// Wavelengths, nm, strictly increasing.
    pub wavelengths: Vec<f64>,
    /// What it contains.
    pub constituents: Vec<Constituent>,
}

impl Atmosphere {
    /// Altitude of the top of the atmosphere, m.
    pub fn top(&self) -> f64 {
        *self.altitudes.last().expect("an atmosphere has nodes")
    }

    /// Value of constituent `k`'s profile at `altitude` (m); 0 above the top, the ground value below 0.
    pub fn profile(&self, k: usize, altitude: f64) -> f64 {
        let (nodes, values) = (&self.altitudes, &self.constituents[k].profile);
        if altitude > self.top() {
            return 0.0;
        }
        let i = nodes
            .partition_point(|&z| z <= altitude)
            .clamp(1, nodes.len() - 1);
        let t = ((altitude - nodes[i - 1]) / (nodes[i] - nodes[i - 1])).clamp(0.0, 1.0);
        values[i - 1] + t * (values[i] - values[i - 1])
    }

    /// Extinction coefficient at `altitude` (m) for wavelength index `w`, m⁻¹.
    pub fn extinction(&self, altitude: f64, w: usize) -> f64 {
        (0..self.constituents.len())
            .map(|k| self.profile(k, altitude) * self.constituents[k].extinction[w])
            .sum()
    }

    /// Vertical optical depth of constituent `k` at wavelength index `w`.
    pub fn vertical_optical_depth(&self, k: usize, w: usize) -> f64 {
        let c = &self.constituents[k];
        column(&self.altitudes, &c.profile) * c.extinction[w]
    }
}

/// Integral of a profile over the altitude, m.
pub fn column(altitudes: &[f64], profile: &[f64]) -> f64 {
    let pairs = altitudes.windows(2).zip(profile.windows(2));
    pairs
        .map(|(z, p)| 0.5 * (p[0] + p[1]) * (z[1] - z[0]))
        .sum()
}

//! An atmosphere prepared for tracing at N wavelengths: fast profiles, coefficients, majorants.

use super::phase::Lobe;
use crate::atmosphere::{Atmosphere, Phase};
use anyhow::{Result, ensure};

/// Most constituents that an atmosphere may have.
pub const MAX_CONSTITUENTS: usize = 8;
/// A number per constituent: profile values at a point, or column densities along a line (m).
pub type Columns = [f64; MAX_CONSTITUENTS];

const GRID: usize = 2048;

/// A spherical shell with an upper bound of the extinction in it.
pub struct Shell {
    /// Radius of its lower boundary, m.
    pub lower: f64,
    /// Radius of its upper boundary, m.
    pub upper: f64,
    /// No wavelength's extinction exceeds this anywhere in it, m⁻¹.
    pub majorant: f64,
}

/// See the module's documentation.
pub struct Medium<const N: usize> {
    /// Planet radius, m.
    pub radius: f64,
    /// Radius of the top of the atmosphere, m.
    pub top: f64,
    /// Number of wavelengths in use; the other lanes repeat the last one.
    pub active: usize,
    /// Wavelengths, nm.
    pub wavelengths: [f64; N],
    /// Extinction per unit profile of each constituent, m⁻¹.
    pub extinction: Vec<[f64; N]>,
    /// Scattering per unit profile of each constituent, m⁻¹.
    pub scattering: Vec<[f64; N]>,
    /// All scatterers.
    pub lobes: Vec<Lobe<N>>,
    /// Majorants, from the ground up.
    pub shells: Vec<Shell>,
    /// Coarser shells, for densities that need not bound anything.
    pub layers: Vec<Shell>,
    nodes: Vec<f64>,
    radii: Vec<f64>,
    inverse_radii: Vec<f64>,
    profiles: Vec<Columns>,
    slopes: Vec<Columns>,
    grid: Vec<u16>,
    grid_scale: f64,
}

impl<const N: usize> Medium<N> {
    /// Prepares `atmosphere` at the wavelengths with the indices `lanes` (1 to N of them).
    pub fn new(atmosphere: &Atmosphere, lanes: &[usize]) -> Result<Self> {
        let k = atmosphere.constituents.len();
        ensure!(
            k <= MAX_CONSTITUENTS,
            "the tracer takes at most {MAX_CONSTITUENTS} altitude profiles, the atmosphere has {k}"
        );
        ensure!(
            atmosphere.altitudes.len() < usize::from(u16::MAX),
            "too many altitude nodes"
        );
        let lane = |values: &[f64]| -> [f64; N] {
            std::array::from_fn(|i| values[lanes[i.min(lanes.len() - 1)]])
        };
        let nodes = atmosphere.altitudes.clone();
        let profiles = node_profiles(atmosphere);
        let mut medium = Self {
            radius: atmosphere.planet_radius,
            top: atmosphere.planet_radius + atmosphere.top(),
            active: lanes.len(),
            wavelengths: lane(&atmosphere.wavelengths),
            extinction: atmosphere
                .constituents
                .iter()
                .map(|c| lane(&c.extinction))
                .collect(),
            scattering: vec![[0.0; N]; k],
            lobes: lobes(atmosphere, lanes, lane),
            shells: vec![],
            layers: vec![],
            radii: nodes.iter().map(|z| atmosphere.planet_radius + z).collect(),
            inverse_radii: nodes
                .iter()
                .map(|z| (atmosphere.planet_radius + z).recip())
                .collect(),
            slopes: slopes(&nodes, &profiles),
            grid_scale: GRID as f64 / atmosphere.top(),
            grid: (0..=GRID)
                .map(|i| {
                    let z = atmosphere.top() * i as f64 / GRID as f64;
                    (nodes.partition_point(|&n| n <= z).clamp(1, nodes.len() - 1) - 1) as u16
                })
                .collect(),
            nodes,
            profiles,
        };
        for lobe in &medium.lobes {
            for (sum, s) in medium.scattering[lobe.constituent]
                .iter_mut()
                .zip(&lobe.scattering)
            {
                *sum += s;
            }
        }
        medium.shells = medium.merge_shells(1.6);
        medium.layers = medium.merge_shells(3.0);
        Ok(medium)
    }

    /// The interval between nodes that holds `altitude` (clamped to the atmosphere).
    #[inline]
    pub fn interval(&self, altitude: f64) -> usize {
        let cell = (altitude * self.grid_scale).clamp(0.0, GRID as f64) as usize;
        let mut i = usize::from(self.grid[cell]);
        while i + 2 < self.nodes.len() && self.nodes[i + 1] <= altitude {
            i += 1;
        }
        i
    }

    /// Profile values at `altitude`.
    pub fn profile(&self, altitude: f64) -> Columns {
        self.profile_in::<MAX_CONSTITUENTS>(self.interval(altitude), altitude)
    }

    /// Values of the first `K` profiles at `altitude` (or a mean altitude) of interval `i`, continued linearly.
    #[inline(always)]
    pub fn profile_in<const K: usize>(&self, i: usize, altitude: f64) -> [f64; K] {
        let dz = altitude - self.nodes[i];
        let (p, m) = (&self.profiles[i], &self.slopes[i]);
        std::array::from_fn(|k| p[k] + m[k] * dz)
    }

    /// Radii of the nodes, m.
    pub fn radii(&self) -> &[f64] {
        &self.radii
    }

    /// Their reciprocals.
    pub fn inverse_radii(&self) -> &[f64] {
        &self.inverse_radii
    }

    /// Index of the one of `shells` that holds `radius`.
    pub fn shell(shells: &[Shell], radius: f64) -> usize {
        let n = shells.len();
        shells
            .partition_point(|shell| shell.upper <= radius)
            .min(n - 1)
    }

    /// Extinction for given profile values, m⁻¹.
    pub fn extinction_of(&self, profile: &Columns) -> [f64; N] {
        combine(&self.extinction, profile)
    }

    /// Scattering for given profile values, m⁻¹.
    pub fn scattering_of(&self, profile: &Columns) -> [f64; N] {
        combine(&self.scattering, profile)
    }

    /// Transmittance of given column densities.
    pub fn transmittance(&self, columns: &Columns) -> [f64; N] {
        combine(&self.extinction, columns).map(|tau| (-tau).exp())
    }

    fn peak(&self, node: usize) -> f64 {
        let e = self.extinction_of(&self.profiles[node]);
        e.iter().fold(0.0, |a, &b| a.max(b))
    }

    /// Joins node intervals while the bound stays tight or the whole stays thin.
    fn merge_shells(&self, ratio: f64) -> Vec<Shell> {
        let mut shells = vec![];
        let (mut first, mut low, mut high) = (0, self.peak(0), self.peak(0));
        for i in 1..self.nodes.len() {
            let e = self.peak(i);
            let (l, h) = (low.min(e), high.max(e));
            let thickness = self.nodes[i] - self.nodes[first];
            let loose = h > ratio * l && h * thickness > 2e-4;
            if i - 1 > first && (loose || thickness > 20_000.0) {
                shells.push(self.shell_between(first, i - 1, high));
                first = i - 1;
                low = e.min(self.peak(i - 1));
                high = e.max(self.peak(i - 1));
            } else {
                (low, high) = (l, h);
            }
        }
        shells.push(self.shell_between(first, self.nodes.len() - 1, high));
        shells
    }

    fn shell_between(&self, from: usize, to: usize, majorant: f64) -> Shell {
        Shell {
            lower: self.radii[from],
            upper: self.radii[to],
            majorant: majorant * (1.0 + 1e-9),
        }
    }
}

fn combine<const N: usize>(coefficients: &[[f64; N]], columns: &Columns) -> [f64; N] {
    let mut sum = [0.0; N];
    for (c, x) in coefficients.iter().zip(columns) {
        for w in 0..N {
            sum[w] += c[w] * x;
        }
    }
    sum
}

fn node_profiles(atmosphere: &Atmosphere) -> Vec<Columns> {
    (0..atmosphere.altitudes.len())
        .map(|i| {
            let mut p = [0.0; MAX_CONSTITUENTS];
            for (x, c) in p.iter_mut().zip(&atmosphere.constituents) {
                *x = c.profile[i];
            }
            p
        })
        .collect()
}

fn slopes(nodes: &[f64], profiles: &[Columns]) -> Vec<Columns> {
    nodes
        .windows(2)
        .zip(profiles.windows(2))
        .map(|(z, p)| std::array::from_fn(|k| (p[1][k] - p[0][k]) / (z[1] - z[0])))
        .collect()
}

fn lobes<const N: usize>(
    atmosphere: &Atmosphere,
    lanes: &[usize],
    lane: impl Fn(&[f64]) -> [f64; N],
) -> Vec<Lobe<N>> {
    let constituents = atmosphere.constituents.iter().enumerate();
    constituents
        .flat_map(|(constituent, c)| c.scatterers.iter().map(move |s| (constituent, s)))
        .map(|(constituent, s)| {
            let scattering = lane(&s.scattering);
            match &s.phase {
                Phase::Rayleigh { depolarisation } => {
                    Lobe::rayleigh(constituent, scattering, lane(depolarisation))
                }
                Phase::HenyeyGreenstein { g } => {
                    Lobe::henyey_greenstein(constituent, scattering, lane(g))
                }
                Phase::Tabulated(matrix) => Lobe::tabulated(constituent, scattering, matrix, lanes),
            }
        })
        .collect()
}

//! The source function of multiply scattered light at the conditions of a scene: every mode but altitude, sun and
//! component is contracted here. Format specification, section 7.7.

use std::sync::Arc;

use super::angular_basis::{Components, Directions};
use super::file_tables::FileTables;
use crate::error::{Error, Result};
use crate::format::{Head, SourceBasisView, visibility_node};
use crate::geometry::Planet;
use crate::ground::reflected;
use crate::kernel::axis::linear;
use crate::kernel::lanes::Lanes;
use crate::kernel::math::LANES;
use crate::model::{Model, Nodes};

/// Sun nodes of the table around that of the scene.
const SUNS: usize = 29;
/// How far these are from it, rad: the farthest points of the atmosphere that are seen from 15 km stand 14° away.
const NEAR: f64 = 0.25;
/// How much denser they are close to it.
const CROWDING: f64 = 2.0;
/// Distance of the nodes beyond them, rad, and how far these may go.
const STEP: f64 = 0.036;
const FAR: f64 = 0.5;

/// The source over altitude and the sun's local elevation.
#[derive(Clone, Debug)]
pub(crate) struct SourceTable {
    pub directions: Arc<Directions>,
    altitude: Vec<f32>,
    /// Sines of the sun's elevation.
    sun: Vec<f32>,
    blocks: usize,
    /// Pairs of components.
    pairs: usize,
    /// `[altitude][sun][block of wavelengths][pair of components]`, over the level: four wavelengths of the one, then
    /// of the other.
    values: Vec<Lanes<8>>,
    /// Logarithm of the level, `[sun][block]`.
    level: Vec<[f32; LANES]>,
}

/// A place in the table.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Spot {
    /// First row of each of the four neighbours.
    row: [usize; 4],
    weight: [f32; 4],
    level: [usize; 2],
    share: f32,
}

impl SourceTable {
    /// A table at some sines of the sun's elevation and the altitudes of the file; its values come later.
    pub fn empty(model: &Model, nodes: Nodes, suns: &[f64]) -> Result<Self> {
        let basis = model.source_basis_chunk()?;
        let mut table = Self {
            directions: Arc::clone(&FileTables::of(model)?.directions),
            altitude: refine(&basis).iter().map(|&h| h as f32).collect(),
            sun: Vec::new(),
            blocks: nodes.head.wavelengths.len().div_ceil(LANES),
            pairs: basis.ranks[2].div_ceil(2),
            values: Vec::new(),
            level: Vec::new(),
        };
        table.turn(suns);
        Ok(table)
    }

    pub fn bytes(&self) -> usize {
        self.directions.bytes()
            + size_of_val(self.values.as_slice())
            + size_of_val(self.level.as_slice())
            + 4 * (self.altitude.len() + self.sun.len())
    }

    /// Moves the table to other sun nodes (sines); its values are those of the last ones.
    pub fn turn(&mut self, suns: &[f64]) {
        self.sun.clear();
        self.sun.extend(suns.iter().map(|&s| s as f32));
        let rows = suns.len() * self.blocks;
        let values = self.altitude.len() * rows * self.pairs;
        self.values
            .resize(values.max(self.values.len()), Lanes::splat(0.0));
        self.level.resize(rows.max(self.level.len()), [0.0; LANES]);
    }

    /// Altitude nodes.
    pub fn altitudes(&self) -> usize {
        self.altitude.len()
    }

    /// The lowest altitude node and sun node of the cell around a place.
    #[inline(always)]
    pub fn cell(&self, altitude: f32, sun: f32) -> [usize; 2] {
        [locate(&self.altitude, altitude).0, locate(&self.sun, sun).0]
    }

    /// The values of a node, `[block][pair]`.
    #[inline(always)]
    pub fn node(&mut self, altitude: usize, sun: usize) -> &mut [Lanes<8>] {
        let n = self.blocks * self.pairs;
        &mut self.values[(altitude * self.sun.len() + sun) * n..][..n]
    }

    /// Logarithm of the level at a sun node, `[block]`.
    pub fn level(&mut self, sun: usize) -> &mut [[f32; LANES]] {
        &mut self.level[sun * self.blocks..][..self.blocks]
    }

    /// Finds a place.
    #[inline(always)]
    pub fn spot(&self, altitude: f32, sun: f32) -> Spot {
        let (a, t) = locate(&self.altitude, altitude);
        let (s, u) = locate(&self.sun, sun);
        let row = |a: usize, s: usize| (a * self.sun.len() + s) * self.blocks * self.pairs;
        Spot {
            row: [row(a, s), row(a, s + 1), row(a + 1, s), row(a + 1, s + 1)],
            weight: [(1.0 - t) * (1.0 - u), (1.0 - t) * u, t * (1.0 - u), t * u],
            level: [s * self.blocks, (s + 1) * self.blocks],
            share: u,
        }
    }

    /// What molecules and what particles scatter towards the observer, per unit of scattering coefficient, m⁻¹ sr⁻¹;
    /// then Q and U of the former.
    #[inline(always)]
    pub fn scattered<const M: usize>(
        &self,
        spot: &Spot,
        seen: &[Components; M],
        block: usize,
    ) -> [[f32; LANES]; M] {
        let rows = spot
            .row
            .map(|row| &self.values[row + block * self.pairs..][..self.pairs]);
        let mut sums = [Lanes::splat(0.0); M];
        for r in 0..self.pairs {
            let mut value = Lanes::splat(0.0);
            for (row, weight) in rows.iter().zip(spot.weight) {
                value = value + row[r] * weight;
            }
            for (sum, seen) in sums.iter_mut().zip(seen) {
                *sum = *sum + value * pair(seen, r);
            }
        }
        let [near, far] = spot.level.map(|level| Lanes(self.level[level + block]));
        let level = (near + (far - near) * spot.share).exp();
        let mut sums = sums.map(|sum| {
            let [even, odd] = sum.halves().map(Lanes);
            even + odd
        });
        // A compressed source may dip below zero where there is next to no light.
        for sum in &mut sums[..2] {
            *sum = sum.max(Lanes::splat(0.0));
        }
        sums.map(|sum| (sum * level).0)
    }
}

#[cold]
pub(super) fn overflow() -> Error {
    let detail = "its values overflow at these conditions: the file is not a sensible sky";
    Error::invalid("source", detail)
}

/// Components 2r and 2r + 1, each for four wavelengths.
#[inline(always)]
fn pair(seen: &Components, r: usize) -> Lanes<8> {
    let vector = &seen[r / 4].0;
    let i = 2 * (r % 4);
    Lanes::pair(vector[i], vector[i + 1])
}

/// Interval and position in it; clamped to the ends.
#[inline(always)]
fn locate(nodes: &[f32], x: f32) -> (usize, f32) {
    // Counted, not searched: there are few, and no branch goes wrong.
    let inner = &nodes[1..nodes.len() - 1];
    let i = inner.iter().map(|&node| u32::from(node <= x)).sum::<u32>() as usize;
    let t = (x - nodes[i]) / (nodes[i + 1] - nodes[i]);
    (i, t.clamp(0.0, 1.0))
}

/// The altitude nodes of the file with one more between each two, for linear interpolation.
pub(super) fn refine(basis: &SourceBasisView) -> Vec<f64> {
    let nodes = basis.altitude.windows(2);
    let mut out: Vec<f64> = nodes
        .flat_map(|n| [n[0].get(), 0.5 * (n[0].get() + n[1].get())])
        .collect();
    out.push(basis.altitude[basis.altitude.len() - 1].get());
    out
}

/// How far from the origin the source holds, as an angle at the planet's centre, rad: to all air that can be seen from
/// air above the origin.
pub(crate) fn reach(planet: &Planet) -> f64 {
    (2.0 * planet.dip(planet.top)).clamp(NEAR, FAR)
}

/// Sines of the elevations around that of the scene's sun (rad), up to `reach` from it.
pub(super) fn sun_nodes(elevation: f64, reach: f64) -> Vec<f64> {
    let half = SUNS / 2;
    let beyond = ((reach - NEAR) / STEP).ceil() as usize;
    let distance = |i: usize| match i.checked_sub(half) {
        None | Some(0) => NEAR * (i as f64 / half as f64).powf(CROWDING),
        Some(k) => NEAR + (reach - NEAR) * k as f64 / beyond as f64,
    };
    let last = half + beyond;
    let below = (1..=last).rev().map(|i| elevation - distance(i));
    let above = (0..=last).map(|i| elevation + distance(i));
    let quarter = core::f64::consts::FRAC_PI_2;
    let mut nodes: Vec<f64> = below
        .chain(above)
        .filter(|a| a.abs() < quarter - 1e-3)
        .map(f64::sin)
        .collect();
    if elevation + reach >= quarter - 1e-3 {
        nodes.push(1.0);
    }
    nodes
}

pub(super) fn sun_coordinate(sine: f64) -> f64 {
    (12.5 * sine).asinh()
}

/// A spectrum in vectors.
pub(crate) fn blocks(spectrum: &[f64]) -> impl Iterator<Item = [f32; LANES]> + '_ {
    let lane = |block: &[f64], i: usize| block.get(i).map_or(0.0, |&v| v as f32);
    spectrum
        .chunks(LANES)
        .map(move |block| core::array::from_fn(|i| lane(block, i)))
}

/// Factor of the light that the ground reflected, per wavelength, given the albedos there: A / (1 − A s).
pub(crate) fn ground_factor(
    head: &Head,
    visibility: f64,
    albedos: impl IntoIterator<Item = f64>,
) -> Vec<f64> {
    let spherical = spherical_albedo(head, visibility).into_iter();
    let pairs = albedos.into_iter().zip(spherical);
    pairs.map(|(a, s)| reflected(a, s)).collect()
}

/// s, per wavelength.
pub(crate) fn spherical_albedo(head: &Head, visibility: f64) -> Vec<f64> {
    let nw = head.wavelengths.len();
    let nodes = linear(&head.visibility_nodes(), visibility_node(visibility));
    let spherical = |w: usize| -> f64 {
        nodes
            .taps()
            .map(|(v, t)| t * head.spherical_albedo[v * nw + w])
            .sum()
    };
    (0..nw).map(spherical).collect()
}

//! What goes into a model file: the head with axes, optics and colour, and the factor matrices as splines.

use crate::dataset::Grid;
use crate::decompose::{Basis, Own, row_major, splines};
use crate::estimate::OF_FIELD;
use crate::successive_orders::{FIELDS, Gatherer, Lobes, Medium, NW, Spectrum};
use crate::units::Plan;
use anyhow::Result;
use faer::Mat;
use welkin::format::{
    AlphaAxis, Field, Head, PhaseFunction, PolarisationBasis, PolarisationFactors, RadianceBasis,
    RadianceFactors,
};

/// What a visibility contributes to the head.
pub struct AirTables {
    /// Extinction per constituent where the profile is 1, m⁻¹.
    pub extinction: Vec<Spectrum>,
    /// Spherical albedo.
    pub spherical_albedo: Spectrum,
}

impl AirTables {
    /// From an atmosphere and its solution.
    pub fn new(medium: &Medium, spherical_albedo: Spectrum) -> Self {
        let extinction = medium.parts.iter().map(|part| part.extinction).collect();
        Self {
            extinction,
            spherical_albedo,
        }
    }
}

/// Assembles the head, without colour. `airs` has one entry per visibility of the plan; `gatherer` gives the phase
/// functions.
pub fn head(
    plan: &Plan,
    airs: &[AirTables],
    gatherer: &Gatherer,
    metadata: String,
) -> Result<Head> {
    let Plan { grid, coverage, .. } = plan;
    let range = coverage.range();
    let wide = |s: &Spectrum| s.iter().map(|&v| f64::from(v)).collect::<Vec<f64>>();
    Ok(Head {
        planet: gatherer.planet(),
        up: AlphaAxis {
            intervals: grid.up.0.intervals,
            exponent: grid.up.1,
        },
        down: AlphaAxis {
            intervals: grid.down.0.intervals,
            exponent: grid.down.1,
        },
        phi_intervals: grid.phi.intervals,
        elevation: grid.elevation,
        wavelengths: coverage.wavelengths().to_vec(),
        altitudes: grid.altitudes.clone(),
        visibilities: grid.visibilities.clone(),
        constituents: airs[0].extinction.len(),
        absorbers: gatherer.medium().absorbers(),
        estimated: true,
        extinction: airs
            .iter()
            .flat_map(|air| air.extinction.iter().flat_map(wide))
            .collect(),
        spherical_albedo: airs
            .iter()
            .flat_map(|air| wide(&air.spherical_albedo))
            .collect(),
        // For whoever knows better.
        xyz: vec![[0.0; 3]; NW],
        solar_start: range[0],
        solar_step: 1.0,
        solar_irradiance: plan.air.solar_irradiance(range)?,
        fields: fields(gatherer, wide),
        metadata,
    })
}

fn fields(gatherer: &Gatherer, wide: impl Fn(&Spectrum) -> Vec<f64>) -> Vec<Field> {
    let field = |f: usize, phase, ground, parameter| Field {
        phase,
        ground,
        estimate: OF_FIELD[f],
        parameter,
    };
    // Δ = (1 − ρ)/(1 + ρ/2) solved for ρ.
    let depolarisation = gatherer.polarising().map(|d| (1.0 - d) / (1.0 + d / 2.0));
    let lobes = |kind: usize| {
        let g = gatherer.phase(kind).iter().map(|lobe| wide(&lobe.g));
        let lobe = |g| field(1 + kind, PhaseFunction::HenyeyGreenstein, false, g);
        g.map(lobe).collect::<Vec<_>>()
    };
    [
        vec![field(
            0,
            PhaseFunction::Rayleigh,
            false,
            wide(&depolarisation),
        )],
        lobes(0),
        lobes(1),
        vec![field(3, PhaseFunction::None, false, vec![0.0; NW])],
        vec![field(4, PhaseFunction::None, true, vec![0.0; NW])],
    ]
    .concat()
}

/// Channel factors with a field for every lobe of the kinds of particles, which differ by the weights.
pub fn by_lobes(basis: RadianceBasis, kinds: &[Lobes; 2]) -> RadianceBasis {
    let row = |row: &[f32]| -> Vec<f32> {
        let field = |f: usize| &row[f * NW..(f + 1) * NW];
        let mut out = field(0).to_vec();
        for (kind, lobes) in kinds.iter().enumerate() {
            for lobe in lobes.iter() {
                out.extend(field(1 + kind).iter().zip(lobe.weight).map(|(v, c)| v * c));
            }
        }
        out.extend_from_slice(&row[3 * NW..]);
        out
    };
    let rows = basis.channel.chunks_exact(FIELDS * NW);
    RadianceBasis {
        channel: rows.flat_map(row).collect(),
        ..basis
    }
}

/// The shared factor matrices as splines, every column scaled to a largest magnitude of 1; the scales go into the
/// chunks.
pub struct PackedBasis {
    rank: usize,
    phi: Vec<f32>,
    /// `[rank][channels]`.
    channel: Vec<f32>,
    scale: Vec<f64>,
}

impl PackedBasis {
    /// From factor matrices at sites.
    pub fn new(grid: &Grid, basis: &Basis) -> Self {
        let rank = basis.rank;
        let mut phi = splines(grid.phi, &basis.phi, rank);
        let mut channel = Mat::from_fn(basis.channel.len() / rank, rank, |i, r| {
            f64::from(basis.channel[i * rank + r])
        });
        let mut scale = vec![1.0; rank];
        normalise(&mut [&mut phi], &mut scale);
        normalise(&mut [&mut channel], &mut scale);
        Self {
            rank,
            phi: row_major(&phi),
            channel: row_major(&channel.transpose().to_owned()),
            scale,
        }
    }

    /// For the radiance.
    pub fn radiance(&self) -> RadianceBasis {
        RadianceBasis {
            rank: self.rank,
            phi: self.phi.clone(),
            channel: self.channel.clone(),
        }
    }

    /// For the polarisation.
    pub fn polarisation(&self) -> PolarisationBasis {
        PolarisationBasis {
            rank: self.rank,
            phi: self.phi.clone(),
            channel: self.channel.clone(),
        }
    }

    /// Radiance factors of a chunk.
    pub fn radiance_chunk(&self, grid: &Grid, own: &Own) -> RadianceFactors {
        let packed = self.chunk(grid, own);
        RadianceFactors {
            rank: self.rank,
            scale: packed.scale,
            alpha_up: packed.alpha_up,
            alpha_down: packed.alpha_down,
            elevation: packed.elevation,
            level: vec![],
        }
    }

    /// Polarisation factors of a chunk.
    pub fn polarisation_chunk(&self, grid: &Grid, own: &Own) -> PolarisationFactors {
        let packed = self.chunk(grid, own);
        PolarisationFactors {
            rank: self.rank,
            scale: packed.scale,
            alpha_up: packed.alpha_up,
            alpha_down: packed.alpha_down,
            elevation: packed.elevation,
        }
    }

    fn chunk(&self, grid: &Grid, own: &Own) -> PackedChunk {
        let (above, below) = own.view.split_at(grid.up.0.len() * self.rank);
        let mut up = splines(grid.up.0, above, self.rank);
        let mut down = splines(grid.down.0, below, self.rank);
        let mut elevation = splines(grid.elevation_axis(), &own.elevation, self.rank);
        let mut scale = self.scale.clone();
        normalise(&mut [&mut up, &mut down], &mut scale);
        normalise(&mut [&mut elevation], &mut scale);
        PackedChunk {
            scale: scale.into_iter().map(|s| s as f32).collect(),
            alpha_up: row_major(&up),
            alpha_down: row_major(&down),
            elevation: row_major(&elevation),
        }
    }
}

/// The factor matrices of a chunk as splines.
struct PackedChunk {
    scale: Vec<f32>,
    alpha_up: Vec<f32>,
    alpha_down: Vec<f32>,
    elevation: Vec<f32>,
}

/// Scales every column to a largest magnitude of 1 over all `matrices`, keeping the product with `scale`.
fn normalise(matrices: &mut [&mut Mat<f64>], scale: &mut [f64]) {
    for (r, scale) in scale.iter_mut().enumerate() {
        let max = matrices
            .iter()
            .flat_map(|m| (0..m.nrows()).map(move |i| m[(i, r)].abs()))
            .fold(1e-300, f64::max);
        *scale *= max;
        for m in matrices.iter_mut() {
            for i in 0..m.nrows() {
                m[(i, r)] /= max;
            }
        }
    }
}

//! Factors to the head and the chunks of a welkin file.

use super::air::Air;
use super::fields::Fields;
use super::light::Light;
use super::sites::PLANET;
use super::split::LOBES;
use super::suns::SunSplines;
use crate::dataset::Grid;
use crate::decompose::{Fit, Own};
use crate::official::layout::Channels;
use crate::pack::PackedBasis;
use welkin::format::{
    AlphaAxis, Chunk, ColumnTable, DensityTable, Field, Head, Payload, PhaseFunction,
};

/// Extinction of the constituent that makes rays opaque, m⁻¹: the fields are whole radiances and not shares of what a
/// ray's optical depth lets through.
const OPAQUE: f64 = 1e3;

/// The head of the model.
pub fn head(
    grid: &Grid,
    channels: Channels,
    light: &Light,
    spherical_albedo: Vec<f64>,
    (air, ground): (&Air, bool),
) -> Head {
    let (nv, nw) = (grid.visibilities.len(), channels.count);
    let mut extinction = vec![];
    for v in 0..nv {
        let own = air.constituents * nw;
        extinction.extend(&air.extinction[v * own..][..own]);
        extinction.extend(vec![OPAQUE; nw]);
    }
    let field = |phase, ground, parameter| Field {
        phase,
        ground,
        estimate: 0,
        parameter: vec![parameter; nw],
    };
    let mut fields = vec![field(PhaseFunction::None, false, 0.0)];
    fields.extend(LOBES.map(|g| field(PhaseFunction::HenyeyGreenstein, false, g)));
    if ground {
        fields.push(field(PhaseFunction::None, true, 0.0));
    }
    Head {
        planet: PLANET,
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
        wavelengths: channels.centres(),
        altitudes: grid.altitudes.clone(),
        visibilities: grid.visibilities.clone(),
        constituents: air.constituents + 1,
        absorbers: 0,
        estimated: false,
        extinction,
        spherical_albedo,
        xyz: light.xyz.clone(),
        solar_start: channels.centre(0),
        solar_step: channels.width,
        solar_irradiance: light.irradiance.iter().map(|e| *e as f32).collect(),
        fields,
        metadata: "{}".into(),
    }
}

/// The basis, then for each altitude its column and its radiance.
pub fn radiance(
    grid: &Grid,
    suns: &SunSplines,
    (chunks, places): (&[Fields], &[[usize; 2]]),
    fit: &Fit,
    constituents: usize,
) -> Vec<Chunk> {
    let packed = PackedBasis::new(grid, &fit.basis);
    let basis = packed.radiance();
    let mut out = vec![Chunk::new(None, None, Payload::RadianceBasis(basis))];
    let mut last = None;
    for ((fields, own), [altitude, visibility]) in chunks.iter().zip(&fit.own).zip(places) {
        if last != Some(*altitude) {
            last = Some(*altitude);
            let rows = grid.up.0.len() + grid.down.0.len();
            // The logarithm of a mean density of 1.
            let values = vec![0.0; rows * constituents];
            let column = Payload::Column(ColumnTable { values });
            out.push(Chunk::new(Some(*altitude), None, column));
        }
        let own = Own {
            view: own.view.clone(),
            elevation: suns.to_sites(&own.elevation, fit.basis.rank),
        };
        let mut factors = packed.radiance_chunk(grid, &own);
        factors.level = fields.level.clone();
        for scale in &mut factors.scale {
            *scale = (f64::from(*scale) * fields.offset) as f32;
        }
        let payload = Payload::Radiance(factors);
        out.push(Chunk::new(Some(*altitude), Some(*visibility), payload));
    }
    out
}

/// What all skies share of the polarisation, then its chunks.
pub fn polarisation(
    grid: &Grid,
    suns: &SunSplines,
    (chunks, places): (&[Fields], &[[usize; 2]]),
    fit: &Fit,
) -> Vec<Chunk> {
    let packed = PackedBasis::new(grid, &fit.basis);
    let basis = packed.polarisation();
    let mut out = vec![Chunk::new(None, None, Payload::PolarisationBasis(basis))];
    for ((fields, own), [altitude, visibility]) in chunks.iter().zip(&fit.own).zip(places) {
        let own = Own {
            view: own.view.clone(),
            elevation: suns.to_sites(&own.elevation, fit.basis.rank),
        };
        let mut factors = packed.polarisation_chunk(grid, &own);
        for scale in &mut factors.scale {
            *scale = (f64::from(*scale) * fields.offset) as f32;
        }
        let payload = Payload::Polarisation(factors);
        out.push(Chunk::new(Some(*altitude), Some(*visibility), payload));
    }
    out
}

/// The profiles of all constituents; the opaque one is nowhere.
pub fn transmittance(air: &Air) -> Option<Chunk> {
    let profiles = air.profiles.as_ref()?;
    let rows = profiles.density.chunks_exact(air.constituents);
    let density = rows.flat_map(|row| row.iter().copied().chain([0.0]));
    let table = DensityTable {
        edges: profiles.edges.clone(),
        density: density.collect(),
    };
    Some(Chunk::new(None, None, Payload::Transmittance(table)))
}

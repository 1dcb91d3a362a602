//! What finite segments need: the air and a synthetic source.

use welkin::format::{
    Chunk, Head, Payload, PhaseFunction, SOURCE_FIELDS, SourceBasis, SourceCore, encode, harmonics,
};

use super::{densities, wave};

/// Numbers of the synthetic source: nodes of altitude and sun, components along the modes.
const SOURCE_ALTITUDES: [f64; 5] = [0.0, 500.0, 4000.0, 20_000.0, 100_000.0];
const SOURCE_SUNS: [f64; 7] = [-0.3, -0.1, -0.03, 0.0, 0.05, 0.3, 1.0];
const SOURCE_RANKS: [usize; 4] = [2, 3, 3, 2];
const SOURCE_DEGREE: usize = 3;
const SOURCE_ORDERS: usize = 2;

/// The air, the source basis, and a source for each visibility of `head`. With `swing` above 1 the source is negative
/// in some directions.
pub fn chunks(head: &Head, swing: f32) -> Vec<Chunk> {
    let chunk = |visibility, payload| Chunk {
        altitude: None,
        visibility,
        error_median: 0.0,
        error_p99: 0.0,
        payload,
    };
    let mut chunks = vec![
        chunk(None, Payload::Transmittance(densities())),
        chunk(None, Payload::SourceBasis(source_basis(head, swing))),
    ];
    for v in 0..head.visibilities.len() {
        chunks.push(chunk(Some(v), Payload::Source(source(head, v))));
    }
    chunks
}

/// The same with a source that is strongest across the plane of the sun, and few particles.
pub fn polarised_chunks(head: &Head) -> Vec<Chunk> {
    let mut chunks = chunks(head, 0.2);
    for chunk in &mut chunks {
        match &mut chunk.payload {
            Payload::SourceBasis(basis) => {
                for (row, value) in [0.2, 0.9, 0.4, 0.25].into_iter().enumerate() {
                    basis.factors[2][row * SOURCE_RANKS[2]] = value;
                }
            }
            Payload::Source(source) => {
                let molecules = head.constituents * head.wavelengths.len();
                for scattering in &mut source.scattering[molecules..] {
                    *scattering *= 0.05;
                }
            }
            _ => {}
        }
    }
    chunks
}

/// The first component of the moments is light from everywhere, the others lean it.
fn source_basis(head: &Head, swing: f32) -> SourceBasis {
    let moments = 4 + harmonics(SOURCE_DEGREE, SOURCE_ORDERS);
    let even = |i: usize| match i {
        0..3 => 0.5,
        3 => 0.0,
        4 => (4.0 * std::f32::consts::PI).sqrt(),
        _ => 0.0,
    };
    let moment = (0..moments * SOURCE_RANKS[2]).map(|i| {
        let (row, component) = (i / SOURCE_RANKS[2], i % SOURCE_RANKS[2]);
        match component {
            0 => even(row),
            _ => swing * (0.3 + 1.7 * row as f32 + 2.1 * component as f32).sin(),
        }
    });
    let gentle = |rows: usize, rank: usize, phase: f32| -> Vec<f32> {
        let wave = wave(rows, rank, 0.4, phase);
        wave.iter().map(|v| 0.2 * v + 0.8).collect()
    };
    SourceBasis {
        degree: SOURCE_DEGREE,
        orders: SOURCE_ORDERS,
        ranks: SOURCE_RANKS,
        altitude: SOURCE_ALTITUDES.to_vec(),
        sun: SOURCE_SUNS.to_vec(),
        factors: [
            gentle(SOURCE_ALTITUDES.len(), SOURCE_RANKS[0], 0.1),
            gentle(SOURCE_SUNS.len(), SOURCE_RANKS[1], 0.7),
            moment.collect(),
            gentle(2 * head.wavelengths.len(), SOURCE_RANKS[3], 1.9),
        ],
    }
}

/// Molecules, and two kinds of particles that mostly belong to the second constituent.
fn source(head: &Head, v: usize) -> SourceCore {
    let (nw, nk) = (head.wavelengths.len(), head.constituents);
    let extinction = |k: usize, w: usize| head.extinction[(v * nk + k) * nw + w] as f32;
    let shares = [[0.95, 0.0], [0.02, 0.5], [0.0, 0.4]];
    let scattering = shares.iter().flat_map(|row| {
        let constituents = row.iter().enumerate();
        constituents.flat_map(|(k, share)| (0..nw).map(move |w| share * extinction(k, w)))
    });
    let first = [0.03, 0.7, -0.2];
    let parameter = first
        .iter()
        .flat_map(|p| (0..nw).map(move |w| p + 0.01 * (v + w) as f32));
    let level = (0..SOURCE_FIELDS * SOURCE_SUNS.len() * nw).map(|i| {
        let (field, sun, w) = (
            i / nw / SOURCE_SUNS.len(),
            i / nw % SOURCE_SUNS.len(),
            i % nw,
        );
        let day = SOURCE_SUNS[sun] as f32;
        let tint = 0.1 * w as f32 + 0.15 * v as f32;
        4.0 * (6.0 * day).tanh() - 6.0 - tint - field as f32 * (0.5 + 0.4 * v as f32)
    });
    let core = (0..SOURCE_RANKS.iter().product()).map(|i: usize| {
        let component = i / SOURCE_RANKS[3] % SOURCE_RANKS[2];
        [0.2, 0.03, 0.02][component] * (1.2 + (0.9 * i as f32 + 0.4 * v as f32).sin())
    });
    SourceCore {
        ranks: SOURCE_RANKS,
        phase: vec![
            PhaseFunction::Rayleigh,
            PhaseFunction::HenyeyGreenstein,
            PhaseFunction::HenyeyGreenstein,
        ],
        parameter: parameter.collect(),
        scattering: scattering.collect(),
        level: level.collect(),
        core: core.collect(),
    }
}

/// One altitude, two visibilities, short axes, and no radiance: for exhaustive damage.
pub fn tiny_bytes() -> Vec<u8> {
    let mut head = super::head_with(&[0.0], &[40e3, 60e3], 2);
    head.solar_step = 460.0;
    head.solar_irradiance = vec![1.0, 1.5];
    encode(&head, &chunks(&head, 0.2)).expect("a valid model")
}

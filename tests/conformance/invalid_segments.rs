//! Files whose transmittance or source breaks a rule.

use welkin::format::{Entry, Kind, Payload, encode, parse};

use crate::common;
use crate::files::small;
use crate::invalid::{Case, forged};

pub fn all() -> Vec<Case> {
    let head = small(&[0.0], &[40e3, 60e3]);
    let good = encode(&head, &common::aerial::chunks(&head, 0.2)).expect("a valid model");
    let directory = parse(&good).expect("a valid file").directory;
    let case = |name, shows, need, bytes| Case {
        name,
        shows,
        class: "value",
        needs: vec![need],
        bytes,
    };
    let forge = |name, shows, need, kind: Kind, at: usize, change: &[u8]| {
        // The second of the sources.
        let entry = directory.iter().rfind(|e| e.kind == kind);
        let place = entry.expect("a chunk of the kind").offset + at;
        case(name, shows, need, forged(&good, place, change))
    };
    let air = |name, shows, at, change: &[u8]| {
        forge(
            name,
            shows,
            "transmittance",
            Kind::Transmittance,
            at,
            change,
        )
    };
    let basis = |name, shows, at, change: &[u8]| {
        forge(
            name,
            shows,
            "aerial-perspective",
            Kind::SourceBasis,
            at,
            change,
        )
    };
    let source = |name, shows, at, change: &[u8]| {
        forge(name, shows, "aerial-perspective", Kind::Source, at, change)
    };
    let fewer_suns = {
        let mut chunks = common::aerial::chunks(&head, 0.2);
        chunks.retain(|chunk| !matches!(chunk.payload, Payload::Source(_)));
        for chunk in &mut chunks {
            if let Payload::SourceBasis(basis) = &mut chunk.payload {
                basis.sun.pop();
                basis.factors[1].truncate(basis.sun.len() * basis.ranks[1]);
            }
        }
        let other = encode(&head, &chunks).expect("a valid model");
        let contents = parse(&other).expect("a valid file");
        let basis = |e: &&Entry| e.kind == Kind::SourceBasis;
        let entry = contents.directory.iter().find(basis).expect("a basis");
        let index = directory.iter().position(|e| basis(&e));
        let stored = &other[entry.offset..entry.offset + entry.length];
        common::with_chunk(&good, index.expect("a basis"), stored)
    };
    // In a source: the counts, then three phase functions, then their parameters and the scattering.
    let (phases, parameters) = (32, 32 + 4 * 3);
    let scattering = parameters + 4 * 3 * head.wavelengths.len();
    let level = scattering + 4 * 3 * head.constituents * head.wavelengths.len();
    let of = |kind: Kind| {
        directory
            .iter()
            .rfind(|e| e.kind == kind)
            .expect("a chunk of the kind")
    };
    let length = of(Kind::Source).length;
    let count = |at: usize| {
        let place = of(Kind::SourceBasis).offset + at;
        u32::from_le_bytes(good[place..place + 4].try_into().expect("four bytes")) as usize
    };
    let (nodes, altitudes, suns) = (32, count(0), count(4));
    let sun_step = {
        let first = of(Kind::SourceBasis).offset + nodes + 8 * altitudes;
        let first = f64::from_le_bytes(good[first..first + 8].try_into().expect("eight bytes"));
        (first + 5e-10).to_le_bytes()
    };
    vec![
        air(
            "air-layers",
            "a transmittance without layers",
            0,
            &0u32.to_le_bytes(),
        ),
        air(
            "air-length",
            "more layers than the payload has",
            0,
            &4u32.to_le_bytes(),
        ),
        air(
            "air-edges",
            "an edge that does not rise",
            16,
            &0f64.to_le_bytes(),
        ),
        air(
            "air-top",
            "the last edge is not the top",
            32,
            &9e4f64.to_le_bytes(),
        ),
        air(
            "air-density",
            "a negative density",
            40,
            &(-1f32).to_le_bytes(),
        ),
        basis(
            "source-degree",
            "harmonics of degree 25",
            8,
            &25u32.to_le_bytes(),
        ),
        basis(
            "source-orders",
            "orders above the degree",
            12,
            &4u32.to_le_bytes(),
        ),
        basis("source-rank", "a rank of 65", 16, &65u32.to_le_bytes()),
        basis(
            "source-altitudes",
            "altitudes that do not rise",
            nodes + 8,
            &0f64.to_le_bytes(),
        ),
        basis(
            "source-sine",
            "a sine of the sun's elevation below -1",
            nodes + 40,
            &(-1.5f64).to_le_bytes(),
        ),
        source(
            "source-phase",
            "a species without phase function",
            phases,
            &0u32.to_le_bytes(),
        ),
        source(
            "source-species",
            "species unlike those of the other source",
            phases,
            &2u32.to_le_bytes(),
        ),
        source(
            "source-parameter",
            "a depolarisation above 1",
            parameters,
            &1.5f32.to_le_bytes(),
        ),
        source(
            "source-scattering",
            "negative scattering",
            scattering,
            &(-1e-9f32).to_le_bytes(),
        ),
        source(
            "source-scale",
            "a core of infinite scale",
            24,
            &f32::INFINITY.to_le_bytes(),
        ),
        air("air-layers-large", "1025 layers", 0, &1025u32.to_le_bytes()),
        air(
            "air-ground",
            "the first edge is not the ground",
            8,
            &1f64.to_le_bytes(),
        ),
        air("air-step", "a layer of 0.9 mm", 16, &9e-4f64.to_le_bytes()),
        air(
            "air-step-rounded",
            "a layer that is thinner than 1 mm by 5e-10 of it",
            16,
            &(1e-3 * (1f64 - 5e-10)).to_le_bytes(),
        ),
        air(
            "air-edge-nan",
            "an edge that is not a number",
            16,
            &f64::NAN.to_le_bytes(),
        ),
        air(
            "air-density-large",
            "a density above 1e6",
            40,
            &2e6f32.to_le_bytes(),
        ),
        air(
            "air-density-nan",
            "a density that is not a number",
            40,
            &f32::NAN.to_le_bytes(),
        ),
        basis(
            "source-basis-altitudes",
            "one altitude",
            0,
            &1u32.to_le_bytes(),
        ),
        basis(
            "source-basis-altitudes-large",
            "257 altitudes",
            0,
            &257u32.to_le_bytes(),
        ),
        basis("source-basis-suns", "one sun", 4, &1u32.to_le_bytes()),
        basis("source-rank-zero", "a rank of 0", 16, &0u32.to_le_bytes()),
        basis(
            "source-moments",
            "33 components of the moments",
            24,
            &33u32.to_le_bytes(),
        ),
        basis(
            "source-altitude-step",
            "altitudes 0.9 mm apart",
            nodes + 8,
            &9e-4f64.to_le_bytes(),
        ),
        basis(
            "source-altitude-negative",
            "an altitude below the ground",
            nodes,
            &(-1f64).to_le_bytes(),
        ),
        basis(
            "source-sun-step",
            "suns closer than 1e-9",
            nodes + 8 * altitudes + 8,
            &sun_step,
        ),
        basis(
            "source-basis-nan",
            "NaN in a factor",
            nodes + 8 * (altitudes + suns),
            &f32::NAN.to_le_bytes(),
        ),
        source("source-species-none", "no species", 0, &0u32.to_le_bytes()),
        source(
            "source-species-large",
            "17 species",
            0,
            &17u32.to_le_bytes(),
        ),
        source(
            "source-ranks",
            "a rank unlike that of the basis",
            8,
            &1u32.to_le_bytes(),
        ),
        source(
            "source-phase-unknown",
            "a species with phase function 3",
            phases,
            &3u32.to_le_bytes(),
        ),
        source(
            "source-asymmetry",
            "an asymmetry of 1",
            parameters + 4 * head.wavelengths.len(),
            &1f32.to_le_bytes(),
        ),
        source(
            "source-parameter-nan",
            "a parameter that is not a number",
            parameters,
            &f32::NAN.to_le_bytes(),
        ),
        source(
            "source-scattering-large",
            "scattering above 1e6",
            scattering,
            &2e6f32.to_le_bytes(),
        ),
        source(
            "source-level-infinite",
            "an infinite level",
            level,
            &f32::INFINITY.to_le_bytes(),
        ),
        source(
            "source-core-nan",
            "NaN in the core",
            length - 2,
            &0x7e00u16.to_le_bytes(),
        ),
        case(
            "source-suns",
            "a source with more suns than its basis",
            "aerial-perspective",
            fewer_suns,
        ),
    ]
}

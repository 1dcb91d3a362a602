//! The valid files.

use welkin::format::{
    Chunk, ENCODING_ZSTD, Head, MAX_TAPS, Payload, PhaseFunction, Spectrum, encode, parse, recode,
};

use crate::axis;
use crate::common;
use crate::common::spectrum::with_spectrum;
use crate::frames::{Start, restarted, with_checksum};

pub struct Case {
    pub name: String,
    /// What the file is there for.
    pub shows: &'static str,
    /// Features that a reader may lack.
    pub needs: Vec<&'static str>,
    pub bytes: Vec<u8>,
    /// The same model with raw chunks, for the oracle.
    pub raw: Vec<u8>,
    /// A few queries are enough.
    pub brief: bool,
}

pub fn valid() -> Vec<Case> {
    let raw = model(&small(
        &[0.0, 120.0, 1000.0, 2000.0],
        &[20e3, 59.4e3, 131.8e3],
    ));
    let small_model = model(&small(&[0.0], &[20e3]));
    let mut cases = vec![
        case(
            "raw",
            "four altitudes, three visibilities, every interpolation",
            raw.clone(),
        ),
        case(
            "minimal",
            "one altitude, one visibility, one interval per axis",
            minimal(),
        ),
        case(
            "pairs",
            "two altitudes, two visibilities: linear between chunks",
            pairs(),
        ),
        case(
            "five",
            "five nodes per axis: inner and outer stencils",
            five(),
        ),
        case(
            "wide",
            "21 wavelengths, 16 fields of every kind, padding of every table",
            wide(),
        ),
        case(
            "sparse",
            "chunks are missing: queries that need them are errors",
            sparse(),
        ),
        case("no-chunks", "a file may have no chunks at all", head_only()),
        case(
            "unknown-kind",
            "a chunk of an unknown kind is skipped, whatever its entry says",
            unknown(&raw),
        ),
        case(
            "unknown-kinds",
            "chunks of unknown kinds: first, last, twice, empty, with wrong checksums",
            unknown_kinds(&small_model),
        ),
        case("minor", "a newer minor version is accepted", minor(&raw)),
        case(
            "metadata",
            "metadata in UTF-8, not a multiple of eight bytes",
            metadata(),
        ),
        case(
            "ranks",
            "a basis of rank 20 with chunks of the ranks 20, 17 and 3",
            ranks(),
        ),
        case(
            "no-basis",
            "without a radiance basis all radiance is missing",
            without_basis(),
        ),
        case("negative", "sums below zero become zero", negative()),
    ];
    cases.push(Case {
        needs: vec!["polarisation"],
        ..case(
            "polarised",
            "Stokes vectors in the vertical frame",
            polarised(0.02),
        )
    });
    cases.push(Case {
        needs: vec!["polarisation"],
        ..case(
            "overpolarised",
            "Q and U are scaled where they exceed L",
            polarised(1.0),
        )
    });
    cases.push(Case {
        needs: vec!["polarisation"],
        ..case(
            "absorbers",
            "a constituent that absorbs and does not scatter",
            absorbers(),
        )
    });
    cases.push(case(
        "estimate",
        "fields relative to estimates: the shadow of the Earth, the horizon, rays that dip",
        estimated(&[0.0, 900.0, 6000.0], &[25e3, 75e3]),
    ));
    cases.push(Case {
        needs: vec!["polarisation"],
        ..case(
            "estimate-polarised",
            "multiply scattered Q and U relative to the estimate of diffuse light",
            estimated(&[0.0, 9000.0], &[40e3]),
        )
    });
    cases.push(Case {
        needs: vec!["transmittance"],
        ..case(
            "air",
            "transmittance along segments that rise, dip, and leave the air",
            air(),
        )
    });
    cases.push(Case {
        needs: vec!["transmittance"],
        ..case("air-thin", "a layer of one millimetre", thin_air())
    });
    for (name, shows, need, file) in spectra() {
        cases.push(Case {
            needs: need.into_iter().collect(),
            ..case(name, shows, file)
        });
    }
    for (name, shows, file) in aerial() {
        let needs = vec!["aerial-perspective"];
        cases.push(Case {
            needs,
            ..case(name, shows, file)
        });
    }
    for (name, shows, file) in compressed_otherwise(&raw) {
        cases.push(Case {
            needs: vec!["zstd"],
            raw: raw.clone(),
            brief: true,
            ..case(name, shows, file)
        });
    }
    cases.extend(axis::valid());
    cases.push(Case {
        needs: vec!["zstd"],
        raw: raw.clone(),
        ..case(
            "zstd",
            "the chunks of raw.welkin, compressed",
            compressed(&raw),
        )
    });
    cases
}

fn case(name: &str, shows: &'static str, bytes: Vec<u8>) -> Case {
    Case {
        name: name.to_owned(),
        shows,
        needs: Vec::new(),
        raw: bytes.clone(),
        bytes,
        brief: false,
    }
}

/// A head with short axes, so that files stay small.
pub fn small(altitudes: &[f64], visibilities: &[f64]) -> Head {
    small_with(altitudes, visibilities, 4)
}

/// The same with five nodes, and a sun that shines at all cells of the synthetic spectrum.
pub fn small_spectral(altitudes: &[f64], visibilities: &[f64]) -> Head {
    let mut head = small_with(altitudes, visibilities, 5);
    head.solar_irradiance.push(1.3);
    head
}

fn small_with(altitudes: &[f64], visibilities: &[f64], wavelengths: usize) -> Head {
    let mut head = common::head_with(altitudes, visibilities, wavelengths);
    head.up.intervals = 3;
    head.down.intervals = 2;
    head.phi_intervals = 2;
    head.elevation.intervals = 3;
    head.solar_start = 310.0;
    head.solar_step = 50.0;
    head.solar_irradiance = (0..10).map(|i| 1.0 + 0.1 * (i % 4) as f32).collect();
    head
}

fn model(head: &Head) -> Vec<u8> {
    encode(head, &common::chunks(head)).expect("a valid model")
}

pub fn minimal() -> Vec<u8> {
    let mut head = common::head_with(&[0.0], &[50e3], 2);
    head.up.intervals = 1;
    head.down.intervals = 1;
    head.phi_intervals = 1;
    head.elevation.intervals = 1;
    head.solar_start = 320.0;
    head.solar_step = 440.0;
    head.solar_irradiance = vec![1.0, 1.5];
    head.fields.truncate(1);
    head.metadata = "{}".to_owned();
    model(&head)
}

fn pairs() -> Vec<u8> {
    model(&small(&[100.0, 900.0], &[25e3, 75e3]))
}

fn five() -> Vec<u8> {
    let mut head = small(
        &[0.0, 50.0, 400.0, 1500.0, 4000.0],
        &[15e3, 30e3, 45e3, 80e3, 200e3],
    );
    head.fields.truncate(2);
    model(&head)
}

fn wide() -> Vec<u8> {
    let mut head = common::head_with(&[500.0], &[40e3], 21);
    head.up.intervals = 2;
    head.down.intervals = 1;
    head.phi_intervals = 3;
    head.elevation.intervals = 1;
    head.fields = (0..16)
        .map(|f| {
            let mut field = head.fields[f % 5].clone();
            field.ground = f % 3 == 0;
            for p in &mut field.parameter {
                *p = match field.phase {
                    PhaseFunction::Rayleigh => 0.02 * f as f64,
                    PhaseFunction::HenyeyGreenstein => 0.9 - 0.11 * f as f64,
                    _ => 0.0,
                };
            }
            field
        })
        .collect();
    model(&head)
}

fn sparse() -> Vec<u8> {
    let head = small(&[0.0, 500.0], &[20e3, 80e3]);
    let mut chunks = common::chunks(&head);
    chunks.retain(|chunk| chunk.altitude != Some(1) || chunk.visibility != Some(1));
    encode(&head, &chunks).expect("a valid model")
}

fn head_only() -> Vec<u8> {
    encode(&small(&[0.0], &[20e3]), &[]).expect("a valid model")
}

/// Chunks that use the first components of a larger basis.
fn ranks() -> Vec<u8> {
    let head = small(&[0.0], &[20e3, 40e3, 80e3]);
    let mut chunks = common::chunks(&head);
    for chunk in &mut chunks {
        let rank = [20, 17, 3][chunk.visibility.unwrap_or(0)];
        match &mut chunk.payload {
            Payload::RadianceBasis(basis) => {
                basis.phi = widened(&basis.phi, common::RANK, rank);
                let channels = basis.channel.len() / common::RANK;
                basis.channel = basis.channel.repeat(rank / common::RANK);
                assert_eq!(basis.channel.len(), rank * channels);
                basis.rank = rank;
            }
            Payload::Radiance(factors) => {
                for matrix in [
                    &mut factors.scale,
                    &mut factors.alpha_up,
                    &mut factors.alpha_down,
                    &mut factors.elevation,
                ] {
                    *matrix = widened(matrix, common::RANK, rank);
                }
                factors.rank = rank;
            }
            _ => {}
        }
    }
    encode(&head, &chunks).expect("a valid model")
}

/// Each row of a matrix cut or repeated to another width.
fn widened(matrix: &[f32], from: usize, to: usize) -> Vec<f32> {
    let rows = matrix.chunks_exact(from);
    rows.flat_map(|row| row.iter().cycle().take(to))
        .copied()
        .collect()
}

fn without_basis() -> Vec<u8> {
    let head = small(&[0.0], &[20e3]);
    let chunks = common::chunks(&head);
    encode(&head, &chunks[1..]).expect("a valid model")
}

/// The last chunk of a file twice, the copy with a kind and an entry that no reader knows.
fn unknown(raw: &[u8]) -> Vec<u8> {
    common::with_entry(raw, |entry| {
        entry[0..4].copy_from_slice(&0x8000_0001u32.to_le_bytes());
        entry[4..8].copy_from_slice(&[0x12, 0x34, 0x56, 0x78]);
        entry[24..36].fill(0xee);
        entry[40..64].fill(0xff);
    })
}

fn minor(raw: &[u8]) -> Vec<u8> {
    let mut bytes = raw.to_vec();
    bytes[10..12].copy_from_slice(&7u16.to_le_bytes());
    common::seal(&mut bytes, raw);
    bytes
}

fn metadata() -> Vec<u8> {
    let mut head = small(&[0.0], &[20e3]);
    head.metadata = r#"{"title":"Himmel über Zürich, 空"}"#.to_owned();
    assert_ne!(head.metadata.len() % 8, 0);
    model(&head)
}

fn negative() -> Vec<u8> {
    let head = small(&[0.0], &[20e3]);
    let mut chunks = common::chunks(&head);
    common::negate_components(&mut chunks);
    encode(&head, &chunks).expect("a valid model")
}

/// Of two constituents the second absorbs.
fn absorbers() -> Vec<u8> {
    let head = Head {
        absorbers: 0b10,
        ..small(&[0.0, 900.0], &[25e3, 40e3, 75e3])
    };
    encode(&head, &common::polarised_chunks(&head, 0.02)).expect("a valid model")
}

fn estimated(altitudes: &[f64], visibilities: &[f64]) -> Vec<u8> {
    let head = small(altitudes, visibilities);
    let chunks = common::polarised_chunks(&head, 0.1);
    let (head, chunks) = common::estimated(head, chunks);
    encode(&head, &chunks).expect("a valid model")
}

fn polarised(strength: f32) -> Vec<u8> {
    let head = small(&[0.0, 900.0], &[25e3, 40e3, 75e3]);
    encode(&head, &common::polarised_chunks(&head, strength)).expect("a valid model")
}

/// The air alone: without radiance.
fn air() -> Vec<u8> {
    let head = small(&[0.0, 900.0], &[25e3, 75e3]);
    let densities = Chunk {
        altitude: None,
        visibility: None,
        error_median: 0.0,
        error_p99: 0.0,
        payload: Payload::Transmittance(common::densities()),
    };
    encode(&head, &[densities]).expect("a valid model")
}

/// The air and what it scatters: without radiance.
fn aerial() -> [(&'static str, &'static str, Vec<u8>); 4] {
    let head = small(&[0.0, 900.0], &[25e3, 40e3, 75e3]);
    let polarised = common::aerial::polarised_chunks(&head);
    let file = |swing: f32, visibilities: &[usize]| {
        let mut chunks = common::aerial::chunks(&head, swing);
        chunks.retain(|c| c.visibility.is_none_or(|v| visibilities.contains(&v)));
        encode(&head, &chunks).expect("a valid model")
    };
    [
        (
            "aerial-perspective",
            "light that segments scatter, by day and in twilight",
            file(0.2, &[0, 1, 2]),
        ),
        (
            "aerial-perspective-negative",
            "the source is negative in some directions",
            file(6.0, &[0, 1, 2]),
        ),
        (
            "aerial-perspective-polarised",
            "molecules scatter most of the light, and polarise it",
            encode(&head, &polarised).expect("a valid model"),
        ),
        (
            "aerial-perspective-sparse",
            "the source of one visibility is missing",
            file(0.2, &[0, 2]),
        ),
    ]
}

type Spectral = (&'static str, &'static str, Option<&'static str>, Vec<u8>);

/// What lies between the nodes.
fn spectra() -> [Spectral; 6] {
    let head = small_spectral(&[0.0, 900.0], &[25e3, 40e3, 75e3]);
    let file = |chunks| encode(&head, &with_spectrum(&head, chunks)).expect("a valid model");
    let mut negative = common::chunks(&head);
    common::negate_components(&mut negative);
    let mut odd = common::chunks(&head);
    let payload = Payload::Spectrum(odd_spectrum(&head));
    odd.push(Chunk::new(None, None, payload));
    let densities = Payload::Transmittance(common::densities());
    let densities = Chunk::new(None, None, densities);
    [
        (
            "spectrum",
            "cells of three taps between five nodes, and beyond them",
            None,
            file(common::chunks(&head)),
        ),
        (
            "spectrum-taps",
            "taps that are not used, twice the same or all one, weights that do not add up to 1",
            None,
            encode(&head, &odd).expect("a valid model"),
        ),
        (
            "spectrum-dark",
            "nodes without light among those of a cell",
            None,
            file(negative),
        ),
        (
            "spectrum-polarised",
            "Stokes vectors of cells",
            Some("polarisation"),
            file(common::polarised_chunks(&head, 0.02)),
        ),
        (
            "spectrum-air",
            "transmittance of cells whose bands have two terms",
            Some("transmittance"),
            file(vec![densities]),
        ),
        (
            "spectrum-aerial-perspective",
            "light that segments scatter at cells, and its polarisation",
            Some("aerial-perspective"),
            file(common::aerial::polarised_chunks(&head)),
        ),
    ]
}

/// Two cells of 16 taps and one term.
fn odd_spectrum(head: &Head) -> Spectrum {
    let (cells, taps) = (2, MAX_TAPS);
    let node = |c: usize, j: usize| [(j / 2) % 5, 3][c] as u32;
    let weight = |c: usize, j: usize| match (c, j) {
        (0, 0..6) => 0.2,
        (0, 6..10) => -0.05,
        (1, 4) => 1.1,
        _ => 0.0,
    };
    Spectrum {
        taps,
        wavelength: vec![400.0, 700.0],
        first_term: vec![0, 1, 2],
        tap_node: (0..cells * taps)
            .map(|i| node(i / taps, i % taps))
            .collect(),
        tap_weight: (0..cells * taps)
            .map(|i| weight(i / taps, i % taps))
            .collect(),
        extinction: vec![1e-5; head.visibilities.len() * head.constituents * cells],
        term_weight: vec![1.0; cells],
        term_extinction: vec![0.0; cells * head.constituents],
        example: Vec::new(),
    }
}

fn compressed(raw: &[u8]) -> Vec<u8> {
    recode(raw, ENCODING_ZSTD).expect("a valid model")
}

/// The same chunks in frames with other headers.
fn compressed_otherwise(raw: &[u8]) -> [(&'static str, &'static str, Vec<u8>); 3] {
    let other = |change: &dyn Fn(&[u8], usize) -> Vec<u8>| {
        let mut file = compressed(raw);
        let contents = parse(&file).expect("a valid file");
        for (i, entry) in contents.directory.iter().enumerate() {
            if entry.encoding == ENCODING_ZSTD {
                // Frames before it may have changed their lengths.
                let place = &parse(&file).expect("a valid file").directory[i];
                let frame = file[place.offset..place.offset + place.length].to_vec();
                file = common::with_chunk(&file, i, &change(&frame, entry.raw_length));
            }
        }
        file
    };
    let started = |start: Start| other(&move |frame, _| restarted(frame, start));
    let dictionary = started(Start {
        dictionary: &[0; 4],
        ..Start::default()
    });
    let window = started(Start {
        window: Some(0x88),
        dictionary: &[0],
        ..Start::default()
    });
    let checksum = other(&|frame, length| {
        with_checksum(&zstd::bulk::decompress(frame, length).expect("a frame"))
    });
    [
        (
            "zstd-no-dictionary",
            "frames with a Dictionary_ID of 0",
            dictionary,
        ),
        ("zstd-widest", "frames with a window of 2^27 bytes", window),
        (
            "zstd-checksums",
            "frames with checksums of their content",
            checksum,
        ),
    ]
}

/// Chunks that no reader knows, among those of `raw`, with entries of which all but the place is absurd.
fn unknown_kinds(raw: &[u8]) -> Vec<u8> {
    let contents = parse(raw).expect("a valid file");
    let directory = contents.head_length - 64 * contents.directory.len();
    let mut chunks: Vec<([u8; 64], &[u8])> = contents
        .directory
        .iter()
        .zip(raw[directory..].chunks_exact(64))
        .map(|(e, entry)| {
            let stored = &raw[e.offset..e.offset + e.length];
            (entry.try_into().expect("64 bytes"), stored)
        })
        .collect();
    let unknown = |kind: u32| {
        let mut entry = [0xee; 64];
        entry[..4].copy_from_slice(&kind.to_le_bytes());
        entry
    };
    chunks.insert(0, (unknown(0), &[]));
    chunks.insert(2, (unknown(77), b"twice"));
    chunks.insert(3, (unknown(77), b"twice"));
    chunks.push((unknown(u32::MAX), &[]));
    let mut bytes = raw[..directory].to_vec();
    bytes.resize(directory + 64 * chunks.len(), 0);
    for (i, (mut entry, stored)) in chunks.into_iter().enumerate() {
        bytes.resize(bytes.len().next_multiple_of(64), 0);
        entry[8..16].copy_from_slice(&(bytes.len() as u64).to_le_bytes());
        entry[16..24].copy_from_slice(&(stored.len() as u64).to_le_bytes());
        bytes[directory + 64 * i..][..64].copy_from_slice(&entry);
        bytes.extend(stored);
    }
    let count = contents.directory.len() + 4;
    let head_length = directory + 64 * count;
    let length = bytes.len() as u64;
    bytes[16..24].copy_from_slice(&length.to_le_bytes());
    bytes[24..32].copy_from_slice(&(head_length as u64).to_le_bytes());
    bytes[36..40].copy_from_slice(&(count as u32).to_le_bytes());
    bytes[32..36].fill(0);
    let crc = crc32fast::hash(&bytes[..head_length]);
    bytes[32..36].copy_from_slice(&crc.to_le_bytes());
    bytes
}

/// Air whose lowest layer is as thin as layers may be.
fn thin_air() -> Vec<u8> {
    let head = small(&[0.0, 900.0], &[25e3, 75e3]);
    let mut table = common::densities();
    table.edges.insert(1, 1e-3);
    let ground = [1.0, 1.0, 1.0, 1.0];
    table.density.splice(0..0, ground);
    let densities = Chunk {
        altitude: None,
        visibility: None,
        error_median: 0.0,
        error_p99: 0.0,
        payload: Payload::Transmittance(table),
    };
    encode(&head, &[densities]).expect("a valid model")
}

//! Directory entries, payloads and frames that break a rule of sections 5 and 6.

use welkin::format::{Chunk, ENCODING_ZSTD, Kind, Payload, encode, parse, recode};

use crate::common;
use crate::files::{minimal, small};
use crate::frames::{Start, restarted, with_checksum};
use crate::invalid::{Case, forged};

pub fn all() -> Vec<Case> {
    [
        entries(),
        payloads(),
        polarisation(),
        lengths(),
        frames(),
        tables(),
    ]
    .concat()
}

fn case(name: &'static str, shows: &'static str, needs: &[&'static str], bytes: Vec<u8>) -> Case {
    Case {
        name,
        shows,
        class: "value",
        needs: needs.to_vec(),
        bytes,
    }
}

fn entry_at(file: &[u8], index: usize) -> usize {
    let contents = parse(file).expect("a valid file");
    contents.head_length - 64 * (contents.directory.len() - index)
}

/// The index and offset of the last chunk of a kind.
fn last(file: &[u8], kind: Kind) -> (usize, usize) {
    let directory = parse(file).expect("a valid file").directory;
    let index = directory
        .iter()
        .rposition(|e| e.kind == kind)
        .expect("a chunk of the kind");
    (index, directory[index].offset)
}

fn good() -> Vec<u8> {
    let head = small(&[0.0], &[50e3]);
    encode(&head, &common::chunks(&head)).expect("a valid model")
}

fn entries() -> Vec<Case> {
    let good = good();
    let [basis, column, radiance] = [0, 1, 2].map(|i| entry_at(&good, i));
    let forge = |name, shows, at, change: &[u8]| case(name, shows, &[], forged(&good, at, change));
    let offset = parse(&good).expect("a valid file").directory[2].offset as u64;
    let encoding = forge(
        "entry-encoding-reserved",
        "an encoding with the highest bit set",
        column + 32,
        &(1u32 << 31).to_le_bytes(),
    );
    vec![
        Case {
            class: "encoding",
            ..encoding
        },
        forge(
            "entry-overlap",
            "a chunk that overlaps its predecessor",
            radiance + 8,
            &(offset - 64).to_le_bytes(),
        ),
        forge(
            "entry-none",
            "radiance without an altitude",
            radiance + 4,
            &[0xff, 0xff],
        ),
        forge(
            "entry-none-visibility",
            "radiance without a visibility",
            radiance + 6,
            &[0xff, 0xff],
        ),
        forge(
            "entry-visibility-large",
            "an index beyond the visibility axis",
            radiance + 6,
            &[1, 0],
        ),
        forge(
            "entry-basis-altitude",
            "a basis with an altitude",
            basis + 4,
            &[0, 0],
        ),
        forge(
            "entry-rank-large",
            "a rank of 4097",
            basis + 40,
            &4097u32.to_le_bytes(),
        ),
        forge(
            "entry-rank-column",
            "a column with a rank",
            column + 40,
            &1u32.to_le_bytes(),
        ),
        forge(
            "entry-tier-large",
            "a tier of 2^31",
            radiance + 44,
            &(1u32 << 31).to_le_bytes(),
        ),
        forge(
            "entry-error-nan",
            "an error that is not a number",
            radiance + 48,
            &f32::NAN.to_le_bytes(),
        ),
        forge(
            "entry-error-infinite",
            "an infinite error",
            radiance + 52,
            &f32::INFINITY.to_le_bytes(),
        ),
    ]
}

/// Numbers that are not finite, also where they are padding.
fn payloads() -> Vec<Case> {
    let good = good();
    let [basis, radiance] = [Kind::RadianceBasis, Kind::Radiance].map(|kind| last(&good, kind).1);
    let end = good.len();
    let forge = |name, shows, at, change: &[u8]| case(name, shows, &[], forged(&good, at, change));
    let half = |name, shows, at, bits: u16| forge(name, shows, at, &bits.to_le_bytes());
    vec![
        half("basis-nan", "NaN in the azimuth factors", basis, 0x7e00),
        half("level-infinite", "an infinite level", end - 2, 0xfc00),
        forge(
            "padding-nan",
            "NaN beside the rank",
            radiance + 4 * common::RANK,
            &f32::NAN.to_le_bytes(),
        ),
        half(
            "padding-infinite",
            "infinity beside the rank",
            basis + 2 * common::RANK,
            0x7c00,
        ),
    ]
}

fn polarisation() -> Vec<Case> {
    let head = small(&[0.0], &[50e3]);
    let good = encode(&head, &common::polarised_chunks(&head, 0.02)).expect("a valid model");
    let (basis, factors) = (
        last(&good, Kind::PolarisationBasis),
        last(&good, Kind::Polarisation),
    );
    let forge = |name, shows, at, change: &[u8]| {
        case(name, shows, &["polarisation"], forged(&good, at, change))
    };
    vec![
        forge(
            "polarisation-nan",
            "NaN in the factors of the polarisation",
            factors.1,
            &f32::NAN.to_le_bytes(),
        ),
        forge(
            "polarisation-basis-nan",
            "NaN in the basis of the polarisation",
            basis.1,
            &0x7e00u16.to_le_bytes(),
        ),
        case(
            "polarisation-rank",
            "polarisation of a larger rank than its basis",
            &[],
            forged(&good, entry_at(&good, basis.0) + 40, &4u32.to_le_bytes()),
        ),
    ]
}

/// Payloads that tell their length themselves.
fn lengths() -> Vec<Case> {
    let head = small(&[0.0], &[40e3, 60e3]);
    let good = encode(&head, &common::aerial::chunks(&head, 0.2)).expect("a valid model");
    let stored = |kind, change: &dyn Fn(&[u8]) -> Vec<u8>| {
        let index = last(&good, kind).0;
        let entry = &parse(&good).expect("a valid file").directory[index];
        let payload = &good[entry.offset..entry.offset + entry.length];
        common::with_chunk(&good, index, &change(payload))
    };
    let longer = |payload: &[u8]| [payload, &[0; 4]].concat();
    let shorter = |payload: &[u8]| payload[..payload.len() - 2].to_vec();
    let source = entry_at(&good, last(&good, Kind::Source).0);
    // Encoding, and raw_length before it.
    let bomb = |encoding: u32| {
        let mut change = (1u64 << 40).to_le_bytes().to_vec();
        change.extend(encoding.to_le_bytes());
        forged(&good, source + 24, &change)
    };
    vec![
        case(
            "air-empty",
            "a transmittance of no bytes",
            &["transmittance"],
            stored(Kind::Transmittance, &|_| Vec::new()),
        ),
        case(
            "air-short",
            "a transmittance of four bytes",
            &["transmittance"],
            stored(Kind::Transmittance, &|p| p[..4].to_vec()),
        ),
        case(
            "air-long",
            "bytes after the densities",
            &["transmittance"],
            stored(Kind::Transmittance, &longer),
        ),
        case(
            "source-short",
            "half a number of the core is missing",
            &["aerial-perspective"],
            stored(Kind::Source, &shorter),
        ),
        case(
            "source-long",
            "bytes after the core",
            &["aerial-perspective"],
            stored(Kind::Source, &longer),
        ),
        case(
            "source-basis-long",
            "bytes after the factors",
            &["aerial-perspective"],
            stored(Kind::SourceBasis, &longer),
        ),
        case(
            "source-bomb",
            "a raw source that declares 2^40 bytes",
            &[],
            bomb(0),
        ),
        case(
            "source-bomb-zstd",
            "a compressed source that declares 2^40 bytes",
            &[],
            bomb(ENCODING_ZSTD),
        ),
    ]
}

fn frames() -> Vec<Case> {
    let packed = recode(&minimal(), ENCODING_ZSTD).expect("a valid model");
    let contents = parse(&packed).expect("a valid file");
    let packed_chunk = |e: &welkin::format::Entry| e.encoding == ENCODING_ZSTD;
    let index = contents.directory.iter().position(packed_chunk);
    let index = index.expect("something that shrinks");
    let entry = &contents.directory[index];
    let frame = &packed[entry.offset..entry.offset + entry.length];
    let content = zstd::bulk::decompress(frame, entry.raw_length).expect("a frame");
    let with = |name, shows, stored: &[u8]| {
        case(
            name,
            shows,
            &["zstd"],
            common::with_chunk(&packed, index, stored),
        )
    };
    let started = |start| restarted(frame, start);
    let mut damaged = with_checksum(&content);
    *damaged.last_mut().expect("a checksum") ^= 1;
    let skippable = [0x50, 0x2a, 0x4d, 0x18, 4, 0, 0, 0, 0, 0, 0, 0];
    vec![
        with(
            "zstd-dictionary",
            "a frame that names a dictionary",
            &started(Start {
                dictionary: &[1],
                ..Start::default()
            }),
        ),
        with(
            "zstd-window",
            "a frame whose window is wider than 2^27 bytes",
            &started(Start {
                window: Some(0x89),
                ..Start::default()
            }),
        ),
        with(
            "zstd-silent",
            "a frame that does not declare its content size",
            &started(Start {
                window: Some(0x50),
                silent: true,
                ..Start::default()
            }),
        ),
        with(
            "zstd-reserved",
            "a frame with the reserved bit set",
            &started(Start {
                reserved: true,
                ..Start::default()
            }),
        ),
        with(
            "zstd-checksum",
            "a frame with a wrong checksum of its content",
            &damaged,
        ),
        with(
            "zstd-skippable",
            "a skippable frame before the frame",
            &[&skippable, frame].concat(),
        ),
        with(
            "zstd-none",
            "bytes that are no frame",
            &content[..frame.len()],
        ),
    ]
}

/// A source basis of more than 2^18 altitudes, wavelengths and moments.
fn tables() -> Vec<Case> {
    let mut head = common::head_with(&[0.0], &[50e3], 40);
    head.solar_step = 46.0;
    head.solar_irradiance = vec![1.0; 11];
    head.fields.truncate(1);
    let mut chunks = common::aerial::chunks(&head, 0.2);
    for chunk in &mut chunks {
        match &mut chunk.payload {
            Payload::SourceBasis(basis) => {
                basis.altitude = (0..200).map(|i| f64::from(i) * 100.0).collect();
                basis.ranks = [1, 1, 32, 1];
                let moments = 4 + welkin::format::harmonics(basis.degree, basis.orders);
                let rows = [200, basis.sun.len(), moments, 2 * 40];
                basis.factors = std::array::from_fn(|i| vec![0.1; rows[i] * basis.ranks[i]]);
            }
            Payload::Source(source) => {
                source.ranks = [1, 1, 32, 1];
                source.core = vec![0.1; 32];
                source.parameter.fill(0.5);
            }
            _ => {}
        }
    }
    let good = encode(&head, &chunks).expect("a valid model");
    let bytes = more_altitudes(&good, &chunks, 206);
    vec![case(
        "source-table",
        "a source of more than 2^18 altitudes, wavelengths and moments",
        &["aerial-perspective"],
        bytes,
    )]
}

/// The file with more altitudes in its source basis than the writer lets pass.
fn more_altitudes(good: &[u8], chunks: &[Chunk], altitudes: usize) -> Vec<u8> {
    let basis = chunks.iter().find_map(|chunk| match &chunk.payload {
        Payload::SourceBasis(basis) => Some(basis),
        _ => None,
    });
    let basis = basis.expect("a basis");
    let (index, offset) = last(good, Kind::SourceBasis);
    let length = parse(good).expect("a valid file").directory[index].length;
    let payload = &good[offset..offset + length];
    let axis = (0..altitudes).flat_map(|i| (100.0 * i as f64).to_le_bytes());
    let (old, suns) = (basis.altitude.len(), 8 * basis.sun.len());
    let mut longer = payload[..32].to_vec();
    longer[..4].copy_from_slice(&(altitudes as u32).to_le_bytes());
    longer.extend(axis);
    longer.extend(&payload[32 + 8 * old..][..suns]);
    longer.extend(
        vec![0.1f32; altitudes - old]
            .iter()
            .flat_map(|v| v.to_le_bytes()),
    );
    longer.extend(&payload[32 + 8 * old + suns..]);
    common::with_chunk(good, index, &longer)
}

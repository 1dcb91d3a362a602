//! Writing and reading back, and what the reader and the writer refuse.

mod common;

use proptest::prelude::*;
use welkin::Error;
use welkin::format::{
    BasisView, ColumnView, Entry, FactorsView, Kind, Payload, PhaseFunction, VERSION_MAJOR, encode,
    parse, write,
};

fn payload<'a>(bytes: &'a [u8], entry: &Entry) -> &'a [u8] {
    &bytes[entry.offset..entry.offset + entry.length]
}

#[test]
fn head_and_chunks_survive_a_round_trip() {
    let head = common::head(&[0.0, 500.0], &[20e3, 80e3]);
    let chunks = common::chunks(&head);
    let bytes = encode(&head, &chunks).unwrap();
    let contents = parse(&bytes).unwrap();
    assert_eq!(contents.head, head);
    assert_eq!(contents.directory.len(), chunks.len());
    for (entry, chunk) in contents.directory.iter().zip(&chunks) {
        assert_eq!(entry.offset % 64, 0);
        let bytes = payload(&bytes, entry);
        assert_eq!(crc32fast::hash(bytes), entry.crc32);
        match &chunk.payload {
            Payload::Column(table) => {
                assert_eq!(entry.kind, Kind::Column);
                let view = ColumnView::new(bytes, &head.shape()).unwrap();
                assert!(view.values.iter().zip(&table.values).all(|(a, b)| a == b));
            }
            Payload::Polarisation(_) | Payload::PolarisationBasis(_) => {
                unreachable!("not asked for")
            }
            Payload::Radiance(factors) => {
                let view = FactorsView::radiance(bytes, &head.shape(), entry.rank).unwrap();
                assert_eq!(view.rank, factors.rank);
                let row = view.stride;
                for (i, &expected) in factors.elevation.iter().enumerate() {
                    let bits = view.elevation[i / factors.rank * row + i % factors.rank].get();
                    assert_eq!(half::f16::from_bits(bits), half::f16::from_f32(expected));
                }
                for (half, &expected) in view.level.iter().zip(&factors.level) {
                    let expected = half::f16::from_f32(expected);
                    assert_eq!(half::f16::from_bits(half.get()), expected);
                }
            }
            Payload::RadianceBasis(basis) => {
                let view = BasisView::radiance(bytes, &head.shape(), entry.rank).unwrap();
                assert_eq!((view.rank, view.stride), (basis.rank, 16));
                for (i, &expected) in basis.channel.iter().enumerate() {
                    let channels = head.shape().channels;
                    let bits = view.channel[i / channels * view.channel_stride + i % channels];
                    assert_eq!(
                        half::f16::from_bits(bits.get()),
                        half::f16::from_f32(expected)
                    );
                }
            }
            other => panic!("a chunk that was not written: {other:?}"),
        }
    }
}

#[test]
fn a_written_file_has_the_encoded_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.welkin");
    let head = common::head(&[0.0], &[20e3]);
    write(&path, &head, &common::chunks(&head)).unwrap();
    let expected = encode(&head, &common::chunks(&head)).unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), expected);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    let nowhere = folder.path().join("missing").join("model.welkin");
    assert!(matches!(
        write(&nowhere, &head, &[]),
        Err(Error::Io { path, .. }) if path == nowhere
    ));
}

#[test]
fn the_writer_refuses_what_the_reader_would() {
    let head = common::head(&[0.0], &[20e3]);
    let good = common::chunks(&head);
    let refuse = |change: &dyn Fn(&mut welkin::format::Chunk)| {
        let mut chunks = good.clone();
        change(&mut chunks[2]);
        encode(&head, &chunks).unwrap_err()
    };
    let factors = |change: fn(&mut welkin::format::RadianceFactors)| {
        refuse(&|chunk| {
            if let Payload::Radiance(f) = &mut chunk.payload {
                change(f);
            }
        })
    };
    assert!(matches!(
        factors(|f| f.alpha_up[3] = f32::NAN),
        Error::Invalid {
            what: "alpha_up",
            ..
        }
    ));
    assert!(matches!(
        factors(|f| f.alpha_up[3] = 70e3),
        Error::Invalid {
            what: "alpha_up",
            ..
        }
    ));
    assert!(matches!(
        factors(|f| f.rank = 0),
        Error::Invalid { what: "rank", .. }
    ));
    assert!(matches!(
        factors(|f| f.rank = 6),
        Error::Length { what: "scale", .. }
    ));
    assert!(matches!(
        refuse(&|c| c.altitude = Some(1)),
        Error::Invalid { .. }
    ));
    assert!(matches!(
        refuse(&|c| c.visibility = None),
        Error::Invalid { .. }
    ));
    assert!(matches!(
        refuse(&|c| c.error_p99 = f32::NAN),
        Error::Invalid { .. }
    ));
    let mut narrow = good.clone();
    if let Payload::RadianceBasis(basis) = &mut narrow[0].payload {
        basis.rank -= 1;
        basis.phi.truncate(basis.rank * head.shape().phi);
        basis.channel.truncate(basis.rank * head.shape().channels);
    }
    let error = encode(&head, &narrow).unwrap_err().to_string();
    assert!(error.contains("a basis of rank 4"), "{error}");
    let twice = [good.clone(), good.clone()].concat();
    assert!(
        encode(&head, &twice)
            .unwrap_err()
            .to_string()
            .contains("twice")
    );
}

#[test]
fn foreign_newer_and_short_files_get_errors_of_their_own() {
    let bytes = common::tiny_bytes();
    assert!(matches!(parse(b""), Err(Error::NotWelkin)));
    assert!(matches!(parse(b"\x89PNG\r\n\x1a\n"), Err(Error::NotWelkin)));
    assert!(matches!(parse(&bytes[..100]), Err(Error::Length { .. })));
    assert!(matches!(
        parse(&bytes[..bytes.len() - 1]),
        Err(Error::Length { .. })
    ));
    let longer = [bytes.clone(), vec![0]].concat();
    assert!(matches!(parse(&longer), Err(Error::Length { .. })));
    let mut newer = bytes.clone();
    newer[8] = 9;
    assert!(matches!(
        parse(&newer),
        Err(Error::Version {
            expected: VERSION_MAJOR,
            got: 9
        })
    ));
    let mut featured = bytes.clone();
    featured[12] = 4;
    assert!(matches!(parse(&featured), Err(Error::Feature { bits: 4 })));
}

#[cfg(feature = "zstd")]
#[test]
fn compressed_files_hold_the_same_numbers() {
    use welkin::format::{ENCODING_RAW, ENCODING_ZSTD, recode};
    use welkin::{Conditions, Model};
    let raw = common::model_bytes();
    let packed = recode(&raw, ENCODING_ZSTD).unwrap();
    assert!(packed.len() < raw.len() * 3 / 4, "{}", packed.len());
    assert_eq!(recode(&packed, ENCODING_RAW).unwrap(), raw);
    let answer = |bytes: Vec<u8>| {
        let model = Model::from_bytes(bytes).unwrap();
        let sky = model.sky(&Conditions::default()).unwrap();
        sky.xyz([0.1, 0.2, 0.3]).unwrap().map(f32::to_bits)
    };
    assert_eq!(answer(packed), answer(raw));
}

#[cfg(feature = "zstd")]
#[test]
fn frames_that_lie_about_their_length_are_refused() {
    use welkin::Model;
    use welkin::format::{ENCODING_ZSTD, recode};
    let packed = recode(&common::model_bytes(), ENCODING_ZSTD).unwrap();
    let contents = parse(&packed).unwrap();
    let entry = &contents.directory[1];
    assert_eq!(entry.encoding, ENCODING_ZSTD);
    let frame = payload(&packed, entry);
    for other in [
        zstd::bulk::compress(&vec![0; entry.raw_length - 1], 1).unwrap(),
        zstd::bulk::compress(&vec![0; 1 << 24], 1).unwrap(),
        [frame, &[0][..]].concat(),
        [frame, frame].concat(),
        frame[..frame.len() - 1].to_vec(),
        b"no frame".repeat(10),
    ] {
        let error = Model::from_bytes(common::with_chunk(&packed, 1, &other))
            .unwrap()
            .verify()
            .unwrap_err();
        assert!(
            matches!(
                error,
                Error::Invalid {
                    what: "zstd frame",
                    ..
                }
            ),
            "{error}"
        );
    }
    // A few bytes cannot stand for a large payload.
    let bomb = common::with_chunk(&packed, 2, &[0; 4]);
    assert!(matches!(
        parse(&bomb),
        Err(Error::Invalid {
            what: "directory",
            ..
        })
    ));
}

proptest! {
    #![proptest_config(common::cases(256))]

    #[test]
    fn any_valid_head_survives_a_round_trip(
        altitudes in proptest::collection::btree_set(0u32..15_000, 1..5),
        visibilities in proptest::collection::btree_set(1u32..200, 1..5),
        metadata in ".{0,40}",
        exponent in 1.0..8.0f64,
    ) {
        let floats = |set: std::collections::BTreeSet<u32>, scale: f64| -> Vec<f64> {
            set.into_iter().map(|v| f64::from(v) * scale).collect()
        };
        let mut head = common::head(&floats(altitudes, 1.0), &floats(visibilities, 1e3));
        head.metadata = metadata;
        head.up.exponent = exponent;
        let bytes = encode(&head, &common::chunks(&head)).unwrap();
        prop_assert_eq!(parse(&bytes).unwrap().head, head);
    }

    #[test]
    fn any_bytes_are_read_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..400), prefix in 0usize..300) {
        let mut file = common::tiny_bytes();
        file.truncate(prefix);
        file.extend(bytes);
        prop_assert!(parse(&file).is_err());
    }
}

#[test]
fn sources_of_unlike_species_are_not_written() {
    let head = common::head(&[0.0], &[20e3, 50e3]);
    let mut chunks = common::aerial::chunks(&head, 0.2);
    assert!(encode(&head, &chunks).is_ok());
    let Some(Payload::Source(source)) = chunks.last_mut().map(|chunk| &mut chunk.payload) else {
        panic!("a source");
    };
    source.phase[0] = PhaseFunction::HenyeyGreenstein;
    let refused = encode(&head, &chunks);
    assert!(matches!(
        refused,
        Err(Error::Invalid {
            what: "source chunks",
            ..
        })
    ));
}

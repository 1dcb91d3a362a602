//! Damaged and hostile files: an error or the same numbers, never a panic or garbage.

mod common;

use proptest::prelude::*;
use welkin::format::parse;
use welkin::{Conditions, Model, PolarisationFrame, Result, Stokes};

const DIRECTIONS: [[f32; 3]; 3] = [[0.1, 0.2, 0.3], [0.0, 0.0, 1.0], [1.0, 0.1, 0.01]];

/// Everything that the tiny model says, as bits.
fn answers(bytes: Vec<u8>) -> Result<Vec<u32>> {
    let model = Model::from_bytes(bytes)?;
    let conditions = Conditions {
        visibility: 50e3,
        ..Conditions::default()
    };
    let sky = model.sky(&conditions)?;
    let polarised = model.polarised_sky(&conditions)?;
    let mut stokes = vec![Stokes::default(); sky.wavelengths().len()];
    let mut out = vec![0.0; sky.wavelengths().len()];
    let mut bits = Vec::new();
    for direction in DIRECTIONS {
        sky.radiance(direction, &mut out)?;
        let values = out
            .iter()
            .chain(&sky.xyz(direction)?)
            .copied()
            .collect::<Vec<f32>>();
        assert!(values.iter().all(|v| v.is_finite()), "{values:?}");
        assert!(out.iter().all(|&l| l >= 0.0));
        bits.extend(values.into_iter().map(f32::to_bits));
        polarised.stokes(direction, PolarisationFrame::SunAligned, &mut stokes)?;
        for (light, l) in stokes.iter().zip(&out) {
            assert!(
                light.i == *l && light.q.is_finite() && light.u.is_finite(),
                "{light:?} {l}"
            );
            assert!(light.q.hypot(light.u) <= light.i, "{light:?}");
            bits.extend([light.q, light.u].map(f32::to_bits));
        }
    }
    Ok(bits)
}

/// Transmittance and light of segments, as bits.
fn segments(bytes: Vec<u8>) -> Result<Vec<u32>> {
    let model = Model::from_bytes(bytes)?;
    let aerial = model.aerial_perspective(&Conditions {
        visibility: 45e3,
        solar_elevation: 0.02,
        ..Conditions::default()
    })?;
    let n = aerial.wavelengths().len();
    let (mut light, mut through) = (vec![0.0; n], vec![0.0; n]);
    let mut bits = Vec::new();
    for end in DIRECTIONS.map(|d| d.map(|v| 5e4 * f64::from(v))) {
        aerial.in_scattering([0.0, 0.0, 10.0], end, &mut light, &mut through)?;
        assert!(
            light.iter().all(|l| l.is_finite() && *l >= 0.0),
            "{light:?}"
        );
        assert!(
            through.iter().all(|t| (0.0..=1.0).contains(t)),
            "{through:?}"
        );
        bits.extend(light.iter().chain(&through).map(|v| v.to_bits()));
    }
    Ok(bits)
}

type Ask = fn(Vec<u8>) -> Result<Vec<u32>>;

/// The smallest files that have everything, and what is asked about them.
fn files() -> [(Vec<u8>, Ask); 2] {
    [
        (common::tiny_bytes(), answers),
        (common::aerial::tiny_bytes(), segments),
    ]
}

#[test]
fn every_truncation_is_refused() {
    for (bytes, _) in files() {
        for length in 0..bytes.len() {
            assert!(parse(&bytes[..length]).is_err(), "{length}");
        }
    }
}

#[test]
fn every_flip_is_refused_or_changes_nothing() {
    for (bytes, ask) in files() {
        let expected = ask(bytes.clone()).unwrap();
        let mut refused = 0;
        for i in 0..bytes.len() {
            for mask in [1 << (i % 8), 0xff] {
                let mut damaged = bytes.clone();
                damaged[i] ^= mask;
                match ask(damaged) {
                    Ok(got) => assert_eq!(got, expected, "byte {i}"),
                    Err(_) => refused += 1,
                }
            }
        }
        // Only the zeros between the chunks are not covered by a checksum.
        let contents = parse(&bytes).unwrap();
        let chunks: usize = contents.directory.iter().map(|e| e.length).sum();
        assert_eq!(refused, 2 * (contents.head_length + chunks));
    }
}

fn hostile() -> impl Strategy<Value = (usize, Vec<u8>)> {
    let floats = [
        f64::NAN,
        f64::INFINITY,
        -1.0,
        0.0,
        1e300,
        5e-324,
        1e38,
        -1e38,
    ];
    let bytes = prop_oneof![
        prop::collection::vec(any::<u8>(), 1..9),
        prop::sample::select(floats.to_vec()).prop_map(|v| v.to_le_bytes().to_vec()),
        prop::sample::select(floats.to_vec()).prop_map(|v| (v as f32).to_le_bytes().to_vec()),
        prop::sample::select(vec![0u16, 1, 2, 0x7bff, 0xfbff, 0x7c00, 0xffff])
            .prop_map(|v| v.to_le_bytes().to_vec()),
    ];
    (
        any::<prop::sample::Index>().prop_map(|i| i.index(1 << 20)),
        bytes,
    )
}

proptest! {
    #![proptest_config(common::cases(2000))]

    #[test]
    fn forged_files_are_refused_or_give_numbers(
        edits in prop::collection::vec(hostile(), 1..4), aligned in any::<bool>(), file in 0..2usize,
    ) {
        let (original, ask) = files()[file].clone();
        let mut forged = original.clone();
        for (position, bytes) in edits {
            let mut at = position % (forged.len() - 8);
            if aligned {
                at -= at % bytes.len().next_power_of_two();
            }
            forged[at..at + bytes.len()].copy_from_slice(&bytes);
        }
        common::seal(&mut forged, &original);
        let _ = ask(forged);
    }
}

#[cfg(feature = "zstd")]
#[test]
fn every_flip_and_truncation_of_a_compressed_file_is_refused_or_changes_nothing() {
    use welkin::format::{ENCODING_ZSTD, recode};
    let bytes = recode(&common::tiny_bytes(), ENCODING_ZSTD).unwrap();
    let expected = answers(bytes.clone()).unwrap();
    for i in 0..bytes.len() {
        assert!(answers(bytes[..i].to_vec()).is_err(), "{i} bytes");
        let mut damaged = bytes.clone();
        damaged[i] ^= 1 << (i % 8);
        if let Ok(got) = answers(damaged) {
            assert_eq!(got, expected, "byte {i}");
        }
    }
}

#[test]
fn a_small_file_cannot_ask_for_a_large_table() {
    let mut head = common::head(&[0.0], &[50e3]);
    head.up.intervals = 1024;
    head.phi_intervals = 1024;
    let chunks = common::chunks(&head);
    assert!(matches!(
        welkin::format::encode(&head, &chunks),
        Err(welkin::Error::Invalid {
            what: "table of a sky",
            ..
        })
    ));
}

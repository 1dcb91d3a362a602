//! Files that readers must accept and verifiers refuse: nothing that evaluation depends on is wrong.

use welkin::format::{Kind, ceil16, encode, parse};

use crate::axis;
use crate::common;
use crate::files::{Case, small};

/// A file and the class of what a verifier finds in it.
pub type Verdict = (Case, &'static str);

pub fn all() -> Vec<Verdict> {
    let mut cases = Vec::new();
    let radiance = polarised();
    let aerial = lit_air();
    let segments = |file: &[u8], kind: Kind, at: usize, change: &[u8]| {
        changed(file, last(file, kind) + at, change)
    };
    let mut add = |name: &str, shows, class, needs: &[&'static str], bytes: Vec<u8>, raw: &[u8]| {
        let case = Case {
            name: name.to_owned(),
            shows,
            needs: needs.to_vec(),
            bytes,
            raw: raw.to_vec(),
            brief: true,
        };
        cases.push((case, class));
    };
    let contents = parse(&radiance).expect("a valid file");
    let (rank, head_length) = (common::RANK, contents.head_length);
    let [factors, basis] = [Kind::Radiance, Kind::RadianceBasis].map(|kind| last(&radiance, kind));
    let of_basis = contents
        .directory
        .iter()
        .find(|e| e.kind == Kind::RadianceBasis);
    let end_of_basis = basis + of_basis.expect("a basis").length;
    let behind_basis = contents
        .directory
        .iter()
        .map(|e| e.offset)
        .find(|&o| o >= end_of_basis);
    let in_gap = behind_basis.expect("a chunk behind the basis") - 1;
    let one = 0x3c00u16.to_le_bytes();
    for (name, shows, at, change) in [
        (
            "reserved-entry",
            "reserved bytes of a directory entry are not zero",
            head_length - 3,
            &[7][..],
        ),
        ("gap", "a gap is not zero", in_gap, &[1]),
        (
            "padding-scale",
            "a weight beside the rank is not zero",
            factors + 4 * rank,
            &1f32.to_le_bytes(),
        ),
        (
            "padding-phi",
            "an azimuth factor beside the rank is not zero",
            basis + 2 * rank,
            &one,
        ),
        (
            "padding-channel",
            "a channel factor beyond the rank is not zero",
            end_of_basis - 2,
            &one,
        ),
        (
            "padding-sign",
            "padding is minus zero",
            factors + 4 * rank,
            &(-0f32).to_le_bytes(),
        ),
    ] {
        assert!(!name.starts_with("gap") || at > end_of_basis, "no gap");
        add(
            name,
            shows,
            "value",
            &[],
            changed(&radiance, at, change),
            &radiance,
        );
    }
    let padded = padded_everywhere(&radiance);
    add(
        "padding-all",
        "no padding of factors is zero",
        "value",
        &["polarisation"],
        padded,
        &radiance,
    );
    let nan = f32::NAN.to_le_bytes();
    let unused = segments(&radiance, Kind::Polarisation, 0, &nan);
    add(
        "unused-value",
        "NaN in a chunk that nothing asked for needs",
        "value",
        &[],
        unused,
        &radiance,
    );
    let mut damaged = radiance.clone();
    damaged[last(&radiance, Kind::PolarisationBasis)] ^= 1;
    add(
        "unused-damaged",
        "a damaged chunk that nothing asked for needs",
        "checksum",
        &[],
        damaged,
        &radiance,
    );
    for (name, shows, kind, at, needs) in [
        (
            "reserved-air",
            "reserved bytes of a transmittance are not zero",
            Kind::Transmittance,
            4,
            "transmittance",
        ),
        (
            "reserved-source",
            "reserved bytes of a source are not zero",
            Kind::Source,
            28,
            "aerial-perspective",
        ),
    ] {
        let bytes = segments(&aerial, kind, at, &7u32.to_le_bytes());
        add(name, shows, "value", &[needs], bytes, &aerial);
    }
    for (name, shows, text) in [
        ("metadata-none", "no metadata", ""),
        ("metadata-text", "metadata that is not JSON", "a sky"),
        ("metadata-array", "metadata that is no JSON object", "[{}]"),
    ] {
        let bytes = with_metadata(text);
        add(name, shows, "value", &[], bytes.clone(), &bytes);
    }
    cases.extend(axis::tolerated());
    cases
}

fn polarised() -> Vec<u8> {
    let head = small(&[0.0], &[50e3]);
    encode(&head, &common::polarised_chunks(&head, 0.02)).expect("a valid model")
}

/// Ones in all columns and rows beyond the rank and the channels.
fn padded_everywhere(file: &[u8]) -> Vec<u8> {
    let contents = parse(file).expect("a valid file");
    let shape = contents.head.shape();
    let mut bytes = file.to_vec();
    for entry in &contents.directory {
        let (rank, width) = (entry.rank, ceil16(entry.rank));
        let payload = &mut bytes[entry.offset..entry.offset + entry.length];
        let channels = match entry.kind {
            Kind::RadianceBasis => shape.channels,
            Kind::PolarisationBasis => shape.polarisation_channels(),
            Kind::Radiance | Kind::Polarisation => {
                let (scale, rest) = payload.split_at_mut(4 * width);
                for weight in scale[4 * rank..].chunks_exact_mut(4) {
                    weight.copy_from_slice(&1f32.to_le_bytes());
                }
                let rows = shape.up + shape.down + shape.elevation;
                pad(&mut rest[..2 * width * rows], width, |_| rank);
                continue;
            }
            _ => continue,
        };
        let (phi, channel) = payload.split_at_mut(2 * width * shape.phi);
        pad(phi, width, |_| rank);
        pad(channel, ceil16(channels), |row| {
            if row < rank { channels } else { 0 }
        });
    }
    common::seal(&mut bytes, file);
    bytes
}

/// Ones in the columns of a matrix of halves from the one that is told for each row.
fn pad(matrix: &mut [u8], width: usize, first: impl Fn(usize) -> usize) {
    for (i, row) in matrix.chunks_exact_mut(2 * width).enumerate() {
        for half in row[2 * first(i)..].chunks_exact_mut(2) {
            half.copy_from_slice(&0x3c00u16.to_le_bytes());
        }
    }
}

fn lit_air() -> Vec<u8> {
    let head = small(&[0.0], &[40e3, 60e3]);
    encode(&head, &common::aerial::chunks(&head, 0.2)).expect("a valid model")
}

fn with_metadata(text: &str) -> Vec<u8> {
    let mut head = small(&[0.0], &[50e3]);
    head.metadata = text.to_owned();
    encode(&head, &common::chunks(&head)).expect("a valid model")
}

/// Where the last chunk of a kind starts.
fn last(file: &[u8], kind: Kind) -> usize {
    let directory = parse(file).expect("a valid file").directory;
    let entry = directory.iter().rfind(|e| e.kind == kind);
    entry.expect("a chunk of the kind").offset
}

fn changed(file: &[u8], at: usize, change: &[u8]) -> Vec<u8> {
    let mut bytes = file.to_vec();
    bytes[at..at + change.len()].copy_from_slice(change);
    common::seal(&mut bytes, file);
    bytes
}

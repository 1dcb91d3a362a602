//! A valid head, read from a source that gives as much as it likes, with any bytes as chunks.
//!
//! The input's first byte says where the source ends early; the others are laid over the bytes of the chunks.
#![no_main]

use std::io;

use libfuzzer_sys::fuzz_target;
use welkin::{Model, ReadAt};
use welkin_fuzz::{forged, interrogate};

static FILES: [&[u8]; 9] = [
    include_bytes!("../../format-spec/conformance/files/minimal.welkin"),
    include_bytes!("../../format-spec/conformance/files/pairs.welkin"),
    include_bytes!("../../format-spec/conformance/files/zstd.welkin"),
    include_bytes!("../../format-spec/conformance/files/polarised.welkin"),
    include_bytes!("../../format-spec/conformance/files/air.welkin"),
    include_bytes!("../../format-spec/conformance/files/aerial-perspective.welkin"),
    include_bytes!("../../format-spec/conformance/files/spectrum-polarised.welkin"),
    include_bytes!("../../format-spec/conformance/files/spectrum-air.welkin"),
    include_bytes!("../../format-spec/conformance/files/spectrum-aerial-perspective.welkin"),
];

/// Ends at `end`, and fails when asked beyond `end` often.
struct Source {
    bytes: Vec<u8>,
    end: usize,
}

impl ReadAt for Source {
    fn read_at(&self, offset: u64, buffer: &mut [u8]) -> io::Result<usize> {
        if offset > self.bytes.len() as u64 {
            return Err(io::Error::other("beyond the end"));
        }
        self.bytes[..self.end].read_at(offset, buffer)
    }
}

fuzz_target!(|data: &[u8]| {
    let Some((&choice, chunks)) = data.split_first() else {
        return;
    };
    let mut bytes = FILES[usize::from(choice) % FILES.len()].to_vec();
    let head = u64::from_le_bytes(bytes[24..32].try_into().expect("eight bytes")) as usize;
    let start = head.next_multiple_of(64).min(bytes.len());
    let length = chunks.len().min(bytes.len() - start);
    bytes[start..start + length].copy_from_slice(&chunks[..length]);
    let bytes = forged(&bytes);
    let end = match choice {
        0..200 => bytes.len(),
        _ => bytes.len() * usize::from(choice - 200) / 56,
    };
    if let Ok(model) = Model::stream(Source { bytes, end }) {
        interrogate(&model);
    }
});

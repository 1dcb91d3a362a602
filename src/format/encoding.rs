//! From the bytes of a chunk in the file to its payload. Format specification, sections 5 and 8.

use std::borrow::Cow;

use super::axis_table::AxisTable;
use super::density::DensityView;
use super::estimate::view as estimate_view;
use super::head::{Entry, Head, Kind};
use super::layout::ENCODING_RAW;
#[cfg(feature = "zstd")]
use super::layout::ENCODING_ZSTD;
use super::source_function::{SourceBasisView, SourceView};
use super::spectrum::view as spectrum_view;
use super::views::{BasisView, ColumnView, FactorsView};
use crate::error::{Error, Result};

/// Verifies the checksum of chunk `i` and undoes its encoding. Chunks of unknown kinds stay as they are: their
/// checksums, too, may be anything.
///
/// Allocates at most `raw_length` bytes, which was compared with what rank and counts give.
pub(crate) fn decode<'a>(i: usize, entry: &Entry, stored: &'a [u8]) -> Result<Cow<'a, [u8]>> {
    if matches!(entry.kind, Kind::Unknown(_)) {
        return Ok(Cow::Borrowed(stored));
    }
    let got = crc32fast::hash(stored);
    if got != entry.crc32 {
        return Err(Error::Checksum {
            chunk: Some(i),
            expected: entry.crc32,
            got,
        });
    }
    match entry.encoding {
        ENCODING_RAW => Ok(Cow::Borrowed(stored)),
        #[cfg(feature = "zstd")]
        ENCODING_ZSTD => decompress(i, stored, entry.raw_length).map(Cow::Owned),
        got => Err(Error::Encoding { chunk: i, got }),
    }
}

/// Checks the payload of chunk `i`: length and numbers.
pub(crate) fn check_chunk(head: &Head, i: usize, entry: &Entry, payload: &[u8]) -> Result<()> {
    let shape = head.shape();
    let (constituents, wavelengths) = (head.constituents, head.wavelengths.len());
    let finite = match entry.kind {
        Kind::Unknown(_) => return Ok(()),
        Kind::Radiance => FactorsView::radiance(payload, &shape, entry.rank)?.is_finite(),
        Kind::Column => ColumnView::new(payload, &shape)?.is_finite(),
        Kind::Polarisation => FactorsView::polarisation(payload, &shape, entry.rank)?.is_finite(),
        Kind::PolarisationBasis => {
            BasisView::polarisation(payload, &shape, entry.rank)?.is_finite()
        }
        Kind::Transmittance => {
            return DensityView::new(payload, constituents, head.planet.top).map(drop);
        }
        Kind::Source => return SourceView::new(payload, constituents, wavelengths).map(drop),
        Kind::SourceBasis => return SourceBasisView::new(payload, wavelengths).map(drop),
        Kind::Estimate => return estimate_view(head, payload).map(drop),
        Kind::Axis => return AxisTable::read(head, payload).map(drop),
        Kind::Spectrum => return spectrum_view(head, payload).map(drop),
        Kind::RadianceBasis => BasisView::radiance(payload, &shape, entry.rank)?.is_finite(),
    };
    if finite {
        return Ok(());
    }
    let detail = format!("chunk {i} holds NaN or infinity");
    Err(Error::invalid("chunk", detail))
}

/// One zstd frame that states its content size and fills `stored`.
#[cfg(feature = "zstd")]
fn decompress(i: usize, stored: &[u8], raw_length: usize) -> Result<Vec<u8>> {
    use zstd::zstd_safe::{find_frame_compressed_size, get_frame_content_size};
    let broken = |detail: &str| Error::invalid("zstd frame", format!("chunk {i}: {detail}"));
    if !is_plain(stored) {
        return Err(broken("needs a window of more than 128 MiB, or is none"));
    }
    let declared = get_frame_content_size(stored);
    if !matches!(declared, Ok(Some(n)) if n == raw_length as u64) {
        return Err(broken("does not declare raw_length bytes"));
    }
    if !matches!(find_frame_compressed_size(stored), Ok(n) if n == stored.len()) {
        return Err(broken("does not fill the stored bytes"));
    }
    let decoded = zstd::bulk::decompress(stored, raw_length);
    let decoded = decoded.map_err(|error| broken(&error.to_string()))?;
    if decoded.len() == raw_length {
        return Ok(decoded);
    }
    Err(broken("has another length than raw_length"))
}

/// Whether the bytes start a frame of RFC 8878, not a skippable or older one, whose window is not wider than the
/// specification allows.
#[cfg(feature = "zstd")]
fn is_plain(stored: &[u8]) -> bool {
    /// Window_Descriptor of 2^27 bytes: smaller ones are smaller numbers.
    const WIDEST: u8 = (27 - 10) << 3;
    let Some(([0x28, 0xb5, 0x2f, 0xfd, descriptor], rest)) = stored.split_first_chunk() else {
        return false;
    };
    let single_segment = descriptor & 0x20 != 0;
    single_segment || rest.first().is_some_and(|&window| window <= WIDEST)
}

/// Compresses a payload; `None` if the frame breaks the limits that the specification sets or saves nothing.
#[cfg(feature = "zstd")]
pub(crate) fn compress(payload: &[u8]) -> Option<Vec<u8>> {
    use super::layout::MOST_EXPANSION;
    const LEVEL: i32 = 19;
    let frame = zstd::bulk::compress(payload, LEVEL).ok()?;
    let worth = frame.len() < payload.len() && payload.len() / frame.len() < MOST_EXPANSION;
    worth.then_some(frame)
}

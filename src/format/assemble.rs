//! Puts head arrays and chunks together to a file: places, lengths, checksums. Format specification, sections 1 and 5.

use zerocopy::IntoBytes;
use zerocopy::little_endian::{U16, U32, U64};

use super::layout::*;
use super::parse::{head_crc, parse};
use crate::error::{Error, Result};

/// The bytes of a file. The fields of `header` and of the entries that depend on the layout are set here.
pub(crate) fn assemble(
    mut header: Header,
    arrays: &[u8],
    chunks: Vec<(RawEntry, Vec<u8>)>,
) -> Result<Vec<u8>> {
    let count = chunks.len();
    let head_length = HEADER_LENGTH + arrays.len() + count * ENTRY_LENGTH;
    header.chunk_count =
        U32::new(u32::try_from(count).map_err(|_| {
            Error::invalid("chunk_count", format!("expected 32 bits, got {count}"))
        })?);
    if chunks.iter().any(|(e, _)| e.kind.get() == KIND_SPECTRUM) {
        header.required_features |= U32::new(FEATURE_SPECTRUM);
    }
    let features = header.required_features.get();
    let has_axis = chunks.iter().any(|(e, _)| e.kind.get() == KIND_AXIS);
    let needed = minor_version(features, has_axis);
    header.version_minor = U16::new(header.version_minor.get().max(needed));
    let mut file = [header.as_bytes(), arrays].concat();
    file.resize(head_length, 0);
    let mut entries = Vec::with_capacity(count);
    for (mut entry, bytes) in chunks {
        file.resize(file.len().next_multiple_of(CHUNK_ALIGNMENT as usize), 0);
        entry.offset = U64::new(file.len() as u64);
        entry.stored_length = U64::new(bytes.len() as u64);
        entry.crc32 = U32::new(crc32fast::hash(&bytes));
        entries.push(entry);
        file.extend(bytes);
    }
    file[head_length - count * ENTRY_LENGTH..head_length].copy_from_slice(entries.as_bytes());
    header.head_length = U64::new(head_length as u64);
    header.file_length = U64::new(file.len() as u64);
    file[..HEADER_LENGTH].copy_from_slice(header.as_bytes());
    let crc = head_crc(&file[..head_length]);
    file[CRC_RANGE].copy_from_slice(&crc.to_le_bytes());
    // The reader's checks of the directory are the writer's too.
    parse(&file)?;
    Ok(file)
}

/// The lowest version that such a file needs.
fn minor_version(features: u32, has_axis: bool) -> u16 {
    match features {
        _ if has_axis => 3,
        _ if features & FEATURE_ESTIMATE != 0 => 2,
        0 => 0,
        _ => 1,
    }
}

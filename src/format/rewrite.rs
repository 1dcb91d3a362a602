//! Writes files anew with other encodings or more chunks.

use zerocopy::FromBytes;
use zerocopy::little_endian::U32;

use super::assemble::assemble;
use super::encoding::{check_chunk, decode};
use super::head::Kind;
use super::layout::*;
use super::parse::{Contents, parse};
use super::verify::check_sources;
use super::write::{Chunk, encode_chunk};
use crate::error::{Error, Result};

/// The same file with its chunks in another encoding ([`ENCODING_RAW`] or [`ENCODING_ZSTD`]).
///
/// Chunks that would not shrink, or shrink beyond what the format allows, stay raw; chunks of unknown kinds stay as
/// they are.
///
/// # Errors
/// As a reader of the file; [`Error::Encoding`] if this build does not have the feature that the encoding needs.
pub fn recode(file: &[u8], encoding: u32) -> Result<Vec<u8>> {
    let contents = parse(file)?;
    let (header, arrays, raw_entries) = parts(file, &contents)?;
    let mut chunks = Vec::with_capacity(contents.directory.len());
    for (i, (entry, mut raw)) in contents.directory.iter().zip(raw_entries).enumerate() {
        let payload = decode(i, entry, &file[entry.offset..entry.offset + entry.length])?;
        let mut stored = payload.into_owned();
        if !matches!(entry.kind, Kind::Unknown(_)) {
            check_chunk(&contents.head, i, entry, &stored)?;
            let (code, bytes) = encode(i, stored, encoding)?;
            raw.encoding = U32::new(code);
            stored = bytes;
        }
        chunks.push((raw, stored));
    }
    assemble(header, arrays, chunks)
}

/// The same file with `chunks` added, in place of chunks of the same kind and nodes. All others are kept as they are.
///
/// # Errors
/// As [`parse`] for `file`, as [`encode`](super::encode()) for `chunks`; [`Error::Invalid`] if sources, old and new,
/// fit neither their basis nor each other.
pub fn extend(file: &[u8], chunks: &[Chunk]) -> Result<Vec<u8>> {
    let contents = parse(file)?;
    let (header, arrays, raw_entries) = parts(file, &contents)?;
    let new = chunks
        .iter()
        .map(|chunk| encode_chunk(&contents.head, chunk));
    let new = new.collect::<Result<Vec<_>>>()?;
    let key = |raw: &RawEntry| (raw.kind, raw.altitude, raw.visibility);
    let mut all = Vec::with_capacity(raw_entries.len() + new.len());
    for (entry, raw) in contents.directory.iter().zip(raw_entries) {
        if !new.iter().any(|(other, _)| key(other) == key(&raw)) {
            all.push((
                raw,
                file[entry.offset..entry.offset + entry.length].to_vec(),
            ));
        }
    }
    all.extend(new);
    let extended = assemble(header, arrays, all)?;
    let misfit = check_sources(&parse(&extended)?, &extended)
        .into_iter()
        .next();
    misfit.map_or(Ok(extended), |problem| Err(problem.error))
}

/// Header, head arrays and directory of a parsed file.
fn parts<'a>(file: &'a [u8], contents: &Contents) -> Result<(Header, &'a [u8], Vec<RawEntry>)> {
    let directory = contents.head_length - contents.directory.len() * ENTRY_LENGTH;
    let (header, _) = Header::read_from_prefix(file).map_err(|_| Error::NotWelkin)?;
    let entries = file[directory..contents.head_length].chunks_exact(ENTRY_LENGTH);
    let entries =
        entries.map(|bytes| RawEntry::read_from_bytes(bytes).map_err(|_| Error::NotWelkin));
    let entries = entries.collect::<Result<Vec<_>>>()?;
    Ok((header, &file[HEADER_LENGTH..directory], entries))
}

fn encode(chunk: usize, payload: Vec<u8>, encoding: u32) -> Result<(u32, Vec<u8>)> {
    match encoding {
        ENCODING_RAW => Ok((ENCODING_RAW, payload)),
        #[cfg(feature = "zstd")]
        ENCODING_ZSTD => Ok(match super::encoding::compress(&payload) {
            Some(frame) => (ENCODING_ZSTD, frame),
            None => (ENCODING_RAW, payload),
        }),
        got => Err(Error::Encoding { chunk, got }),
    }
}

//! Checks a whole file, also what evaluation does not depend on. Format specification, sections 3 to 6 and 8.

use super::axis_table::RESERVED as AXIS_RESERVED;
use super::density::RESERVED as DENSITY_RESERVED;
use super::encoding::{check_chunk, decode};
use super::estimate::view as estimate_view;
use super::head::{Entry, Head, Kind};
use super::layout::ENTRY_LENGTH;
use super::parse::{Contents, parse};
use super::source_function::{RESERVED as SOURCE_RESERVED, SourceBasisView, SourceView};
use super::views::{BasisView, FactorsView, Payload16};
use crate::error::Error;

/// A rule of the format specification that a file breaks.
///
/// ```
/// use welkin::format::{parse, verify};
///
/// let mut file = welkin::DEFAULT_MODEL.to_vec();
/// assert!(verify(&file).is_empty());
/// let chunk = parse(&file)?.directory[3];
/// file[chunk.offset] ^= 1;
/// let problems = verify(&file);
/// assert_eq!(problems[0].chunk, Some(3));
/// assert_eq!(problems[0].error.class(), "checksum");
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Debug)]
pub struct Problem {
    /// Index of the chunk in the directory, if it is about a chunk.
    pub chunk: Option<usize>,
    /// What is wrong.
    pub error: Error,
}

/// All problems of a file: a broken head hides what is behind it, but every chunk is looked at.
///
/// Stricter than a reader: bytes that no reader needs must be zero as the specification says.
pub fn verify(file: &[u8]) -> Vec<Problem> {
    let contents = match parse(file) {
        Ok(contents) => contents,
        Err(error) => return vec![Problem { chunk: None, error }],
    };
    let mut end = contents.head_length;
    let mut problems = Vec::new();
    for (i, entry) in contents.directory.iter().enumerate() {
        let found = [
            check_gap(&file[end..entry.offset]),
            check_reserved(&contents, file, i, entry),
            check_payload(&contents, file, i, entry),
        ];
        let broken = found.into_iter().filter_map(Result::err);
        problems.extend(broken.map(|error| Problem {
            chunk: Some(i),
            error,
        }));
        end = entry.offset + entry.length;
    }
    problems.extend(check_sources(&contents, file));
    problems
}

/// Source chunks that are sound by themselves, but do not fit their basis or the first of them.
pub(super) fn check_sources(contents: &Contents, file: &[u8]) -> Vec<Problem> {
    let wavelengths = contents.head.wavelengths.len();
    let payloads = |kind: Kind| {
        let entries = contents.directory.iter().enumerate();
        entries
            .filter(move |(_, e)| e.kind == kind)
            .filter_map(|(i, e)| {
                let payload = decode(i, e, &file[e.offset..e.offset + e.length]).ok()?;
                Some((i, payload))
            })
    };
    let Some((_, basis)) = payloads(Kind::SourceBasis).next() else {
        return Vec::new();
    };
    let Ok(basis) = SourceBasisView::new(&basis, wavelengths) else {
        return Vec::new();
    };
    let sources: Vec<_> = payloads(Kind::Source).collect();
    let views = sources.iter().filter_map(|(i, payload)| {
        let view = SourceView::new(payload, contents.head.constituents, wavelengths).ok()?;
        Some((*i, view))
    });
    let Some((_, first)) = views.clone().next() else {
        return Vec::new();
    };
    views
        .filter_map(|(i, view)| {
            let error = view.check_with(&basis, &first).err()?;
            Some(Problem {
                chunk: Some(i),
                error,
            })
        })
        .collect()
}

fn check_gap(gap: &[u8]) -> Result<(), Error> {
    if gap.iter().all(|&b| b == 0) {
        return Ok(());
    }
    let detail = "expected zeros between the end of its predecessor and the chunk";
    Err(Error::invalid("gap", detail))
}

/// The last eight bytes of a directory entry.
fn check_reserved(contents: &Contents, file: &[u8], i: usize, entry: &Entry) -> Result<(), Error> {
    if matches!(entry.kind, Kind::Unknown(_)) {
        return Ok(());
    }
    let directory = contents.head_length - contents.directory.len() * ENTRY_LENGTH;
    let end = directory + (i + 1) * ENTRY_LENGTH;
    if file[end - 8..end] == [0; 8] {
        return Ok(());
    }
    Err(Error::invalid("reserved", "expected zeros"))
}

fn check_payload(contents: &Contents, file: &[u8], i: usize, entry: &Entry) -> Result<(), Error> {
    let stored = &file[entry.offset..entry.offset + entry.length];
    let payload = decode(i, entry, stored)?;
    check_chunk(&contents.head, i, entry, &payload)?;
    check_reserved_of_payload(entry, &payload)?;
    check_padding(&contents.head, entry, &payload)
}

/// `reserved` in payloads that have it.
fn check_reserved_of_payload(entry: &Entry, payload: &[u8]) -> Result<(), Error> {
    let reserved = match entry.kind {
        Kind::Transmittance => DENSITY_RESERVED,
        Kind::Source => SOURCE_RESERVED,
        Kind::Axis => AXIS_RESERVED,
        _ => return Ok(()),
    };
    match payload.get(reserved) {
        Some([0, 0, 0, 0]) => Ok(()),
        _ => Err(Error::invalid("reserved of a payload", "expected zeros")),
    }
}

/// Columns beyond the rank and beyond the channels: every bit of them, so that −0 is not zero.
fn check_padding(head: &Head, entry: &Entry, payload: &[u8]) -> Result<(), Error> {
    let (shape, rank) = (head.shape(), entry.rank);
    let zero = match entry.kind {
        Kind::Radiance => factors_are_padded(&FactorsView::radiance(payload, &shape, rank)?),
        Kind::Polarisation => {
            factors_are_padded(&FactorsView::polarisation(payload, &shape, rank)?)
        }
        Kind::RadianceBasis => basis_is_padded(&BasisView::radiance(payload, &shape, rank)?),
        Kind::PolarisationBasis => {
            basis_is_padded(&BasisView::polarisation(payload, &shape, rank)?)
        }
        Kind::Estimate => estimate_view(head, payload)?.is_padded(shape.wavelengths),
        _ => true,
    };
    if zero {
        return Ok(());
    }
    Err(Error::invalid("padding of a payload", "expected zeros"))
}

fn factors_are_padded(view: &FactorsView) -> bool {
    let scale = view.scale[view.rank..]
        .iter()
        .all(|s| s.get().to_bits() == 0);
    let matrices = [view.alpha_up, view.alpha_down, view.elevation];
    scale && matrices.iter().all(|m| is_zero(m, view.stride, view.rank))
}

fn basis_is_padded(view: &BasisView) -> bool {
    let (channel, rest) = view.channel.split_at(view.rank * view.channel_stride);
    is_zero(view.phi, view.stride, view.rank)
        && is_zero(channel, view.channel_stride, view.channels)
        && is_zero(rest, view.channel_stride, 0)
}

/// Whether the columns of a matrix from `width` on are zero.
fn is_zero(matrix: &Payload16, stride: usize, width: usize) -> bool {
    let mut rows = matrix.chunks_exact(stride);
    rows.all(|row| row[width..].iter().all(|h| h.get() == 0))
}

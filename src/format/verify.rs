//! Checks a whole file, also what evaluation does not depend on. Format specification, sections 3 to 6 and 8.

use super::encoding::{check_chunk, decode};
use super::head::{Entry, Kind};
use super::layout::ENTRY_LENGTH;
use super::parse::{Contents, parse};
use crate::error::Error;

/// A rule of the format specification that a file breaks.
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
    problems
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
    check_chunk(&contents.head, i, entry, &payload)
}

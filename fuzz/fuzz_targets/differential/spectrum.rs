//! Changes of a spectrum chunk (section 6.9 of the format specification) that leave it sound, or almost.

use std::ops::Range;

use crate::bytes::Bytes;
use crate::parts::Chunk;

const KIND: [u8; 4] = [9, 0, 0, 0];

/// Where the tables of a payload are.
struct Tables {
    wavelength: Range<usize>,
    first_term: Range<usize>,
    term_weight: Range<usize>,
    term_extinction: Range<usize>,
    tap_node: Range<usize>,
    tap_weight: Range<usize>,
    extinction: Range<usize>,
}

impl Tables {
    /// None if earlier changes left no sound counts.
    fn of(header: &[u8], payload: &[u8]) -> Option<Self> {
        let count = |at: usize| usize::from(u16::from_le_bytes([header[at], header[at + 1]]));
        let (visibilities, constituents) = (count(44), count(48));
        let count = |i: usize| word(payload, 4 * i).map(|n| n as usize);
        let [cells, taps, terms] = [count(0)?, count(1)?, count(2)?];
        if cells < 2 || taps == 0 || terms < cells || terms.max(taps) > payload.len() {
            return None;
        }
        let mut end = 16;
        let mut next = |bytes: usize| {
            let start = end;
            end += bytes;
            start..end
        };
        let tables = Self {
            wavelength: next(8 * cells),
            first_term: next(4 * (cells + 1)),
            term_weight: next(4 * terms),
            term_extinction: next(4 * terms * constituents),
            tap_node: next(4 * terms * taps),
            tap_weight: next(4 * terms * taps),
            extinction: next(4 * visibilities * constituents * cells),
        };
        (tables.extinction.end <= payload.len()).then_some(tables)
    }
}

pub fn change(bytes: &mut Bytes, header: &[u8], chunks: &mut [Chunk]) -> Option<String> {
    let chunk = chunks.iter_mut().find(|chunk| chunk.entry[..4] == KIND)?;
    let payload = &mut chunk.payload;
    let tables = Tables::of(header, payload)?;
    match bytes.below(7) {
        0 => cell(bytes, &mut payload[tables.wavelength]),
        1 => bound(bytes, &mut payload[tables.first_term]),
        2 => shares(bytes, &mut payload[tables.term_weight]),
        3 => scaled(bytes, &mut payload[tables.term_extinction]),
        4 => node(bytes, header[40], &mut payload[tables.tap_node]),
        5 => scaled(bytes, &mut payload[tables.tap_weight]),
        _ => scaled(bytes, &mut payload[tables.extinction]),
    }
}

fn word(table: &[u8], at: usize) -> Option<u32> {
    let bytes = table.get(at..at + 4)?;
    Some(u32::from_le_bytes(bytes.try_into().ok()?))
}

/// The place of any number of a table.
fn any(bytes: &mut Bytes, table: &[u8], size: usize) -> Option<usize> {
    (bytes.u32() as usize)
        .checked_rem(table.len() / size)
        .map(|i| size * i)
}

fn cell(bytes: &mut Bytes, table: &mut [u8]) -> Option<String> {
    let at = any(bytes, table, 8)?;
    let place: &mut [u8; 8] = (&mut table[at..at + 8]).try_into().ok()?;
    let old = f64::from_le_bytes(*place);
    let value = old * bytes.one_of(&[0.9, 0.99, 1.0 - 1e-9, 1.0 + 1e-9, 1.01, 1.1]);
    *place = value.to_le_bytes();
    Some(format!("cell {}: {old} to {value}", at / 8))
}

/// A cell loses terms to its neighbour, or gets some.
fn bound(bytes: &mut Bytes, table: &mut [u8]) -> Option<String> {
    let at = any(bytes, table, 4)?;
    let old = word(table, at)?;
    let value = bytes.one_of(&[old.wrapping_sub(1), old.wrapping_add(1), 0, u32::MAX]);
    table[at..at + 4].copy_from_slice(&value.to_le_bytes());
    Some(format!("first term {}: {old} to {value}", at / 4))
}

/// Two terms that stand together share what they had in another way.
fn shares(bytes: &mut Bytes, table: &mut [u8]) -> Option<String> {
    let at = any(bytes, &table[4..], 4)?;
    let [a, b] = [at, at + 4].map(|at| word(table, at).map(f32::from_bits));
    let sum = a? + b?;
    let first = sum * bytes.one_of(&[0.0, 1e-6, 0.3, 0.9999, 1.0, 1.00001, 1.1]);
    for (at, share) in [(at, first), (at + 4, sum - first)] {
        table[at..at + 4].copy_from_slice(&share.to_le_bytes());
    }
    Some(format!("shares from {}: {first}, {}", at / 4, sum - first))
}

fn scaled(bytes: &mut Bytes, table: &mut [u8]) -> Option<String> {
    let at = any(bytes, table, 4)?;
    let old = f32::from_bits(word(table, at)?);
    let value = old * bytes.one_of(&[0.0, -1.0, 0.5, 0.9, 1.1, 2.0]);
    table[at..at + 4].copy_from_slice(&value.to_le_bytes());
    Some(format!("{old} of the spectrum to {value}"))
}

/// Another node, or the first that is none.
fn node(bytes: &mut Bytes, nodes: u8, table: &mut [u8]) -> Option<String> {
    let at = any(bytes, table, 4)?;
    let node = bytes.below(usize::from(nodes) + 1) as u32;
    table[at..at + 4].copy_from_slice(&node.to_le_bytes());
    Some(format!("tap {} of node {node}", at / 4))
}

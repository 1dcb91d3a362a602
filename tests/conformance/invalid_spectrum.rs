//! Files whose spectrum breaks a rule of section 6.9, or is not declared as section 3 says.

use welkin::format::{Chunk, Head, Kind, Payload, encode, parse};

use crate::common;
use crate::common::spectrum::{CELLS, TAPS, TERMS, with_spectrum};
use crate::files::small_spectral;
use crate::invalid::{Case, forged};

/// Where the arrays of the synthetic spectrum start in its payload.
struct Offsets {
    wavelength: usize,
    first_term: usize,
    term_weight: usize,
    term_extinction: usize,
    tap_node: usize,
    tap_weight: usize,
    extinction: usize,
    example: usize,
}

impl Offsets {
    fn of(head: &Head) -> Self {
        let wavelength = 16;
        let first_term = wavelength + 8 * CELLS;
        let term_weight = first_term + 4 * (CELLS + 1);
        let term_extinction = term_weight + 4 * TERMS;
        let tap_node = term_extinction + 4 * TERMS * head.constituents;
        let tap_weight = tap_node + 4 * TERMS * TAPS;
        let extinction = tap_weight + 4 * TERMS * TAPS;
        Self {
            wavelength,
            first_term,
            term_weight,
            term_extinction,
            tap_node,
            tap_weight,
            extinction,
            example: extinction + 4 * head.visibilities.len() * head.constituents * CELLS,
        }
    }
}

fn case(name: &'static str, shows: &'static str, bytes: Vec<u8>) -> Case {
    Case {
        name,
        shows,
        class: "value",
        needs: Vec::new(),
        bytes,
    }
}

/// One interval on every axis, one field.
fn tiny() -> Head {
    let mut head = small_spectral(&[0.0], &[50e3]);
    head.up.intervals = 1;
    head.down.intervals = 1;
    head.phi_intervals = 1;
    head.elevation.intervals = 1;
    head.fields.truncate(1);
    head
}

/// A file with a spectrum, at one altitude and one visibility.
fn good() -> (Head, Vec<u8>) {
    let head = tiny();
    let chunks = with_spectrum(&head, common::chunks(&head));
    let bytes = encode(&head, &chunks).expect("a valid model");
    (head, bytes)
}

pub fn all() -> Vec<Case> {
    [
        declared(),
        entries(),
        lengths(),
        counts(),
        numbers(),
        tables(),
    ]
    .concat()
}

/// Feature bit and chunk do not go together.
fn declared() -> Vec<Case> {
    let (head, good) = good();
    let plain = encode(&head, &common::chunks(&head)).expect("a valid model");
    let bits = |file: &[u8], bits: u32| forged(file, 12, &bits.to_le_bytes());
    let unknown = case(
        "spectrum-and-more",
        "beside the bit of the spectrum one that nobody knows",
        bits(&good, 5),
    );
    vec![
        case(
            "spectrum-absent",
            "the bit without the chunk",
            bits(&plain, 1),
        ),
        case(
            "spectrum-undeclared",
            "the chunk without the bit",
            bits(&good, 0),
        ),
        Case {
            class: "feature",
            ..unknown
        },
    ]
}

fn entries() -> Vec<Case> {
    let (_, good) = good();
    let head_length = parse(&good).expect("a valid file").head_length;
    let entry = |at: usize, change: &[u8]| forged(&good, head_length - 64 + at, change);
    vec![
        case(
            "spectrum-altitude",
            "a spectrum of an altitude",
            entry(4, &[0, 0]),
        ),
        case(
            "spectrum-visibility",
            "a spectrum of a visibility",
            entry(6, &[0, 0]),
        ),
        case("spectrum-rank", "a spectrum with a rank", entry(40, &[1])),
        case(
            "spectrum-twice",
            "two spectra",
            common::with_entry(&good, |_| {}),
        ),
    ]
}

fn lengths() -> Vec<Case> {
    let (_, good) = good();
    let contents = parse(&good).expect("a valid file");
    let index = contents.index[&(Kind::Spectrum, None, None)];
    let entry = &contents.directory[index];
    let payload = &good[entry.offset..][..entry.length];
    let stored = |bytes: &[u8]| common::with_chunk(&good, index, bytes);
    vec![
        case("spectrum-empty", "a spectrum of no bytes", stored(&[])),
        case(
            "spectrum-counts-short",
            "ends within the counts",
            stored(&payload[..15]),
        ),
        case(
            "spectrum-short",
            "the last example lacks a number",
            stored(&payload[..payload.len() - 4]),
        ),
        case(
            "spectrum-long",
            "bytes after the examples",
            stored(&[payload, &[0; 4]].concat()),
        ),
    ]
}

/// A number of one of the arrays is changed.
fn forge(name: &'static str, shows: &'static str, at: usize, change: &[u8]) -> Case {
    let (_, good) = good();
    let contents = parse(&good).expect("a valid file");
    let entry = contents.directory[contents.index[&(Kind::Spectrum, None, None)]];
    case(name, shows, forged(&good, entry.offset + at, change))
}

fn counts() -> Vec<Case> {
    let count = |name, shows, i: usize, n: u32| forge(name, shows, 4 * i, &n.to_le_bytes());
    vec![
        count("spectrum-one-cell", "one cell", 0, 1),
        count("spectrum-cells", "more than 4096 cells", 0, 4097),
        count("spectrum-cells-huge", "2^32 - 1 cells", 0, u32::MAX),
        count("spectrum-no-taps", "no taps", 1, 0),
        count("spectrum-17-taps", "17 taps", 1, 17),
        count(
            "spectrum-few-terms",
            "fewer terms than cells",
            2,
            CELLS as u32 - 1,
        ),
        count("spectrum-terms", "more than 65536 terms", 2, 65_537),
        count("spectrum-examples", "more than 1024 examples", 3, 1025),
    ]
}

fn numbers() -> Vec<Case> {
    let at = Offsets::of(&good().0);
    let single = |name, shows, at, value: f32| forge(name, shows, at, &value.to_le_bytes());
    vec![
        forge(
            "spectrum-node",
            "a tap that is no node",
            at.tap_node + 4,
            &5u32.to_le_bytes(),
        ),
        single(
            "spectrum-weight",
            "a weight above 1000",
            at.tap_weight,
            1000.1,
        ),
        single(
            "spectrum-weight-low",
            "a weight below -1000",
            at.tap_weight + 8,
            -1000.1,
        ),
        single(
            "spectrum-weight-nan",
            "a weight that is NaN",
            at.tap_weight + 4,
            f32::NAN,
        ),
        single(
            "spectrum-weight-infinite",
            "an infinite weight",
            at.tap_weight,
            f32::INFINITY,
        ),
        single(
            "spectrum-extinction",
            "extinction above 1e6",
            at.extinction + 4,
            1.1e6,
        ),
        single(
            "spectrum-extinction-negative",
            "negative extinction",
            at.extinction,
            -1e-9,
        ),
        single(
            "spectrum-extinction-nan",
            "extinction that is NaN",
            at.extinction,
            f32::NAN,
        ),
        single(
            "spectrum-lines",
            "lines that absorb above 1e6",
            at.term_extinction,
            1.1e6,
        ),
        single(
            "spectrum-lines-negative",
            "lines that shine",
            at.term_extinction + 4,
            -1e-9,
        ),
        single(
            "spectrum-lines-nan",
            "lines that are NaN",
            at.term_extinction,
            f32::NAN,
        ),
        single(
            "spectrum-example",
            "ln L of an example above 100",
            at.example,
            100.1,
        ),
        single(
            "spectrum-example-low",
            "ln L of an example below -100",
            at.example,
            -100.1,
        ),
        single(
            "spectrum-example-nan",
            "an example that is NaN",
            at.example + 4,
            f32::NAN,
        ),
    ]
}

/// Numbers that are sound alone and not together.
fn tables() -> Vec<Case> {
    let (head, _) = good();
    let at = Offsets::of(&head);
    let cells = common::spectrum::spectrum(&head).wavelength;
    let cell = |name, shows, i: usize, nm: f64| {
        forge(name, shows, at.wavelength + 8 * i, &nm.to_le_bytes())
    };
    // Of the second cell.
    let shares = |name, shows, shares: [f32; 2]| {
        let change = shares.map(f32::to_le_bytes).concat();
        forge(name, shows, at.term_weight + 4, &change)
    };
    let first = |name, shows, i: usize, term: u32| {
        forge(name, shows, at.first_term + 4 * i, &term.to_le_bytes())
    };
    let end = head.solar_range()[1];
    vec![
        cell(
            "spectrum-cells-equal",
            "two cells of one wavelength",
            3,
            cells[2],
        ),
        cell(
            "spectrum-cells-fall",
            "cells that do not increase",
            3,
            cells[1],
        ),
        cell("spectrum-cell-nan", "a cell that is NaN", 3, f64::NAN),
        cell(
            "spectrum-before-sun",
            "a cell before solar_start",
            0,
            head.solar_start - 1e-6,
        ),
        cell(
            "spectrum-after-sun",
            "a cell after the solar samples",
            CELLS - 1,
            end + 1e-6,
        ),
        first(
            "spectrum-first-term",
            "terms before those of the first cell",
            0,
            1,
        ),
        first(
            "spectrum-last-term",
            "a term after those of the last cell",
            CELLS,
            TERMS as u32 - 1,
        ),
        first("spectrum-terms-none", "a cell without terms", 1, 0),
        first("spectrum-terms-fall", "cells whose terms go back", 3, 2),
        first("spectrum-terms-huge", "terms beyond the last", 4, u32::MAX),
        many_terms(),
        shares("spectrum-shares", "shares of sum 1.00002", [0.5, 0.500_02]),
        shares("spectrum-shares-low", "shares of sum 0.9", [0.5, 0.4]),
        shares("spectrum-share-negative", "a negative share", [1.1, -0.1]),
        shares("spectrum-share-nan", "a share that is NaN", [1.0, f32::NAN]),
    ]
}

/// Of two cells with 64 terms the first gets one of the second's.
fn many_terms() -> Case {
    let head = tiny();
    let mut spectrum = common::spectrum::spectrum(&head);
    spectrum.wavelength = vec![330.0, 750.0];
    spectrum.first_term = vec![0, 64, 128];
    spectrum.term_weight = [[1.0].as_slice(), &[0.0; 64], &[1.0], &[0.0; 62]].concat();
    spectrum.term_extinction = vec![0.0; 128 * head.constituents];
    spectrum.tap_node = vec![0; 128 * TAPS];
    spectrum.tap_weight = vec![0.3; 128 * TAPS];
    spectrum.extinction = vec![1e-5; 2 * head.constituents];
    let mut chunks = common::chunks(&head);
    let payload = Payload::Spectrum(spectrum);
    chunks.push(Chunk::new(None, None, payload));
    let good = encode(&head, &chunks).expect("64 terms are allowed");
    let contents = parse(&good).expect("a valid file");
    let entry = contents.directory[contents.index[&(Kind::Spectrum, None, None)]];
    let bound = entry.offset + 16 + 8 * 2 + 4;
    case(
        "spectrum-65-terms",
        "a cell of 65 terms",
        forged(&good, bound, &65u32.to_le_bytes()),
    )
}

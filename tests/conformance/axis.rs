//! Files whose visibilities stand for values of another quantity: section 6.11 and 7.10.

use serde_json::Value;
use welkin::format::{AxisTable, Chunk, Head, Kind, Payload, encode, parse};

use crate::common;
use crate::files::small;
use crate::invalid::{self, forged};
use crate::queries;
use crate::{files, tolerated};

/// What a reader is asked that knows the chunk.
pub const QUANTITY: &str = "axis_visibility";
const NEEDS: &str = "axis";
const VISIBILITIES: [f64; 4] = [20e3, 30e3, 59.4e3, 131.8e3];
const OZONE: [f64; 4] = [500.0, 380.0, 250.0, 100.0];

/// One interval on every axis.
fn tiny(visibilities: &[f64]) -> Head {
    let mut head = small(&[0.0], visibilities);
    head.up.intervals = 1;
    head.down.intervals = 1;
    head.phi_intervals = 1;
    head.elevation.intervals = 1;
    head.fields.truncate(2);
    head
}

fn file(visibilities: &[f64], name: &str, unit: &str, values: &[f64]) -> Vec<u8> {
    let head = tiny(visibilities);
    let mut chunks = common::chunks(&head);
    let table = AxisTable {
        name: name.to_owned(),
        unit: unit.to_owned(),
        values: values.to_vec(),
    };
    chunks.insert(0, Chunk::new(None, None, Payload::Axis(table)));
    encode(&head, &chunks).expect("a valid model")
}

pub fn valid() -> Vec<files::Case> {
    let case = |name: &str, shows, bytes: Vec<u8>| files::Case {
        name: name.to_owned(),
        shows,
        needs: vec![NEEDS],
        raw: bytes.clone(),
        bytes,
        brief: true,
    };
    let plain = tiny(&[20e3, 60e3]);
    let longest = ["é".repeat(32), "°".repeat(16)];
    vec![
        case(
            "axis",
            "visibilities that stand for columns of ozone, which decrease",
            file(&VISIBILITIES, "ozone", "DU", &OZONE),
        ),
        case(
            "axis-increasing",
            "values that increase, from below zero; name and unit as long as they may be",
            file(
                &VISIBILITIES,
                &longest[0],
                &longest[1],
                &[-2.0, 0.0, 0.25, 7.0],
            ),
        ),
        case(
            "axis-one",
            "a single node, a number without unit",
            file(&[50e3], "dust", "", &[0.3]),
        ),
        case(
            "axis-absent",
            "values of a file without axis are missing",
            encode(&plain, &common::chunks(&plain)).expect("a valid model"),
        ),
    ]
}

/// A reader that is asked for visibilities need not look at the chunk.
pub fn tolerated() -> Vec<tolerated::Verdict> {
    let good = file(&VISIBILITIES, "ozone", "DU", &OZONE);
    let case = |name: &str, shows, needs: &[&'static str], bytes| files::Case {
        name: name.to_owned(),
        shows,
        needs: needs.to_vec(),
        raw: good.clone(),
        bytes,
        brief: true,
    };
    let mut damaged = good.clone();
    damaged[place(&good)] ^= 1;
    vec![
        (
            case(
                "axis-reserved",
                "reserved bytes of an axis are not zero",
                &[NEEDS],
                changed(&good, 12, &[7]),
            ),
            "value",
        ),
        (
            case(
                "axis-unused-value",
                "an axis that does not move, which no visibility needs",
                &[],
                changed(&good, 24, &OZONE[0].to_le_bytes()),
            ),
            "value",
        ),
        (
            case(
                "axis-unused-damaged",
                "a damaged axis, which no visibility needs",
                &[],
                damaged,
            ),
            "checksum",
        ),
    ]
}

pub fn invalid() -> Vec<invalid::Case> {
    let good = file(&[20e3, 60e3, 90e3], "ozone", "DU", &[500.0, 300.0, 100.0]);
    let case = |name, shows, bytes| invalid::Case {
        name,
        shows,
        class: "value",
        needs: vec![NEEDS],
        bytes,
    };
    let count = |i: usize, n: u32| changed(&good, 4 * i, &n.to_le_bytes());
    let value = |i: usize, v: f64| changed(&good, 16 + 8 * i, &v.to_le_bytes());
    let text = 16 + 8 * 3;
    vec![
        case("axis-nodes", "a node less than visibilities", count(0, 2)),
        case("axis-nameless", "no name", count(1, 0)),
        case("axis-name-long", "a name of 65 bytes", count(1, 65)),
        case("axis-unit-long", "a unit of 33 bytes", count(2, 33)),
        case(
            "axis-length",
            "a byte more than the counts give",
            count(2, 1),
        ),
        case(
            "axis-name-text",
            "a name that is not UTF-8",
            changed(&good, text, &[0xff]),
        ),
        case(
            "axis-unit-text",
            "a unit that is not UTF-8",
            changed(&good, text + 5, &[0xc3]),
        ),
        case("axis-equal", "two equal values", value(1, 500.0)),
        case("axis-turns", "values that fall and rise", value(2, 400.0)),
        case(
            "axis-infinite",
            "an infinite value",
            value(0, f64::INFINITY),
        ),
        case("axis-nan", "a value that is no number", value(1, f64::NAN)),
        case("axis-large", "a value beyond 1e30", value(0, 1.1e30)),
        case(
            "axis-placed",
            "an axis of one visibility",
            forged(&good, directory(&good) + 6, &[0, 0]),
        ),
        case(
            "axis-ranked",
            "an axis with a rank",
            forged(&good, directory(&good) + 40, &[1]),
        ),
    ]
}

/// The chunk stands first.
fn place(file: &[u8]) -> usize {
    let contents = parse(file).expect("a valid file");
    assert_eq!(contents.directory[0].kind, Kind::Axis);
    contents.directory[0].offset
}

fn directory(file: &[u8]) -> usize {
    let contents = parse(file).expect("a valid file");
    contents.head_length - 64 * contents.directory.len()
}

fn changed(file: &[u8], at: usize, bytes: &[u8]) -> Vec<u8> {
    forged(file, place(file) + at, bytes)
}

/// Values at nodes, between them, at ends with rounding, and beyond them.
pub fn queries(case: &files::Case) -> Vec<Value> {
    if case.name == "axis-absent" {
        return vec![asked(1.0, Err("missing"))];
    }
    let (visibilities, values) = stored(&case.bytes);
    let nodes = values.iter().zip(&visibilities);
    let mut all: Vec<Value> = nodes.map(|(p, v)| asked(*p, Ok(*v))).collect();
    for (p, v) in values.windows(2).zip(visibilities.windows(2)) {
        for t in [0.1, 0.618] {
            let inverse = (1.0 - t) / v[0] + t / v[1];
            all.push(asked((1.0 - t) * p[0] + t * p[1], Ok(1.0 / inverse)));
        }
    }
    let [least, most] =
        [f64::min, f64::max].map(|pick| values.iter().copied().reduce(pick).unwrap());
    let size = least.abs().max(most.abs());
    let at = |end: f64| visibilities[values.iter().position(|v| *v == end).unwrap()];
    all.extend([
        asked(most + 1e-10 * size, Ok(at(most))),
        asked(least - 1e-10 * size, Ok(at(least))),
        asked(most + 1e-8 * size, Err("range")),
        asked(least - 1e-8 * size, Err("range")),
    ]);
    all
}

/// Visibilities and values as the specification lays them out.
fn stored(file: &[u8]) -> (Vec<f64>, Vec<f64>) {
    let f64s = |at: usize, n: usize| -> Vec<f64> {
        let cells = file[at..at + 8 * n].chunks_exact(8);
        cells
            .map(|c| f64::from_le_bytes(c.try_into().unwrap()))
            .collect()
    };
    let count = |at: usize| usize::from(u16::from_le_bytes([file[at], file[at + 1]]));
    let [wavelengths, altitudes, visibilities] = [40, 42, 44].map(count);
    (
        f64s(128 + 8 * (wavelengths + altitudes), visibilities),
        f64s(place(file) + 16, visibilities),
    )
}

fn asked(value: f64, answer: Result<f64, &str>) -> Value {
    queries::of_axis(QUANTITY, value, answer)
}

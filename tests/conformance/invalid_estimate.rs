//! Files whose estimates break a rule of section 6.10, or are not declared as section 3 says.

use welkin::format::{Head, Kind, encode, parse};

use crate::common;
use crate::files::small;
use crate::invalid::{Case, forged};

fn case(name: &'static str, shows: &'static str, bytes: Vec<u8>) -> Case {
    Case {
        name,
        shows,
        class: "value",
        needs: Vec::new(),
        bytes,
    }
}

/// One interval on every axis.
fn tiny() -> Head {
    let mut head = small(&[0.0], &[50e3]);
    head.up.intervals = 1;
    head.down.intervals = 1;
    head.phi_intervals = 1;
    head.elevation.intervals = 1;
    head
}

/// A file with estimates, at one altitude and one visibility.
fn good() -> Vec<u8> {
    let head = tiny();
    let (head, chunks) = common::estimated(head.clone(), common::chunks(&head));
    encode(&head, &chunks).expect("a valid model")
}

pub fn all() -> Vec<Case> {
    [declared(), counts(), numbers()].concat()
}

/// Feature bit, chunk and fields do not go together.
fn declared() -> Vec<Case> {
    let (head, good) = (tiny(), good());
    let plain = encode(&head, &common::chunks(&head)).expect("a valid model");
    let bits = |file: &[u8], bits: u32| forged(file, 12, &bits.to_le_bytes());
    let contents = parse(&good).expect("a valid file");
    let metadata = contents.head.metadata.len();
    let entries = 64 * contents.directory.len();
    let fields = contents.head_length - entries - (metadata + 4 * head.fields.len());
    let field = fields / 4 * 4;
    vec![
        case(
            "estimate-absent",
            "the bit without the chunk",
            bits(&plain, 2),
        ),
        case(
            "estimate-undeclared",
            "the chunk without the bit",
            bits(&good, 0),
        ),
        case(
            "estimate-unknown",
            "a field relative to an estimate that the file does not have",
            forged(&good, field + 3, &[3]),
        ),
        case(
            "estimate-far",
            "a field relative to the estimate 255",
            forged(&good, field + 3, &[255]),
        ),
    ]
}

/// A change in the payload of the estimate.
fn changed(at: usize, bytes: &[u8]) -> Vec<u8> {
    let good = good();
    let contents = parse(&good).expect("a valid file");
    let chunk = &contents.directory[contents.index[&(Kind::Estimate, None, None)]];
    forged(&good, chunk.offset + at, bytes)
}

fn counts() -> Vec<Case> {
    let count = |i: usize, n: u32| changed(4 * i, &n.to_le_bytes());
    vec![
        case("estimate-levels", "a single level", count(0, 1)),
        case("estimate-levels-large", "25 levels", count(0, 25)),
        case("estimate-angles", "a single angle", count(1, 1)),
        case("estimate-suns-large", "257 suns", count(2, 257)),
        case("estimate-densities", "a single density", count(3, 1)),
        case("estimate-rings-large", "five rings", count(4, 5)),
        case("estimate-none", "no estimate", count(5, 0)),
        case("estimate-many", "five estimates", count(5, 5)),
        case(
            "estimate-length",
            "a level less than the payload has",
            count(0, 5),
        ),
    ]
}

fn numbers() -> Vec<Case> {
    let number = |at: usize, v: f32| changed(at, &v.to_le_bytes());
    let (head, levels, rings, estimates) = (tiny(), 6, 2, 3);
    let level = 32;
    let ring = level + 4 * levels;
    let scatters = ring + 4 * rings;
    let albedo = scatters + 4 * estimates;
    let density = albedo + 4 * estimates * head.constituents * 8;
    let column = density + 4 * 8 * 17;
    let light = column + 4 * 8 * levels * 5;
    vec![
        case(
            "estimate-sun",
            "a lowest sun above the horizon",
            number(24, 0.1),
        ),
        case(
            "estimate-width",
            "an axis of suns without width",
            number(28, 0.0),
        ),
        case(
            "estimate-ground",
            "a first level above the ground",
            number(level, 1.0),
        ),
        case(
            "estimate-order",
            "levels that do not increase",
            number(level + 8, 1500.0),
        ),
        case(
            "estimate-top",
            "a last level that is not the top",
            number(level + 20, 99e3),
        ),
        case(
            "estimate-ring",
            "a ring below the ground",
            number(ring, -1.0),
        ),
        case(
            "estimate-scatters",
            "a third of two constituents",
            changed(scatters, &[4]),
        ),
        case(
            "estimate-albedo",
            "more light than was scattered",
            number(albedo, 1.5),
        ),
        case(
            "estimate-density",
            "a density below zero",
            number(density, -0.1),
        ),
        case(
            "estimate-column",
            "a column beyond its range",
            number(column, 81.0),
        ),
        case(
            "estimate-nan",
            "light that is no number",
            number(light, f32::NAN),
        ),
    ]
}

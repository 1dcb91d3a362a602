//! `welkin verify`: every byte of a file is covered by a rule.
#![cfg(feature = "cli")]

mod common;

use std::path::Path;
use std::process::Output;

use common::command;
use welkin::format::{Kind, parse, verify};

fn run(bytes: &[u8], arguments: &[&str]) -> Output {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), bytes).unwrap();
    let file = file.path().to_str().unwrap();
    command::run(Path::new("."), &[&["verify", file], arguments].concat(), "")
}

fn json(bytes: &[u8]) -> serde_json::Value {
    let output = run(bytes, &["--json"]);
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn good_files_conform() {
    for bytes in [common::model_bytes(), common::tiny_bytes()] {
        let output = run(&bytes, &[]);
        assert_eq!(output.status.code(), Some(0));
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(text.contains("conforms"), "{text}");
        assert_eq!(json(&bytes)["conforming"], true);
    }
}

#[test]
fn every_flipped_byte_is_found() {
    let bytes = common::tiny_bytes();
    for i in 0..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[i] ^= 1 << (i % 8);
        // The minor version is the one number that a reader takes as it comes, but the checksum covers it.
        assert!(!verify(&damaged).is_empty(), "byte {i}");
    }
}

#[test]
fn every_problem_is_told_with_its_place_and_class() {
    let mut bytes = common::model_bytes();
    let contents = parse(&bytes).unwrap();
    let offsets: Vec<usize> = contents.directory.iter().map(|e| e.offset).collect();
    bytes[offsets[2]] ^= 1;
    bytes[offsets[4] + 9] ^= 8;
    bytes[offsets[7] - 1] = 1;
    let output = run(&bytes, &[]);
    assert_eq!(output.status.code(), Some(1));
    let report = json(&bytes);
    let found: Vec<(u64, &str)> = report["problems"]
        .as_array()
        .unwrap()
        .iter()
        .map(|p| (p["chunk"].as_u64().unwrap(), p["class"].as_str().unwrap()))
        .collect();
    assert_eq!(found, [(2, "checksum"), (4, "checksum"), (7, "value")]);
}

#[test]
fn padding_must_be_zero_though_readers_do_not_look() {
    let bytes = common::tiny_bytes();
    let contents = parse(&bytes).unwrap();
    let rank = common::RANK;
    // Behind the weights of the components, and behind the first row of the azimuth factors.
    for (kind, at) in [(Kind::Radiance, 4 * rank), (Kind::RadianceBasis, 2 * rank)] {
        let entry = contents.directory.iter().find(|e| e.kind == kind).unwrap();
        let mut padded = bytes.clone();
        padded[entry.offset + at] = 1;
        common::seal(&mut padded, &bytes);
        let problems = verify(&padded);
        assert_eq!(problems.len(), 1);
        assert!(problems[0].error.to_string().contains("padding"));
        welkin::Model::from_bytes(padded).unwrap().verify().unwrap();
    }
}

#[test]
fn metadata_must_be_a_json_object() {
    for (metadata, good) in [("{}", true), ("[]", false), ("{", false), ("", false)] {
        let mut head = common::head(&[0.0], &[20e3]);
        head.metadata = metadata.to_owned();
        let bytes = welkin::format::encode(&head, &common::chunks(&head)).unwrap();
        assert_eq!(json(&bytes)["conforming"], good, "{metadata}");
    }
}

#[test]
fn a_file_that_is_not_there_is_code_2() {
    let output = command::call(Path::new("."), "verify /nonexistent/file.welkin");
    assert_eq!(output.status.code(), Some(2));
}

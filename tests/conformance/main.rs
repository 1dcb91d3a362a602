//! The conformance suite of the format: makes it, and checks that the committed one is what this makes.
//!
//! `WELKIN_BLESS=1 cargo test --release --features cli --test conformance` writes it anew.
#![cfg(feature = "zstd")]

#[path = "../common/mod.rs"]
mod common;
mod files;
mod invalid;
mod invalid_segments;
mod queries;

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("format-spec/conformance")
}

/// Every file of the suite with its name, and the manifest.
fn suite() -> (Vec<(String, Vec<u8>)>, Value) {
    let mut files = Vec::new();
    let mut cases = Vec::new();
    for case in files::valid() {
        let name = format!("files/{}.welkin", case.name);
        cases.push(json!({
            "file": name,
            "shows": case.shows,
            "needs": case.needs,
            "queries": queries::of(&case),
        }));
        files.push((name, case.bytes));
    }
    for case in invalid::all() {
        let name = format!("files/x-{}.welkin", case.name);
        cases.push(json!({
            "file": name,
            "shows": case.shows,
            "needs": case.needs,
            "queries": [queries::refused(case.quantity(), case.class)],
        }));
        files.push((name, case.bytes));
    }
    let manifest = json!({
        "format_version": welkin::format::VERSION_MAJOR,
        "relative_tolerance": queries::RELATIVE,
        "cases": cases,
    });
    (files, manifest)
}

#[test]
fn the_committed_suite_is_the_one_made_here() {
    let (mut files, manifest) = suite();
    files.push(("manifest.json".to_owned(), text(&manifest).into_bytes()));
    let bless = std::env::var_os("WELKIN_BLESS").is_some();
    if bless {
        let _ = std::fs::remove_dir_all(folder().join("files"));
        std::fs::create_dir_all(folder().join("files")).unwrap();
    }
    for (name, bytes) in &files {
        let path = folder().join(name);
        if bless {
            std::fs::write(&path, bytes).unwrap();
        }
        assert!(std::fs::read(&path).unwrap() == *bytes, "{name} differs");
    }
    let committed = std::fs::read_dir(folder().join("files")).unwrap().count();
    assert_eq!(committed, files.len() - 1, "files that nothing makes");
    let total: usize = files.iter().map(|(_, bytes)| bytes.len()).sum();
    assert!(total < 3 << 19, "{total} bytes");
}

/// One query per line, so that changes can be read.
fn text(manifest: &Value) -> String {
    let mut text = format!(
        "{{\n\"format_version\": {},\n\"relative_tolerance\": {},\n\"cases\": [",
        manifest["format_version"], manifest["relative_tolerance"]
    );
    let mut between_cases = "";
    for case in manifest["cases"].as_array().into_iter().flatten() {
        text += &format!(
            "{between_cases}\n{{\"file\": {}, \"shows\": {}, \"needs\": {}, \"queries\": [",
            case["file"], case["shows"], case["needs"]
        );
        let queries = case["queries"].as_array().into_iter().flatten();
        let lines: Vec<String> = queries.map(|query| format!("\n {query}")).collect();
        text += &lines.join(",");
        text += "\n]}";
        between_cases = ",";
    }
    text + "\n]\n}\n"
}

#[test]
fn valid_files_are_valid_and_invalid_ones_are_refused_as_told() {
    for case in files::valid() {
        let problems = welkin::format::verify(&case.bytes);
        assert!(problems.is_empty(), "{}: {problems:?}", case.name);
    }
    for case in invalid::all() {
        let problems = welkin::format::verify(&case.bytes);
        let class = problems.first().map(|p| p.error.class());
        assert_eq!(class, Some(case.class), "{}: {problems:?}", case.name);
    }
}

#[test]
fn this_reader_agrees_with_the_suite() {
    for case in files::valid() {
        let model = welkin::Model::from_bytes(case.bytes.clone()).unwrap();
        for query in queries::of(&case) {
            let answer = common::answer::answer(&model, &queries::line(&query));
            queries::check(&query, answer, &case.name);
        }
    }
}

#[test]
fn this_reader_refuses_what_the_suite_says() {
    for case in invalid::all() {
        let query = queries::refused(case.quantity(), case.class);
        let answer = match welkin::Model::from_bytes(case.bytes.clone()) {
            Ok(model) => common::answer::answer(&model, &queries::line(&query)),
            Err(error) => Err(error.class()),
        };
        queries::check(&query, answer, case.name);
    }
}

#[test]
fn the_example_in_the_specification_is_the_minimal_file() {
    let text = include_str!("../../format-spec/SPEC.md");
    let (_, appendix) = text.split_once("## Appendix A").unwrap();
    let dump = appendix.split("```").nth(1).unwrap();
    let mut bytes = Vec::new();
    for line in dump.trim().lines().filter(|line| *line != "*") {
        let (offset, row) = line.split_once("  ").unwrap();
        let offset = usize::from_str_radix(offset, 16).unwrap();
        let row: Vec<u8> = row
            .split(' ')
            .map(|byte| u8::from_str_radix(byte, 16).unwrap())
            .collect();
        // A star stands for lines like the one before it.
        while bytes.len() < offset {
            bytes.extend_from_within(bytes.len() - 16..);
        }
        bytes.extend(row);
    }
    assert!(bytes == files::minimal());
}

//! The conformance suite of the format: makes it, and checks that the committed one is what this makes.
//!
//! `WELKIN_BLESS=1 cargo test --release --features cli --test conformance` writes it anew.
#![cfg(feature = "zstd")]

mod axis;
#[path = "../common/mod.rs"]
mod common;
mod files;
mod frames;
mod invalid;
mod invalid_chunks;
mod invalid_estimate;
mod invalid_head;
mod invalid_segments;
mod invalid_spectrum;
mod queries;
mod tolerated;

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

/// The verdict of a verifier on a file that breaks no rule.
const CONFORMS: &str = "conforms";

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("format-spec/conformance")
}

/// Every file of the suite with its name, and the manifest.
fn suite() -> (Vec<(String, Vec<u8>)>, Value) {
    let mut files = Vec::new();
    let mut cases = Vec::new();
    let valid = files::valid().into_iter().map(|case| (case, "", CONFORMS));
    let tolerated = tolerated::all().into_iter();
    let tolerated = tolerated.map(|(case, class)| (case, "v-", class));
    for (case, prefix, verdict) in valid.chain(tolerated) {
        let name = format!("files/{prefix}{}.welkin", case.name);
        cases.push(json!({
            "file": name,
            "shows": case.shows,
            "needs": case.needs,
            "verdict": verdict,
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
            "verdict": case.class,
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
    assert!(total < 10 << 18, "{total} bytes");
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
            "{between_cases}\n{{\"file\": {}, \"shows\": {}, \"needs\": {}, \"verdict\": {}, \"queries\": [",
            case["file"], case["shows"], case["needs"], case["verdict"]
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
    for (case, expected) in tolerated::all() {
        let problems = welkin::format::verify(&case.bytes);
        // The command looks at metadata, the library does not.
        if case.name.starts_with("metadata") {
            assert!(problems.is_empty(), "{}: {problems:?}", case.name);
            continue;
        }
        assert!(!problems.is_empty(), "{}", case.name);
        for problem in problems {
            assert_eq!(problem.error.class(), expected, "{}", case.name);
        }
    }
}

#[cfg(feature = "cli")]
#[test]
fn the_command_gives_the_verdicts_of_the_suite() {
    let (files, manifest) = suite();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("file.welkin");
    for ((name, bytes), case) in files.iter().zip(manifest["cases"].as_array().unwrap()) {
        std::fs::write(&path, bytes).unwrap();
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_welkin"));
        let output = command
            .args(["verify", "--json"])
            .arg(&path)
            .output()
            .unwrap();
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        let first = &report["problems"][0]["class"];
        let verdict = first.as_str().unwrap_or(CONFORMS);
        assert_eq!(case["verdict"], verdict, "{name}: {report}");
        let code = i32::from(verdict != CONFORMS);
        assert_eq!(output.status.code(), Some(code), "{name}");
    }
}

#[test]
fn this_reader_agrees_with_the_suite() {
    let tolerated = tolerated::all().into_iter().map(|(case, _)| case);
    for case in files::valid().into_iter().chain(tolerated) {
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
fn files_with_chunks_that_nobody_knows_can_be_taken_apart_and_put_together() {
    let mut cases = files::valid();
    cases.retain(|case| case.name.starts_with("unknown"));
    assert_eq!(cases.len(), 2);
    for case in cases {
        let (head, chunks) = welkin::format::unpack(&case.bytes).unwrap();
        welkin::format::encode(&head, &chunks).unwrap();
        let bytes = welkin::format::recode(&case.bytes, welkin::format::ENCODING_ZSTD).unwrap();
        assert!(welkin::format::verify(&bytes).is_empty());
        let model = welkin::Model::from_bytes(case.bytes.clone()).unwrap();
        model.verify().unwrap();
        let general = welkin::PointQuery::new(&case.bytes).unwrap();
        general.verify(&case.bytes).unwrap();
    }
}

#[test]
fn the_general_evaluator_agrees_with_the_suite() {
    let tolerated = tolerated::all().into_iter().map(|(case, _)| case);
    for case in files::valid().into_iter().chain(tolerated) {
        let Ok(general) = welkin::PointQuery::new(&case.bytes) else {
            continue;
        };
        let general = general.with_interpolation(welkin::Interpolation::Full);
        for query in queries::of(&case) {
            let (conditions, direction) = queries::scene(&query);
            // Which of two errors comes first is left to readers.
            if query["quantity"] == "relative_radiance_at" {
                let wavelength = query["wavelength"].as_f64().expect("a number");
                let light = general.relative_radiance_at(&conditions, direction, wavelength);
                let answer = light.map(|l| vec![l]).map_err(|error| error.class());
                queries::check(&query, answer, &case.name);
            }
            if query["quantity"] == "relative_radiance" && direction != [0.0; 3] {
                let mut row = vec![0.0; general.wavelengths().len()];
                let done = general.relative_radiance(&conditions, direction, &mut row);
                let answer = done.map(|()| row).map_err(|error| error.class());
                queries::check(&query, answer, &case.name);
            }
        }
    }
}

/// What one reader refuses at open, the other refuses for the same reason.
#[test]
fn the_general_evaluator_opens_what_a_model_opens() {
    let (files, _) = suite();
    for (name, bytes) in files {
        let model = welkin::Model::from_bytes(bytes.clone()).map(drop);
        let general = welkin::PointQuery::new(&bytes).map(drop);
        match (model, general) {
            (Ok(()), Err(error)) => {
                // A model looks at its spectrum and estimates later.
                let model = welkin::Model::from_bytes(bytes).expect("it opened before");
                let spectrum = model.wavelength_range().map_err(|error| error.class());
                let sky = model.sky(&welkin::Conditions {
                    altitude: model.altitude_range()[0],
                    visibility: model.visibility_range()[0],
                    ..welkin::Conditions::default()
                });
                let later = [spectrum.err(), sky.map_err(|error| error.class()).err()];
                assert!(
                    ["limit", "encoding"].contains(&error.class())
                        || later.contains(&Some(error.class())),
                    "{name}: {error}"
                );
            }
            (Err(expected), got) => {
                let got = got.expect_err(&name);
                assert_eq!(got.class(), expected.class(), "{name}: {got}");
            }
            (Ok(()), Ok(())) => {}
        }
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

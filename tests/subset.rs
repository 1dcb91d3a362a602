//! `welkin subset`: smaller files that keep their promise, and writers that never leave half a file.
#![cfg(feature = "cli")]

mod common;

use std::path::Path;
use std::process::{Command, Output};

use common::command::welkin;
use serde_json::Value;
use welkin::{Conditions, Model};

/// The test model without some of it.
fn subset(folder: &Path, arguments: &[&str]) -> Output {
    std::fs::write(folder.join("source.welkin"), common::model_bytes()).unwrap();
    subset_of_source(folder, arguments)
}

fn subset_of_source(folder: &Path, arguments: &[&str]) -> Output {
    let files = "subset --model source.welkin --out small.welkin --json";
    let all: Vec<&str> = files.split(' ').chain(arguments.iter().copied()).collect();
    welkin(folder, &all).output().unwrap()
}

fn report(output: &Output) -> Value {
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{text}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn spectrum(model: &Model, altitude: f64, visibility: f64) -> Vec<f32> {
    let sky = model
        .sky(&Conditions {
            altitude,
            visibility,
            ..Conditions::default()
        })
        .unwrap();
    let mut out = vec![0.0; sky.wavelengths().len()];
    sky.radiance([0.3, 0.1, 0.4], &mut out).unwrap();
    out
}

#[test]
fn a_crop_without_tolerance_changes_nothing_in_its_ranges() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = [
        "--altitudes",
        "0..100",
        "--visibilities",
        "70..131.8",
        "--zstd",
    ];
    let report = report(&subset(folder.path(), &arguments));
    assert_eq!(report["difference_to_source"]["max"], 0.0);
    let path = folder.path().join("small.welkin");
    let small = Model::open(&path).unwrap();
    assert!(report["bytes"].as_u64() < report["source_bytes"].as_u64());
    assert_eq!(small.head().altitudes, [0.0, 120.0, 1000.0]);
    let source = Model::from_bytes(common::model_bytes()).unwrap();
    for (altitude, visibility) in [(0.0, 70e3), (50.0, 80e3), (100.0, 131.8e3)] {
        assert_eq!(
            spectrum(&small, altitude, visibility),
            spectrum(&source, altitude, visibility)
        );
    }
    assert!(welkin::format::verify(&std::fs::read(path).unwrap()).is_empty());
    let metadata: Value = serde_json::from_str(&small.head().metadata).unwrap();
    assert_eq!(
        metadata["subset"]["for_altitudes_m"],
        serde_json::json!([0.0, 100.0])
    );
    assert!(metadata["provenance"].is_string());
}

#[test]
fn wavelengths_can_be_cut_and_colour_folded() {
    let folder = tempfile::tempdir().unwrap();
    let cut = report(&subset(folder.path(), &["--wavelengths", "320..360"]));
    assert_eq!(cut["difference_to_source"]["max"], 0.0);
    let small = Model::open(folder.path().join("small.welkin")).unwrap();
    assert!(small.wavelengths().len() < 6);

    let colour = report(&subset(folder.path(), &["--rgb", "--tolerance", "2%"]));
    assert!(colour["wavelengths_nm"].as_array().unwrap().len() < 6);
    assert!(colour["difference_to_source"]["p99"].as_f64().unwrap() < 0.02);
    let small = Model::open(folder.path().join("small.welkin")).unwrap();
    let source = Model::from_bytes(common::model_bytes()).unwrap();
    let xyz = |model: &Model| {
        let sky = model.sky(&Conditions::default()).unwrap();
        sky.xyz([0.5, 0.1, 0.3]).unwrap()
    };
    for (got, expected) in xyz(&small).into_iter().zip(xyz(&source)) {
        assert!((got / expected - 1.0).abs() < 0.04, "{got} {expected}");
    }
}

#[test]
fn a_range_keeps_its_part_of_a_spectrum() {
    let folder = tempfile::tempdir().unwrap();
    let head = common::head_with(&[0.0, 120.0], &[20e3, 60e3], 14);
    let chunks = common::spectrum::with_spectrum(&head, common::chunks(&head));
    let bytes = welkin::format::encode(&head, &chunks).unwrap();
    let source = Model::from_bytes(bytes.clone()).unwrap();
    let [first, last] = source.wavelength_range().unwrap();
    let (low, high) = (0.6 * first + 0.4 * last, 0.5 * (first + last));
    let range = format!("{low}..{high}");
    let wish = ["--wavelengths", &range];
    report(&subset_in_time(folder.path(), &bytes, &wish));
    let small = Model::open(folder.path().join("small.welkin")).unwrap();
    assert!(small.has_spectrum() && small.wavelengths().len() < source.wavelengths().len());
    let [start, end] = small.wavelength_range().unwrap();
    assert!(first < start && start <= low && high <= end && end < last);
    let at = |model: &Model, nm: f64| {
        let sky = model.sky(&Conditions::default()).unwrap();
        sky.radiance_at([0.3, 0.1, 0.4], nm).unwrap()
    };
    for step in 0..=50 {
        let nm = low + (high - low) * f64::from(step) / 50.0;
        assert_eq!(at(&small, nm), at(&source, nm), "{nm}");
    }
    let beyond = format!("{low}..{}", last + 1.0);
    let output = subset_in_time(folder.path(), &bytes, &["--wavelengths", &beyond]);
    let error = String::from_utf8(output.stderr).unwrap();
    assert!(error.contains("wavelengths must be a range in"), "{error}");
}

#[test]
fn a_wider_tolerance_keeps_less_and_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let all = welkin::format::parse(&common::model_bytes()).unwrap();
    let mut last = all.directory.len() as u64;
    for tolerance in ["0.001%", "1%", "20%"] {
        let report = report(&subset(folder.path(), &["--tolerance", tolerance]));
        let p99 = report["difference_to_source"]["p99"].as_f64().unwrap();
        let promise: f64 = tolerance.trim_end_matches('%').parse().unwrap();
        assert!(p99 <= promise / 100.0, "{p99} for {tolerance}");
        // The chunks of the source say 0.1 % and 1 %.
        let against_data = &report["error_against_data"];
        assert_eq!(against_data["worst_chunk_median"], 0.001);
        let bound = against_data["p99"].as_f64().unwrap();
        assert!((bound - 0.01 - p99).abs() < 1e-8, "{bound}");
        let chunks = report["chunks"].as_u64().unwrap();
        assert!(chunks <= last);
        last = chunks;
        let small = Model::open(folder.path().join("small.welkin")).unwrap();
        assert_eq!(small.altitude_range(), [0.0, 2000.0]);
    }
    // What all chunks share stays whole.
    assert!(3 * last < 2 * all.directory.len() as u64, "{last}");
}

#[test]
fn extras_and_what_nobody_sees_can_be_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let source = folder.path().join("source.welkin");
    std::fs::write(&source, common::polarised_bytes(0.02)).unwrap();
    let run = |arguments: &[&str]| report(&subset_of_source(folder.path(), arguments));
    let small = || Model::open(folder.path().join("small.welkin")).unwrap();
    run(&["--without", "aerial-perspective"]);
    assert!(small().is_polarised());
    run(&["--without", "aerial-perspective,polarisation"]);
    assert!(!small().is_polarised());
    let ground = run(&["--altitudes", "0", "--without", "polarisation"]);
    assert_eq!(ground["difference_to_source"]["max"], 0.0);
    let packed = run(&["--altitudes", "0", "--without", "polarisation", "--zstd"]);
    assert!(packed["bytes"].as_u64() < ground["bytes"].as_u64());
}

/// The chunks of a model with a luminance of nothing, or of far too much.
fn absurd_files() -> Vec<(&'static str, Vec<u8>)> {
    use welkin::format::{Payload, encode};
    let head = common::head(&[0.0, 120.0], &[20e3, 60e3]);
    let xyz = |value: f64| {
        let mut head = head.clone();
        head.xyz.fill([value; 3]);
        encode(&head, &common::chunks(&head)).unwrap()
    };
    let scale = |value: f32| {
        let mut chunks = common::chunks(&head);
        for chunk in &mut chunks {
            if let Payload::Radiance(factors) = &mut chunk.payload {
                factors.scale.fill(value);
            }
        }
        encode(&head, &chunks).unwrap()
    };
    vec![
        ("colours of zero", xyz(0.0)),
        ("colours below zero", xyz(-1e30)),
        ("scales of zero", scale(0.0)),
        ("scales below zero", scale(-1.0)),
        ("scales that overflow", scale(1e30)),
    ]
}

/// Runs `welkin subset` over a file; panics if it takes more than a minute.
fn subset_in_time(folder: &Path, bytes: &[u8], arguments: &[&str]) -> Output {
    std::fs::write(folder.join("source.welkin"), bytes).unwrap();
    let fixed = "subset --json --model source.welkin --out small.welkin";
    let mut child = welkin(folder, &fixed.split(' ').collect::<Vec<_>>())
        .args(arguments)
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    for _ in 0..600 {
        if child.try_wait().unwrap().is_some() {
            return child.wait_with_output().unwrap();
        }
        std::thread::sleep(std::time::Duration::from_millis(100));
    }
    child.kill().unwrap();
    panic!("subset {arguments:?} has not ended after a minute");
}

#[test]
fn absurd_files_that_conform_are_refused_and_end() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in absurd_files() {
        assert!(welkin::format::verify(&bytes).is_empty(), "{name}");
        // What does not ask for colour can do with any.
        let wishes = [
            ["--rgb", "--zstd"],
            ["--wavelengths", "320..500"],
            ["--tolerance", "1%"],
        ];
        for wish in wishes {
            let output = subset_in_time(folder.path(), &bytes, &wish);
            let error = String::from_utf8(output.stderr.clone()).unwrap();
            let dark = wish[0] == "--rgb" && !name.contains("overflow");
            if dark || output.status.code() != Some(0) {
                assert_eq!(output.status.code(), Some(2), "{name} {wish:?}: {error}");
                assert!(error.contains("invalid "), "{name} {wish:?}: {error}");
                assert!(!folder.path().join("small.welkin").exists(), "{name}");
                continue;
            }
            let difference = &report(&output)["difference_to_source"];
            assert!(difference["max"].is_f64(), "{name} {wish:?}: {difference}");
            std::fs::remove_file(folder.path().join("small.welkin")).unwrap();
        }
    }
}

#[test]
fn impossible_wishes_are_refused_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, text) in [
        (
            &["--altitudes", "0..9000"][..],
            "altitudes must be in 0..2000 m",
        ),
        (
            &["--visibilities", "10..30"],
            "visibilities must be in 20..131.8 km",
        ),
        (
            &["--wavelengths", "100..400"],
            "wavelengths must be a range in 320..760 nm",
        ),
        (&["--altitudes", "5..1"], "LOW not above HIGH"),
        (&["--tolerance", "-1"], "percentage"),
        (&["--altitudes", "NaN"], "LOW not above HIGH"),
    ] {
        let output = subset(folder.path(), arguments);
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{error}");
        assert!(
            error.contains(text) && error.lines().count() == 1,
            "{error}"
        );
        assert!(!folder.path().join("small.welkin").exists());
    }
}

/// Runs `welkin subset` over an existing file in a shell that limits the size of files to 8 KiB.
#[cfg(unix)]
fn with_small_files(before: &str) -> (Output, usize) {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("source.welkin"), common::model_bytes()).unwrap();
    std::fs::write(path("old.welkin"), "what was here before").unwrap();
    let script = format!(
        "{before} ulimit -f 8; exec {} subset --model source.welkin --out old.welkin",
        env!("CARGO_BIN_EXE_welkin")
    );
    let output = Command::new("bash")
        .args(["-c", &script])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let old = std::fs::read_to_string(path("old.welkin")).unwrap();
    assert_eq!(old, "what was here before");
    (output, std::fs::read_dir(folder.path()).unwrap().count())
}

#[cfg(unix)]
#[test]
fn a_write_that_fails_midway_leaves_the_old_file_and_no_other() {
    // With the signal ignored, the write fails as it does on a full disk.
    let (output, files) = with_small_files("trap '' XFSZ;");
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(error.contains("old.welkin"), "{error}");
    assert_eq!(files, 2);
}

#[cfg(unix)]
#[test]
fn a_kill_midway_leaves_the_old_file() {
    use std::os::unix::process::ExitStatusExt;
    // The limit kills the process in the middle of its write.
    let (output, files) = with_small_files("");
    assert_eq!(output.status.signal(), Some(25), "SIGXFSZ");
    assert_eq!(files, 3, "the temporary file shows that it was midway");
}

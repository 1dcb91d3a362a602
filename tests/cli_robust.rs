//! The command against absurd, hostile and changing files: numbers or errors, text that hides nothing, no crash.
#![cfg(feature = "cli")]

mod common;

use std::io::Write;
use std::process::Stdio;

use common::command::{QUANTITIES, run, welkin};
use welkin::format::{Chunk, Head, Payload, encode};

const HEADER: &str = "quantity,visibility_km,albedo,altitude_m,solar_elevation_deg,view_zenith_deg,view_azimuth_deg,wavelength_nm,distance_m\n";

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// A model with everything, changed.
fn forged(change: impl Fn(&mut Head, &mut [Chunk])) -> Vec<u8> {
    let mut head = common::head(&[0.0, 2000.0], &[20e3, 60e3]);
    let mut chunks = common::polarised_chunks(&head, 0.02);
    chunks.extend(common::aerial::chunks(&head, 0.3));
    change(&mut head, &mut chunks);
    let bytes = encode(&head, &chunks).unwrap();
    assert!(welkin::format::verify(&bytes).is_empty());
    bytes
}

fn columns(value: f32) -> Vec<u8> {
    forged(|_, chunks| {
        for chunk in chunks {
            if let Payload::Column(column) = &mut chunk.payload {
                column.values.fill(value);
            }
        }
    })
}

fn absurd_files() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("columns of 88", columns(88.0)),
        ("columns of -1e30", columns(-1e30)),
        ("columns of 1e30", columns(1e30)),
        (
            "a dark sun",
            forged(|head, _| head.solar_irradiance.fill(0.0)),
        ),
        (
            "a sun that overflows",
            forged(|head, _| head.solar_irradiance.fill(f32::MAX)),
        ),
        (
            "colours of 1e30",
            forged(|head, _| head.xyz.fill([1e30, -1e30, 1e30])),
        ),
        ("thick air", forged(|head, _| head.extinction.fill(1e6))),
        (
            "scales of 1e38",
            forged(|_, chunks| {
                for chunk in chunks {
                    if let Payload::Radiance(factors) = &mut chunk.payload {
                        factors.scale.fill(1e38);
                    }
                }
            }),
        ),
    ]
}

#[test]
fn answers_about_absurd_files_are_numbers_or_errors() {
    let folder = tempfile::tempdir().unwrap();
    let mut table = HEADER.to_owned();
    for quantity in QUANTITIES {
        for (elevation, zenith, nm) in [
            (20, 70, 430.0),
            (20, 30, 320.0),
            (-2, 90, 760.0),
            (90, 0, 550.0),
        ] {
            for altitude in [0, 700, 2000] {
                table += &format!("{quantity},40,0.3,{altitude},{elevation},{zenith},0,{nm},\n");
            }
        }
    }
    for (name, bytes) in absurd_files() {
        std::fs::write(folder.path().join("m.welkin"), bytes).unwrap();
        let output = run(folder.path(), &["query", "--model", "m.welkin"], &table);
        assert_eq!(output.status.code(), Some(0), "{name}");
        let mut rows = csv::Reader::from_reader(output.stdout.as_slice());
        let mut count = 0;
        for row in rows.records() {
            let row = row.unwrap();
            let (value, error) = (&row[9], &row[10]);
            count += 1;
            match value.is_empty() {
                true => assert!(!error.is_empty(), "{name}: {row:?}"),
                false => assert!(
                    error.is_empty() && value.parse::<f32>().unwrap().is_finite(),
                    "{name}: {row:?}"
                ),
            }
        }
        assert_eq!(count, 96, "{name}");
    }
}

#[test]
fn pictures_volumes_and_reports_of_absurd_files_hold_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let mut pictures = 0;
    for (name, bytes) in absurd_files() {
        std::fs::write(folder.path().join("m.welkin"), bytes).unwrap();
        for arguments in [
            &["render", "--size", "8"][..],
            &["render", "--size", "8", "--spectral", "--stokes"],
            &["render", "--size", "8", "--quantity", "dolp"],
            &["render", "--size", "8", "--terrain", "hills"],
            &["froxels", "--size", "4x4x4"],
            &["froxels", "--size", "4x4x4", "--spectral"],
        ] {
            let place = [
                "--model",
                "m.welkin",
                "--visibility",
                "40",
                "--out",
                "out.exr",
            ];
            let output = run(folder.path(), &[arguments, &place].concat(), "");
            let error = text(&output.stderr);
            if output.status.code() != Some(0) {
                assert_eq!(
                    output.status.code(),
                    Some(2),
                    "{name} {arguments:?}: {error}"
                );
                assert!(error.contains("invalid "), "{name} {arguments:?}: {error}");
                continue;
            }
            let said = text(&output.stdout);
            let lines = said.lines().filter(|line| !line.contains("wrote"));
            for word in lines.flat_map(str::split_whitespace) {
                assert!(
                    !["NaN", "inf", "-inf"].contains(&word),
                    "{name} {arguments:?}: {said}"
                );
            }
            let image = exr::prelude::read_all_flat_layers_from_file(folder.path().join("out.exr"))
                .unwrap();
            for channel in image
                .layer_data
                .iter()
                .flat_map(|layer| &layer.channel_data.list)
            {
                let sound = channel.sample_data.values_as_f32().all(f32::is_finite);
                assert!(sound, "{name} {arguments:?}: {}", channel.name);
            }
            pictures += 1;
        }
        for arguments in [
            &["info", "--json"][..],
            &["plan", "--json", "--visibilities", "40"],
        ] {
            let output = run(
                folder.path(),
                &[arguments, &["--model", "m.welkin"]].concat(),
                "",
            );
            assert_eq!(output.status.code(), Some(0), "{name}");
            let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
            let numbers = ["file_bytes", "worst_error_p99", "error_p99", "bake_p95"];
            let found = numbers.iter().filter(|key| !json[**key].is_null());
            assert!(found.clone().count() > 1, "{json}");
            found.for_each(|key| assert!(json[*key].is_number(), "{key}"));
        }
    }
    assert!(pictures > 20, "{pictures}");
}

/// Turns writing round, moves the cursor, has no width.
const HOSTILE: &str =
    "a\u{202e}b\u{2066}c\u{200f}d\u{61c}e\u{200b}f\u{2028}g\u{9b}h\u{feff}i\u{7f}j";

fn assert_harmless(what: &str, bytes: &[u8]) {
    let said = text(bytes);
    let hidden =
        |c: &char| (c.is_control() && *c != '\n') || (HOSTILE.contains(*c) && !c.is_ascii());
    assert_eq!(said.chars().find(hidden), None, "{what}: {said:?}");
}

#[test]
fn text_from_files_cannot_hide_anything() {
    let folder = tempfile::tempdir().unwrap();
    let metadata = serde_json::json!({ "title": HOSTILE, HOSTILE: [HOSTILE, "\u{1b}[2J"] });
    let name = format!("{HOSTILE}.welkin");
    let bytes = forged(|head, _| head.metadata = metadata.to_string());
    let path = folder.path().join(&name);
    std::fs::write(&path, &bytes).unwrap();
    for arguments in [
        &["info"][..],
        &["info", "--json"],
        &["plan", "--visibilities", "40"],
        &["plan", "--visibilities", "40", "--json"],
        &["subset", "--out", &format!("small{HOSTILE}")],
        &["subset", "--json", "--out", &format!("small{HOSTILE}")],
        &[
            "render",
            "--size",
            "4",
            "--visibility",
            "40",
            "--out",
            &format!("{HOSTILE}.exr"),
        ],
    ] {
        let output = run(
            folder.path(),
            &[arguments, &["--model", &name]].concat(),
            "",
        );
        assert_eq!(
            output.status.code(),
            Some(0),
            "{arguments:?} {}",
            text(&output.stderr)
        );
        assert!(!output.stdout.is_empty());
        assert_harmless(&format!("{arguments:?}"), &output.stdout);
        assert_harmless(&format!("{arguments:?}"), &output.stderr);
    }
    let output = run(folder.path(), &["info", "--json", "--model", &name], "");
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["metadata"], metadata, "JSON means the same");
    // Files that cannot be opened, and metadata that is no JSON.
    let broken = forged(|head, _| head.metadata = HOSTILE.to_owned());
    std::fs::write(&path, &broken).unwrap();
    for arguments in [
        &["verify", &name][..],
        &["verify", "--json", &name],
        &["verify", &format!("absent{HOSTILE}")],
        &["info", &format!("absent{HOSTILE}")],
        &["query", &format!("absent{HOSTILE}")],
        &["render", &format!("--{HOSTILE}")],
    ] {
        let output = run(folder.path(), arguments, "");
        assert_ne!(output.status.code(), Some(0), "{arguments:?}");
        assert_harmless(&format!("{arguments:?}"), &output.stdout);
        assert_harmless(&format!("{arguments:?}"), &output.stderr);
    }
}

#[test]
fn errors_are_in_the_units_of_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("m.welkin"), forged(|_, _| ())).unwrap();
    for (arguments, expected) in [
        (
            &["render", "--sun-elevation", "95", "--visibility", "40"][..],
            "solar elevation must be in -4.2..=90 degrees, got 95 degrees",
        ),
        (
            &["render", "--sun-azimuth", "inf", "--visibility", "40"],
            "solar azimuth must be finite, got inf",
        ),
        (
            &["froxels", "--sun-elevation", "-30", "--visibility", "40"],
            "solar elevation must be in -4.2..=90 degrees, got -30 degrees",
        ),
        (
            &["plan", "--sun-elevations", "-20..5", "--visibilities", "40"],
            "solar elevation must be in -4.2..=90 degrees, got -20 degrees",
        ),
        (
            &["plan", "--visibilities", "40..90"],
            "visibility must be in 20..=60 km, got 90 km",
        ),
        (
            &["plan", "--visibilities", "40", "--tolerance", "0.01%"],
            "tolerance must be finite and at least 0.03 %, got 0.01 %",
        ),
        (
            &["render", "--visibility", "1e300"],
            "visibility must be in 20..=60 km, got 1e300 km",
        ),
        (
            &["render", "--visibility", "1e-30"],
            "visibility must be in 20..=60 km, got 1e-30 km",
        ),
        (
            &["render", "--visibility", "40", "--altitude", "1e200"],
            "altitude must be in 0..=2000 m, got 1e200 m",
        ),
        (
            &["subset", "--altitudes", "0..1e300", "--out", "small"],
            "altitudes must be in 0..2000 m, got 0..1e300",
        ),
    ] {
        let output = run(
            folder.path(),
            &[arguments, &["--model", "m.welkin"]].concat(),
            "",
        );
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert_eq!(
            text(&output.stderr).trim_end(),
            format!("welkin: {expected}")
        );
    }
}

/// Truncates the model while `query` answers questions about it; the second half of the table needs other chunks.
#[cfg(unix)]
fn truncated_meanwhile(arguments: &[&str]) -> std::process::ExitStatus {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.welkin");
    std::fs::write(&path, forged(|_, _| ())).unwrap();
    let answers = std::fs::File::create(folder.path().join("answers.csv")).unwrap();
    let mut child = welkin(folder.path(), arguments)
        .args(["--model", "m.welkin", "--strict"])
        .stdin(Stdio::piped())
        .stdout(answers)
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut input = child.stdin.take().unwrap();
    input.write_all(HEADER.as_bytes()).unwrap();
    // More than a pipe holds: when it is written, the command has opened its model and reads.
    let row = "relative_radiance,60,0.3,0,20,30,0,550,\n";
    input.write_all(row.repeat(5000).as_bytes()).unwrap();
    std::fs::OpenOptions::new()
        .write(true)
        .open(&path)
        .unwrap()
        .set_len(100)
        .unwrap();
    let _ = input.write_all(b"relative_radiance,30,0.3,1500,20,30,0,550,\n");
    drop(input);
    let status = child.wait().unwrap();
    if status.success() {
        let answers = std::fs::read_to_string(folder.path().join("answers.csv")).unwrap();
        assert_eq!(answers.lines().count(), 5002);
        assert!(
            answers.lines().last().unwrap().contains(",550,,0."),
            "a value"
        );
    }
    status
}

#[cfg(unix)]
#[test]
fn a_model_that_is_read_survives_its_truncation() {
    assert!(truncated_meanwhile(&["--no-map", "query"]).success());
    assert!(truncated_meanwhile(&["query", "--no-map"]).success());
    // As the help says; without this the test would not show anything.
    #[cfg(target_os = "linux")]
    {
        use std::os::unix::process::ExitStatusExt;
        const SIGBUS: i32 = 7;
        assert_eq!(truncated_meanwhile(&["query"]).signal(), Some(SIGBUS));
    }
}

#[test]
fn the_help_of_every_command_that_opens_a_model_tells_of_mapping() {
    let folder = tempfile::tempdir().unwrap();
    for command in [
        "render",
        "contact-sheet",
        "froxels",
        "query",
        "info",
        "plan",
        "subset",
    ] {
        let output = run(folder.path(), &[command, "--help"], "");
        let help = text(&output.stdout);
        assert!(
            help.contains("--no-map") && help.contains("SIGBUS"),
            "{command}: {help}"
        );
    }
}

#[test]
fn no_line_has_hundreds_of_digits() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = forged(|head, chunks| {
        head.xyz.fill([1e30; 3]);
        for chunk in chunks {
            (chunk.error_median, chunk.error_p99) = (f32::MAX, f32::MAX);
            if let Payload::Radiance(factors) = &mut chunk.payload {
                factors.scale.fill(1e36);
            }
        }
    });
    std::fs::write(folder.path().join("m.welkin"), bytes).unwrap();
    let table = format!("{HEADER}transmittance,1e300,0,0,1e-300,1e300,0,1e300,-1e300\n");
    for arguments in [
        &[
            "render",
            "--size",
            "4",
            "--visibility",
            "40",
            "--sun-azimuth",
            "1e300",
            "--out",
            "o",
        ][..],
        &[
            "render",
            "--size",
            "4",
            "--visibility",
            "40",
            "--altitude",
            "1e-300",
            "--out",
            "o",
        ],
        &["plan", "--visibilities", "40", "--stokes"],
        &["info"],
        &["subset", "--tolerance", "1%", "--out", "small.welkin"],
        &["query"],
    ] {
        let output = run(
            folder.path(),
            &[arguments, &["--model", "m.welkin"]].concat(),
            &table,
        );
        let said = text(&output.stdout) + &text(&output.stderr);
        assert!(!said.is_empty(), "{arguments:?}");
        let digits = |word: &str| word.chars().filter(char::is_ascii_digit).count();
        let words = said.split(|c: char| c != '.' && !c.is_ascii_alphanumeric());
        let longest = words.map(digits).max();
        assert!(longest < Some(25), "{arguments:?}: {said}");
    }
}

//! `welkin-fit atmosphere`: the air that it writes is the air that is traced.

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};
use welkin_fitter::atmosphere::{Atmosphere, json::Case, real};
use welkin_fitter::tracer::{Options, Query, Tracer};

const WAVELENGTHS: [f64; 5] = [320.0, 440.0, 550.0, 602.5, 760.0];

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_welkin-fit"))
        .args(arguments)
        .output()
        .unwrap()
}

/// The text of the exported file.
fn export(visibility: f64, wavelengths: &[f64], out: &Path) -> String {
    let list: Vec<String> = wavelengths.iter().map(f64::to_string).collect();
    let output = run(&[
        "atmosphere",
        "--visibility",
        &visibility.to_string(),
        "--wavelengths",
        &list.join(","),
        "--out",
        out.to_str().unwrap(),
    ]);
    assert!(output.status.success(), "{output:?}");
    std::fs::read_to_string(out).unwrap()
}

/// Vertical, slanted, horizontal and descending lines, to their end and cut, from all altitudes.
fn lines() -> Vec<Query> {
    let mut lines = vec![];
    for altitude in [0.0, 150.0, 1999.0, 8000.0, 30_000.0, 99_000.0] {
        for zenith in [0.0, 30.0, 75.0, 88.0, 90.0, 90.5, 93.0, 120.0, 180.0_f64] {
            for distance in [None, Some(10.0), Some(5e3), Some(300e3)] {
                lines.push(Query {
                    altitude,
                    view_zenith: zenith.to_radians(),
                    view_azimuth: 0.0,
                    sun_elevation: 0.5,
                    distance,
                });
            }
        }
    }
    lines
}

fn optical_depths(air: &Atmosphere) -> Vec<f64> {
    let tracer = Tracer::new(air, Options::default()).unwrap();
    let depth = |line| tracer.optical_depth(line).unwrap();
    lines().iter().flat_map(depth).collect()
}

#[test]
fn the_file_has_the_optical_depths_of_the_built_in_air() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("air.json");
    for visibility in [20.0, 33.0, 131.8] {
        for wavelengths in [&WAVELENGTHS[..], &WAVELENGTHS[2..3]] {
            let case = Case::parse(&export(visibility, wavelengths, &file)).unwrap();
            let air = real(1e3 * visibility, wavelengths).unwrap();
            assert_eq!(case.atmosphere.wavelengths, wavelengths);
            let (written, built_in) = (optical_depths(&case.atmosphere), optical_depths(&air));
            assert_eq!(written.len(), 6 * 9 * 4 * wavelengths.len());
            for (a, b) in written.iter().zip(&built_in) {
                assert!((a - b).abs() <= 1e-9 * b, "{visibility} km: {a} for {b}");
            }
        }
    }
}

/// What another program would compute from the numbers in the file, without any code of this one.
#[test]
fn a_trapezium_rule_over_the_file_gives_the_vertical_optical_depth() {
    let folder = tempfile::tempdir().unwrap();
    let text = export(59.4, &WAVELENGTHS, &folder.path().join("air.json"));
    let file: Value = serde_json::from_str(&text).unwrap();
    let numbers = |v: &Value| -> Vec<f64> {
        let list = v.as_array().unwrap();
        list.iter().map(|x| x.as_f64().unwrap()).collect()
    };
    assert_eq!(file["planet_radius_m"], 6_378_000.0);
    assert_eq!(file["toa_altitude_m"], 100_000.0);
    let z = numbers(&file["altitude_m"]);
    let air = real(59.4e3, &WAVELENGTHS).unwrap();
    let species = file["species"].as_array().unwrap();
    assert_eq!(
        species.len(),
        11,
        "air, ozone at three temperatures, water, three particles in two layers"
    );
    for w in 0..WAVELENGTHS.len() {
        let column = |species: &Value| -> f64 {
            let e = numbers(&species["extinction_per_m"][w]);
            let steps = z.windows(2).zip(e.windows(2));
            steps
                .map(|(z, e)| 0.5 * (e[0] + e[1]) * (z[1] - z[0]))
                .sum()
        };
        let scattered = |species: &Value| match species["single_scattering_albedo"][w].as_f64() {
            Some(albedo) => albedo * column(species),
            None => 0.0,
        };
        let there: f64 = species.iter().map(column).sum();
        let expected: f64 = (0..air.constituents.len())
            .map(|k| air.vertical_optical_depth(k, w))
            .sum();
        assert!((there / expected - 1.0).abs() < 1e-9);
        let there: f64 = species.iter().map(scattered).sum();
        let constituents = air.constituents.iter().enumerate();
        let expected: f64 = constituents
            .map(|(k, c)| {
                let share: f64 = c.scatterers.iter().map(|s| s.scattering[w]).sum();
                let part = share / c.extinction[w].max(f64::MIN_POSITIVE);
                air.vertical_optical_depth(k, w) * part
            })
            .sum();
        assert!((there / expected - 1.0).abs() < 1e-9);
    }
}

/// With the same random numbers the two differ by the rounding of a product only.
#[test]
fn tracing_the_file_gives_the_radiance_of_the_built_in_air() {
    let folder = tempfile::tempdir().unwrap();
    let [file, queries] = ["air.json", "queries.csv"].map(|name| folder.path().join(name));
    export(40.0, &[440.0, 550.0], &file);
    let rows = "altitude_m,view_zenith_deg,view_azimuth_deg,distance_m\n\
                0,45,90,\n0,89,10,\n2000,95,120,\n0,60,0,5000\n";
    std::fs::write(&queries, rows).unwrap();
    let trace = |source: &[&str]| {
        let common = ["trace", "--target-error", "5%", "--seed", "7", "--queries"];
        let output = run(&[&common[..], &[queries.to_str().unwrap()], source].concat());
        assert!(output.status.success(), "{output:?}");
        let mut reader = csv::Reader::from_reader(&output.stdout[..]);
        let cells = reader.records().flat_map(|record| {
            let record = record.unwrap();
            record.iter().map(str::to_owned).collect::<Vec<_>>()
        });
        cells
            .filter_map(|c| c.parse::<f64>().ok())
            .collect::<Vec<f64>>()
    };
    let built_in = trace(&[
        "--visibility",
        "40",
        "--wavelengths",
        "440,550",
        "--solar-elevation",
        "20",
        "--albedo",
        "0.2",
    ]);
    let written = trace(&["--atmosphere", file.to_str().unwrap()]);
    assert_eq!(written.len(), built_in.len());
    assert!(written.len() > 8 * 7);
    for (a, b) in written.iter().zip(&built_in) {
        assert!((a - b).abs() <= 1e-8 * b.abs(), "{a} for {b}");
    }
}

/// The file of a varied air says so, and has its ozone and its particles.
#[test]
fn varied_air_is_written() {
    let read = |more: &[&str]| {
        let start = ["atmosphere", "--visibility", "59.4", "--wavelengths", "600"];
        let output = run(&[&start[..], more].concat());
        assert!(output.status.success(), "{output:?}");
        Case::parse(&String::from_utf8(output.stdout).unwrap()).unwrap()
    };
    let at = |case: &Case, altitude: f64| case.atmosphere.extinction(altitude, 0);
    let usual = read(&[]);
    let none = read(&["--ozone", "0"]);
    assert!(at(&none, 22_000.0) < 0.9 * at(&usual, 22_000.0));
    assert_ne!(none.id, usual.id);
    let one = read(&["--aerosol-profile", "exponential"]);
    assert!(at(&one, 3000.0) > 1.2 * at(&usual, 3000.0));
    let sharp = read(&["--aerosol-profile", "sharp"]);
    assert!(at(&sharp, 1999.0) > 1.5 * at(&sharp, 2001.0));
}

#[test]
fn bad_input_is_one_line_and_exit_code_2_and_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("air.json");
    let good = [("--visibility", "40"), ("--wavelengths", "550")];
    for (option, value, what) in [
        ("--visibility", "10", "visibility"),
        ("--visibility", "-40", "visibility"),
        ("--visibility", "NaN", "visibility"),
        ("--wavelengths", "200", "wavelengths"),
        ("--wavelengths", "inf", "wavelengths"),
        ("--wavelengths", "550,440", "wavelengths must increase"),
        ("--wavelengths", "550,550", "wavelengths must increase"),
        ("--albedo", "1.5", "ground_albedo"),
        ("--albedo", "-0.1", "ground_albedo"),
        ("--albedo", "NaN", "ground_albedo"),
        ("--solar-elevation", "91", "sun_elevation_deg"),
        ("--solar-elevation", "inf", "sun_elevation_deg"),
        ("--ozone", "-1", "ozone"),
        ("--ozone", "NaN", "ozone"),
        ("--out", "/nowhere/air.json", "/nowhere/air.json"),
    ] {
        let mut arguments = vec!["atmosphere", option, value];
        for (name, value) in good.into_iter().filter(|(name, _)| *name != option) {
            arguments.extend([name, value]);
        }
        if option != "--out" {
            arguments.extend(["--out", out.to_str().unwrap()]);
        }
        let output = run(&arguments);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{option} {value}: {message}");
        assert_eq!(message.trim_end().lines().count(), 1, "{message}");
        assert!(message.contains(what), "{what}: {message}");
        assert!(!out.exists(), "{option} {value}");
    }
    let output = run(&["atmosphere", "--wavelengths", "550"]);
    assert_eq!(output.status.code(), Some(2));
}

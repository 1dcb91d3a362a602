//! Files whose visibilities stand for values of another quantity.

mod common;

use welkin::format::{
    AxisTable, Chunk, Head, Payload, Selection, crop, encode, extend, parse, unpack, verify,
};
use welkin::{Conditions, Error, Model};

const VISIBILITIES: [f64; 4] = [20e3, 30e3, 59.4e3, 131.8e3];
const OZONE: [f64; 4] = [500.0, 380.0, 250.0, 100.0];

fn head() -> Head {
    common::head_with(&[0.0, 900.0], &VISIBILITIES, 4)
}

fn table(values: &[f64]) -> AxisTable {
    AxisTable {
        name: "ozone".to_owned(),
        unit: "DU".to_owned(),
        values: values.to_vec(),
    }
}

fn chunk(table: AxisTable) -> Chunk {
    Chunk::new(None, None, Payload::Axis(table))
}

fn file() -> Vec<u8> {
    let head = head();
    let mut chunks = common::chunks(&head);
    chunks.push(chunk(table(&OZONE)));
    encode(&head, &chunks).unwrap()
}

fn minor(file: &[u8]) -> u16 {
    u16::from_le_bytes([file[10], file[11]])
}

#[test]
fn a_value_is_a_visibility_and_back() {
    let model = Model::from_bytes(file()).unwrap();
    let axis = model.axis().unwrap().unwrap();
    assert_eq!(
        (axis.name(), axis.unit(), axis.range()),
        ("ozone", "DU", [100.0, 500.0])
    );
    for (value, visibility) in OZONE.into_iter().zip(VISIBILITIES) {
        assert_eq!(axis.visibility(value).unwrap(), visibility);
        assert_eq!(axis.value(visibility).unwrap(), value);
    }
    let mut last = 0.0;
    for i in 0..=1000 {
        let value = 500.0 - 0.4 * f64::from(i);
        let visibility = axis.visibility(value).unwrap();
        assert!(visibility > last, "{value}: {visibility} after {last}");
        assert!((axis.value(visibility).unwrap() - value).abs() < 1e-9);
        last = visibility;
    }
    let half = axis.visibility(0.5 * (380.0 + 250.0)).unwrap();
    assert!((1.0 / half - 0.5 * (1.0 / 30e3 + 1.0 / 59.4e3)).abs() < 1e-18);
}

#[test]
fn what_is_beyond_the_values_is_refused_and_named() {
    let axis = Model::from_bytes(file()).unwrap().axis().unwrap().unwrap();
    assert_eq!(axis.visibility(500.0 + 1e-8).unwrap(), 20e3);
    for value in [99.9, 500.1, f64::NAN, f64::INFINITY] {
        let error = axis.visibility(value).unwrap_err();
        assert!(matches!(&error, Error::OutOfAxis { name, .. } if name == "ozone"));
        assert!(
            error
                .to_string()
                .starts_with("ozone must be in 100..=500 DU, got ")
        );
    }
    assert_eq!(axis.value(19e3).unwrap_err().class(), "range");
    let plain = Model::from_bytes(common::model_bytes()).unwrap();
    assert!(plain.axis().unwrap().is_none());
}

#[test]
fn only_files_with_the_chunk_need_the_new_version() {
    let head = head();
    let plain = encode(&head, &common::chunks(&head)).unwrap();
    assert_eq!((minor(&plain), minor(&file())), (0, 3));
    assert_eq!(extend(&plain, &[chunk(table(&OZONE))]).unwrap(), file());
}

/// Light does not depend on what the nodes are called, also for readers that skip the chunk.
#[test]
fn visibilities_are_answered_as_before() {
    let head = head();
    let plain = Model::from_bytes(encode(&head, &common::chunks(&head)).unwrap()).unwrap();
    let named = Model::from_bytes(file()).unwrap();
    let conditions = Conditions {
        visibility: named.axis().unwrap().unwrap().visibility(300.0).unwrap(),
        ..Conditions::default()
    };
    let light = |model: &Model| {
        let mut row = vec![0.0; 4];
        let sky = model.sky(&conditions).unwrap();
        sky.radiance([0.3, 0.1, 0.4], &mut row).unwrap();
        row
    };
    assert_eq!(light(&plain), light(&named));
    let bytes = file();
    let query = welkin::PointQuery::new(&bytes).unwrap();
    let mut row = vec![0.0; 4];
    query
        .radiance(&conditions, [0.3, 0.1, 0.4], &mut row)
        .unwrap();
    assert!(
        row.iter()
            .zip(light(&named))
            .all(|(a, b)| (a / b - 1.0).abs() < 1e-3)
    );
}

#[test]
fn cropping_keeps_values_and_visibilities_together() {
    let (mut head, mut chunks) = unpack(&file()).unwrap();
    let kept = Selection {
        visibilities: vec![1, 3],
        ..Selection::all(&head)
    };
    crop(&mut head, &mut chunks, &kept).unwrap();
    let bytes = encode(&head, &chunks).unwrap();
    assert!(verify(&bytes).is_empty());
    let axis = Model::from_bytes(bytes).unwrap().axis().unwrap().unwrap();
    assert_eq!(axis.values(), [380.0, 100.0]);
    assert_eq!(axis.visibility(380.0).unwrap(), 30e3);
}

#[test]
fn the_writer_refuses_what_readers_refuse() {
    let bad = [
        AxisTable {
            name: String::new(),
            ..table(&OZONE)
        },
        AxisTable {
            name: "x".repeat(65),
            ..table(&OZONE)
        },
        AxisTable {
            unit: "x".repeat(33),
            ..table(&OZONE)
        },
        table(&OZONE[1..]),
        table(&[1.0, 2.0, 2.0, 3.0]),
        table(&[1.0, 2.0, 3.0, 2.5]),
        table(&[1.0, 2.0, 3.0, f64::NAN]),
        table(&[1.0, 2.0, 3.0, 1e31]),
    ];
    for table in bad {
        let error = extend(&file(), &[chunk(table.clone())]).unwrap_err();
        assert_eq!(error.class(), "value", "{table:?}: {error}");
    }
    // In place of the one that is there.
    let renamed = AxisTable {
        name: "dust".to_owned(),
        ..table(&[0.0, 1.0, 2.0, 4.0])
    };
    let bytes = extend(&file(), &[chunk(renamed)]).unwrap();
    assert_eq!(
        parse(&bytes).unwrap().directory.len(),
        parse(&file()).unwrap().directory.len()
    );
    let axis = Model::from_bytes(bytes).unwrap().axis().unwrap().unwrap();
    assert_eq!(
        (axis.name(), axis.visibility(4.0).unwrap()),
        ("dust", 131.8e3)
    );
}

#[cfg(feature = "cli")]
mod command {
    use super::common::command::{call, run};
    use super::*;
    use std::path::Path;

    fn folder() -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("ozone.welkin"), file()).unwrap();
        folder
    }

    fn said(folder: &Path, line: &str) -> serde_json::Value {
        let output = call(folder, line);
        let text = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{line}: {text}");
        serde_json::from_slice(&output.stdout).unwrap()
    }

    fn refusal(folder: &Path, line: &str) -> String {
        let output = call(folder, line);
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}: {text}");
        assert!(output.stdout.is_empty());
        text
    }

    #[test]
    fn info_says_what_the_nodes_stand_for() {
        let folder = folder();
        let info = said(folder.path(), "info ozone.welkin --json");
        let values: Vec<f64> = serde_json::from_value(info["axis"]["values"].clone()).unwrap();
        assert_eq!(
            (info["axis"]["name"].as_str(), values.as_slice()),
            (Some("ozone"), &OZONE[..])
        );
        assert!(said(folder.path(), "info --json").get("axis").is_none());
    }

    #[test]
    fn a_parameter_is_taken_instead_of_the_visibility() {
        let folder = folder();
        let folder = folder.path();
        let visibility = |line: &str| {
            let said = said(folder, &format!("light --json --model ozone.welkin {line}"));
            said["conditions"]["visibility_km"].as_f64().unwrap()
        };
        assert!((visibility("--parameter 250") - 59.4).abs() < 1e-9);
        let refused = |line: &str| refusal(folder, line);
        let ozone = "light --model ozone.welkin --parameter";
        assert!(
            refused(&format!("{ozone} 501")).contains("ozone must be in 100..=500 DU, got 501 DU")
        );
        assert!(refused(&format!("{ozone} nan")).contains("ozone must be in"));
        assert!(refused(&format!("{ozone} 300 --visibility 50")).contains("cannot be used with"));
        assert!(refused(&format!("{ozone} 300 --turbidity 2")).contains("cannot be used with"));
        assert!(refused("light --parameter 300").contains("use --visibility"));
        let output = call(folder, &format!("{ozone} 600 --clamp --json"));
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(text, "welkin: ozone moved from 600 to 500 DU\n");
    }

    /// And nothing is taken for what is not given.
    #[test]
    fn commands_tell_of_the_parameter() {
        let folder = folder();
        let folder = folder.path();
        let told = |line: &str| {
            let output = call(folder, line);
            let text = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{line}: {text}");
            String::from_utf8(output.stdout).unwrap()
        };
        let light = told("light --model ozone.welkin --parameter 345.6");
        assert!(light.contains("  ozone 345.6 DU, albedo 0.2"), "{light}");
        let picture = told("render --size 8 --model ozone.welkin --parameter 345.6 --out a.exr");
        assert!(
            picture.contains("  ozone 345.6 DU, albedo 0.2"),
            "{picture}"
        );
        assert!(!picture.contains("visibility"), "{picture}");
        let file = std::fs::read(folder.join("a.exr")).unwrap();
        let has = |name: &str| file.windows(name.len()).any(|w| w == name.as_bytes());
        assert!(has("parameterValue") && !has("visibilityKm"));
        let said = said(
            folder,
            "light --json --model ozone.welkin --parameter 345.6",
        );
        assert_eq!(said["conditions"]["parameter"]["value"], 345.6);
        for line in [
            "light",
            "render --out b.exr",
            "export --for pbrt --out b",
            "froxels --out b.exr",
        ] {
            let refused = refusal(folder, &format!("{line} --model ozone.welkin"));
            assert!(
                refused.contains("depends on ozone: --parameter 100 to 500 DU is needed"),
                "{refused}"
            );
        }
        assert!(!folder.join("b.exr").exists());
    }

    #[test]
    fn a_table_needs_no_visibilities_beside_a_parameter() {
        let folder = folder();
        let row = "0.2,0,20,30,40,450";
        let columns =
            "albedo,altitude_m,solar_elevation_deg,view_zenith_deg,view_azimuth_deg,wavelength_nm";
        let light = |arguments: &[&str], rows: &str| {
            let all = [&["query", "--strict", "--model", "ozone.welkin"], arguments].concat();
            let output = run(folder.path(), &all, rows);
            let text = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{text}");
            let text = String::from_utf8(output.stdout).unwrap();
            let row = text.lines().nth(1).unwrap();
            row.split(',').nth_back(1).unwrap().parse::<f64>().unwrap()
        };
        let plain = format!("quantity,visibility_km,{columns}\nradiance,59.4,{row}\n");
        let named = format!("quantity,{columns}\nradiance,{row}\n");
        let expected = light(&[], &plain);
        assert!(expected > 0.0);
        assert_eq!(light(&["--parameter", "250"], &named), expected);
        assert_ne!(light(&["--parameter", "300"], &named), expected);
    }
}

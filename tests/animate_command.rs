//! Time-lapses: every frame once, none lost.
#![cfg(feature = "cli")]

mod common;

use std::fs;
use std::path::Path;

use common::command::call;
use exr::prelude::{AttributeValue, Text, read_all_flat_layers_from_file};

fn works(folder: &Path, line: &str) -> String {
    let output = call(folder, line);
    assert!(output.status.success(), "{line}: {output:?}");
    assert!(output.stderr.is_empty(), "{output:?}");
    String::from_utf8(output.stdout).unwrap()
}

fn refusal(folder: &Path, line: &str) -> String {
    let output = call(folder, line);
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{line}: {text}");
    assert_eq!(text.lines().count(), 1, "{text}");
    text
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

fn number(folder: &Path, file: &str, name: &str) -> f32 {
    let image = read_all_flat_layers_from_file(folder.join(file)).unwrap();
    match image.layer_data[0].attributes.other[&Text::from(name)] {
        AttributeValue::F32(value) => value,
        ref other => panic!("{other:?}"),
    }
}

#[test]
fn frames_follow_the_sun() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    works(
        folder,
        "animate --sun-elevation -4..60 --sun-azimuth 10..-20 --frames 3 --size 8 --out day.exr",
    );
    assert_eq!(
        names(folder),
        ["day-0001.exr", "day-0002.exr", "day-0003.exr"]
    );
    for (file, elevation, azimuth) in [
        ("day-0001.exr", -4.0, 10.0),
        ("day-0002.exr", 28.0, -5.0),
        ("day-0003.exr", 60.0, -20.0),
    ] {
        assert!((number(folder, file, "sunElevationDeg") - elevation).abs() < 1e-4);
        assert!((number(folder, file, "sunAzimuthDeg") - azimuth).abs() < 1e-4);
    }
    // Both files of a frame, by date: the sun rises in the east (+x) towards the south (−y).
    works(
        folder,
        "animate --date 2026-06-21 --time 05:00Z..10:00Z --latitude 48 --longitude 11 --frames 2 --size 8 --out morning",
    );
    assert_eq!(names(folder).len(), 7);
    let at = |file| number(folder, file, "sunAzimuthDeg");
    assert!(
        number(folder, "morning-0002.exr", "sunElevationDeg")
            > number(folder, "morning-0001.exr", "sunElevationDeg")
    );
    assert!(at("morning-0001.exr") < 30.0 && at("morning-0002.exr") > 300.0);
}

/// A render of the same moment is the same picture.
#[test]
fn a_frame_is_the_picture_of_its_moment() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    works(
        folder,
        "animate --sun-elevation 5..25 --frames 3 --size 16 --out f.exr",
    );
    works(folder, "render --sun-elevation 15 --size 16 --out one.exr");
    let values = |file: &str| {
        let image = read_all_flat_layers_from_file(folder.join(file)).unwrap();
        let channels = image.layer_data[0].channel_data.list.iter();
        let planes = channels.map(|c| c.sample_data.values_as_f32().collect::<Vec<_>>());
        planes.collect::<Vec<_>>()
    };
    assert_eq!(values("f-0002.exr"), values("one.exr"));
}

#[test]
fn whole_frames_of_the_same_call_are_kept_and_others_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let line = "animate --sun-elevation 1..20 --frames 4 --size 8 --out f";
    assert!(works(folder, line).contains("4, and 0 were there"));
    let bytes = |name: &str| fs::read(folder.join(name)).unwrap();
    let before: Vec<_> = names(folder).iter().map(|name| bytes(name)).collect();
    // Half of a frame is missing: both files of it come again, the others stay.
    fs::remove_file(folder.join("f-0003.png")).unwrap();
    let age = |name: &str| fs::metadata(folder.join(name)).unwrap().modified().unwrap();
    let old = age("f-0002.exr");
    assert!(works(folder, line).contains("1, and 3 were there"));
    assert_eq!(age("f-0002.exr"), old);
    let after: Vec<_> = names(folder).iter().map(|name| bytes(name)).collect();
    assert!(before == after);
    // Another call, a frame that is cut short, and a file of somebody's.
    let other = line.replace("1..20", "2..20");
    assert!(refusal(folder, &other).contains("f-0001.exr is there, and not of this call"));
    let picture = bytes("f-0002.png");
    fs::write(folder.join("f-0002.png"), &picture[..picture.len() - 20]).unwrap();
    assert!(refusal(folder, line).contains("f-0002.png is there"));
    fs::write(folder.join("f-0002.png"), "mine").unwrap();
    assert!(refusal(folder, line).contains("f-0002.png is there"));
    assert_eq!(bytes("f-0002.png"), b"mine");
    assert!(works(folder, &format!("{line} --overwrite")).contains("4, and 0 were there"));
    assert_eq!(bytes("f-0002.png"), picture);
}

#[test]
fn courses_that_the_model_does_not_reach_are_refused_before_the_first_frame() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (line, word) in [
        (
            "animate --sun-elevation 60..-20 --frames 9 --out f",
            "solar elevation must be in -12..=90 degrees, got -20",
        ),
        ("animate --frames 9 --out f", "--sun-elevation"),
        ("animate --sun-elevation 1..2 --frames 0 --out f", "frames"),
        ("animate --sun-elevation 1..2 --out -", "frames need a name"),
        (
            "animate --sun-elevation 1..2 --out missing/frames/f",
            "missing/f",
        ),
        (
            "animate --sun-elevation 1..2 --visibility 5 --out f",
            "visibility must be in",
        ),
        (
            "animate --date 2026-06-21 --time 12:00Z..23:59Z --latitude 48 --longitude 11 --out f",
            "solar elevation must be in",
        ),
    ] {
        let text = refusal(folder, line);
        assert!(text.contains(word), "{line}: {text}");
    }
    assert!(names(folder).is_empty());
    // By name it is allowed.
    let output = call(
        folder,
        "animate --sun-elevation -10..0 --frames 2 --size 4 --clamp --out f",
    );
    assert!(output.status.success(), "{output:?}");
    assert_eq!(names(folder).len(), 4);
}

#[test]
fn the_last_folder_is_made() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let line = "animate --sun-elevation 1..2 --frames 2 --size 4 --out";
    for _ in 0..2 {
        works(folder, &format!("{line} frames/day.png"));
    }
    assert_eq!(
        names(&folder.join("frames")),
        ["day-0001.png", "day-0002.png"]
    );
    let said = refusal(folder, &format!("{line} no/frames/day.png"));
    assert!(said.contains("no/frames: no folder can be made"), "{said}");
    fs::write(folder.join("file"), "").unwrap();
    let said = refusal(folder, &format!("{line} file/day.png"));
    assert!(said.contains("file: is no folder"), "{said}");
    assert_eq!(names(folder), ["file", "frames"]);
}

/// No flicker: the exposure is a smooth function of the sun, and one for all frames if it is given.
#[test]
fn exposure_changes_as_smoothly_as_the_sun() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    works(
        folder,
        "animate --sun-elevation -4..30 --frames 69 --size 2 --out f.exr",
    );
    let values: Vec<f32> = (1..=69)
        .map(|k| number(folder, &format!("f-{k:04}.exr"), "exposureValue"))
        .collect();
    assert!(values[68] > values[0] + 5.0, "{values:?}");
    for three in values.windows(3) {
        assert!(three[1] > three[0], "{three:?}");
        assert!(
            (three[0] - 2.0 * three[1] + three[2]).abs() < 0.08,
            "{three:?}"
        );
    }
    works(
        folder,
        "animate --sun-elevation -4..30 --frames 3 --size 2 --exposure 11.5 --out g.exr",
    );
    for frame in 1..=3 {
        assert_eq!(
            number(folder, &format!("g-000{frame}.exr"), "exposureValue"),
            11.5
        );
    }
}

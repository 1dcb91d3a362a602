//! Pictures in moonlight and from beyond the air.
#![cfg(feature = "cli")]

mod common;

use std::path::Path;

use common::command::call;
use exr::prelude::{AttributeValue, Text, read_all_flat_layers_from_file};

fn works(folder: &Path, line: &str) -> String {
    let output = call(folder, line);
    assert!(output.status.success(), "{line}: {output:?}");
    String::from_utf8(output.stdout).unwrap()
}

fn refusal(folder: &Path, line: &str) -> String {
    let output = call(folder, line);
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{line}: {text}");
    text
}

/// The mean of green, and an attribute.
fn picture(folder: &Path, file: &str, attribute: &str) -> (f64, Option<f32>) {
    let image = read_all_flat_layers_from_file(folder.join(file)).unwrap();
    let layer = &image.layer_data[0];
    let green = layer.channel_data.list.iter().find(|c| c.name.eq("G"));
    let values: Vec<f32> = green.unwrap().sample_data.values_as_f32().collect();
    let mean = values.iter().map(|&v| f64::from(v)).sum::<f64>() / values.len() as f64;
    let number = match layer.attributes.other.get(&Text::from(attribute)) {
        Some(AttributeValue::F32(number)) => Some(*number),
        _ => None,
    };
    (mean, number)
}

#[test]
fn the_moon_adds_its_light() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let at = |sun: &str, more: &str, file: &str| {
        let line = format!(
            "render --size 16 --ground --projection lat-long --sun-elevation {sun} {more} --out {file}"
        );
        works(folder, &line);
        picture(folder, file, "moonPhaseDeg")
    };
    let moon = "--moon-elevation 40 --moon-azimuth 90 --moon-phase 20";
    let (both, phase) = at("-8", moon, "both.exr");
    let (sun, none) = at("-8", "", "sun.exr");
    let (night, _) = at("-50", moon, "night.exr");
    assert_eq!((phase, none), (Some(20.0), None));
    assert!(
        (both / (sun + night) - 1.0).abs() < 1e-5,
        "{both} {sun} {night}"
    );
    assert!((1e-4..2e-2).contains(&night), "{night}");
    // Before the first frame.
    let course =
        "animate --sun-elevation 10..-20 --frames 3 --moon-elevation -20 --size 8 --out frame.exr";
    assert!(refusal(folder, course).contains("both below"));
    assert!(!folder.join("frame-0001.exr").exists());
    for (line, word) in [
        (
            "render --sun-elevation -20 --moon-elevation -20",
            "both below",
        ),
        ("render --moon-elevation 20 --moon-phase 181", "phase angle"),
        ("render --moon-phase 20", "--moon-elevation"),
        ("render --moon-elevation 20 --stokes", "cannot be used with"),
        ("render --moon-elevation 20 --quantity dolp", "polarisation"),
        ("render --sun-elevation -20", "solar elevation must be in"),
    ] {
        let text = refusal(folder, &format!("{line} --size 8 --out none"));
        assert!(text.contains(word), "{line}: {text}");
    }
}

#[test]
fn cameras_beyond_the_air_see_the_planet() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let at = |altitude: &str, more: &str, file: &str| {
        let line = format!(
            "render --size 24 --projection lat-long --sun-elevation 30 --altitude {altitude} {more} --out {file}"
        );
        works(folder, &line);
        picture(folder, file, "altitude").0
    };
    let (near, far) = (at("98000", "", "near.exr"), at("400000", "", "far.exr"));
    let (lit, farther) = (
        at("400000", "--ground", "lit.exr"),
        at("4000000", "", "farther.exr"),
    );
    // The planet gets smaller, and the ground is brighter than the air before it.
    assert!(
        near > far && far > 2.0 * farther && lit > 1.1 * far,
        "{near} {far} {lit} {farther}"
    );
    // The limb towards a sun that is below the camera's horizontal, but not below that of the air there.
    let sunrise = "render --size 64 --projection lat-long --sun-elevation -15 --altitude 400000 --out sunrise.exr";
    works(folder, sunrise);
    assert!(picture(folder, "sunrise.exr", "altitude").0 > 0.0);
    for (line, word) in [
        ("--altitude 400000 --sun", "beyond the air"),
        ("--altitude 400000 --spectral", "beyond the air"),
        ("--altitude 400000 --terrain flat", "beyond the air"),
        ("--altitude 1e12", "altitude must be in"),
    ] {
        let text = refusal(folder, &format!("render {line} --size 8 --out none"));
        assert!(text.contains(word), "{line}: {text}");
    }
}

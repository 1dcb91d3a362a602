//! Pictures of the command: the same on any number of cores, with what they show written into them.
#![cfg(feature = "cli")]

mod common;

use std::path::Path;
use std::process::Output;

use common::command::{self, welkin};
use exr::prelude::{AttributeValue, FlatImage, Text, Vec2, read_all_flat_layers_from_file};

fn run(folder: &Path, line: &str, threads: usize) -> Output {
    welkin(folder, &line.split(' ').collect::<Vec<_>>())
        .env("RAYON_NUM_THREADS", threads.to_string())
        .output()
        .unwrap()
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("m.welkin"),
        common::polarised_bytes(0.02),
    )
    .unwrap();
    folder
}

fn works(folder: &Path, line: &str, threads: usize) -> Output {
    let output = run(folder, line, threads);
    assert!(output.status.success(), "{line}: {output:?}");
    // Standard error is no terminal here: no bar.
    assert!(output.stderr.is_empty(), "{output:?}");
    output
}

#[test]
fn files_do_not_depend_on_the_number_of_threads() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    for (line, files) in [
        (
            "render --size 130 --projection lat-long --out OUT",
            &[".exr", ".png"][..],
        ),
        (
            "render --size 70 --model m.welkin --spectral --out OUT.exr",
            &[".exr"],
        ),
        (
            "render --size 70 --model m.welkin --stokes --out OUT",
            &[".exr", ".png"],
        ),
        (
            "render --size 70 --model m.welkin --stokes --spectral --out OUT.exr",
            &[".exr"],
        ),
        (
            "render --size 40 --model m.welkin --quantity aolp --out OUT",
            &[".exr", ".png"],
        ),
        (
            "render --size 24 --terrain hills --out OUT",
            &[".exr", ".png"],
        ),
        ("froxels --size 5x4x3 --out OUT.raw", &[".raw"]),
        ("froxels --size 5x4x3 --out OUT.exr", &[".exr"]),
        ("contact-sheet --size 16 --out OUT.png", &[".png"]),
    ] {
        for threads in [1, 3] {
            let out = line.replace("OUT", &format!("t{threads}"));
            works(folder.path(), &out, threads);
        }
        for file in files {
            let [one, three] = ["t1", "t3"].map(|t| std::fs::read(path(&format!("{t}{file}"))));
            assert!(one.unwrap() == three.unwrap(), "{line}: {file}");
        }
    }
}

fn read(path: &Path) -> FlatImage {
    read_all_flat_layers_from_file(path).unwrap()
}

fn number(image: &FlatImage, name: &str) -> f32 {
    let own = &image.layer_data[0].attributes.other;
    match &own[&Text::from(name)] {
        AttributeValue::F32(value) => *value,
        other => panic!("{name}: {other:?}"),
    }
}

fn text(image: &FlatImage, name: &str) -> String {
    let own = &image.layer_data[0].attributes.other;
    match &own[&Text::from(name)] {
        AttributeValue::Text(text) => text.to_string(),
        other => panic!("{name}: {other:?}"),
    }
}

const SCENE: &str =
    "--sun-elevation -3 --sun-azimuth -30 --view-azimuth -90 --visibility 40 --albedo 0.5";

#[test]
fn exr_files_say_what_they_show() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let line = format!("render --model m.welkin {SCENE} --altitude 300 --size 8 --out a");
    works(folder.path(), &line, 2);
    let image = read(&path("a.exr"));
    let primaries = image.attributes.chromaticities.unwrap();
    assert_eq!(primaries.red, Vec2(0.64, 0.33));
    assert_eq!(primaries.green, Vec2(0.30, 0.60));
    assert_eq!(primaries.blue, Vec2(0.15, 0.06));
    assert_eq!(primaries.white, Vec2(0.3127, 0.3290));
    let own = &image.layer_data[0].attributes;
    assert_eq!(
        (own.white_luminance, own.altitude),
        (Some(1.0), Some(300.0))
    );
    let software = own.software_name.as_ref().unwrap().to_string();
    assert!(software.starts_with("welkin "));
    for (name, expected) in [
        ("sunElevationDeg", -3.0),
        ("sunAzimuthDeg", -30.0),
        ("viewAzimuthDeg", -90.0),
        ("visibilityKm", 40.0),
        ("groundAlbedo", 0.5),
    ] {
        assert!((number(&image, name) - expected).abs() < 1e-5, "{name}");
    }
    let AttributeValue::FloatVec3((x, y, z)) = own.other[&Text::from("sunDirection")] else {
        panic!("no direction of the sun");
    };
    let (elevation, azimuth) = ((-3f32).to_radians(), (-30f32).to_radians());
    assert!((z - elevation.sin()).abs() < 1e-6);
    assert!((x - elevation.cos() * azimuth.cos()).abs() < 1e-6);
    assert!((y - elevation.cos() * azimuth.sin()).abs() < 1e-6);
    assert_eq!(text(&image, "units"), "cd.m^-2");
    assert_eq!(text(&image, "projection"), "up");
    assert_eq!(text(&image, "model"), "m.welkin");

    let spectral = format!("render --model m.welkin {SCENE} --size 8 --spectral --out s.exr");
    works(folder.path(), &spectral, 2);
    let image = read(&path("s.exr"));
    assert_eq!(text(&image, "units"), "W.m^-2.sr^-1.nm^-1");
    assert!(image.attributes.chromaticities.is_none());

    let line = "render --terrain flat --size 8 --pitch -4 --altitude 100 --out t.exr";
    works(folder.path(), line, 2);
    let image = read(&path("t.exr"));
    assert_eq!(text(&image, "projection"), "perspective");
    assert_eq!(text(&image, "terrain"), "flat");
    assert_eq!(
        (number(&image, "pitchDeg"), number(&image, "fieldOfViewDeg")),
        (-4.0, 40.0)
    );
    assert_eq!(image.layer_data[0].attributes.altitude, Some(102.0));

    works(
        folder.path(),
        "froxels --size 2x2x2 --altitude 50 --out f.exr",
        2,
    );
    let image = read(&path("f.exr"));
    assert_eq!(
        (number(&image, "nearM"), number(&image, "farM")),
        (50.0, 1e5)
    );
    assert_eq!(image.layer_data[0].attributes.altitude, Some(50.0));
    assert!(image.attributes.chromaticities.is_some());
}

/// Whoever finds both can compare them.
#[test]
fn png_files_say_the_same_as_their_exr() {
    let folder = folder();
    let line = format!("render --model m.welkin {SCENE} --size 8 --out a");
    works(folder.path(), &line, 2);
    let image = read(&folder.path().join("a.exr"));
    let file = std::fs::File::open(folder.path().join("a.png")).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(file))
        .read_info()
        .unwrap();
    reader.finish().unwrap();
    let said = |name: &str| {
        let chunks = &reader.info().utf8_text;
        let chunk = chunks.iter().find(|c| c.keyword == name);
        chunk
            .unwrap_or_else(|| panic!("{name}"))
            .get_text()
            .unwrap()
    };
    for name in [
        "sunElevationDeg",
        "sunAzimuthDeg",
        "visibilityKm",
        "groundAlbedo",
        "exposureValue",
    ] {
        assert_eq!(
            said(name).parse::<f32>().unwrap(),
            number(&image, name),
            "{name}"
        );
    }
    assert_eq!(said("model"), text(&image, "model"));
    assert_eq!(said("altitude"), "0");
}

/// From above and towards a mountain, unless something else is said.
#[test]
fn hills_have_a_viewpoint() {
    let folder = folder();
    let show = |more: &str| {
        let line = format!("render --terrain hills --size 4 --out h.exr{more}");
        works(folder.path(), &line, 2);
        let image = read(&folder.path().join("h.exr"));
        let altitude = image.layer_data[0].attributes.altitude.unwrap();
        let view = ["viewAzimuthDeg", "pitchDeg"].map(|name| number(&image, name).round());
        (altitude.round(), view)
    };
    assert_eq!(show(""), (2602.0, [104.0, -5.0]));
    // On the ground, and so the mountain is above.
    assert_eq!(show(" --altitude 1500"), (1585.0, [104.0, 5.0]));
    let given = " --altitude 3000 --view-azimuth 20 --pitch -7";
    assert_eq!(show(given), (3002.0, [20.0, -7.0]));
}

/// One byte per character would do for few names of files.
#[test]
fn models_may_have_any_name() {
    let folder = folder();
    std::fs::rename(
        folder.path().join("m.welkin"),
        folder.path().join("空 é.welkin"),
    )
    .unwrap();
    let name = ["--model", "空 é.welkin"];
    let arguments = [&["render", "--size", "4", "--out", "a"][..], &name].concat();
    let output = command::run(folder.path(), &arguments, "");
    assert!(output.status.success(), "{output:?}");
    let image = read(&folder.path().join("a.exr"));
    let own = &image.layer_data[0].attributes.other;
    let AttributeValue::Text(name) = &own[&Text::from("model")] else {
        panic!("no name");
    };
    assert_eq!(name.as_slice(), "空 é.welkin".as_bytes());
}

#[test]
fn clamping_says_what_it_moved() {
    let folder = folder();
    let line = "render --model m.welkin --clamp --size 4 --sun-elevation -20 --visibility 5 --altitude -5 --out a";
    let output = run(folder.path(), line, 2);
    assert!(output.status.success(), "{output:?}");
    let text = String::from_utf8(output.stderr).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let expected = [
        "welkin: sun elevation moved from -20 to -4.2 degrees",
        "welkin: visibility moved from 5 to 20 km",
        "welkin: altitude moved from -5 to 0 m",
    ];
    assert_eq!(lines, expected);
    works(
        folder.path(),
        "render --model m.welkin --clamp --size 4 --out a",
        2,
    );
}

/// A negative number is a value, never an option that nobody knows.
#[test]
fn negative_values_parse_everywhere() {
    let folder = folder();
    let scene = [
        "sun-elevation",
        "sun-azimuth",
        "view-azimuth",
        "visibility",
        "albedo",
    ];
    let lens = ["pitch", "field-of-view", "altitude"];
    let render = [
        "exposure",
        "wavelength",
        "terrain-width",
        "terrain-height",
        "polariser",
    ];
    let ranges = ["altitudes", "visibilities", "tolerance"];
    // The file has no light of segments: a landscape is refused as soon as its options are understood.
    let commands = [
        (
            "render --model m.welkin --terrain flat --size 2 --out a",
            [&scene[..], &lens, &render].concat(),
        ),
        ("render --out a", vec!["size"]),
        (
            "froxels --size 1x1x1",
            [&scene[..], &lens, &["near", "far"]].concat(),
        ),
        ("contact-sheet", vec!["size"]),
        (
            "light",
            [
                "altitude",
                "sun-elevation",
                "sun-azimuth",
                "visibility",
                "albedo",
            ]
            .to_vec(),
        ),
        ("plan", [&ranges[..], &["sun-elevations"]].concat()),
        (
            "subset --model m.welkin --out a",
            [&ranges[..], &["wavelengths"]].concat(),
        ),
    ];
    for (command, options) in commands {
        for option in options {
            for value in ["-5", "-0.5", "-1e3"] {
                let output = run(folder.path(), &format!("{command} --{option} {value}"), 2);
                let text = String::from_utf8(output.stderr).unwrap();
                assert!(
                    !text.contains("unexpected argument") && !text.contains("subcommand"),
                    "{command} {option}: {text}"
                );
            }
        }
    }
    // A little below the ground is on it.
    let below = "froxels --size 1x1x1 --altitude -5 --out below.exr";
    works(folder.path(), below, 2);
    let output = run(folder.path(), "froxels --altitude -10000", 2);
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(
        text.starts_with("welkin: altitude must be in 0..=")
            && text.ends_with(" m, got -10000 m\n"),
        "{text}"
    );
}

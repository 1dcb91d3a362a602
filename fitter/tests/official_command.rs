//! `welkin-fit official`, `import` and `export` as a user meets them: what is wrong is said, and nothing is lost.

use std::path::Path;
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;
use welkin_fitter::official::Writer;
use welkin_fitter::official::layout::{Axes, Channels, Header, RadianceBreaks};
use welkin_fitter::official::tables::RadianceTables;

fn run(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_welkin-fit"));
    command
        .current_dir(folder)
        .args(arguments)
        .output()
        .unwrap()
}

fn complaint(output: &Output) -> String {
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// One sky of constant radiance, and nothing else: a file that ends after its radiance.
fn file() -> Vec<u8> {
    let breaks = vec![0.0, 1.0, 2.0, 3.25];
    let header = Header {
        axes: Axes {
            visibilities: vec![50.0],
            albedos: vec![0.0],
            altitudes: vec![0.0],
            elevations: vec![30.0],
        },
        channels: Channels {
            count: 1,
            start: 500.0,
            width: 50.0,
        },
        breaks: RadianceBreaks {
            rank: 1,
            sun: breaks.clone(),
            zenith: breaks.clone(),
            emphasis: breaks,
        },
    };
    let mut bytes = vec![];
    let mut writer = Writer::new(&mut bytes, header).unwrap();
    let tables = RadianceTables {
        sun: vec![0.5; 4],
        zenith: vec![0.25; 4],
        emphasis: vec![1.0; 4],
    };
    writer.radiance(&tables).unwrap();
    drop(writer);
    bytes
}

#[test]
fn a_file_says_what_it_is_and_lacks() {
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("sky.dat"), file()).unwrap();
    let output = run(folder.path(), &["official", "info", "sky.dat"]);
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("1 of 50 nm, 500 to 550 nm"), "{text}");
    assert!(text.contains("no transmittance section"), "{text}");
}

#[test]
fn rows_are_answered_or_refused_by_their_number() {
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("sky.dat"), file()).unwrap();
    let header =
        "x,y,z,dx,dy,dz,solar_elevation,solar_azimuth,visibility,albedo,wavelength,distance\n";
    let evaluate = |rows: &str| {
        std::fs::write(folder.path().join("rows.csv"), [header, rows].concat()).unwrap();
        run(
            folder.path(),
            &["official", "evaluate", "sky.dat", "--at", "rows.csv"],
        )
    };
    let output = evaluate("0,0,0,0,0,1,30,0,50,0,525,inf\n0,0,0,0,0,1,30,0,50,0,600,inf\n");
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(
        text,
        "radiance,polarisation,transmittance\n1.25e-1,,\n0e0,,\n"
    );
    let bad = complaint(&evaluate(
        "0,0,0,0,0,1,30,0,50,0,525,inf\n0,0,0,0,0,0,30,0,50,0,525,inf\n",
    ));
    assert!(bad.contains("row 2") && bad.contains("direction"), "{bad}");
    let bad = complaint(&evaluate("0,0,0,0,0,1,30,0,50,0,NaN,inf\n"));
    assert!(bad.contains("row 1") && bad.contains("wavelength"), "{bad}");
    let bad = complaint(&evaluate("0,0,0,0,0,1,30,0,fog,0,525,inf\n"));
    assert!(bad.contains("row 1: visibility: \"fog\""), "{bad}");
    let spaced = evaluate("0, 0, 0, 0, 0, 1, 30, 0, 50, 0, 525, inf\n");
    assert!(spaced.status.success(), "{spaced:?}");
    let none = evaluate("");
    assert!(none.stdout.is_empty());
    assert!(complaint(&none).contains("rows.csv: no row"), "{none:?}");
    let empty = Command::new(env!("CARGO_BIN_EXE_welkin-fit"))
        .current_dir(folder.path())
        .args(["official", "evaluate", "sky.dat", "--at", "-"])
        .stdin(Stdio::null())
        .output()
        .unwrap();
    assert!(complaint(&empty).contains("empty"), "{empty:?}");
}

#[test]
fn nothing_is_said_twice() {
    let folder = TempDir::new().unwrap();
    std::fs::create_dir(folder.path().join("d")).unwrap();
    for arguments in [
        &["export", "prague", "d", "--out", "x.dat"][..],
        &["official", "info", "d"],
    ] {
        let text = complaint(&run(folder.path(), arguments));
        let (path, reason) = (
            text.matches("d: ").count(),
            text.matches("directory").count(),
        );
        assert_eq!((path, reason), (1, 1), "{text}");
    }
}

#[test]
fn an_export_goes_to_a_file_of_its_own() {
    let folder = TempDir::new().unwrap();
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/default.welkin");
    std::fs::copy(model, folder.path().join("own.welkin")).unwrap();
    let export = |out: &str| {
        let arguments = ["export", "prague", "own.welkin", "--out", out];
        complaint(&run(folder.path(), &arguments))
    };
    for stream in ["-", "/dev/null"] {
        assert!(export(stream).contains("must be a file"), "{stream}");
    }
    assert!(export("./own.welkin").contains("the model that is read"));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn an_import_that_fails_leaves_the_target() {
    let folder = TempDir::new().unwrap();
    let target = folder.path().join("sky.welkin");
    std::fs::write(&target, "what was there").unwrap();
    let import = |name: &str| {
        run(
            folder.path(),
            &["import", "prague", name, "--out", "sky.welkin"],
        )
    };
    assert!(complaint(&import("none.dat")).contains("none.dat"));
    let mut short = file();
    short.pop();
    std::fs::write(folder.path().join("short.dat"), short).unwrap();
    let text = complaint(&import("short.dat"));
    assert!(text.contains("ends within its radiance section"), "{text}");
    std::fs::write(folder.path().join("other.dat"), "no such thing").unwrap();
    assert!(complaint(&import("other.dat")).contains("other.dat"));
    assert_eq!(std::fs::read_to_string(&target).unwrap(), "what was there");
}

#[test]
fn a_part_that_a_file_lacks_is_refused() {
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("sky.dat"), file()).unwrap();
    let import = |options: &[&str]| {
        let fixed = ["import", "prague", "sky.dat", "--out", "sky.welkin"];
        run(folder.path(), &[&fixed, options].concat())
    };
    let text = complaint(&import(&["--wavelengths", "600..700"]));
    assert!(text.contains("from 525 to 525 nm"), "{text}");
    for wrong in ["600", "700..600", "a..b", "500..inf"] {
        let text = complaint(&import(&["--wavelengths", wrong]));
        assert!(text.contains("expected LOW..HIGH"), "{text}");
    }
    let text = complaint(&import(&["--leave-out-elevations"]));
    assert!(text.contains("the file has 1 of them"), "{text}");
    assert!(!complaint(&import(&["--visible", "--wavelengths", "500..600"])).is_empty());
    assert!(!folder.path().join("sky.welkin").exists());
}

#[test]
fn an_export_needs_a_model() {
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("bad.welkin"), "no model").unwrap();
    let output = run(
        folder.path(),
        &["export", "prague", "bad.welkin", "--out", "sky.dat"],
    );
    assert!(complaint(&output).contains("bad.welkin"));
    assert!(!folder.path().join("sky.dat").exists());
}

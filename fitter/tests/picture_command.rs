//! `welkin-fit picture` as its users meet it.

use std::path::Path;
use std::process::{Command, Output};

fn picture(directory: &Path, more: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_welkin-fit"))
        .current_dir(directory)
        .args([
            "picture",
            "--width",
            "16",
            "--height",
            "8",
            "--samples",
            "4",
        ])
        .args(more)
        .output()
        .unwrap()
}

#[test]
fn every_projection_gives_files_and_seeds_decide() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let obj = "v -50 0 0\nv 50 0 0\nv 0 80 0\nf 1 2 3\n";
    std::fs::write(path("mesh.obj"), obj).unwrap();
    for projection in ["perspective", "fish-eye", "lat-long"] {
        let run = |seed: &str, out: &str| {
            let more = ["--projection", projection, "--seed", seed, "--exr", out];
            let scene = [
                "--tower", "8,-2,1,4", "--ground", "grid", "--mesh", "mesh.obj",
            ];
            let files = ["--png", "a.png", "--spectral", "--aerosol", "mie"];
            let files = [&files[..], &["--wavelengths", "450,550,650"]].concat();
            let output = picture(folder.path(), &[&more[..], &scene[..], &files[..]].concat());
            assert!(output.status.success(), "{output:?}");
            std::fs::read(path(out)).unwrap()
        };
        let first = run("1", "a.exr");
        assert_eq!(first, run("1", "b.exr"));
        assert_ne!(first, run("2", "c.exr"));
        assert!(
            std::fs::read(path("a.png"))
                .unwrap()
                .starts_with(b"\x89PNG")
        );
    }
}

#[test]
fn bad_input_is_one_line_and_exit_code_2() {
    let folder = tempfile::tempdir().unwrap();
    for (more, what) in [
        (&["--altitude", "200"][..], "altitude"),
        (&["--altitude", "NaN"], "altitude"),
        (&["--samples", "0"], "sample"),
        (&["--altitude", "-0.5"], "altitude"),
        (&["--visibility", "-40"], "visibility"),
        (&["--surface-albedo", "-0.5"], "albedo"),
        (&["--pitch", "NaN"], "pitch"),
        (&["--pitch", "91"], "pitch"),
        (&["--field-of-view", "180"], "field of view"),
        (&["--solar-elevation", "-91"], "sun elevation"),
        (&["--sun-radius", "9"], "sun radius"),
        (&["--albedo", "2"], "albedo"),
        (&["--cell", "0"], "cell"),
        (&["--tower", "1,2,3,-4"], "tower 1: tower height"),
        (&["--tower", "1,1e9,3,4"], "tower 1: distance left"),
        (&["--mesh", "none.obj"], "none.obj"),
        (&["--visibility", "5"], "visibility"),
        (&["--aerosol", "mie", "--wavelengths", "900"], "900"),
        (&["--wavelengths", "500,400"], "increase"),
        (&["--white", "0"], "--white"),
        (&["--ozone", "-1"], "ozone"),
    ] {
        let output = picture(folder.path(), &[more, &["--png", "x.png"]].concat());
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{more:?}");
        assert!(
            message.starts_with("error: ") && message.contains(what),
            "{what}: {message}"
        );
        assert!(!message.contains("unexpected argument"), "{message}");
        assert!(!folder.path().join("x.png").exists());
    }
}

/// Ozone takes red light from twilight, and an exponential puts haze where the layers have none.
#[test]
fn the_air_may_be_varied() {
    let folder = tempfile::tempdir().unwrap();
    let run = |more: &[&str]| {
        let scene = [
            "--solar-elevation",
            "-2",
            "--altitude",
            "4",
            "--png",
            "a.png",
            "--white",
            "100",
        ];
        let output = picture(folder.path(), &[&scene[..], more].concat());
        assert!(output.status.success(), "{output:?}");
        std::fs::read(folder.path().join("a.png")).unwrap()
    };
    let usual = run(&[]);
    assert_eq!(usual, run(&["--aerosol-profile", "smooth"]));
    for varied in [["--ozone", "0"], ["--aerosol-profile", "exponential"]] {
        assert_ne!(usual, run(&varied), "{varied:?}");
    }
}

/// The picture and nothing else, and no file of that name.
#[test]
fn pictures_go_to_standard_output() {
    let folder = tempfile::tempdir().unwrap();
    let named = picture(folder.path(), &["--png", "a.png"]);
    assert!(named.status.success(), "{named:?}");
    let piped = picture(folder.path(), &["--png", "-"]);
    assert!(piped.status.success(), "{piped:?}");
    let file = std::fs::read(folder.path().join("a.png")).unwrap();
    assert_eq!(piped.stdout, file);
    let names = std::fs::read_dir(folder.path()).unwrap();
    assert_eq!(names.count(), 1);
}

#[test]
fn targets_are_checked_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    for more in [
        &["--png", "missing/a.png"][..],
        &["--png", "."],
        &["--exr", "a", "--png", "a"],
        &["--exr", "a.exr", "--png", "missing/a.png"],
    ] {
        let output = picture(folder.path(), more);
        assert_eq!(output.status.code(), Some(2), "{more:?}");
    }
    assert!(std::fs::read_dir(folder.path()).unwrap().next().is_none());
}

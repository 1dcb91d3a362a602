//! `welkin-fit trace` as its users meet it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn atmosphere() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference/sky_O1.json")
}

fn trace(directory: &Path, queries: &str, more: &[&str]) -> Output {
    let file = directory.join("queries.csv");
    std::fs::write(&file, queries).unwrap();
    Command::new(env!("CARGO_BIN_EXE_welkin-fit"))
        .args(["trace", "--target-error", "5%", "--atmosphere"])
        .arg(atmosphere())
        .arg("--queries")
        .arg(file)
        .args(more)
        .output()
        .unwrap()
}

fn column(csv: &str, name: &str) -> Vec<f64> {
    let mut lines = csv.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let i = header.iter().position(|h| *h == name).unwrap();
    lines
        .map(|line| line.split(',').nth(i).unwrap().parse().unwrap())
        .collect()
}

#[test]
fn rows_come_back_with_answers() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("out.csv");
    let queries = "name,altitude_m,view_zenith_deg,view_azimuth_deg,distance_m,albedo,solar_elevation_deg\n\
                   a,0,45,0,,,\n\
                   b,0,45,0,1000,,\n\
                   c,0,45,0,,0.9,\n\
                   d,0,45,0,,,5\n";
    let output = trace(
        directory.path(),
        queries,
        &["--out", out.to_str().unwrap(), "--seed", "3"],
    );
    assert!(output.status.success(), "{output:?}");
    let csv = std::fs::read_to_string(&out).unwrap();
    assert!(csv.starts_with("name,altitude_m,"), "{csv}");
    assert!(csv.contains("\na,0,45,0,,,,"), "{csv}");
    let i = column(&csv, "I");
    assert!(
        i[1] < 0.2 * i[0] && i[2] > 1.1 * i[0] && i[3] < 0.5 * i[0],
        "{i:?}"
    );
    let t = column(&csv, "transmittance");
    assert!(t[1] > t[0] && t[0] > 0.7, "{t:?}");
    assert!(column(&csv, "I_se").iter().all(|&e| e > 0.0));
}

#[test]
fn the_atmosphere_files_own_lines_are_used_without_queries() {
    let output = Command::new(env!("CARGO_BIN_EXE_welkin-fit"))
        .args(["trace", "--orders", "single", "--visible-ground", "black"])
        .arg("--atmosphere")
        .arg(atmosphere())
        .output()
        .unwrap();
    assert!(output.status.success());
    let csv = String::from_utf8(output.stdout).unwrap();
    let i = column(&csv, "I");
    assert_eq!(i.len(), 60);
    assert!((i[0] / 0.0182834993 - 1.0).abs() < 1e-6);
}

#[test]
fn bad_input_is_one_line_and_exit_code_2() {
    let directory = tempfile::tempdir().unwrap();
    let head = "altitude_m,view_zenith_deg,view_azimuth_deg,albedo\n";
    for (rows, what) in [
        ("0,10,0,\n-5,10,0,\n", "row 2: altitude"),
        ("1e6,10,0,\n", "row 1: altitude"),
        ("0,200,0,\n", "row 1: view zenith"),
        ("0,10,x,\n", "row 1: view_azimuth_deg"),
        ("0,10,NaN,\n", "row 1: view_azimuth_deg"),
        ("0,,0,\n", "row 1: view_zenith_deg is missing"),
        ("0,10,0,1.5\n", "row 1: albedo"),
        ("0,10,0\n", "row 1"),
        ("", "no rows"),
    ] {
        let output = trace(directory.path(), &format!("{head}{rows}"), &[]);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{rows}");
        assert_eq!(message.trim_end().lines().count(), 1, "{message}");
        assert!(message.contains(what), "{what}: {message}");
    }
    let output = trace(directory.path(), "altitude_m,view_azimuth_deg\n0,0\n", &[]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("no column view_zenith_deg"), "{message}");
}

fn real(directory: &Path, more: &[&str]) -> Output {
    real_command(directory, more).output().unwrap()
}

fn real_command(directory: &Path, more: &[&str]) -> Command {
    let mut command = counted_command(directory, more);
    command.args(["--target-error", "5%"]);
    command
}

/// Without an error to aim at.
fn counted_command(directory: &Path, more: &[&str]) -> Command {
    let file = directory.join("queries.csv");
    std::fs::write(
        &file,
        "altitude_m,view_zenith_deg,view_azimuth_deg\n0,45,90\n0,60,40\n2000,30,120\n",
    )
    .unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_welkin-fit"));
    command
        .args(["trace", "--visibility", "40"])
        .args(["--wavelengths", "440,550", "--queries"])
        .arg(file)
        .args(more);
    command
}

/// Four times the walks halve the error, and another number than whole batches is refused.
#[test]
fn walks_may_be_counted() {
    let directory = tempfile::tempdir().unwrap();
    let run = |walks: &str| {
        let more = [&SCENE[..], &["--walks", walks, "--out", "-"]].concat();
        counted_command(directory.path(), &more).output().unwrap()
    };
    let error = |walks: &str| -> f64 {
        let output = run(walks);
        assert!(output.status.success(), "{output:?}");
        let csv = String::from_utf8(output.stdout).unwrap();
        column(&csv, "I_se").into_iter().sum()
    };
    let (few, many) = (error("32"), error("8192"));
    assert!(many > 0.0 && many < 0.25 * few, "{few} {many}");
    assert_eq!(error("32"), few);
    for walks in ["0", "100", "-32", "many"] {
        let bad = run(walks);
        assert_eq!(bad.status.code(), Some(2), "{walks}");
        let message = String::from_utf8(bad.stderr).unwrap();
        assert!(message.contains("--walks"), "{message}");
    }
    let both = real(directory.path(), &["--walks", "32"]);
    assert_eq!(both.status.code(), Some(2));
}

const SCENE: [&str; 4] = ["--solar-elevation", "30", "--albedo", "0.2"];

#[test]
fn the_real_atmosphere_answers_at_several_wavelengths() {
    let directory = tempfile::tempdir().unwrap();
    let run = |aerosol: &str| {
        let output = real(
            directory.path(),
            &[&SCENE[..], &["--aerosol", aerosol]].concat(),
        );
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let (natural, mie) = (run("depolarising"), run("mie"));
    assert_eq!(column(&mie, "wavelength_nm")[..2], [440.0, 550.0]);
    let pairs = column(&natural, "I").into_iter().zip(column(&mie, "I"));
    for (a, b) in pairs {
        assert!((b / a - 1.0).abs() < 0.5 && a != b, "{a} {b}");
    }
    let bad = real(directory.path(), &["--aerosol", "mie"]);
    let message = String::from_utf8(bad.stderr).unwrap();
    assert!(
        message.contains("solar_elevation_deg is missing"),
        "{message}"
    );
    let directory = directory.path();
    let bad = trace(directory, "altitude_m\n", &["--aerosol", "mie"]);
    let message = String::from_utf8(bad.stderr).unwrap();
    assert!(message.contains("--visibility"), "{message}");
}

/// What an interrupted run leaves behind is used if, and only if, it belongs to the same settings.
#[test]
fn an_interrupted_run_goes_on() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("out.csv");
    let folder = directory.path().join("out.csv.unfinished");
    let run = |seed: &str| {
        let more = ["--seed", seed, "--out", out.to_str().unwrap()];
        real(directory.path(), &[&SCENE[..], &more].concat())
    };
    // A folder that comes into the output's place lets all the work be done and the last step fail.
    let more = ["--seed", "1", "--out", out.to_str().unwrap()];
    let mut child = real_command(directory.path(), &[&SCENE[..], &more].concat())
        .spawn()
        .unwrap();
    while !folder.exists() {
        assert!(child.try_wait().unwrap().is_none(), "it ended early");
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    std::fs::create_dir(&out).unwrap();
    assert!(!child.wait().unwrap().success());
    // A folder that is there from the beginning is refused before the work.
    let before = std::fs::metadata(folder.join("row-1.unit"))
        .unwrap()
        .modified();
    let refused = run("2");
    assert_eq!(refused.status.code(), Some(2), "{refused:?}");
    let after = std::fs::metadata(folder.join("row-1.unit"))
        .unwrap()
        .modified();
    assert_eq!(before.unwrap(), after.unwrap());
    let kept = folder.join("row-1.unit");
    let whole = std::fs::read(&kept).unwrap();
    assert_eq!(whole.len(), 16 + 2 * 7 * 8);
    std::fs::remove_dir(&out).unwrap();
    // Rows 0 and 2 are lost; row 1 is marked, with its checksum, to be known again.
    std::fs::remove_file(folder.join("row-0.unit")).unwrap();
    std::fs::write(folder.join("row-2.unit"), &whole[..20]).unwrap();
    let mut marked = whole.clone();
    marked[16..24].copy_from_slice(&42.0_f64.to_le_bytes());
    let checksum = crc32fast::hash(&marked[16..]).to_le_bytes();
    marked[12..16].copy_from_slice(&checksum);
    std::fs::write(&kept, &marked).unwrap();
    assert!(run("1").status.success());
    let resumed = column(&std::fs::read_to_string(&out).unwrap(), "I");
    assert!(!folder.exists());
    assert!(run("1").status.success());
    let fresh = column(&std::fs::read_to_string(&out).unwrap(), "I");
    assert_eq!(resumed[2], 42.0);
    for i in [0, 1, 3, 4, 5] {
        assert_eq!(resumed[i], fresh[i]);
    }
    // Other settings do not trust it.
    std::fs::create_dir(&folder).unwrap();
    std::fs::write(&kept, &marked).unwrap();
    assert!(run("2").status.success());
    let other = column(&std::fs::read_to_string(&out).unwrap(), "I");
    assert!(other[2] < 1.0);
}

/// Nothing is kept beside what is no file.
#[cfg(unix)]
#[test]
fn answers_go_to_standard_output_and_devices() {
    let directory = tempfile::tempdir().unwrap();
    let null = directory.path().join("null");
    std::os::unix::fs::symlink("/dev/null", &null).unwrap();
    let run = |out: &str| {
        let output = real(directory.path(), &[&SCENE[..], &["--out", out]].concat());
        assert!(output.status.success(), "{output:?}");
        output.stdout
    };
    let table = String::from_utf8(run("-")).unwrap();
    assert_eq!(column(&table, "I").len(), 6);
    assert!(run(null.to_str().unwrap()).is_empty());
    // The queries and the link.
    assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 2);
}

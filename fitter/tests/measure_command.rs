//! `welkin-fit measure`: synthetic scans in the form of the measured ones are found again, what is none is refused.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;
use welkin::{Conditions, Model};
use welkin_fitter::measured::capture_time::CaptureTime;
use welkin_fitter::measured::fit::{Choice, Fitted, fit};
use welkin_fitter::measured::model_sky::{direction, radiance};
use welkin_fitter::measured::pyranometer::Log;
use welkin_fitter::measured::scan::{Scan, folders};
use welkin_fitter::measured::scan_report::Spread;
use welkin_fitter::measured::site::Site;
use welkin_fitter::measured::{MeasuredError, pattern};

const NAME: &str = "2013-05-27___09.30.00";

fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap()
}

/// What a scan is made of.
struct Truth {
    visibility: f64,
    albedo: f64,
    scale: f64,
    /// Added to the azimuths that are named, degrees counter-clockwise.
    north: f64,
    /// Standard deviation of ln radiance.
    noise: f64,
}

const TRUTH: Truth = Truth {
    visibility: 70e3,
    albedo: 0.35,
    scale: 0.73,
    north: -11.0,
    noise: 0.03,
};

/// Nearly normal, and the same every time.
fn normal(seed: &mut u64) -> f64 {
    let mut uniform = || {
        *seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..12).map(|_| uniform()).sum::<f64>() - 6.0
}

fn number(value: f64) -> String {
    format!("{value:?}")
}

/// Writes a scan as the instrument would: every nanometre, names with the azimuth of a wrong north, the first sample
/// wrong.
fn write_scan(folder: &Path, model: &Model, truth: &Truth) -> PathBuf {
    let scan = folder.join(NAME);
    fs::create_dir_all(&scan).unwrap();
    let time = CaptureTime::parse(NAME).unwrap();
    let sun = Site::RHODES_HALL
        .sun(&time.after(0.5 * Scan::DURATION))
        .unwrap();
    let conditions = Conditions {
        solar_elevation: sun.elevation,
        solar_azimuth: sun.azimuth,
        visibility: truth.visibility,
        albedo: truth.albedo,
        altitude: Site::RHODES_HALL.altitude,
    };
    let wavelengths: Vec<f64> = (350..=850).map(f64::from).collect();
    let mut seed = 7;
    for index in 0..pattern::SAMPLES {
        let [azimuth, elevation] = pattern::named(index).unwrap();
        let view = direction(
            elevation.to_radians(),
            (90.0 + azimuth + truth.north).to_radians(),
        );
        let light = radiance(model, &conditions, sun.intensity, &[view], &wavelengths).unwrap();
        let wrong = if index == 0 { 3.0 } else { 1.0 };
        let factor = wrong * truth.scale * (truth.noise * normal(&mut seed)).exp();
        let mut text = String::from("Wavelength\tRadiance\r\n");
        for (nm, value) in wavelengths.iter().zip(&light[0]) {
            text += &format!("{nm}\t{:.9}\r\n", factor * value);
        }
        let [azimuth, elevation] = [azimuth, elevation].map(number);
        let file = format!("{NAME}_-_{index}____{azimuth}___{elevation}.asd.rad.txt");
        fs::write(scan.join(file), text).unwrap();
    }
    scan
}

fn choice() -> Choice {
    Choice {
        wavelengths: (0..10).map(|i| 400.0 + 40.0 * f64::from(i)).collect(),
        step: 10.0,
        albedo: None,
        north: None,
        scale: true,
        without: vec![0],
        around_sun: 0.2,
        altitude: Site::RHODES_HALL.altitude,
    }
}

fn fitted(model: &Model, scan: &Path, choice: &Choice) -> Fitted {
    let scan = Scan::read(scan).unwrap();
    let sun = Site::RHODES_HALL.sun(&scan.middle()).unwrap();
    fit(model, &scan, sun, choice).unwrap()
}

#[test]
fn what_a_scan_was_made_of_is_found_again() {
    let folder = TempDir::new().unwrap();
    let model = Model::default_model().unwrap();
    let scan = write_scan(folder.path(), &model, &TRUTH);

    let found = fitted(&model, &scan, &choice());
    let Conditions {
        visibility, albedo, ..
    } = found.conditions;
    assert!(
        (visibility / TRUTH.visibility).ln().abs() < 0.1,
        "{found:?}"
    );
    assert!((albedo - TRUTH.albedo).abs() < 0.1, "{albedo}");
    assert!(
        (found.scale / TRUTH.scale).ln().abs() < 0.02,
        "{}",
        found.scale
    );
    let north = found.north.to_degrees();
    assert!((north - TRUTH.north).abs() < 0.6, "{north}");
    // The noise, and nothing else: one value per sample.
    let noise = Spread::of(found.residuals.iter().map(|r| r.error)).unwrap();
    let spread = &noise;
    assert!((0.02..0.04).contains(&spread.rms), "{spread:?}");

    // Without any of what is free, it is seen that something is wrong.
    let stiff = Choice {
        albedo: Some(0.0),
        north: Some(0.0),
        scale: false,
        ..choice()
    };
    let off = fitted(&model, &scan, &stiff);
    let spread = Spread::of(off.residuals.iter().map(|r| r.error)).unwrap();
    assert!(spread.rms > 3.0 * noise.rms, "{spread:?}");

    // The first sample is three times too bright.
    let first = Choice {
        without: vec![],
        ..choice()
    };
    let worse = fitted(&model, &scan, &first);
    let most = worse.residuals.iter().map(|r| r.error).fold(0.0, f64::max);
    assert!(most > 0.9, "{most}");
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_welkin-fit"));
    let model = repository().join("models/default.welkin");
    command
        .current_dir(folder)
        .arg("measure")
        .args(arguments)
        .args(["--model", model.to_str().unwrap()])
        .output()
        .unwrap()
}

fn complaint(output: &Output) -> String {
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    String::from_utf8(output.stderr.clone()).unwrap()
}

#[test]
fn the_command_reports_and_draws() {
    let folder = TempDir::new().unwrap();
    let model = Model::default_model().unwrap();
    write_scan(&folder.path().join("RADIANCE"), &model, &TRUTH);
    let arguments = [
        "kider",
        ".",
        "--to",
        "800",
        "--step",
        "40",
        "--fit-albedo",
        "--csv",
        "out.csv",
        "--png",
        "out.png",
    ];
    let output = run(folder.path(), &arguments);
    assert!(output.status.success(), "{output:?}");
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(
        said.contains("2013-05-27 09:30:00") && said.contains("rms 0.0"),
        "{said}"
    );
    let table = fs::read_to_string(folder.path().join("out.csv")).unwrap();
    assert_eq!(
        table
            .lines()
            .filter(|line| line.contains(",wavelength_nm,"))
            .count(),
        11
    );
    let rings = table
        .lines()
        .filter(|line| line.contains(",elevation_deg,"));
    let counts: Vec<&str> = rings.map(|line| line.split(',').nth(3).unwrap()).collect();
    // The first of the lowest ring is left out, and what is near to the sun.
    assert_eq!((counts[0], counts[3], counts[4]), ("341", "88", "11"));
    let picture = fs::read(folder.path().join("out.png")).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(picture))
        .read_info()
        .unwrap();
    assert_eq!((reader.info().width, reader.info().height), (752, 256));
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    // The difference in the zenith is green: the fit is good.
    let zenith = &pixels[3 * (752 * 128 + 624)..][..3];
    assert!(zenith[1] == 255, "{zenith:?}");

    let nothing = run(folder.path(), &["kider", ".", "--day", "2013-09-24"]);
    assert!(complaint(&nothing).contains("no scan of this day"));
    let bands = run(folder.path(), &["kider", ".", "--from", "900"]);
    assert!(complaint(&bands).contains("no bands"));
    let albedo = run(folder.path(), &["kider", ".", "--albedo", "-1"]);
    assert!(complaint(&albedo).contains("--albedo"));
    let beyond = run(
        folder.path(),
        &["kider", ".", "--to", "1500", "--step", "100"],
    );
    assert!(complaint(&beyond).contains("wavelength"));
    assert_eq!(
        fs::read_to_string(folder.path().join("out.csv")).unwrap(),
        table
    );
}

#[test]
fn options_that_mean_nothing_are_refused_by_name() {
    let folder = TempDir::new().unwrap();
    let scan = plain_scan(folder.path());
    let refused = |option: &str, value: &str| {
        let output = run(folder.path(), &["kider", NAME, option, value]);
        let text = complaint(&output);
        assert!(text.contains(option), "{option} {value}: {text}");
    };
    for north in ["nan", "400", "inf"] {
        refused("--north", north);
    }
    refused("--without", "500");
    refused("--without", "3,81");
    // The middle of the night, if the clock is taken for one of the Gulf.
    refused("--utc-offset", "4");
    // Said before anything is fitted.
    let nowhere = ["kider", NAME, "--csv", "none/out.csv"];
    assert!(complaint(&run(folder.path(), &nowhere)).contains("none/out.csv"));
    let one = ["kider", NAME, "--csv", "out", "--png", "out"];
    assert!(complaint(&run(folder.path(), &one)).contains("one file"));
    assert!(!folder.path().join("out").exists());
    for factor in ["nan", "0", "-1"] {
        let output = run(repository(), &["irradiance", ".", "--sky-factor", factor]);
        assert!(complaint(&output).contains("--sky-factor"), "{factor}");
    }
    // The folder of the scan by another name.
    assert_eq!(folders(&scan).unwrap(), [scan.as_path()]);
    let dotted = scan.join("..").join(NAME).join(".");
    assert_eq!(folders(&dotted).unwrap(), [dotted.as_path()]);
    let inside = run(&scan, &["kider", ".", "--from", "400", "--to", "700"]);
    assert!(complaint(&inside).contains("no wavelengths in some band"));
}

/// Sets the radiance of whole samples to 0.
fn darken(scan: &Path, samples: &[usize]) {
    for &index in samples {
        let path = scan.join(plain_name(index));
        let text = fs::read_to_string(&path).unwrap();
        let dark = |line: &str| match line.split_once('\t') {
            Some((nm, value)) if value.starts_with(|c: char| c.is_ascii_digit()) => {
                format!("{nm}\t0.0\n")
            }
            _ => format!("{line}\n"),
        };
        fs::write(&path, text.lines().map(dark).collect::<String>()).unwrap();
    }
}

#[test]
fn what_is_no_light_is_counted_or_refused() {
    let folder = TempDir::new().unwrap();
    let model = Model::default_model().unwrap();
    let scan = write_scan(folder.path(), &model, &TRUTH);
    darken(&scan, &[40, 75]);
    let arguments = [
        "kider", ".", "--to", "700", "--step", "100", "--csv", "out.csv",
    ];
    let output = run(folder.path(), &arguments);
    assert!(output.status.success(), "{output:?}");
    let what = "8 of 320 values are not above 0, at samples (bands): 40 (4), 75 (4)";
    let said = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
    assert!(said.iter().all(|text| text.contains(what)), "{said:?}");
    let table = fs::read_to_string(folder.path().join("out.csv")).unwrap();
    let lines = table.lines();
    let left_out: Vec<&str> = lines.filter(|l| l.contains("left_out_of_sample")).collect();
    assert_eq!(left_out.len(), 2, "{table}");
    assert!(
        left_out[1].ends_with(",left_out_of_sample,75,4,,,"),
        "{table}"
    );
    fs::remove_file(folder.path().join("out.csv")).unwrap();

    // One in twenty of the 80 is four.
    darken(&scan, &[10, 20, 30]);
    let text = complaint(&run(folder.path(), &arguments));
    assert!(text.contains("20 of 320") && text.contains(NAME), "{text}");
    assert!(!folder.path().join("out.csv").exists());
}

/// A scan that is the same everywhere.
fn plain_scan(folder: &Path) -> PathBuf {
    let scan = folder.join(NAME);
    fs::create_dir_all(&scan).unwrap();
    for index in 0..pattern::SAMPLES {
        let path = scan.join(plain_name(index));
        fs::write(path, "Wavelength\tRadiance\n400\t0.1\n401\t0.1\n").unwrap();
    }
    scan
}

fn plain_name(index: usize) -> String {
    let [azimuth, elevation] = pattern::named(index).unwrap().map(number);
    format!("{NAME}_-_{index}____{azimuth}___{elevation}.asd.rad.txt")
}

#[test]
fn hostile_scans_are_refused_by_name_and_line() {
    let folder = TempDir::new().unwrap();
    let scan = plain_scan(folder.path());
    assert_eq!(Scan::read(&scan).unwrap().samples.len(), 81);
    fs::write(scan.join("notes.txt"), "not an export").unwrap();
    assert!(Scan::read(&scan).is_ok());

    let file = scan.join(plain_name(17));
    let good = fs::read(&file).unwrap();
    let refused = |text: &[u8]| {
        fs::write(&file, text).unwrap();
        let error = Scan::read(&scan).unwrap_err();
        fs::write(&file, &good).unwrap();
        assert!(error.to_string().contains("_-_17__"), "{error}");
        error
    };
    for (text, line) in [
        ("Wavelength\tRadiance\n400\t0.1\n401\tNaN\n", 3),
        ("Wavelength\tRadiance\n400\t0.1\n401\tinf\n", 3),
        ("Wavelength\tRadiance\n400\t0.1\n401\t1e4\n", 3),
        ("Wavelength\tRadiance\n400\t0.1\n400\t0.1\n", 3),
        ("Wavelength\tRadiance\n400\t0.1\n401\n", 3),
        ("Wavelength\tRadiance\n400\t0.1\t0.2\n401\t0.1\n", 2),
        ("Wavelength\tRadiance\nblue\t0.1\n401\t0.1\n", 2),
        ("Wavelength\tRadiance\n-400\t0.1\n401\t0.1\n", 2),
    ] {
        let error = refused(text.as_bytes());
        assert!(
            matches!(error, MeasuredError::Line { line: at, .. } if at == line),
            "{text:?}: {error}"
        );
    }
    let other = refused(b"Wavelength\tRadiance\n400\t0.1\n402\t0.1\n");
    assert!(matches!(other, MeasuredError::Incomplete { .. }), "{other}");
    for text in [
        &b""[..],
        b"Wavelength\tRadiance\n",
        b"Wavelength\n400\t0.1\n",
    ] {
        assert!(matches!(refused(text), MeasuredError::Incomplete { .. }));
    }
    assert!(matches!(
        refused(b"\xff\xfe\x00"),
        MeasuredError::Read { .. }
    ));
}

#[test]
fn scans_with_wrong_names_are_refused() {
    let folder = TempDir::new().unwrap();
    let scan = plain_scan(folder.path());
    let file = scan.join(plain_name(17));
    let moved = |name: &str| {
        let to = scan.join(name);
        fs::rename(&file, &to).unwrap();
        let error = Scan::read(&scan).unwrap_err();
        fs::rename(&to, &file).unwrap();
        error
    };
    for name in [
        // Another index, another direction, another scan, no direction, no index.
        format!("{NAME}_-_18____191.25___12.1151.asd.rad.txt"),
        format!("{NAME}_-_17____90.0___12.1151.asd.rad.txt"),
        format!("{NAME}_-_99____191.25___12.1151.asd.rad.txt"),
        format!("{NAME}_-_17____NaN___12.1151.asd.rad.txt"),
        format!("{NAME}_-_17.asd.rad.txt"),
        format!("{NAME}_-_____191.25___12.1151.asd.rad.txt"),
        "2013-05-27___09.45.00_-_17____191.25___12.1151.asd.rad.txt".into(),
    ] {
        let error = moved(&name);
        assert!(
            matches!(error, MeasuredError::Name { .. }),
            "{name}: {error}"
        );
    }
    // Twice the same, and one that is missing.
    let twice = scan.join(format!("{NAME}_-_17____191.26___12.1151.asd.rad.txt"));
    fs::copy(&file, &twice).unwrap();
    let error = Scan::read(&scan).unwrap_err();
    assert!(error.to_string().contains("second"), "{error}");
    fs::remove_file(&twice).unwrap();
    fs::remove_file(&file).unwrap();
    let error = Scan::read(&scan).unwrap_err();
    assert!(error.to_string().contains("80 of 81"), "{error}");

    let empty = folder.path().join("empty");
    fs::create_dir(&empty).unwrap();
    let error = folders(&empty).unwrap_err();
    assert!(error.to_string().contains("unpacked"), "{error}");
    let error = folders(&folder.path().join("missing")).unwrap_err();
    assert!(matches!(error, MeasuredError::Read { .. }), "{error}");
    let error = Scan::read(&empty).unwrap_err();
    assert!(matches!(error, MeasuredError::Name { .. }), "{error}");
}

fn excerpt() -> PathBuf {
    repository().join("fitter/tests/measured/2013-05-27/IRRADIANCE")
}

#[test]
fn the_logs_of_the_set_are_read() {
    let log = Log::read(&excerpt().join("2013.05.27.10.30.00.txt")).unwrap();
    assert_eq!(log.readings.len(), 81);
    assert_eq!(log.readings[0].1, 808.06);
    let (time, median) = log.median();
    assert_eq!((time.clock().as_str(), median), ("10:32:51", 814.52));
}

#[test]
fn hostile_logs_are_refused_by_line() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("log.txt");
    for (text, line) in [
        (
            "808.06 2013.05.27.10.30.00\nbright 2013.05.27.10.30.03\n",
            2,
        ),
        ("808.06\n", 1),
        ("-1 2013.05.27.10.30.00\n", 1),
        ("1e9 2013.05.27.10.30.00\n", 1),
        ("NaN 2013.05.27.10.30.00\n", 1),
        ("808.06 2013.05.27.25.30.00\n", 1),
        (
            "808.06 2013.05.27.10.30.00\n808.06 2013.05.27.10.29.00\n",
            2,
        ),
        (
            "808.06 2013.05.27.10.30.00\n808.06 2013.05.28.10.30.00\n",
            2,
        ),
    ] {
        fs::write(&path, text).unwrap();
        let error = Log::read(&path).unwrap_err();
        assert!(
            matches!(error, MeasuredError::Line { line: at, .. } if at == line),
            "{text:?}: {error}"
        );
    }
    fs::write(&path, "\n\n").unwrap();
    let error = Log::read(&path).unwrap_err();
    assert!(matches!(error, MeasuredError::Incomplete { .. }), "{error}");
}

/// The pyranometer beside the scanner is within its own few percent of the model with no factor, whatever the hour.
#[test]
fn global_irradiance_is_that_of_the_model() {
    let output = run(repository(), &["irradiance", excerpt().to_str().unwrap()]);
    assert!(output.status.success(), "{output:?}");
    let said = String::from_utf8(output.stdout).unwrap();
    let ratios: Vec<f64> = said
        .lines()
        .skip(2)
        .map(|line| line.split(',').nth(7).unwrap().parse().unwrap())
        .collect();
    assert_eq!(ratios.len(), 3, "{said}");
    assert!(ratios.iter().all(|r| (r - 1.0).abs() < 0.05), "{said}");
}

#[test]
fn a_low_sun_is_not_compared() {
    let low = repository().join("fitter/tests/measured/2013-09-24/IRRADIANCE");
    let output = run(repository(), &["irradiance", low.to_str().unwrap()]);
    assert!(complaint(&output).contains("10° or more"));
}

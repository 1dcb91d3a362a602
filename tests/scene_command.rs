//! Sun, air and observer as every command takes them.
#![cfg(feature = "cli")]

mod common;

use std::path::Path;
use std::process::Output;

use common::command;

fn call(line: &str) -> Output {
    command::call(Path::new("."), line)
}

/// What `welkin light` says about its conditions.
fn conditions(scene: &str) -> serde_json::Value {
    let output = call(&format!("light --json {scene}"));
    assert!(output.status.success(), "{scene}: {output:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn number(value: &serde_json::Value, name: &str) -> f64 {
    value["conditions"][name].as_f64().unwrap()
}

fn refusal(line: &str) -> String {
    let output = call(line);
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{line}: {text}");
    assert_eq!(text.lines().count(), 1, "{text}");
    assert!(output.stdout.is_empty() && !text.contains("panicked"));
    text
}

/// The definition (molecules 0.0971, ozone 0.0306 at 550 nm), with the transmittance that another command gives.
#[test]
fn turbidity_is_that_of_the_air_of_the_model() {
    for turbidity in [1.5, 2.1, 3.0, 4.4] {
        let visibility = number(
            &conditions(&format!("--turbidity {turbidity}")),
            "visibility_km",
        );
        let rows = format!(
            "quantity,visibility_km,albedo,altitude_m,solar_elevation_deg,view_zenith_deg,view_azimuth_deg,wavelength_nm\n\
             transmittance,{visibility},0.2,0,20,0,0,550\n"
        );
        let output = command::run(Path::new("."), &["query"], &rows);
        let text = String::from_utf8(output.stdout).unwrap();
        let cells: Vec<&str> = text.lines().nth(1).unwrap().split(',').collect();
        let through: f64 = cells[8].parse().unwrap();
        let got = (-through.ln() - 0.0306) / 0.0971;
        assert!((got - turbidity).abs() < 2e-3, "{turbidity}: {got}");
    }
    let text = refusal("light --turbidity 8");
    assert!(
        text.contains("turbidity must be in 1.4") && text.contains("got 8"),
        "{text}"
    );
    for wrong in ["nan", "inf", "-3", "0"] {
        assert!(refusal(&format!("render --turbidity {wrong}")).contains("turbidity"));
    }
    assert!(refusal("light --turbidity 3 --visibility 40").contains("cannot be used with"));
    let output = call("light --clamp --turbidity 8");
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(
        text.starts_with("welkin: turbidity moved from 8 to 4.4"),
        "{text}"
    );
}

/// 17 October 2003 in Golden, Colorado: the example of NREL/TP-560-34302 (39.872046° without refraction, azimuth
/// 194.34024° from the north to the east). 21 June 2026 on the Tropic of Cancer: the sun passes within 0.01° of the
/// zenith.
#[test]
fn dates_and_places_give_the_sun() {
    let golden = "--latitude 39.742476 --longitude -105.1786";
    for date in [
        "--date 2003-10-17 --time 12:30:30-07:00",
        "--date 2003-10-17T19:30:30Z",
    ] {
        let sun = conditions(&format!("{date} {golden}"));
        assert!(
            (number(&sun, "solar_elevation_deg") - 39.872_046).abs() < 1e-3,
            "{sun}"
        );
        // Counter-clockwise from the east.
        assert!(
            (number(&sun, "solar_azimuth_deg") - (450.0 - 194.340_24)).abs() < 1e-3,
            "{sun}"
        );
    }
    let noon = "--date 2026-06-21 --time 12:02Z --latitude 23.436 --longitude 0";
    assert!(number(&conditions(noon), "solar_elevation_deg") > 89.8);
    // In the morning the sun is in the east, +x; in the south at noon in Europe, −y.
    let morning = conditions("--date 2026-03-20 --time 07:00Z --latitude 0 --longitude 0");
    let direction = morning["sun"]["direction"].as_array().unwrap();
    assert!(direction[0].as_f64().unwrap() > 0.9, "{morning}");
    let noon = conditions("--date 2026-03-20 --time 12:00Z --latitude 50 --longitude 0");
    assert!(
        noon["sun"]["direction"][1].as_f64().unwrap() < -0.7,
        "{noon}"
    );
}

#[test]
fn dates_that_are_none_are_refused() {
    let here = "--latitude 48 --longitude 11";
    for (line, word) in [
        (
            format!("light --date 2026-06-21 --time 23:00Z {here}"),
            "solar elevation must be in -12..=90 degrees, got -18",
        ),
        (
            format!("render --date 2026-06-21 --time 12:00 {here}"),
            "offset from UTC",
        ),
        (format!("render --date 2026-06-21 {here}"), "--time"),
        (
            format!("render --date 2026-06-21T12:00 {here}"),
            "offset from UTC",
        ),
        (
            format!("render --date 2026-02-30 --time 12:00Z {here}"),
            "2026-02-30",
        ),
        (
            format!("render --date 9999-01-01 --time 12:00Z {here}"),
            "position of the sun",
        ),
        (
            format!("render --date 2026-06-21T12:00Z --time 12:00Z {here}"),
            "time already",
        ),
        (format!("render --time 12:00Z {here}"), "--date"),
        (
            "render --date 2026-06-21 --time 12:00Z".to_owned(),
            "--latitude",
        ),
        ("render --latitude 48 --longitude 11".to_owned(), "--date"),
        (
            "render --date 2026-06-21 --time 12:00Z --latitude 91 --longitude 11".to_owned(),
            "-90..=90",
        ),
        (
            "render --date 2026-06-21 --time 12:00Z --latitude 48 --longitude nan".to_owned(),
            "-180..=180",
        ),
        (
            format!("render --date 2026-06-21 --time 12:00Z {here} --sun-elevation 20"),
            "cannot be used with",
        ),
        (
            format!("render --date 2026-06-21 --time 12:00Z {here} --sun-azimuth 20"),
            "cannot be used with",
        ),
        (
            format!("render --date 2026-06-21 --time 10:00Z..12:00Z {here}"),
            "welkin animate",
        ),
        ("render --sun-elevation 1..2".to_owned(), "welkin animate"),
        ("froxels --sun-elevation 1..2".to_owned(), "welkin animate"),
        ("light --sun-azimuth 1..2".to_owned(), "welkin animate"),
        ("light --sun-elevation 1..two".to_owned(), "no number"),
    ] {
        let text = refusal(&line);
        assert!(text.contains(word), "{line}: {text}");
    }
}

/// One struct: whoever adds a condition adds it everywhere.
#[test]
fn every_command_that_shows_a_sky_takes_all_conditions() {
    for command in ["render", "animate", "froxels", "light", "contact-sheet"] {
        let help = String::from_utf8(call(&format!("{command} --help")).stdout).unwrap();
        for option in [
            "sun-elevation",
            "sun-azimuth",
            "date",
            "time",
            "latitude",
            "longitude",
            "visibility",
            "turbidity",
            "albedo",
            "altitude",
            "clamp",
        ] {
            assert!(
                help.contains(&format!("--{option} ")) || help.contains(&format!("--{option}\n")),
                "{command} {option}"
            );
        }
    }
}

#[test]
fn shells_and_man_pages() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = String::from_utf8(call(&format!("completions {shell}")).stdout).unwrap();
        assert!(
            script.contains("contact-sheet") && script.contains("turbidity"),
            "{shell}"
        );
    }
    assert!(refusal("completions tcsh").contains("tcsh"));
    let folder = tempfile::tempdir().unwrap();
    let output = command::call(folder.path(), "man --out .");
    assert!(output.status.success(), "{output:?}");
    for page in [
        "welkin.1",
        "welkin-render.1",
        "welkin-contact-sheet.1",
        "welkin-man.1",
    ] {
        let text = std::fs::read_to_string(folder.path().join(page)).unwrap();
        assert!(text.contains(".TH"), "{page}");
    }
    let text = std::fs::read_to_string(folder.path().join("welkin-render.1")).unwrap();
    assert!(text.contains("turbidity") && text.contains("Preetham"));
    assert!(
        command::call(folder.path(), "man --out man1")
            .status
            .success()
    );
    assert!(folder.path().join("man1/welkin.1").is_file());
    assert!(refusal("man --out missing/man1").contains("no folder can be made"));
    let page = folder.path().join("welkin.1");
    assert!(refusal(&format!("man --out {}", page.display())).contains("is no folder"));
}

/// A night says whose it is, in no more digits than anybody reads.
#[test]
fn suns_of_dates_beyond_the_model_are_named() {
    let said = refusal("light --date 2026-12-21 --time 19:00Z --latitude 48 --longitude 11");
    assert_eq!(
        said,
        "welkin: the sun on 2026-12-21: solar elevation must be in -12..=90 degrees, got -34.69 degrees\n"
    );
}

#[test]
fn visibilities_of_turbidities_have_no_digits_of_conversions() {
    let output = call("light --turbidity 3");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("visibility 34.094 km,"), "{text}");
}

/// What is given is the same in all skies of a sheet, the rest varies.
#[test]
fn sheets_are_of_the_model_or_of_a_day() {
    let folder = tempfile::tempdir().unwrap();
    let size = |line: &str| {
        let line = format!("contact-sheet --size 16 --out s.png {line}");
        let output = command::call(folder.path(), &line);
        assert!(output.status.success(), "{line}: {output:?}");
        let file = std::fs::File::open(folder.path().join("s.png")).unwrap();
        let reader = png::Decoder::new(std::io::BufReader::new(file))
            .read_info()
            .unwrap();
        let said = String::from_utf8(output.stdout).unwrap();
        ([reader.info().width, reader.info().height], said)
    };
    assert_eq!(size("").0, [7 * 16, 8 * 16 + 28]);
    let (day, said) =
        size("--sun-elevation -4..60 --columns 9 --altitude 0 --visibility 90 --projection up");
    assert_eq!(day, [9 * 16, 16]);
    assert!(
        said.contains("sun at -4, 4, 12, 20, 28, 36, 44, 52, 60 degrees"),
        "{said}"
    );
    assert!(said.contains("visibility 90 km, altitude 0 m"), "{said}");
    assert_eq!(size("--turbidity 2").0, [7 * 16, 4 * 16]);
    assert!(refusal("contact-sheet --projection cube").contains("up or side"));
    assert!(
        refusal("contact-sheet --sun-elevation -40..60").contains("solar elevation must be in")
    );
}

/// Above a model that ends within the air there is no space.
#[test]
fn an_observer_above_a_low_model_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let call = |line: &str| command::call(folder.path(), line);
    let made = call("subset --altitudes 0..2000 --visibilities 50..60 --out low.welkin");
    assert!(made.status.success(), "{made:?}");
    let refused = call("render --model low.welkin --altitude 9000 --size 16 --out sky");
    let text = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(2), "{text}");
    assert!(text.contains("altitude must be in 0..="), "{text}");
    assert!(!folder.path().join("sky.png").exists());
}

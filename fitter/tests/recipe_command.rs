//! `welkin-fit atmosphere` with a recipe.

use std::path::Path;
use std::process::{Command, Output};
use welkin_fitter::atmosphere::{Monochromatic, json::Case};
use welkin_fitter::recipe::Recipe;

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_welkin-fit"))
        .current_dir(folder)
        .arg("atmosphere")
        .args(arguments)
        .output()
        .unwrap()
}

fn text(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout).unwrap()
}

fn complaint(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert!(!output.status.success(), "{output:?}");
    String::from_utf8(output.stderr).unwrap()
}

#[test]
fn recipes_are_listed_with_what_they_make() {
    let folder = tempfile::tempdir().unwrap();
    let list = text(folder.path(), &["--list"]);
    for name in Recipe::names() {
        assert!(list.contains(name), "{name}");
    }
    text(folder.path(), &["--list", "--out", "list.csv"]);
    let csv = std::fs::read_to_string(folder.path().join("list.csv")).unwrap();
    assert!(csv.contains("urban,10.7,"), "{csv}");
    let rows = csv.lines().filter(|line| !line.starts_with('#')).count();
    assert_eq!(rows, 1 + Recipe::names().count());
}

/// What `--toml` prints is a recipe, the same one.
#[test]
fn a_recipe_is_written_changed_and_read() {
    let folder = tempfile::tempdir().unwrap();
    let mine = text(folder.path(), &["fog", "--toml"]);
    std::fs::write(folder.path().join("mine.toml"), &mine).unwrap();
    let [fog, own] = ["fog", "mine.toml"].map(|name| text(folder.path(), &[name]));
    assert_eq!(fog, own);
    assert!(own.contains("visibility 4.0 km"), "{own}");
    let thick = text(
        folder.path(),
        &["mine.toml", "--set", "visibility=2.5", "--set", "ozone=100"],
    );
    assert!(thick.contains("visibility 2.5 km, ozone 100 DU"), "{thick}");
}

#[test]
fn the_air_of_a_recipe_goes_into_a_file() {
    let folder = tempfile::tempdir().unwrap();
    text(
        folder.path(),
        &["desert", "--wavelengths", "440,550", "--out", "air.json"],
    );
    let case = Case::read(&folder.path().join("air.json")).unwrap();
    let lights = [440.0, 550.0].map(Monochromatic::beside_lines);
    let recipe = Recipe::named("desert").unwrap();
    let air = recipe.air(&lights).unwrap();
    assert_eq!(case.atmosphere.altitudes, air.altitudes);
    for altitude in [0.0, 1000.0, 6000.0, 20_000.0] {
        for w in 0..2 {
            let [a, b] = [&case.atmosphere, &air].map(|air| air.extinction(altitude, w));
            assert!((a / b - 1.0).abs() < 1e-12, "{altitude} m: {a}, {b}");
        }
    }
    let surface = recipe.surface().unwrap().unwrap();
    assert_eq!(case.albedo, 0.5 * (surface.at(440.0) + surface.at(550.0)));
}

#[test]
fn the_plot_has_every_layer() {
    let folder = tempfile::tempdir().unwrap();
    text(folder.path(), &["mars", "--plot", "mars.svg"]);
    let svg = std::fs::read_to_string(folder.path().join("mars.svg")).unwrap();
    for word in [
        "Mars",
        "dust",
        "molecules",
        "altitude, km",
        "wavelength, nm",
        "scattering angle, degrees",
    ] {
        assert!(svg.contains(word), "{word}");
    }
    assert!(complaint(folder.path(), &["mars", "--plot", "mars.png"]).contains("SVG"));
    assert!(!folder.path().join("mars.png").exists());
}

/// Text of others goes neither raw to the terminal nor into XML.
#[test]
fn names_of_layers_are_made_printable() {
    let folder = tempfile::tempdir().unwrap();
    let text_of = "[layers.\"a b<&\\u001b[31mred\"]\ntop_km = 1\nmixture = \"urban\"\n";
    std::fs::write(folder.path().join("odd.toml"), text_of).unwrap();
    let said = text(folder.path(), &["odd.toml", "--plot", "odd.svg"]);
    assert!(said.contains("a b<&\\u{1b}[31mred"), "{said}");
    let svg = std::fs::read_to_string(folder.path().join("odd.svg")).unwrap();
    assert!(svg.contains("a b&lt;&amp;\\u{1b}[31mred"));
    assert!(!svg.contains('\u{1b}'));
}

#[test]
fn separators_and_short_tables_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    for (name, text) in [
        (
            "semi.csv",
            "altitude_km;temperature_k;air_per_cm3\n0;288;2,5e19\n",
        ),
        (
            "tabs.csv",
            "altitude_km\ttemperature_k\tair_per_cm3\n0\t288\t2.5e19\n",
        ),
    ] {
        write(name, text);
        write("air.toml", &format!("[gases]\ntable = \"{name}\"\n"));
        let said = complaint(folder.path(), &["air.toml"]);
        assert!(
            said.contains(name) && said.contains("commas are expected"),
            "{said}"
        );
    }
    let optics = "[layers.d]\noptical_depth_550 = 0.2\noptics = { wavelength_nm = [400, 1000], \
        extinction = [1, 1], single_scattering_albedo = [0.9, 0.9], asymmetry = [0.7, 0.7] }\n";
    write("short.toml", optics);
    let output = Command::new(env!("CARGO_BIN_EXE_welkin-fit"))
        .current_dir(folder.path())
        .args(["make", "short.toml", "--out", "short.welkin"])
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        said.contains("short.toml: layers.d.optics: 300 nm is outside the table, 400..1000 nm"),
        "{said}"
    );
}

/// Before anything is traced.
#[test]
fn aureole_says_what_a_model_does_not_have() {
    let folder = tempfile::tempdir().unwrap();
    let model = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/default.welkin");
    let colours = folder.path().join("colours.welkin");
    let (mut head, mut chunks) = welkin::format::unpack(&std::fs::read(model).unwrap()).unwrap();
    chunks.retain(|chunk| !matches!(chunk.payload, welkin::format::Payload::Spectrum(_)));
    let selection = welkin::format::Selection {
        wavelengths: vec![9, 12, 15],
        ..welkin::format::Selection::all(&head)
    };
    welkin::format::crop(&mut head, &mut chunks, &selection).unwrap();
    std::fs::write(&colours, welkin::format::encode(&head, &chunks).unwrap()).unwrap();
    let says = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_welkin-fit"))
            .current_dir(folder.path())
            .args(["aureole", "continental-average", "colours.welkin"])
            .args(arguments)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2), "{output:?}");
        String::from_utf8(output.stderr).unwrap()
    };
    let lacking = says(&[]);
    assert!(
        lacking.contains("colours.welkin: has no node at 343 nm, only at 430, 550, 650"),
        "{lacking}"
    );
    let low = says(&["--wavelengths", "550", "--suns", "20,95"]);
    assert!(low.contains("up to 90 degrees, got 95"), "{low}");
    let plot = says(&["--wavelengths", "550", "--plot", "a.svg", "0"]);
    assert!(plot.contains("up to 90 degrees, got 0"), "{plot}");
}

#[test]
fn mistakes_are_explained() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("bad.toml"),
        "[layers.a]\nmixture = \"urban\"\ntop_km = -1\n",
    )
    .unwrap();
    for (arguments, says) in [
        (&["venus"][..], "continental-clean"),
        (&["nowhere.toml"], "nowhere.toml"),
        (&["bad.toml"], "layers.a.top_km: -1.0 is outside 0..100"),
        (&["urban", "--set", "colour=3"], "cannot be changed"),
        (&["urban", "--set", "ozone"], "no ="),
        (&["urban", "--ozone", "100"], "--set ozone"),
        (&["urban", "--visibility", "50"], "--visibility"),
        (
            &["urban", "--wavelengths", "550,440", "--out", "a.json"],
            "increase",
        ),
        (&["urban", "--wavelengths", "200", "--out", "a.json"], "200"),
        (&[], "--visibility"),
    ] {
        let complaint = complaint(folder.path(), arguments);
        assert!(complaint.contains(says), "{arguments:?}: {complaint}");
    }
    assert!(!folder.path().join("a.json").exists());
}

/// Ranges that begin below zero are no options.
#[test]
fn make_says_which_suns_a_model_cannot_have() {
    let folder = tempfile::tempdir().unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_welkin-fit"))
        .current_dir(folder.path())
        .args(["make", "desert", "--out", "desert.welkin"])
        .args(["--elevations", "-30..40"])
        .output()
        .unwrap();
    assert!(!output.status.success(), "{output:?}");
    let complaint = String::from_utf8(output.stderr).unwrap();
    assert!(complaint.contains("solar elevations"), "{complaint}");
    assert!(!complaint.contains("wrong order"), "{complaint}");
    let output = Command::new(env!("CARGO_BIN_EXE_welkin-fit"))
        .current_dir(folder.path())
        .args(["make", "desert", "--out", "desert.welkin"])
        .args(["--elevations", "40..5"])
        .output()
        .unwrap();
    let complaint = String::from_utf8(output.stderr).unwrap();
    assert!(
        complaint.contains("solar elevations 40..5 are in the wrong order"),
        "{complaint}"
    );
    assert!(std::fs::read_dir(folder.path()).unwrap().next().is_none());
}

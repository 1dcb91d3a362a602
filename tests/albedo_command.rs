//! `--albedo` by wavelength in the command: what the library says.
#![cfg(feature = "cli")]

mod common;

use std::fs;
use std::path::Path;

use common::command::run;
use exr::prelude::{FlatSamples, read_all_flat_layers_from_file};
use welkin::{Albedo, Conditions, Model};

const LIST: &str = "450:0.04,680:0.05,750:0.45";
const TABLE: &str = "# grass\nwavelength_nm,albedo\n450,0.04\n680,0.05\n750,0.45\n";

fn meadow() -> Model {
    let grass = Albedo::table(&[450.0, 680.0, 750.0], &[0.04, 0.05, 0.45]).unwrap();
    Model::default_model().unwrap().over(&grass)
}

/// R, G, B of the pixel in the middle of a picture.
fn middle(path: &Path) -> [f32; 3] {
    let image = read_all_flat_layers_from_file(path).unwrap();
    ["R", "G", "B"].map(|name| {
        let channels = &image.layer_data[0].channel_data.list;
        let channel = channels
            .iter()
            .find(|c| c.name.to_string() == name)
            .unwrap();
        match &channel.sample_data {
            FlatSamples::F32(values) => values[values.len() / 2],
            other => panic!("{other:?}"),
        }
    })
}

/// The names of recipes are those of the command.
#[test]
fn grounds_have_names() {
    let folder = tempfile::tempdir().unwrap();
    let said = |albedo: &str| {
        let output = run(folder.path(), &["light", "--json", "--albedo", albedo], "");
        let text = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{text}");
        String::from_utf8(output.stdout).unwrap()
    };
    assert_eq!(said("sea"), said("0.06"));
    assert_eq!(said("urban"), said("0.18"));
    assert_ne!(said("grass"), said("sand"));
    let output = run(folder.path(), &["light", "--albedo", "moss"], "");
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(
        text.contains("none of grass, snow, sand, sea, urban, and no file"),
        "{text}"
    );
}

#[test]
fn pictures_are_over_the_ground() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("grass.csv"), TABLE).unwrap();
    let expected = meadow().colour_sky(&Conditions::default()).unwrap();
    let expected = expected.linear_srgb([0.0, 0.0, 1.0]).unwrap();
    for (albedo, out) in [(LIST, "a.exr"), ("grass.csv", "b.exr")] {
        // The middle of the fish-eye is the zenith.
        let line = [
            "render",
            "--size",
            "3",
            "--exr-type",
            "float",
            "--albedo",
            albedo,
            "--out",
            out,
        ];
        let output = run(folder, &line, "");
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{text}");
        for (got, wanted) in middle(&folder.join(out)).into_iter().zip(expected) {
            assert!((got / wanted - 1.0).abs() < 0.01, "{got} {wanted}");
        }
    }
    let [a, b] = ["a.exr", "b.exr"].map(|name| middle(&folder.join(name)));
    assert_eq!(a, b);
}

/// Below the horizon grass is green, in pictures and in the light that it sends.
#[test]
fn lit_ground_has_its_colour() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let line = [
        "render",
        "--size",
        "2",
        "--exr-type",
        "float",
        "--projection",
        "cube",
        "--ground",
        "--albedo",
        "500:0.02,550:0.3,600:0.02",
        "--out",
        "g.exr",
        "--altitude",
        "10",
    ];
    let output = run(folder, &line, "");
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{text}");
    let image = read_all_flat_layers_from_file(folder.join("g.exr")).unwrap();
    let greenest = |name: &str| {
        let channels = &image.layer_data[0].channel_data.list;
        let channel = channels
            .iter()
            .find(|c| c.name.to_string() == name)
            .unwrap();
        match &channel.sample_data {
            FlatSamples::F32(values) => values.clone(),
            other => panic!("{other:?}"),
        }
    };
    let [r, g, b] = ["R", "G", "B"].map(greenest);
    let green = (0..g.len())
        .filter(|&i| g[i] > 1.5 * r[i] && g[i] > 1.5 * b[i])
        .count();
    assert!(green >= 4 && green <= g.len() / 2, "{green} of {}", g.len());
}

#[test]
fn rows_have_the_albedo_of_their_wavelength() {
    let folder = tempfile::tempdir().unwrap();
    let rows = "quantity,visibility_km,altitude_m,solar_elevation_deg,view_zenith_deg,view_azimuth_deg,wavelength_nm\n\
                radiance,59.4,0,20,0,0,600\nradiance,59.4,0,20,0,0,740\n";
    let output = run(
        folder.path(),
        &["query", "--strict", "--albedo", LIST],
        rows,
    );
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let sky = meadow().sky(&Conditions::default()).unwrap();
    for (line, wavelength) in text.lines().skip(1).zip([600.0, 740.0]) {
        let cells: Vec<&str> = line.split(',').collect();
        let got: f32 = cells[7].parse().unwrap();
        let wanted = sky.radiance_at([0.0, 0.0, 1.0], wavelength).unwrap();
        assert!((got / wanted - 1.0).abs() < 1e-3, "{got} {wanted}");
    }
}

#[test]
fn what_is_wrong_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(
        folder.join("bad.csv"),
        "wavelength_nm,albedo\n450,0.04\n500,1.5\n",
    )
    .unwrap();
    let cases: [(&[&str], &str); 6] = [
        (
            &["render", "--albedo", "bad.csv"],
            "line 3: albedo must be in 0..=1, got 1.5",
        ),
        (
            &["render", "--albedo", "none.csv"],
            "no number, none of grass, snow, sand, sea, urban, and no file",
        ),
        (&["light", "--albedo", "500:0.1,400:0.2"], "increase"),
        (&["light", "--albedo", "500:x"], "must be a number"),
        (
            &["render", "--albedo", LIST, "--altitude", "400000"],
            "give --albedo a number",
        ),
        (
            &["query", "--albedo", LIST, "--wavelengths", "500"],
            "take a number",
        ),
    ];
    for (line, expected) in cases {
        let output = run(folder, line, "");
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{line:?} {text}");
        assert!(
            text.contains(expected) && text.lines().count() == 1,
            "{line:?} {text}"
        );
    }
}

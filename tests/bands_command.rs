//! `--bands` and `--wavelengths` of the command: what the library says, under good names.
#![cfg(feature = "cli")]

mod common;

use std::fs;
use std::path::Path;

use common::command::run;
use exr::prelude::{AnyChannel, AttributeValue, FlatSamples, Text, read_all_flat_layers_from_file};
use welkin::{Bands, Conditions, Model, PolarisationFrame, Response, Stokes};

const CAMERA: &str =
    "# a camera\nwavelength_nm,red,Band 2\n400,0,0\n450,0,1\n500,0.1,0\n600,1,0\n680,0,0\n";
const HEADER: &str = "quantity,visibility_km,albedo,altitude_m,solar_elevation_deg,view_zenith_deg,view_azimuth_deg,distance_m";

/// As in [`CAMERA`].
fn camera(model: &Model) -> Bands {
    let nm = [400.0, 450.0, 500.0, 600.0, 680.0];
    let red = Response::table(&nm, &[0.0, 0.0, 0.1, 1.0, 0.0]).unwrap();
    let blue = Response::table(&nm, &[0.0, 1.0, 0.0, 0.0, 0.0]).unwrap();
    model.bands(&[red, blue]).unwrap()
}

fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments, String::new());
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?} {text}");
    assert!(!text.contains("panicked"), "{text}");
    text
}

/// Channels of a picture by name, and one of its attributes.
fn picture(path: &Path, attribute: &str) -> (Vec<(String, Vec<f32>)>, Option<String>) {
    let image = read_all_flat_layers_from_file(path).unwrap();
    let layer = &image.layer_data[0];
    let channel = |channel: &AnyChannel<FlatSamples>| match &channel.sample_data {
        FlatSamples::F32(values) => (channel.name.to_string(), values.clone()),
        other => panic!("{other:?}"),
    };
    let text = match layer.attributes.other.get(&Text::from(attribute)) {
        Some(AttributeValue::Text(text)) => Some(text.to_string()),
        _ => None,
    };
    (layer.channel_data.list.iter().map(channel).collect(), text)
}

#[test]
fn pictures_have_a_channel_per_band() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("camera.csv"), CAMERA).unwrap();
    // The middle of the fish-eye is the zenith.
    let arguments = [
        "render",
        "--size",
        "3",
        "--out",
        "p",
        "--bands",
        "camera.csv",
    ];
    let output = run(folder, &arguments, String::new());
    assert!(output.status.success(), "{output:?}");
    assert!(
        fs::read(folder.join("p.png"))
            .unwrap()
            .starts_with(b"\x89PNG")
    );
    let (channels, units) = picture(&folder.join("p.exr"), "units");
    assert_eq!(units.as_deref(), Some("W.m^-2.sr^-1"));
    let names: Vec<&str> = channels.iter().map(|c| c.0.as_str()).collect();
    assert_eq!(names, ["Band 2", "red"]);
    let model = Model::default_model().unwrap();
    let sky = model
        .band_sky(&Conditions::default(), &camera(&model))
        .unwrap();
    let mut zenith = [0.0; 2];
    sky.radiance([0.0, 0.0, 1.0], &mut zenith).unwrap();
    for (channel, expected) in channels.iter().zip([zenith[1], zenith[0]]) {
        assert!((channel.1[4] / expected - 1.0).abs() < 1e-5, "{channel:?}");
    }

    let arguments = [
        "render",
        "--size",
        "3",
        "--out",
        "l.exr",
        "--wavelengths",
        "670,440.5",
    ];
    let output = run(folder, &arguments, String::new());
    assert!(output.status.success(), "{output:?}");
    let (channels, layout) = picture(&folder.join("l.exr"), "spectralLayoutVersion");
    assert_eq!(layout.as_deref(), Some("1.0"));
    let sky = model.sky(&Conditions::default()).unwrap();
    for (channel, (name, nm)) in channels
        .iter()
        .zip([("S0.440,5nm", 440.5), ("S0.670nm", 670.0)])
    {
        let expected = sky.radiance_at([0.0, 0.0, 1.0], nm).unwrap();
        assert_eq!(channel.0, name);
        assert!((channel.1[4] / expected - 1.0).abs() < 5e-3, "{channel:?}");
    }
}

#[test]
fn a_frame_of_other_bands_is_another_frame() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let arguments = [
        "animate",
        "--frames",
        "2",
        "--sun-elevation",
        "5..9",
        "--size",
        "2",
        "--out",
        "f",
        "--bands",
        "camera.csv",
    ];
    fs::write(folder.join("camera.csv"), CAMERA).unwrap();
    assert!(run(folder, &arguments, String::new()).status.success());
    assert!(run(folder, &arguments, String::new()).status.success());
    fs::write(folder.join("camera.csv"), CAMERA.replace("600,1", "600,2")).unwrap();
    assert!(refused(folder, &arguments).contains("not of this call"));
}

#[test]
fn what_cannot_be_bands_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let bands = |text: &str| {
        fs::write(folder.join("b.csv"), text).unwrap();
        refused(folder, &["render", "--out", "x", "--bands", "b.csv"])
    };
    assert!(bands("").contains("b.csv: expected the columns wavelength_nm"));
    assert!(bands("wavelength_nm,λ\n500,1\n600,1\n").contains("b.csv: the name of a band"));
    assert!(bands("wavelength_nm,a\n500,NaN\n600,1\n").contains("b.csv: a: "));
    assert!(
        bands("wavelength_nm,a\n2,1\n600,1\n").contains("a: the response reaches from 2 to 600")
    );
    assert!(refused(folder, &["render", "--bands", "none.csv"]).contains("none.csv: "));
    let wavelengths = |list: &str| refused(folder, &["render", &format!("--wavelengths={list}")]);
    assert!(wavelengths("450,2").contains("wavelength must be in"));
    assert!(wavelengths("NaN").contains("wavelength must be in"));
    assert!(wavelengths("450,550,450.0").contains("450 nm is given twice"));
    assert!(wavelengths("").contains("--wavelengths"));
    for other in [
        "--spectral",
        "--stokes",
        "--ground",
        "--sun",
        "--terrain=hills",
        "--polariser=3",
        "--bands=b",
    ] {
        let text = refused(folder, &["render", "--wavelengths", "500", other]);
        assert!(text.contains("cannot be used with"), "{other} {text}");
    }
    assert!(!folder.join("x.exr").exists() && !folder.join("sky.exr").exists());
}

/// Rows of numbers, without the columns that were asked.
fn answers(folder: &Path, bands: &[&str], table: String) -> (Vec<String>, Vec<Vec<String>>) {
    let output = run(folder, &[&["query"], bands].concat(), table);
    assert!(output.status.success(), "{output:?}");
    let mut reader = csv::Reader::from_reader(output.stdout.as_slice());
    let new = |row: &csv::StringRecord| row.iter().skip(8).map(str::to_owned).collect();
    let header = new(reader.headers().unwrap());
    (
        header,
        reader.records().map(|row| new(&row.unwrap())).collect(),
    )
}

#[test]
fn queries_have_a_column_per_band() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("camera.csv"), CAMERA).unwrap();
    let rows = [
        "radiance,50,0.2,100,30,60,30,",
        "transmittance,50,0.2,100,30,85,30,20000",
        "transmittance,50,0.2,100,30,60,30,",
        "in_scattering,50,0.2,100,30,85,30,20000",
        "stokes_q,50,0.2,100,30,60,30,",
        "stokes_u,50,0.2,100,30,85,30,20000",
        "polarisation,50,0.2,100,30,60,30,",
        "sun_radiance,50,0.2,100,30,60,0,",
        "relative_radiance,50,0.2,100,30,60,30,",
        "radiance,5,0.2,100,30,60,30,",
    ];
    let table = format!("{HEADER}\n{}\n", rows.join("\n"));
    let (header, got) = answers(folder, &["--bands", "camera.csv"], table.clone());
    assert_eq!(header, ["red", "Band 2", "error"]);
    assert!(
        got[8][2].contains("relative_radiance has no bands"),
        "{got:?}"
    );
    assert!(
        got[9][0].is_empty() && got[9][2].contains("visibility"),
        "{got:?}"
    );

    let model = Model::default_model().unwrap();
    let bands = camera(&model);
    let conditions = Conditions {
        visibility: 50e3,
        albedo: 0.2,
        altitude: 100.0,
        solar_elevation: 30f64.to_radians(),
        ..Conditions::default()
    };
    let towards = |zenith: f64, azimuth: f64| {
        let ((r, z), (y, x)) = (
            zenith.to_radians().sin_cos(),
            azimuth.to_radians().sin_cos(),
        );
        [r * x, r * y, z]
    };
    let view = towards(60.0, 30.0);
    let (narrow, from) = (view.map(|v| v as f32), [0.0, 0.0, 100.0]);
    let far = towards(85.0, 30.0);
    let to = std::array::from_fn(|k| from[k] + 2e4 * far[k]);
    let mut expected = [[0.0; 2]; 8];
    let sky = model.band_sky(&conditions, &bands).unwrap();
    sky.radiance(narrow, &mut expected[0]).unwrap();
    let aerial = model.band_aerial_perspective(&conditions, &bands).unwrap();
    let (mut light, mut through) = ([0.0; 2], [0.0; 2]);
    aerial
        .in_scattering(from, to, &mut light, &mut through)
        .unwrap();
    expected[1] = through;
    // Light of segments is asked at all wavelengths of the model, whose quadrature is a little finer.
    let whole = model.aerial_perspective(&conditions).unwrap();
    let n = model.wavelengths().len();
    let (mut nodes, mut rest) = (vec![0.0; n], vec![0.0; n]);
    whole
        .in_scattering(from, to, &mut nodes, &mut rest)
        .unwrap();
    for (light, &l) in nodes.iter_mut().zip(model.wavelengths()) {
        *light /= model.head().solar_irradiance_at(l) as f32;
    }
    bands.project(&nodes, &mut expected[3]).unwrap();
    assert!(
        (light[0] / expected[3][0] - 1.0).abs() < 1e-3,
        "{light:?} {:?}",
        expected[3]
    );
    let air = aerial.transmittance();
    air.transmittance_to_end(from, view, &mut expected[2])
        .unwrap();
    let polarised = model.polarised_band_sky(&conditions, &bands).unwrap();
    let mut stokes = [Stokes::default(); 2];
    let frame = PolarisationFrame::Vertical;
    polarised.stokes(narrow, frame, &mut stokes).unwrap();
    expected[4] = stokes.map(|s| s.q);
    aerial
        .in_scattering_stokes(from, to, frame, &mut stokes, &mut through)
        .unwrap();
    expected[5] = stokes.map(|s| s.u);
    let frame = PolarisationFrame::SunAligned;
    polarised.stokes(narrow, frame, &mut stokes).unwrap();
    expected[6] = stokes.map(|s| s.signed_degree());
    let disc = model.band_solar_disc(&conditions, &bands).unwrap();
    let sun = towards(60.0, 0.0).map(|v| v as f32);
    disc.radiance(sun, &mut expected[7]).unwrap();
    for ((row, got), expected) in rows.iter().zip(&got).zip(expected) {
        for (got, expected) in got.iter().zip(expected) {
            let got: f32 = got.parse().unwrap();
            assert!(expected != 0.0, "{row}");
            assert!(
                (got / expected - 1.0).abs() < 1e-4,
                "{row}: {got} {expected}"
            );
        }
    }

    // A column of wavelengths may stand there; it counts without bands alone.
    let (header, got) = answers(folder, &["--wavelengths", "550.5,440"], table);
    assert_eq!(header, ["550.5nm", "440nm", "error"]);
    let sky = model.sky(&conditions).unwrap();
    for (got, nm) in got[0].iter().zip([550.5, 440.0]) {
        let expected = sky.radiance_at(narrow, nm).unwrap();
        assert!((got.parse::<f32>().unwrap() / expected - 1.0).abs() < 5e-3);
    }
    let text = refused(folder, &["query", "--bands", "camera.csv"]);
    assert!(
        text.contains("lacks the column \"quantity\"") || text.contains("visibility_km"),
        "{text}"
    );
}

#[test]
fn a_column_that_is_there_already_is_not_written_over() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("camera.csv"), CAMERA).unwrap();
    let table = format!("{HEADER},red\n");
    let output = run(folder.path(), &["query", "--bands", "camera.csv"], table);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        String::from_utf8(output.stderr)
            .unwrap()
            .contains("a column \"red\" already")
    );
}

//! The sun's disc in pictures: its light, all of it, in the pixels that it covers.
#![cfg(feature = "cli")]

mod common;

use std::f64::consts::PI;
use std::path::Path;

use common::command::call;
use exr::prelude::read_all_flat_layers_from_file;
use welkin::Model;

struct Picture {
    size: [usize; 2],
    /// By name of the channel.
    planes: Vec<(String, Vec<f32>)>,
}

impl Picture {
    fn plane(&self, name: &str) -> &[f32] {
        &self.planes.iter().find(|(n, _)| n == name).unwrap().1
    }
}

fn picture(folder: &Path, line: &str) -> Picture {
    let output = call(folder, &format!("{line} --out p.exr"));
    assert!(output.status.success(), "{line}: {output:?}");
    let image = read_all_flat_layers_from_file(folder.join("p.exr")).unwrap();
    let layer = &image.layer_data[0];
    let planes = layer.channel_data.list.iter();
    Picture {
        size: [layer.size.width(), layer.size.height()],
        planes: planes
            .map(|c| (c.name.to_string(), c.sample_data.values_as_f32().collect()))
            .collect(),
    }
}

/// Solid angle of a pixel, sr, from formulas that the renderer does not have.
fn solid_angle(projection: &str, [width, height]: [usize; 2], [column, row]: [usize; 2]) -> f64 {
    let [x, y] = [column, row].map(|p| p as f64);
    match projection {
        "lat-long" => {
            let z = |row: f64| (PI * row / height as f64).cos();
            2.0 * PI / width as f64 * (z(y) - z(y + 1.0))
        }
        "cube" => {
            // Of the corner of a face's quadrant.
            let corner = |s: f64, t: f64| (s * t / (1.0 + s * s + t * t).sqrt()).atan();
            let n = width as f64;
            let at = |p: f64| p / n * 2.0 - 1.0;
            let row = (row % width) as f64;
            corner(at(x + 1.0), at(row + 1.0))
                - corner(at(x), at(row + 1.0))
                - corner(at(x + 1.0), at(row))
                + corner(at(x), at(row))
        }
        _ => {
            // Equidistant: sin θ / θ of the plane, over 8 × 8 points.
            let n = height as f64;
            let mut sum = 0.0;
            for k in 0..64 {
                let u = (x + ((k % 8) as f64 + 0.5) / 8.0) / n * 2.0 - 1.0;
                let v = (y + ((k / 8) as f64 + 0.5) / 8.0) / n * 2.0 - 1.0;
                let theta = u.hypot(v) * PI / 2.0;
                sum += if theta > 0.0 {
                    theta.sin() / theta
                } else {
                    1.0
                } / 64.0;
            }
            sum * (PI / n) * (PI / n)
        }
    }
}

/// Light on a plane that faces the sun, lx in linear sRGB, or W m⁻² nm⁻¹.
fn irradiance(folder: &Path, scene: &str, key: &str) -> Vec<f64> {
    let output = call(folder, &format!("light --json {scene}"));
    let light: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let values = light["direct_normal"][key].as_array().unwrap();
    values.iter().map(|v| v.as_f64().unwrap()).collect()
}

/// What `--sun` adds, times the solid angle of each pixel, in each channel.
fn added(folder: &Path, line: &str, projection: &str, channels: &[&str]) -> Vec<f64> {
    let line = format!("{line} --projection {projection}");
    let (with, without) = (
        picture(folder, &format!("{line} --sun")),
        picture(folder, &line),
    );
    let sum = |name: &&str| {
        let pairs = with.plane(name).iter().zip(without.plane(name)).enumerate();
        let terms = pairs.map(|(k, (a, b))| {
            let pixel = [k % with.size[0], k / with.size[0]];
            f64::from(a - b) * solid_angle(projection, with.size, pixel)
        });
        terms.sum::<f64>()
    };
    channels.iter().map(sum).collect()
}

#[test]
fn the_pixels_of_the_disc_hold_its_light() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (scene, size) in [
        ("--sun-elevation 33 --sun-azimuth 17 --view-azimuth 30", 256),
        // Smaller than a pixel, at the zenith, at an edge between faces, and half below the horizon.
        ("--sun-elevation 33 --sun-azimuth 17", 24),
        ("--sun-elevation 89.9 --sun-azimuth 40", 64),
        ("--sun-elevation 20 --sun-azimuth 45", 90),
        ("--sun-elevation 0.05 --sun-azimuth -20", 200),
    ] {
        let sun = scene.split(" --view").next().unwrap();
        let expected = irradiance(folder, sun, "linear_srgb");
        for projection in ["up", "side", "lat-long", "cube"] {
            // The edge of the fish-eyes runs through the sun.
            let is_cut = projection == "up" && sun.contains("0.05")
                || projection == "side" && sun.contains("89.9");
            if is_cut {
                continue;
            }
            let line = format!("render {scene} --size {size}");
            let got = added(folder, &line, projection, &["R", "G", "B"]);
            // A setting sun has next to no blue: what is left of larger numbers.
            let most = expected.iter().fold(0.0f64, |most, v| most.max(v.abs()));
            for (got, expected) in got.iter().zip(&expected) {
                assert!(
                    (got - expected).abs() < 4e-3 * expected.abs().max(0.01 * most),
                    "{line} {projection}: {got} {expected}"
                );
            }
        }
    }
}

#[test]
fn spectra_hold_it_too() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let expected = irradiance(folder, "--sun-elevation 12", "spectral");
    let nodes = Model::default_model().unwrap().wavelengths().to_vec();
    let places = [0, nodes.len() / 2, nodes.len() - 1];
    let names = places.map(|w| format!("S0.{}nm", nodes[w]));
    let got = added(
        folder,
        "render --sun-elevation 12 --size 100 --spectral",
        "lat-long",
        &names.each_ref().map(String::as_str),
    );
    for (got, expected) in got.iter().zip(places.map(|w| expected[w])) {
        assert!((got / expected - 1.0).abs() < 4e-3, "{got} {expected}");
    }
}

/// At 16 pixels across: bright in the middle, darker towards the limb, in between at the edge, nothing beyond.
#[test]
fn the_limb_is_dark_and_its_edge_smooth() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let scene = "--sun-elevation 0.5 --view-azimuth 0 --visibility 100";
    // Half a degree in 16 pixels: the middle of the picture is the horizon, the sun 16 pixels above it.
    let line = format!("render {scene} --terrain flat --altitude 0 --field-of-view 4 --size 128");
    let (with, without) = (
        picture(folder, &format!("{line} --sun")),
        picture(folder, &line),
    );
    let green = |p: &Picture, k: usize| p.plane("G")[k];
    let added: Vec<f32> = (0..with.plane("G").len())
        .map(|k| green(&with, k) - green(&without, k))
        .collect();
    let peak = added.iter().copied().fold(0.0, f32::max);
    let lit = added.iter().filter(|&&v| v > 0.0).count();
    let partial = added
        .iter()
        .filter(|&&v| v > 0.0 && v < 0.25 * peak)
        .count();
    // π/4 · 17² pixels, and its circumference.
    assert!((200..330).contains(&lit), "{lit}");
    assert!((15..80).contains(&partial), "{partial}");
    assert!(peak > 1e6, "{peak}");
}

#[test]
fn the_disc_is_refused_where_it_means_nothing() {
    let folder = tempfile::tempdir().unwrap();
    for (line, word) in [
        ("render --sun --stokes --out a", "cannot be used with"),
        (
            "render --sun --quantity dolp --out a",
            "--sun shows radiance only",
        ),
    ] {
        let output = call(folder.path(), line);
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}: {text}");
        assert!(text.contains(word) && text.lines().count() == 1, "{text}");
    }
    // A sun that has set adds nothing.
    let output = call(
        folder.path(),
        "render --sun --sun-elevation -3 --size 8 --out a.exr",
    );
    assert!(output.status.success(), "{output:?}");
}

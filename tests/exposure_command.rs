//! What becomes of light in PNGs: as a photographer would expose and develop it. EXRs stay as they are.
#![cfg(feature = "cli")]

mod common;

use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;

use common::command::call;
use exr::prelude::read_all_flat_layers_from_file;

fn works(folder: &Path, line: &str) {
    let output = call(folder, line);
    assert!(output.status.success(), "{line}: {output:?}");
}

fn png(path: &Path) -> Vec<[u8; 3]> {
    let file = BufReader::new(File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    bytes.as_chunks().0.to_vec()
}

fn text(path: &Path, keyword: &str) -> String {
    let file = BufReader::new(File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    reader.finish().unwrap();
    let texts = &reader.info().utf8_text;
    let found = texts.iter().find(|t| t.keyword == keyword);
    found.unwrap().get_text().unwrap()
}

/// R, G and B of every pixel.
fn exr(path: &Path) -> Vec<[f32; 3]> {
    let image = read_all_flat_layers_from_file(path).unwrap();
    let plane = |name: &str| -> Vec<f32> {
        let channels = &image.layer_data[0].channel_data.list;
        let channel = channels.iter().find(|c| c.name.to_string() == name);
        channel.unwrap().sample_data.values_as_f32().collect()
    };
    let [r, g, b] = ["R", "G", "B"].map(plane);
    (0..r.len()).map(|k| [r[k], g[k], b[k]]).collect()
}

/// Away from the sun and the horizon: neither slate nor clipped.
#[test]
fn a_noon_sky_is_blue() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (elevation, altitude) in [(55, 0), (40, 1000), (70, 3000)] {
        let line = format!(
            "render --sun-elevation {elevation} --altitude {altitude} --visibility 90 --size 64 --out sky"
        );
        works(folder, &line);
        // Two thirds down: 30° from the zenith, across from the sun.
        let [r, g, b] = png(&folder.join("sky.png"))[43 * 64 + 32];
        assert!(b > 150 && b < 245, "{line}: {r} {g} {b}");
        assert!(f32::from(b) > 1.6 * f32::from(r), "{line}: {r} {g} {b}");
        assert!(r < g && g < b, "{line}: {r} {g} {b}");
    }
}

/// The mean of the sky is one stop above middle grey, whatever the sun.
#[test]
fn the_automatic_exposure_is_as_documented() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for elevation in [-3.5, 2.0, 50.0] {
        works(
            folder,
            &format!("render --sun-elevation {elevation} --size 128 --projection lat-long --out s"),
        );
        let value: f64 = text(&folder.join("s.png"), "exposureValue")
            .parse()
            .unwrap();
        // Every row of the upper half by its share of the hemisphere.
        let (mut sum, mut weights) = (0.0, 0.0);
        for (k, [r, g, b]) in exr(&folder.join("s.exr"))
            .into_iter()
            .enumerate()
            .take(64 * 256)
        {
            let weight = (std::f64::consts::PI * (k / 256) as f64 / 128.0 + 0.012).sin();
            let luminance = 0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b);
            sum += weight * luminance.ln();
            weights += weight;
        }
        let white = 1.2 * value.exp2();
        let share = (sum / weights).exp() / white;
        assert!((share / 0.36 - 1.0).abs() < 0.03, "{elevation}: {share}");
    }
}

/// Landscapes in the middle grey of their mean, away from the sun and towards it, and a slope in the shadow before a
/// bright sky, of which no more than a twentieth of the picture is brighter than twice white.
#[test]
fn landscapes_are_exposed_for_what_they_show() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut values = Vec::new();
    for (view, is_dark) in [
        ("--altitude 2000 --view-azimuth 0 --pitch 0", false),
        ("--altitude 2000 --view-azimuth 180 --pitch 0", false),
        (
            "--altitude 1500 --view-azimuth 0 --pitch 0 --field-of-view 22",
            true,
        ),
    ] {
        works(
            folder,
            &format!("render --terrain hills --sun-elevation 5 {view} --size 40 --out l"),
        );
        let value: f64 = text(&folder.join("l.png"), "exposureValue")
            .parse()
            .unwrap();
        let white = 1.2 * value.exp2();
        let light = exr(&folder.join("l.exr"));
        let luminances: Vec<f64> = light
            .iter()
            .map(|rgb| {
                let [r, g, b] = rgb.map(f64::from);
                (0.2126 * r + 0.7152 * g + 0.0722 * b) / white
            })
            .collect();
        let count = luminances.len() as f64;
        let mean = (luminances.iter().map(|l| l.ln()).sum::<f64>() / count).exp();
        let bright = luminances.iter().filter(|&&l| l > 2.0).count() as f64 / count;
        match is_dark {
            false => assert!((mean / 0.25 - 1.0).abs() < 1e-3, "{view}: {mean}"),
            true => assert!(
                mean < 0.2 && (0.04..=0.051).contains(&bright),
                "{mean} {bright}"
            ),
        }
        assert!(bright <= 0.051, "{view}: {bright}");
        values.push(value);
    }
    assert!(values[0] > values[1] + 0.5, "{values:?}");
}

#[test]
fn curves_and_white_balance_change_the_png_alone() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut pictures = Vec::new();
    for (tone, balance) in [
        ("linear", "d65"),
        ("filmic", "d65"),
        ("aces", "d65"),
        ("aces", "daylight"),
    ] {
        let line = format!(
            "render --size 32 --exposure 13 --tone {tone} --white-balance {balance} --out p"
        );
        works(folder, &line);
        let path = folder.join("p.png");
        assert_eq!(
            (&*text(&path, "toneCurve"), &*text(&path, "whiteBalance")),
            (tone, balance)
        );
        assert_eq!(text(&path, "exposureValue"), "13");
        let picture = (png(&path), exr(&folder.join("p.exr")));
        for (other, light) in &pictures {
            assert!(*other != picture.0, "{tone} {balance}");
            assert!(*light == picture.1);
        }
        pictures.push(picture);
    }
    works(folder, "render --size 32 --exposure 13 --out p");
    assert!(png(&folder.join("p.png")) == pictures[3].0);
    // A pixel of the linear one, by hand: 1.2 · 2¹³ cd m⁻² is white.
    let (shown, light) = &pictures[0];
    let k = 20 * 32 + 16;
    for c in 0..3 {
        let v = (light[k][c] / (1.2 * 8192.0)).clamp(0.0, 1.0);
        let encoded = 1.055 * v.powf(1.0 / 2.4) - 0.055;
        assert!((encoded * 255.0 - f32::from(shown[k][c])).abs() < 0.6);
    }
    let output = call(folder, "render --tone sepia --out q");
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(
        message.contains("linear, filmic, aces") && message.lines().count() == 1,
        "{message}"
    );
    assert!(!fs::exists(folder.join("q.png")).unwrap());
}

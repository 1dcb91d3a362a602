//! What `welkin export` writes for renderers, read as each of them reads it.
#![cfg(feature = "cli")]

mod common;

use std::f64::consts::{FRAC_2_PI, PI, TAU};
use std::path::Path;

use common::command::{call, run};
use common::unit;
use exr::prelude::read_all_flat_layers_from_file;
use welkin::SOLAR_ANGULAR_RADIUS;

type Vector = [f64; 3];

const SKY: &str = "--sun-elevation 25 --sun-azimuth 40 --visibility 40";
const SUN: [f64; 2] = [25.0, 40.0];
/// Renderer, axis that is up, extension of the scene.
const ALL: [[&str; 3]; 8] = [
    ["pbrt", "z", "pbrt"],
    ["pbrt", "y", "pbrt"],
    ["arnold", "y", "ass"],
    ["arnold", "z", "ass"],
    ["karma", "y", "usda"],
    ["karma", "z", "usda"],
    ["usd", "z", "usda"],
    ["usd", "y", "usda"],
];

struct Map {
    size: [usize; 2],
    /// Red, green, blue.
    planes: [Vec<f32>; 3],
}

impl Map {
    fn read(path: &Path) -> Self {
        let image = read_all_flat_layers_from_file(path).unwrap();
        let layer = &image.layer_data[0];
        let plane = |name: &str| {
            let channels = &layer.channel_data.list;
            let channel = channels.iter().find(|c| c.name.to_string() == name);
            channel.unwrap().sample_data.values_as_f32().collect()
        };
        Self {
            size: [layer.size.width(), layer.size.height()],
            planes: ["R", "G", "B"].map(plane),
        }
    }

    /// Column and row of a place, from the left and from the top, 0 to 1.
    fn pixel(&self, place: [f64; 2]) -> [usize; 2] {
        std::array::from_fn(|i| ((place[i] * self.size[i] as f64) as usize).min(self.size[i] - 1))
    }

    fn at(&self, place: [f64; 2]) -> Vector {
        let [column, row] = self.pixel(place);
        std::array::from_fn(|c| f64::from(self.planes[c][row * self.size[0] + column]))
    }

    fn brightest(&self) -> [usize; 2] {
        let green = &self.planes[1];
        let brightest = (0..green.len()).max_by(|&a, &b| green[a].total_cmp(&green[b]));
        brightest
            .map(|k| [k % self.size[0], k / self.size[0]])
            .unwrap()
    }
}

/// Where pbrt-v4 looks up a direction: Clarberg 2008, from the sphere to the square.
fn equal_area([x, y, z]: Vector) -> [f64; 2] {
    let size = (1.0 - z.abs()).max(0.0).sqrt();
    let share = y.abs().atan2(x.abs()) * FRAC_2_PI;
    let [u, v] = [size * (1.0 - share), size * share];
    let [u, v] = if z < 0.0 { [1.0 - v, 1.0 - u] } else { [u, v] };
    [u.copysign(x), v.copysign(y)].map(|v| 0.5 + 0.5 * v)
}

/// Where OpenEXR's lat-long maps have a direction: +y up, longitudes from +z to +x, +π at the left edge.
fn open_exr([x, y, z]: Vector) -> [f64; 2] {
    let (latitude, longitude) = (y.asin(), x.atan2(z));
    [0.5 - longitude / TAU, 0.5 - latitude / PI]
}

/// From the axes of a scene to those with +z up.
fn upright(up: &str, [x, y, z]: Vector) -> Vector {
    match up {
        "y" => [x, -z, y],
        _ => [x, y, z],
    }
}

/// To the axes of a scene.
fn in_scene(up: &str, [x, y, z]: Vector) -> Vector {
    match up {
        "y" => [x, z, -y],
        _ => [x, y, z],
    }
}

/// Where a renderer looks for a direction of its scene, as the scene says.
fn look_up(renderer: &str, up: &str, scene: &str, direction: Vector) -> [f64; 2] {
    let turned_up = [
        "Rotate -90 1 0 0",
        "matrix\n 1 0 0 0\n 0 0 1 0\n 0 -1 0 0\n 0 0 0 1\n",
        "float xformOp:rotateX:orientToStageUpAxis = 90",
    ];
    let is_turned = turned_up.iter().any(|line| scene.contains(line));
    // Only what is not upright by itself is turned, and each into its own axes.
    assert_eq!(
        is_turned,
        (renderer == "pbrt") == (up == "y"),
        "{renderer} {up}: {scene}"
    );
    match renderer {
        "pbrt" => equal_area(upright(up, direction)),
        // Its own +y is +z with +z up, its +z is −y.
        _ => open_exr(in_scene("y", upright(up, direction))),
    }
}

fn export(folder: &Path, line: &str, [renderer, up, extension]: [&str; 3]) -> (Map, String) {
    let line = format!("export --for {renderer} --up {up} {line} --out s");
    let output = call(folder, &line);
    assert!(output.status.success(), "{line}");
    // Red suns have no blue in sRGB.
    let said = String::from_utf8(output.stderr).unwrap();
    let is_known = said.starts_with("warning: pbrt takes negative components");
    assert!(
        said.is_empty() || renderer == "pbrt" && is_known,
        "{line}: {said}"
    );
    let scene = std::fs::read_to_string(folder.join(format!("s.{extension}"))).unwrap();
    (Map::read(&folder.join("s.exr")), scene)
}

fn light(folder: &Path, scene: &str) -> serde_json::Value {
    let output = call(folder, &format!("light --json {scene}"));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn rgb(light: &serde_json::Value, key: &str) -> Vector {
    let values = light[key]["linear_srgb"].as_array().unwrap();
    std::array::from_fn(|c| values[c].as_f64().unwrap())
}

/// The numbers that follow a word up to the end of the line, without brackets and commas.
fn numbers(text: &str, word: &str) -> Vec<f64> {
    let rest = text
        .split(word)
        .nth(1)
        .unwrap_or_else(|| panic!("no {word}: {text}"));
    let line = rest.lines().next().unwrap();
    let cells = line.split([' ', ',', '(', ')', '[', ']', '=', '"']);
    cells
        .map_while(|cell| match cell {
            "" => Some(None),
            cell => cell.parse().ok().map(Some),
        })
        .flatten()
        .collect()
}

fn close(a: Vector, b: Vector, tolerance: f64, what: &str) {
    let off = (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max);
    let size = b.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    assert!(off <= tolerance * size, "{what}: {a:?} {b:?}");
}

#[test]
fn a_level_plane_gets_the_light_of_the_sky() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let expected = rgb(&light(folder, SKY), "diffuse_horizontal");
    for each @ [renderer, up, _] in ALL {
        let (map, scene) = export(folder, &format!("{SKY} --size 256"), each);
        // Rings of equal height over the upper hemisphere, much finer than pixels.
        const RINGS: usize = 1000;
        const SPOKES: usize = 2000;
        let mut sum = [0.0; 3];
        for ring in 0..RINGS {
            let z = (ring as f64 + 0.5) / RINGS as f64;
            for spoke in 0..SPOKES {
                let azimuth = TAU * (spoke as f64 + 0.5) / SPOKES as f64;
                let direction = in_scene(up, unit(z.asin(), azimuth));
                let pixel = map.at(look_up(renderer, up, &scene, direction));
                sum = std::array::from_fn(|c| sum[c] + z * pixel[c]);
            }
        }
        let irradiance = sum.map(|v| v * TAU / (RINGS * SPOKES) as f64);
        close(irradiance, expected, 3e-3, &format!("{renderer} {up}"));
    }
}

#[test]
fn the_disc_in_the_map_is_where_the_sun_is() {
    let folder = tempfile::tempdir().unwrap();
    for each @ [renderer, up, _] in ALL {
        for [elevation, azimuth] in [SUN, [3.0, -170.0], [70.0, 200.0]] {
            let sky = format!("--sun-elevation {elevation} --sun-azimuth {azimuth}");
            let (map, scene) = export(folder.path(), &format!("{sky} --sun --size 360"), each);
            let sun = in_scene(up, unit(elevation.to_radians(), azimuth.to_radians()));
            let at = map.pixel(look_up(renderer, up, &scene, sun));
            let brightest = map.brightest();
            // The centre may lie at an edge between pixels.
            let off = [0, 1].map(|i| at[i].abs_diff(brightest[i]));
            assert!(
                off[0] <= 1 && off[1] <= 1,
                "{renderer} {up} {sky}: {at:?} {brightest:?}"
            );
            let has_light = ["distant", "Distant"]
                .iter()
                .any(|word| scene.contains(word));
            assert!(!has_light, "two suns: {scene}");
        }
    }
}

/// Pixels of the same solid angle, also where the disc lies across the folds of the map.
#[test]
fn the_disc_in_the_map_for_pbrt_has_the_light_of_the_sun() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for sky in [
        "--sun-elevation 25 --sun-azimuth 40",
        "--sun-elevation 60 --sun-azimuth 90",
        "--sun-elevation 0.3 --sun-azimuth 45",
        "--sun-elevation 0.05 --sun-azimuth 0",
        "--sun-elevation 89.9",
    ] {
        let (with, _) = export(folder, &format!("{sky} --size 400 --sun"), ALL[0]);
        let (without, _) = export(folder, &format!("{sky} --size 400"), ALL[0]);
        let solid_angle = 4.0 * PI / (400.0 * 400.0);
        let irradiance = std::array::from_fn(|c| {
            let pairs = with.planes[c].iter().zip(&without.planes[c]);
            pairs.map(|(a, b)| f64::from(a - b)).sum::<f64>() * solid_angle
        });
        close(
            irradiance,
            rgb(&light(folder, sky), "direct_normal"),
            4e-3,
            sky,
        );
    }
}

#[test]
fn the_sun_shines_from_where_it_is_with_its_irradiance() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let described = light(folder, SKY);
    let expected = rgb(&described, "direct_normal");
    let lux = described["direct_normal"]["luminous"].as_f64().unwrap();
    for each @ [renderer, up, _] in ALL {
        let (_, scene) = export(folder, &format!("{SKY} --size 8"), each);
        let direction = in_scene(up, unit(SUN[0].to_radians(), SUN[1].to_radians()));
        let vector = |word: &str| -> Vector { numbers(&scene, word).try_into().unwrap() };
        let number = |word: &str| numbers(&scene, word)[0];
        let what = format!("{renderer} {up}");
        let (from, irradiance) = match renderer {
            "pbrt" => {
                assert!((number("\"float illuminance\"") / lux - 1.0).abs() < 1e-6);
                let from: Vec<f64> = numbers(&scene, "\"point3 from\"");
                // In the frame of the map, which the same lines turn.
                let from: Vector = from.try_into().unwrap();
                (in_scene(up, from), vector("\"rgb L\""))
            }
            "arnold" => {
                assert!(scene.contains(" normalize on\n"));
                let dark = scene.split("distant_light").nth(1).unwrap();
                let colour: Vector = numbers(dark, " color").try_into().unwrap();
                let intensity = numbers(dark, " intensity")[0];
                (
                    vector(" direction").map(|v| -v),
                    colour.map(|v| v * intensity),
                )
            }
            _ => {
                let sun = scene.split("DistantLight").nth(1).unwrap();
                let colour: Vector = numbers(sun, "inputs:color").try_into().unwrap();
                let intensity = numbers(sun, "inputs:intensity")[0];
                // UsdLux: a normalised light has its irradiance, others the radiance of their disc.
                let sine = SOLAR_ANGULAR_RADIUS.sin();
                let factor = match numbers(sun, "inputs:normalize")[0] as i32 {
                    1 => 1.0,
                    _ => PI * sine * sine,
                };
                assert_eq!(factor == 1.0, renderer == "usd", "{what}");
                (usd_direction(sun), colour.map(|v| v * intensity * factor))
            }
        };
        close(from, direction, 1e-6, &what);
        close(irradiance, expected, 1e-5, &what);
        if renderer != "pbrt" {
            let angle = numbers(&scene, "angle")[0];
            let diameter = 2.0 * SOLAR_ANGULAR_RADIUS.to_degrees();
            assert!((angle / diameter - 1.0).abs() < 1e-6, "{what}: {angle}");
        }
    }
}

/// Where a light of USD that shines along −z comes from, by its rotations, the last first.
fn usd_direction(light: &str) -> Vector {
    let mut direction = [0.0, 0.0, 1.0];
    let order = light
        .split("xformOpOrder = [")
        .nth(1)
        .unwrap()
        .split(']')
        .next()
        .unwrap();
    for name in order.split(", ").collect::<Vec<_>>().into_iter().rev() {
        let name = name.trim_matches('"');
        let (s, c) = numbers(light, name)[0].to_radians().sin_cos();
        let [x, y, z] = direction;
        direction = match name {
            "xformOp:rotateX" => [x, c * y - s * z, s * y + c * z],
            "xformOp:rotateY" => [c * x + s * z, y, c * z - s * x],
            "xformOp:rotateZ" => [c * x - s * y, s * x + c * y, z],
            _ => panic!("{name}"),
        };
    }
    direction
}

/// CIE 1931 x̄, ȳ, z̄ as Wyman, Sloan and Shirley 2013 fit them, about 1 % off.
fn colour_matching(nm: f64) -> Vector {
    let lobe = |height: f64, middle: f64, below: f64, above: f64| {
        let width = if nm < middle { below } else { above };
        height * (-0.5 * ((nm - middle) / width).powi(2)).exp()
    };
    [
        lobe(1.056, 599.8, 37.9, 31.0) + lobe(0.362, 442.0, 16.0, 26.7)
            - lobe(0.065, 501.1, 20.4, 26.2),
        lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1),
        lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8),
    ]
}

/// As pbrt takes it: straight lines between samples, 683 lm/W.
#[test]
fn the_spectrum_for_pbrt_has_the_colour_of_the_sun() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for elevation in [3, 25, 60] {
        let sky = format!("--sun-elevation {elevation}");
        let (_, scene) = export(folder, &format!("{sky} --size 8"), ALL[0]);
        let samples = scene.split("\"spectrum L\" [").nth(1).unwrap();
        let samples = samples.lines().map(|line| {
            let words = line.split_whitespace();
            words.map_while(|n| n.parse().ok()).collect::<Vec<f64>>()
        });
        let samples: Vec<Vec<f64>> = samples.filter(|pair| pair.len() == 2).collect();
        assert!(samples.windows(2).all(|pair| pair[0][0] < pair[1][0]));
        let ends = [samples[0][0], samples[samples.len() - 1][0]];
        assert_eq!(ends, [360.0, 830.0]);
        let mut xyz = [0.0; 3];
        for pair in samples.windows(2) {
            let step = pair[1][0] - pair[0][0];
            for k in 0..10 {
                let t = (f64::from(k) + 0.5) / 10.0;
                let value = pair[0][1] + t * (pair[1][1] - pair[0][1]);
                let weights = colour_matching(pair[0][0] + t * step);
                xyz = std::array::from_fn(|c| xyz[c] + 683.0 * weights[c] * value * step / 10.0);
            }
        }
        let got = welkin::xyz_to_linear_srgb(xyz.map(|v| v as f32)).map(f64::from);
        let expected = rgb(&light(folder, &sky), "direct_normal");
        close(got, expected, 0.02, &sky);
    }
}

#[test]
fn white_at_an_exposure_value_becomes_one() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let scale: f64 = 1.0 / (1.2 * 14f64.exp2());
    for each @ [renderer, ..] in ALL {
        let (plain, without) = export(folder, &format!("{SKY} --size 8"), each);
        let (map, with) = export(folder, &format!("{SKY} --size 8 --exposure 14"), each);
        assert_eq!(plain.planes, map.planes);
        let (word, expected) = match renderer {
            "pbrt" => ("\"float scale\"", scale),
            "arnold" => (" exposure", scale.log2()),
            _ => ("inputs:exposure", scale.log2()),
        };
        assert!(!without.contains(word), "{without}");
        // Of the sky and of the sun.
        let parts: Vec<&str> = with.split(word).collect();
        assert_eq!(parts.len(), 3, "{with}");
        for part in &parts[1..] {
            let value = numbers(&format!("{word}{part}"), word)[0];
            assert!((value / expected - 1.0).abs() < 1e-6, "{value} {expected}");
        }
    }
}

#[test]
fn a_sun_that_has_set_is_no_light() {
    let folder = tempfile::tempdir().unwrap();
    for each in ALL {
        let (_, scene) = export(folder.path(), "--sun-elevation -3 --size 8", each);
        assert!(!scene.to_lowercase().contains("distant"), "{scene}");
    }
}

#[test]
fn colours_of_map_and_sun_are_in_the_same_space() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let usd = ["usd", "z", "usda"];
    let (srgb, in_srgb) = export(folder, &format!("{SKY} --size 8"), usd);
    let (aces, in_aces) = export(
        folder,
        &format!("{SKY} --size 8 --colour-space acescg"),
        usd,
    );
    assert!(in_srgb.contains("colorSpace:name = \"lin_rec709_scene\""));
    assert!(in_aces.contains("colorSpace:name = \"lin_ap1_scene\""));
    let sun = |scene: &str| -> Vector {
        let sun = scene.split("DistantLight").nth(1).unwrap();
        numbers(sun, "inputs:color").try_into().unwrap()
    };
    let convert = |rgb: Vector| {
        let rgb = welkin::ColourSpace::AcesCg.from_linear_srgb(rgb.map(|v| v as f32));
        rgb.map(f64::from)
    };
    close(sun(&in_aces), convert(sun(&in_srgb)), 1e-5, "sun");
    let middle = [0.51, 0.3];
    close(aces.at(middle), convert(srgb.at(middle)), 1e-5, "sky");
    let (_, rec2020) = export(
        folder,
        &format!("{SKY} --size 8 --colour-space rec2020"),
        ["pbrt", "z", "pbrt"],
    );
    assert!(rec2020.contains("ColorSpace \"rec2020\""), "{rec2020}");
}

#[test]
fn names_may_have_an_extension_and_both_files_come_together() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let listed = || {
        let entries = std::fs::read_dir(folder).unwrap();
        let mut names: Vec<String> = entries
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    };
    for out in ["dusk 2.5", "dusk 2.5.exr", "dusk 2.5.usda"] {
        let output = run(
            folder,
            &["export", "--for", "usd", "--size", "8", "--out", out],
            "",
        );
        assert!(output.status.success(), "{output:?}");
        assert_eq!(listed(), ["dusk 2.5.exr", "dusk 2.5.usda"]);
        let scene = std::fs::read_to_string(folder.join("dusk 2.5.usda")).unwrap();
        assert!(scene.contains("@./dusk 2.5.exr@"), "{scene}");
        for name in listed() {
            std::fs::remove_file(folder.join(name)).unwrap();
        }
    }
    for out in [".", "./", "d/", ".."] {
        let arguments = ["export", "--for", "usd", "--size", "8", "--out", out];
        assert_eq!(run(folder, &arguments, "").status.code(), Some(2), "{out}");
    }
    let output = call(folder, "export --for usd --size 8 --sun --exr-type half");
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert!(listed().is_empty());
    // A folder where the scene should be: nothing is written.
    std::fs::create_dir(folder.join("s.ass")).unwrap();
    let output = call(folder, "export --for arnold --size 8 --out s");
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(listed(), ["s.ass"]);
}

#[test]
fn refusals_are_one_line_and_leave_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (line, word) in [
        ("export", "--for"),
        ("export --for maya", "maya"),
        ("export --for usd --up x", "--up"),
        ("export --for usd --out -", "two files"),
        ("export --for usd --out /dev/null", "two files"),
        ("export --for usd --out sky.ass", ".exr or .usda"),
        ("export --for usd --out a@b", "cannot refer"),
        ("export --for pbrt --out a\"b", "cannot refer"),
        ("export --for usd --out none/sky", "none"),
        ("export --for usd --colour-space xyz", "RGB"),
        (
            "export --for pbrt --colour-space acescg",
            "srgb and rec2020",
        ),
        ("export --for usd --sun-elevation -20", "solar elevation"),
        ("export --for usd --sun-elevation 1..5", "stand still"),
        ("export --for usd --size 3", "--size"),
        ("export --for usd --exposure nan", "--exposure"),
        ("export --for usd --model none.welkin", "none.welkin"),
    ] {
        let output = call(folder, line);
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}: {text}");
        assert!(
            text.contains(word) && text.lines().count() == 1,
            "{line}: {text}"
        );
        assert_eq!(std::fs::read_dir(folder).unwrap().count(), 0, "{line}");
    }
}

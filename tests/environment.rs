//! Environment maps and the lights that go with them.
#![cfg(feature = "cli")]

mod common;

use std::f64::consts::PI;
use std::path::Path;

use common::command::run;
use exr::prelude::read_first_flat_layer_from_file;
use serde_json::Value;
use welkin::{Conditions, Model};

fn light(arguments: &[&str]) -> Value {
    let output = run(
        Path::new("."),
        &[&["light", "--json"], arguments].concat(),
        "",
    );
    assert!(output.status.success(), "{output:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    let all = value.as_array().unwrap().iter();
    all.map(|v| v.as_f64().unwrap()).collect()
}

/// Planes of a rendered picture in the order of their names, and its size.
fn render(arguments: &[&str]) -> (Vec<Vec<f32>>, [usize; 2]) {
    let folder = tempfile::tempdir().unwrap();
    let arguments = [&["render", "--out", "map.exr"], arguments].concat();
    let output = run(folder.path(), &arguments, "");
    assert!(output.status.success(), "{output:?}");
    let image = read_first_flat_layer_from_file(folder.path().join("map.exr")).unwrap();
    let size = image.layer_data.size;
    // The file has them in the order of the letters.
    let mut channels = image.layer_data.channel_data.list;
    let wavelength = |name: &str| {
        let digits: String = name.chars().filter(char::is_ascii_digit).collect();
        digits.parse::<u32>().unwrap_or(0)
    };
    channels.sort_by_key(|c| wavelength(&c.name.to_string()));
    let planes = channels.iter();
    let planes = planes.map(|c| c.sample_data.values_as_f32().collect());
    (planes.collect(), [size.width(), size.height()])
}

/// Red, green and blue.
fn render_srgb(arguments: &[&str]) -> ([Vec<f32>; 3], [usize; 2]) {
    let (planes, size) = render(arguments);
    let [blue, green, red] = planes.try_into().unwrap();
    ([red, green, blue], size)
}

/// Irradiance of a level plane by the upper half of a lat-long picture.
fn from_above(plane: &[f32], [width, height]: [usize; 2]) -> f64 {
    let mut sum = 0.0;
    for row in 0..height / 2 {
        let (low, high) = (row as f64, row as f64 + 1.0);
        let [low, high] = [low, high].map(|r| (PI * r / height as f64).sin().powi(2));
        let mean: f64 = (plane[row * width..][..width].iter())
            .map(|&v| f64::from(v))
            .sum::<f64>()
            / width as f64;
        sum += PI * (high - low) * mean;
    }
    sum
}

const SKIES: [&[&str]; 4] = [
    &["--sun-elevation", "40", "--visibility", "30"],
    &["--sun-elevation", "3", "--albedo", "0.6"],
    &[
        "--sun-elevation",
        "12",
        "--altitude",
        "3000",
        "--sun-azimuth",
        "77",
    ],
    &["--sun-elevation", "-2.5", "--visibility", "100"],
];

#[test]
fn skylight_is_the_integral_of_the_map() {
    for sky in SKIES {
        let light = light(sky);
        let map = [&["--projection", "lat-long", "--size", "256"], sky].concat();
        let (planes, size) = render_srgb(&map);
        let diffuse = &light["diffuse_horizontal"];
        assert_eq!(diffuse["unit"], "lx");
        for (plane, expected) in planes.iter().zip(numbers(&diffuse["linear_srgb"])) {
            let got = from_above(plane, size);
            assert!(
                (got / expected - 1.0).abs() < 2e-3,
                "{sky:?} {got} {expected}"
            );
        }
        let (planes, size) = render(&[&map[..], &["--spectral"]].concat());
        for (plane, expected) in planes.iter().zip(numbers(&diffuse["spectral"])) {
            let got = from_above(plane, size);
            assert!(
                (got / expected - 1.0).abs() < 2e-3,
                "{sky:?} {got} {expected}"
            );
        }
    }
}

#[test]
fn sunlight_is_that_of_the_disc() {
    let model = Model::default_model().unwrap();
    for (sky, elevation) in [(SKIES[0], 40f64), (SKIES[1], 3.0)] {
        let light = light(sky);
        let luminous = |name: &str| light[name]["luminous"].as_f64().unwrap();
        let [normal, level] = ["direct_normal", "direct_horizontal"].map(luminous);
        // Through the air the upper half of a low disc is brighter.
        let rise = level / normal / elevation.to_radians().sin() - 1.0;
        let most = if elevation > 10.0 { 1e-3 } else { 2e-2 };
        assert!((-1e-4..most).contains(&rise), "{rise}");
        let global = luminous("diffuse_horizontal") + level;
        assert!((luminous("global_horizontal") / global - 1.0).abs() < 1e-6);
        let disc = luminous("sun_disc_mean") * light["sun"]["solid_angle_sr"].as_f64().unwrap();
        assert!((disc / normal - 1.0).abs() < 1e-5);
        // Darker towards the limb.
        let ratio = luminous("sun_disc_centre") / luminous("sun_disc_mean");
        assert!(ratio > 1.1 && ratio < 1.4, "{ratio}");
        let conditions = &light["conditions"];
        let number = |name: &str| conditions[name].as_f64().unwrap();
        let conditions = Conditions {
            solar_elevation: elevation.to_radians(),
            solar_azimuth: 0.0,
            visibility: 1e3 * number("visibility_km"),
            albedo: number("albedo"),
            altitude: 0.0,
        };
        let disc = model.solar_disc(&conditions).unwrap();
        let mut expected = vec![0.0; model.wavelengths().len()];
        disc.irradiance(disc.direction(), &mut expected).unwrap();
        for (got, expected) in numbers(&light["direct_normal"]["spectral"])
            .iter()
            .zip(expected)
        {
            assert!((got / f64::from(expected) - 1.0).abs() < 1e-5);
        }
    }
    // As the literature has it: some 100,000 lx by both in clear air, at most 1.37 kW/m² times 100 lm/W outside.
    let noon = light(&["--sun-elevation", "60", "--visibility", "100"]);
    let lux = |name: &str| noon[name]["luminous"].as_f64().unwrap();
    assert!((80e3..120e3).contains(&lux("direct_normal")), "{noon}");
    assert!((80e3..120e3).contains(&lux("global_horizontal")), "{noon}");
    let night = light(SKIES[3]);
    assert_eq!(night["direct_normal"]["luminous"], 0.0);
    assert_eq!(night["sun_disc_mean"]["luminous"], 0.0);
    assert!(night["diffuse_horizontal"]["luminous"].as_f64().unwrap() > 1.0);
    let human = run(Path::new("."), &["light"], "");
    let text = String::from_utf8(human.stdout).unwrap();
    for word in ["direct normal", "global horizontal", "lx", "cd m^-2", "683"] {
        assert!(text.contains(word), "{text}");
    }
    let refused = run(Path::new("."), &["light", "--visibility", "5"], "");
    assert_eq!(refused.status.code(), Some(2));
}

#[test]
fn the_ground_is_lit_by_sun_and_sky() {
    for sky in [SKIES[0], SKIES[1], SKIES[3]] {
        let light = light(sky);
        let albedo = light["conditions"]["albedo"].as_f64().unwrap();
        let map = [&["--projection", "lat-long", "--size", "32"], sky].concat();
        let (black, size) = render_srgb(&map);
        let (lit, _) = render_srgb(&[&map[..], &["--ground"]].concat());
        let global = numbers(&light["global_horizontal"]["linear_srgb"]);
        let half = size[0] * size[1] / 2;
        for ((black, lit), global) in black.iter().zip(&lit).zip(global) {
            assert_eq!(black[..half], lit[..half]);
            let expected = albedo / PI * global;
            for (black, lit) in black[half..].iter().zip(&lit[half..]) {
                assert_eq!(*black, 0.0);
                assert!(
                    (f64::from(*lit) / expected - 1.0).abs() < 1e-3,
                    "{lit} {expected}"
                );
            }
        }
    }
}

#[test]
fn the_ground_far_below_is_seen_through_the_air_under_its_own_sun() {
    let model = Model::default_model().unwrap();
    let conditions = Conditions {
        solar_elevation: 2f64.to_radians(),
        altitude: 10e3,
        albedo: 0.3,
        ..Conditions::default()
    };
    let scene = [
        "--projection",
        "lat-long",
        "--size",
        "64",
        "--spectral",
        "--ground",
        "--sun-elevation",
        "2",
        "--albedo",
        "0.3",
        "--altitude",
        "10000",
    ];
    let (planes, [width, height]) = render(&scene);
    let sky = model.sky(&conditions).unwrap();
    let air = model.transmittance(conditions.visibility).unwrap();
    let planet = model.head().planet;
    let n = planes.len();
    let [mut light, mut through, mut direct] = [0; 3].map(|_| vec![0.0; n]);
    for (row, column) in [(33, 32), (34, 0), (38, 20), (50, 40), (63, 3)] {
        let polar = PI * (row as f64 + 0.5) / height as f64;
        let azimuth = (0.5 - (column as f64 + 0.5) / width as f64) * 2.0 * PI;
        let (r, z) = polar.sin_cos();
        let way = [r * azimuth.cos(), r * azimuth.sin(), z];
        // The sphere of the ground, by the textbook.
        let b = (planet.radius + conditions.altitude) * z;
        let c = (planet.radius + conditions.altitude).powi(2) - planet.radius.powi(2);
        let distance = -b - (b * b - c).sqrt();
        assert!(distance > 0.0, "row {row} shows the ground");
        let from = [0.0, 0.0, conditions.altitude];
        let point: [f64; 3] = std::array::from_fn(|k| from[k] + distance * way[k]);
        let sun = conditions.sun_direction();
        let sine = (point[0] * sun[0] + point[1] * sun[1] + (point[2] + planet.radius) * sun[2])
            / planet.radius;
        let there = model
            .sky(&Conditions {
                solar_elevation: sine.asin(),
                altitude: 0.0,
                ..conditions
            })
            .unwrap();
        sky.radiance(way.map(|v| v as f32), &mut light).unwrap();
        air.transmittance(from, point, &mut through).unwrap();
        model
            .solar_disc(there.conditions())
            .unwrap()
            .irradiance([0.0, 0.0, 1.0], &mut direct)
            .unwrap();
        let baked = there.bake(1e-3).unwrap();
        let mut diffuse = vec![0.0; n];
        baked.irradiance([0.0, 0.0, 1.0], &mut diffuse).unwrap();
        for w in 0..n {
            let global = f64::from(direct[w] + diffuse[w]);
            let seen = 0.3 / PI * global * f64::from(through[w]);
            let expected = f64::from(light[w]) + seen;
            let got = f64::from(planes[w][row * width + column]);
            // Between its suns the table is within a per cent.
            let tolerance = 1e-4 * expected + 0.01 * seen;
            assert!(
                (got - expected).abs() <= tolerance,
                "{row} {w}: {got} {expected} {seen}"
            );
        }
    }
}

#[test]
fn cubes_and_lat_longs_show_the_same() {
    let light = light(SKIES[0]);
    let (planes, [n, height]) =
        render_srgb(&[&["--projection", "cube", "--size", "64"], SKIES[0]].concat());
    assert_eq!(height, 6 * n);
    let expected = numbers(&light["diffuse_horizontal"]["linear_srgb"]);
    for (plane, expected) in planes.iter().zip(expected) {
        let mut sum = 0.0;
        for (i, &value) in plane.iter().enumerate() {
            let place = |pixel: usize| (pixel as f64 + 0.5) / n as f64 * 2.0 - 1.0;
            let (face, s, t) = (i / n / n, place(i % n), place(i / n % n));
            let square = 1.0 + s * s + t * t;
            // The third face looks up; on the four sides up is up.
            let up = match face {
                2 => 1.0,
                3 => -1.0,
                _ => -t,
            };
            sum += f64::from(value) * f64::max(up, 0.0) / (square * square);
        }
        let got = sum * (2.0 / n as f64).powi(2);
        assert!((got / expected - 1.0).abs() < 3e-3, "{got} {expected}");
    }
    // The glow of the sun is on +Z, the face of the view azimuth, above its middle.
    let brightest = (0..planes[1].len()).max_by(|&a, &b| planes[1][a].total_cmp(&planes[1][b]));
    let (column, row) = (brightest.unwrap() % n, brightest.unwrap() / n);
    assert_eq!(row / n, 4);
    assert!(
        column.abs_diff(n / 2) <= 1 && row % n < n / 2,
        "{column} {row}"
    );
}

#[test]
fn grounds_are_refused_where_they_would_be_wrong() {
    let folder = tempfile::tempdir().unwrap();
    for wrong in [
        &["--ground", "--stokes"][..],
        &["--ground", "--quantity", "dolp"],
        &["--ground", "--terrain", "flat"],
    ] {
        let output = run(
            folder.path(),
            &[&["render", "--size", "8"], wrong].concat(),
            "",
        );
        assert_eq!(output.status.code(), Some(2), "{wrong:?}");
        assert_eq!(String::from_utf8(output.stderr).unwrap().lines().count(), 1);
    }
}

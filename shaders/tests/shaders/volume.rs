//! Volumes that the device fills are those of the library.

use std::time::{Duration, Instant};

use crate::common::gpu::{Binding, bytes, device};
use crate::common::{Errors, readme};
use welkin::{CameraVolume, ColourAerialPerspective, Conditions, Model};

const SIZE: [usize; 2] = [32, 18];
/// Steps that the library marches each slice in: with one its own error is as large as what is measured.
const STEPS: usize = 6;

fn depths(last: f64, n: usize) -> Vec<f64> {
    // Denser near the camera.
    (1..=n)
        .map(|k| last * (k as f64 / n as f64).powi(2))
        .collect()
}

/// Light and factors, `[row][column][slice]`.
fn fill(
    gpu: &crate::common::gpu::Gpu,
    aerial: &ColourAerialPerspective,
    volume: &CameraVolume,
) -> [Vec<[f32; 4]>; 2] {
    let buffers = aerial.buffers(volume.from).unwrap();
    let mut uniform = Vec::new();
    let counts = [volume.size[0], volume.size[1], volume.depths.len()];
    for (vector, count) in [volume.axis, volume.right, volume.up].iter().zip(counts) {
        uniform.extend(vector.iter().flat_map(|v| (*v as f32).to_ne_bytes()));
        uniform.extend((count as u32).to_ne_bytes());
    }
    let depths: Vec<u8> = volume
        .depths
        .iter()
        .flat_map(|d| (*d as f32).to_ne_bytes())
        .collect();
    let length = counts.iter().product();
    let bindings = [
        Binding::Uniform(buffers.header_bytes()),
        Binding::Uniform(&uniform),
        Binding::Input(&depths),
        Binding::Output(length),
        Binding::Output(length),
    ];
    let groups = volume.size.map(|n| n.div_ceil(8) as u32);
    let table = [vec![[f32::NAN; 4]; 2], buffers.table.clone()].concat();
    let out = gpu.run(
        "fill_volume",
        &bytes(&table),
        [2, 0, 0, 0],
        &bindings,
        groups,
    );
    out.try_into().expect("two outputs")
}

/// Whether the point is above the ground, and the way to it.
fn is_seen(volume: &CameraVolume, place: [usize; 2], depth: f64) -> bool {
    const RADIUS: f64 = 6.378e6;
    let way = volume.direction(place.map(|n| n as f64));
    let at = |t: f64| {
        let p: [f64; 3] = std::array::from_fn(|i| volume.from[i] + t * way[i]);
        p[2] + (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) / (2.0 * RADIUS)
    };
    (1..=64).all(|k| at(depth * f64::from(k) / 64.0) >= 0.0)
}

/// Where steps end.
fn steps(depths: &[f64]) -> impl Iterator<Item = f64> + '_ {
    (0..depths.len() * STEPS).map(|i| {
        let (k, share) = (i / STEPS, (i % STEPS + 1) as f64 / STEPS as f64);
        let before = if k == 0 { 0.0 } else { depths[k - 1] };
        before + share * (depths[k] - before)
    })
}

struct Compared {
    light: Errors,
    factors: Errors,
}

fn compare(
    gpu: &crate::common::gpu::Gpu,
    conditions: &Conditions,
    volume: &CameraVolume,
    out: &mut Compared,
) {
    let aerial = Model::default_model()
        .unwrap()
        .colour_aerial_perspective(conditions)
        .unwrap();
    let [light, factors] = fill(gpu, &aerial, volume);
    let slices = volume.depths.len();
    let [mut rays, mut through] = [(); 2].map(|()| vec![[0.0; 3]; STEPS * slices]);
    for row in 0..volume.size[1] {
        for column in 0..volume.size[0] {
            let way = volume.direction([column, row].map(|n| n as f64));
            let stretch = way.iter().map(|v| v * v).sum::<f64>().sqrt();
            let distances: Vec<f64> = steps(volume.depths).map(|d| d * stretch).collect();
            aerial
                .linear_srgb_along(volume.from, way, &distances, &mut rays, &mut through)
                .unwrap();
            let ends = (STEPS - 1..).step_by(STEPS);
            for (k, (rays, through)) in (0..slices).zip(ends.map(|i| (rays[i], through[i]))) {
                if !is_seen(volume, [column, row], volume.depths[k]) {
                    continue;
                }
                let at = (row * volume.size[0] + column) * slices + k;
                // Of the luminance, as single components of dusk can be near zero.
                let luminance = 0.2126 * rays[0] + 0.7152 * rays[1] + 0.0722 * rays[2];
                for c in 0..3 {
                    out.light.add(light[at][c], rays[c], luminance);
                    out.factors.add(factors[at][c], through[c], 1.0);
                }
            }
        }
    }
}

/// Towards a heading and up, both in radians, 77° wide.
fn view(from: [f64; 3], heading: f64, pitch: f64, depths: &[f64]) -> CameraVolume<'_> {
    let ((s, c), (sp, cp)) = (heading.sin_cos(), pitch.sin_cos());
    CameraVolume {
        from,
        axis: [cp * c, cp * s, sp],
        right: [0.8 * s, -0.8 * c, 0.0],
        up: [-0.45 * sp * c, -0.45 * sp * s, 0.45 * cp],
        size: SIZE,
        depths,
    }
}

/// Reports what the table leaves out, and guards it: limits are what was measured and half as much again.
fn measure(altitude: f64, last: f64, of: [(&str, [f64; 2], [f64; 2]); 2]) {
    let Some(gpu) = device() else { return };
    for (sun, elevations, limits) in of {
        let mut out = Compared {
            light: Errors::default(),
            factors: Errors::default(),
        };
        for elevation in elevations {
            let conditions = Conditions {
                solar_elevation: f64::to_radians(elevation),
                solar_azimuth: 0.7,
                ..Conditions::default()
            };
            let depths = depths(last, 24);
            for (heading, pitch) in [(0.7, 0.1), (2.5, -0.15), (3.8, 0.6)] {
                let volume = view([150.0, -80.0, altitude], heading, pitch, &depths);
                compare(&gpu, &conditions, &volume, &mut out);
            }
        }
        let what = format!("of volumes from {altitude} m, {sun}");
        let [light, _] = out.light.report(&format!("light {what}"));
        let [factors, _] = out.factors.report(&format!("factors {what} (differences)"));
        assert!(light < limits[0] && factors < limits[1], "{what}");
    }
}

const DAY: (&str, [f64; 2]) = ("suns at 90 and 20°", [90.0, 20.0]);
const LOW: (&str, [f64; 2]) = ("suns at 2 and −4°", [2.0, -4.0]);

#[test]
fn from_the_ground() {
    let limits = [[2.2e-3, 9.2e-5], [5.9e-3, 9.2e-5]];
    measure(
        2.0,
        100e3,
        [(DAY.0, DAY.1, limits[0]), (LOW.0, LOW.1, limits[1])],
    );
}

#[test]
fn from_a_mountain() {
    let limits = [[7.5e-4, 2.1e-4], [6.2e-3, 2.1e-4]];
    measure(
        3e3,
        100e3,
        [(DAY.0, DAY.1, limits[0]), (LOW.0, LOW.1, limits[1])],
    );
}

#[test]
fn from_a_balloon() {
    let limits = [[1.7e-3, 6.8e-4], [3.3e-3, 6.8e-4]];
    measure(
        30e3,
        400e3,
        [(DAY.0, DAY.1, limits[0]), (LOW.0, LOW.1, limits[1])],
    );
}

/// As games have them.
const FROXELS: [usize; 2] = [160, 90];

/// How long the device and a core of the library take for the same volume.
#[test]
fn times() {
    let Some(gpu) = device() else { return };
    let conditions = Conditions::default();
    let aerial = Model::default_model()
        .unwrap()
        .colour_aerial_perspective(&conditions)
        .unwrap();
    let depths = depths(100e3, 64);
    let volume = CameraVolume {
        size: FROXELS,
        ..view([0.0, 0.0, 2.0], 0.7, 0.1, &depths)
    };
    let length = FROXELS[0] * FROXELS[1] * depths.len();
    let [mut light, mut factors] = [(); 2].map(|()| vec![[0.0; 3]; length]);
    let mut clock = Instant::now();
    let mut lap = || std::mem::replace(&mut clock, Instant::now()).elapsed();
    aerial
        .linear_srgb_volume(&volume, &mut light, &mut factors)
        .unwrap();
    let library = lap();
    aerial.buffers(volume.from).unwrap();
    let table = lap();
    let device = gpu.time(|gpu| drop(fill(gpu, &aerial, &volume)));
    let per = |time: Duration| format!("{:.2}", time.as_secs_f64() / library.as_secs_f64());
    let on = gpu.name().split(" (").next().unwrap_or_default();
    for (what, time) in [
        ("`linear_srgb_volume`, a core".to_string(), library),
        ("`buffers`, a core, once for a place".to_string(), table),
        (format!("`fill_volume` on {on}"), device),
    ] {
        println!("{what}: {time:?}, {} of the library's", per(time));
        if readme::is_blessed() {
            let ms = format!("{:.1}", 1e3 * time.as_secs_f64());
            readme::insert(
                "times",
                ["160 × 90 × 64", "ms", "ratio"],
                [what, ms, per(time)],
            );
        }
    }
    assert!(light.iter().all(|rgb| rgb[1] > 0.0) && !device.is_zero());
}

//! A picture: drawn on the device, and the same as that of the library.

use std::path::Path;

use crate::common::Errors;
use crate::common::gpu::{Binding, bytes, device};
use welkin::{BakedSky, ColourSpace, Conditions, Model};

const SIZE: usize = 384;

/// The direction of a pixel: equidistant, +x at the top and +y on the right.
fn direction(column: usize, row: usize) -> Option<[f32; 3]> {
    let [right, down] = [column, row].map(|n| (n as f64 + 0.5) * 2.0 / SIZE as f64 - 1.0);
    let radius = right.hypot(down);
    let (sine, cosine) = (radius * std::f64::consts::FRAC_PI_2).sin_cos();
    (radius < 1.0).then(|| [-down * sine / radius, right * sine / radius, cosine].map(|v| v as f32))
}

#[test]
fn a_sky_with_the_sun() {
    let Some(gpu) = device() else { return };
    let conditions = Conditions {
        solar_elevation: 25f64.to_radians(),
        solar_azimuth: 0.4,
        ..Conditions::default()
    };
    let model = Model::default_model().unwrap();
    let sky = model
        .colour_sky(&conditions)
        .unwrap()
        .bake(BakedSky::TOLERANCE)
        .unwrap();
    let disc = model.solar_disc(&conditions).unwrap();
    let (a, b) = (sky.buffers(), disc.buffers());
    let table = [a.table(), b.table.clone()].concat();
    let bindings = [
        Binding::Uniform(a.header_bytes()),
        Binding::Uniform(b.header_bytes()),
        Binding::Output(SIZE * SIZE),
    ];
    let place = [0, a.table().len() as u32, SIZE as u32, 0];
    let groups = [SIZE.div_ceil(8) as u32; 2];
    let picture = gpu
        .run("fish_eye", &bytes(&table), place, &bindings, groups)
        .remove(0);
    let (mut errors, mut misses) = (Errors::default(), 0);
    for (i, got) in picture.iter().enumerate() {
        let Some(d) = direction(i % SIZE, i / SIZE) else {
            assert_eq!(*got, [0.0; 4]);
            continue;
        };
        let sun = disc.xyz(d).unwrap();
        let xyz = sky.xyz(d).unwrap();
        let expected = ColourSpace::Srgb.from_xyz(std::array::from_fn(|c| xyz[c] + sun[c]));
        // Beside the limb one may see the sun and the other the sky.
        if (got[1] / expected[1] - 1.0).abs() > 0.5 {
            misses += 1;
            continue;
        }
        (0..3).for_each(|c| errors.add(got[c], expected[c], 0.0));
    }
    let [p99, max] = errors.report("pixels of a picture");
    assert!(p99 < 1e-3 && max < 1e-2 && misses <= 2, "{misses}");
    write(&picture);
}

/// As PPM, to be looked at.
fn write(picture: &[[f32; 4]]) {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("sky.ppm");
    let encoded = |v: f32| {
        // White at 12000 cd/m², compressed above half of that; then sRGB's curve.
        let v = (v / 12e3).max(0.0);
        let v = if v < 0.5 { v } else { 1.0 - 0.25 / v };
        let curve = if v < 0.003_130_8 {
            12.92 * v
        } else {
            1.055 * v.powf(1.0 / 2.4) - 0.055
        };
        (255.0 * curve + 0.5) as u8
    };
    let mut bytes = format!("P6 {SIZE} {SIZE} 255\n").into_bytes();
    bytes.extend(picture.iter().flat_map(|p| [p[0], p[1], p[2]].map(encoded)));
    std::fs::write(&path, bytes).unwrap();
    println!("{}", path.display());
}

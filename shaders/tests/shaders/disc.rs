//! The disc on the device is that of the library.

use crate::common::gpu::{Binding, bytes, device, padded};
use crate::common::{Errors, scenes, unit};
use welkin::{Conditions, Model, Moon};

/// All over the disc and a little beyond; its limb apart, where rounding decides.
fn directions(centre: [f32; 3], chord: f32) -> Vec<[f32; 3]> {
    let n = centre.map(f64::from);
    let side = unit([n[2] + 0.3, -n[2], n[1] - n[0] - 0.1]);
    let along: f64 = (0..3).map(|i| side[i] * n[i]).sum();
    let x = unit(std::array::from_fn(|i| side[i] - along * n[i]));
    let y = [
        n[1] * x[2] - n[2] * x[1],
        n[2] * x[0] - n[0] * x[2],
        n[0] * x[1] - n[1] * x[0],
    ];
    let places = (0..3000).map(|i| {
        let share = (f64::from(i) + 0.5) / 3000.0;
        let r = 1.1 * share.sqrt() * f64::from(chord);
        let (sine, cosine) = (f64::from(i) * 2.399_963).sin_cos();
        unit(std::array::from_fn(|k| {
            n[k] + r * (cosine * x[k] + sine * y[k])
        }))
        .map(|v| v as f32)
    });
    std::iter::once(centre).chain(places).collect()
}

fn compare(model: &Model, conditions: &Conditions, errors: &mut Errors, misses: &mut usize) {
    let Some(gpu) = device() else { return };
    let disc = model.solar_disc(conditions).unwrap();
    let buffers = disc.buffers();
    let (h, n) = (buffers.header, disc.wavelengths().len());
    let directions = directions(h.centre, h.chord);
    let stride = 1 + h.groups as usize;
    let bindings = [
        Binding::Uniform(buffers.header_bytes()),
        Binding::Input(&padded(&directions)),
        Binding::Output(directions.len() * stride),
    ];
    let groups = [directions.len().div_ceil(64) as u32, 1];
    let table = [vec![[f32::NAN; 4]; 3], buffers.table.clone()].concat();
    let out = gpu.run(
        "disc_directions",
        &bytes(&table),
        [3, 0, 0, 0],
        &bindings,
        groups,
    );
    let mut radiance = vec![0.0; n];
    for (d, got) in directions.iter().zip(out[0].chunks_exact(stride)) {
        let xyz = disc.xyz(*d).unwrap();
        disc.radiance(*d, &mut radiance).unwrap();
        // On the limb one may see what the other does not.
        if (xyz[1] > 0.0) != (got[0][1] > 0.0) {
            *misses += 1;
            continue;
        }
        (0..3).for_each(|c| errors.add(got[0][c], xyz[c], 1e-12));
        (0..n).for_each(|w| errors.add(got[1 + w / 4][w % 4], radiance[w], 1e-12));
    }
}

#[test]
fn suns() {
    if device().is_none() {
        return;
    }
    let model = Model::default_model().unwrap();
    let (mut errors, mut misses, mut asked) = (Errors::default(), 0, 0);
    // On the horizon, too, half set.
    let low = [0.0, 0.2, -0.2].map(|elevation| Conditions {
        solar_elevation: f64::to_radians(elevation),
        ..Conditions::default()
    });
    for conditions in scenes().iter().chain(&low) {
        compare(&model, conditions, &mut errors, &mut misses);
        asked += 3001;
    }
    let [p99, max] = errors.report("disc");
    println!("seen by one alone: {misses} of {asked}");
    assert!(p99 < 1e-3 && max < 1e-2 && misses * 1000 < asked);
}

#[test]
fn moons() {
    if device().is_none() {
        return;
    }
    let (mut errors, mut misses) = (Errors::default(), 0);
    for elevation in [0.5f64, 0.01] {
        let moon = Moon {
            elevation,
            azimuth: 2.0,
            ..Moon::default()
        };
        let model = Model::default_model().unwrap().moonlit(&moon).unwrap();
        compare(
            &model,
            &moon.conditions(&Conditions::default()),
            &mut errors,
            &mut misses,
        );
    }
    let [p99, max] = errors.report("disc of the moon");
    assert!(p99 < 1e-3 && max < 1e-2 && misses < 6);
}

//! Times of one query and of one preparation with the embedded model.

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use welkin::{Conditions, Model, Sky};

/// Directions all over the sphere, in an order that no cache can guess.
fn directions() -> Vec<[f32; 3]> {
    (0..1024)
        .map(|i| {
            let z = 1.0 - 2.0 * ((f64::from(i) * 0.618_034).fract());
            let phi = f64::from(i) * 2.399_963;
            let r = (1.0 - z * z).sqrt();
            [r * phi.cos(), r * phi.sin(), z].map(|v| v as f32)
        })
        .collect()
}

fn between_nodes() -> Conditions {
    Conditions {
        altitude: 500.0,
        visibility: 40e3,
        ..Conditions::default()
    }
}

fn query(c: &mut Criterion) {
    let model = Model::default_model().expect("the embedded model is valid");
    let sky: Sky = model.sky(&between_nodes()).expect("inside the model");
    let directions = directions();
    let mut out = vec![0.0; sky.wavelengths().len()];
    let mut next = 0;
    let mut direction = || {
        next = (next + 1) % 1024;
        directions[next]
    };
    sky.radiance([0.0, 0.0, 1.0], &mut out).expect("zenith");
    assert!(out.iter().all(|&l| l > 0.0));
    let name = format!("one direction, {} wavelengths", out.len());
    c.bench_function(&name, |b| {
        b.iter(|| sky.radiance(black_box(direction()), &mut out))
    });
    c.bench_function("xyz", |b| b.iter(|| sky.xyz(black_box(direction()))));
    c.bench_function("one wavelength", |b| {
        b.iter(|| sky.radiance_at(black_box(direction()), black_box(543.2)))
    });
}

fn prepare(c: &mut Criterion) {
    let model = Model::default_model().expect("the embedded model is valid");
    let node = Conditions::default();
    c.bench_function("prepare at a node", |b| b.iter(|| model.sky(&node)));
    let between = between_nodes();
    c.bench_function("prepare between nodes", |b| b.iter(|| model.sky(&between)));
}

criterion_group!(benches, query, prepare);
criterion_main!(benches);

//! Times of one query and of one preparation with the embedded model.

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use welkin::{BakedSky, Conditions, Model, Response, Sky};

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

/// A bell of 61 samples.
fn bell([centre, width]: [f64; 2]) -> Response {
    let steps = (-30..=30).map(|i| f64::from(i) / 10.0);
    let wavelengths: Vec<f64> = steps.clone().map(|t| centre + width * t).collect();
    let values: Vec<f64> = steps.map(|t| (-0.5 * t * t).exp()).collect();
    Response::table(&wavelengths, &values).expect("a curve")
}

/// Bands of three kinds, against all wavelengths of the model in `query` and `prepare`.
fn bands(c: &mut Criterion) {
    let model = Model::default_model().expect("the embedded model is valid");
    let [first, last] = model.wavelength_range().expect("a range");
    let conditions = between_nodes();
    let directions = directions();
    let camera = [[600.0, 30.0], [540.0, 35.0], [460.0, 25.0]].map(bell);
    let lines = (0..12).map(|i| Response::wavelength(403.7 + 26.3 * f64::from(i)));
    let narrow = (0..40).map(|i| {
        let share = (f64::from(i) + 0.5) / 40.0;
        bell([first + 10.0 + share * (last - first - 20.0), 3.0])
    });
    for (name, responses) in [
        ("three curves of a camera", camera.to_vec()),
        ("twelve wavelengths between nodes", lines.collect()),
        ("forty narrow bands", narrow.collect::<Vec<_>>()),
    ] {
        let bands = model.bands(&responses).expect("within the model");
        let sky = (model.band_sky(&conditions, &bands)).expect("inside the model");
        let baked = sky.bake(BakedSky::TOLERANCE).expect("a sky of the ground");
        let mut out = vec![0.0; bands.count()];
        let mut next = 0;
        let mut direction = || {
            next = (next + 1) % 1024;
            directions[next]
        };
        c.bench_function(&format!("one direction, {name}"), |b| {
            b.iter(|| sky.radiance(black_box(direction()), &mut out))
        });
        c.bench_function(&format!("one direction, baked, {name}"), |b| {
            b.iter(|| baked.radiance(black_box(direction()), &mut out))
        });
        c.bench_function(&format!("prepare, {name}"), |b| {
            b.iter(|| model.band_sky(&conditions, &bands))
        });
        let mut group = c.benchmark_group("project");
        group.sample_size(10);
        group.bench_function(name, |b| b.iter(|| model.bands(&responses)));
        group.finish();
    }
}

/// A segment of finite length, by the stored source and as the paper's Eq. 2 has it: the difference of two skies.
fn segment(c: &mut Criterion) {
    let model = Model::default_model().expect("the embedded model is valid");
    let conditions = between_nodes();
    let aerial = model
        .aerial_perspective(&conditions)
        .expect("inside the model");
    let n = aerial.wavelengths().len();
    let (mut light, mut through) = (vec![0.0; n], vec![0.0; n]);
    let mut next = 0;
    let mut segment = || {
        next = (next + 1) % 1024;
        let u = |step: f64| (f64::from(next) * step).fract();
        let from = [0.0, 0.0, 14e3 * u(0.618_034)];
        let to = [1e5 * u(0.754_878), 3e4 * u(0.569_84), 14e3 * u(0.430_16)];
        (from, to)
    };
    c.bench_function("segment, by the source", |b| {
        b.iter(|| {
            let (from, to) = black_box(segment());
            aerial.in_scattering(from, to, &mut light, &mut through)
        })
    });
    c.bench_function("segment, transmittance alone", |b| {
        b.iter(|| {
            let (from, to) = black_box(segment());
            aerial.transmittance().transmittance(from, to, &mut through)
        })
    });
    let difference = model.sky_difference(&conditions).expect("inside the model");
    c.bench_function("segment, by Eq. 2", |b| {
        b.iter(|| {
            let (from, to) = black_box(segment());
            difference.in_scattering(from, to, &mut light)
        })
    });
    c.bench_function("prepare an aerial perspective", |b| {
        b.iter(|| model.aerial_perspective(&conditions))
    });
}

criterion_group!(benches, query, segment, prepare, bands);
criterion_main!(benches);

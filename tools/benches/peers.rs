//! The same questions to this library and to others, in one run: `cargo bench -p welkin-tools`.

use criterion::{Criterion, criterion_group, criterion_main};
use hw_skymodel::rgb::{Channel, SkyParams, SkyState};
use std::hint::black_box;
use welkin::{BakedSky, Conditions, Interpolation, Model, PointQuery, Sky};
use welkin_tools::WAVELENGTHS;
use welkin_tools::paper::{Cell, Paper};
use welkin_tools::random::{self, Sequence, sphere};
use welkin_tools::texture::Texture;

const QUERIES: usize = 4096;

fn cell() -> Cell {
    Cell {
        visibility: [27.6e3, 40e3],
        albedo: [0.0, 0.33],
        altitude: [405.0, 643.1],
        elevation: [0.315, 0.408],
    }
}

/// Directions and, for each, a place among the conditions.
fn queries() -> Vec<([f32; 3], [f64; 4])> {
    let (mut views, mut places) = (Sequence::<2>::default(), Sequence::<4>::default());
    (0..QUERIES)
        .map(|_| (sphere(views.draw()), places.draw()))
        .collect()
}

/// Calls with the next of the queries each time.
fn each(c: &mut Criterion, name: &str, mut ask: impl FnMut(usize)) {
    let mut next = 0;
    c.bench_function(name, |b| {
        b.iter(|| {
            next = (next + 1) % QUERIES;
            ask(black_box(next));
        })
    });
}

fn spectrum(sky: &Sky, direction: [f32; 3]) -> [f32; WAVELENGTHS] {
    let mut spectrum = [0.0; WAVELENGTHS];
    sky.radiance(direction, &mut spectrum).expect("a direction");
    spectrum
}

fn prepared(c: &mut Criterion) {
    let model = Model::default_model().expect("the embedded model is valid");
    let conditions = cell().inside([0.5; 4]);
    let sky = model.sky(&conditions).expect("inside the model");
    let baked = sky.bake(BakedSky::TOLERANCE).expect("bakes");
    let colour = sky.bake_colour(BakedSky::TOLERANCE).expect("bakes");
    let paper = Paper::fit(&model, cell()).expect("inside the model");
    let texture = Texture::<WAVELENGTHS>::new(&sky, spectrum);
    let hosek = SkyState::new(&SkyParams {
        elevation: conditions.solar_elevation as f32,
        turbidity: 3.0,
        albedo: [conditions.albedo as f32; 3],
    })
    .expect("within the range of Hosek-Wilkie");
    let queries = queries();
    let sun = sky.sun_direction();
    let mut out = [0.0; WAVELENGTHS];
    each(
        c,
        &format!("prepared: baked, {WAVELENGTHS} wavelengths"),
        |i| {
            baked.radiance(queries[i].0, &mut out).expect("a direction");
            black_box(&out);
        },
    );
    each(
        c,
        &format!("prepared: paper's scheme, {WAVELENGTHS} wavelengths"),
        |i| {
            paper.radiance(0, &conditions, queries[i].0, &mut out);
            black_box(&out);
        },
    );
    each(
        c,
        &format!("prepared: texture, {WAVELENGTHS} wavelengths"),
        |i| {
            black_box(texture.at(queries[i].0));
        },
    );
    each(c, "prepared: baked, RGB", |i| {
        black_box(colour.linear_srgb(queries[i].0)).expect("a direction");
    });
    each(c, "prepared: hw-skymodel, RGB", |i| {
        let [x, y, z] = queries[i].0;
        let cosine = x * sun[0] + y * sun[1] + z * sun[2];
        let (theta, gamma) = (z.max(0.0).acos(), cosine.clamp(-1.0, 1.0).acos());
        let channels = [Channel::R, Channel::G, Channel::B];
        black_box(channels.map(|channel| hosek.radiance(theta, gamma, channel)));
    });
}

fn general(c: &mut Criterion) {
    let model = Model::default_model().expect("the embedded model is valid");
    let paper = Paper::fit(&model, cell()).expect("inside the model");
    let queries = queries();
    let anywhere: Vec<Conditions> = queries
        .iter()
        .map(|&(_, place)| random::conditions(&model, place))
        .collect();
    let inside: Vec<Conditions> = queries
        .iter()
        .map(|&(_, place)| cell().inside(place))
        .collect();
    let mut out = [0.0; WAVELENGTHS];
    for (name, interpolation) in [
        ("general: 4 chunks", Interpolation::Linear),
        ("general: 16 chunks", Interpolation::Full),
    ] {
        let general = PointQuery::new(welkin::DEFAULT_MODEL)
            .expect("the embedded model is valid")
            .with_interpolation(interpolation);
        each(c, name, |i| {
            let answer = general.radiance(&anywhere[i], queries[i].0, &mut out);
            answer.expect("inside the model");
            black_box(&out);
        });
    }
    each(c, "general: paper's scheme", |i| {
        paper.radiance(i * 89, &inside[i], queries[i].0, &mut out);
        black_box(&out);
    });
}

criterion_group!(peers, prepared, general);
criterion_main!(peers);

//! Skies in bands next to those at all wavelengths of the model.

use std::hint::black_box;

use welkin::{BakedSky, Directions, Response, Result};
use welkin_tools::random::p95;

use crate::clock;
use crate::report::Row;
use crate::scene::{QUERIES, ROUND, Scene, span, unwrapped};

/// Twelve wavelengths of visible light, 40 nm apart.
pub fn rows(scene: &Scene) -> Result<Vec<Row>> {
    let lines: Vec<Response> = (0..12)
        .map(|i| Response::wavelength(320.0 + 40.0 * f64::from(i)))
        .collect();
    let bands = scene.model.bands(&lines)?;
    let sky = scene.model.band_sky(&scene.conditions, &bands)?;
    let baked = sky.bake(BakedSky::TOLERANCE)?;
    let n = lines.len();
    let [mut truth, mut got] = [vec![0.0; n * QUERIES], vec![0.0; n * QUERIES]];
    sky.radiance_batch(&scene.directions, &mut truth)?;
    let [x, y, z] = &scene.components;
    baked.radiance_batch(&Directions { x, y, z }, &mut got)?;
    let error = p95(got.iter().copied().zip(truth));

    let all = scene.sky.wavelengths().len();
    let mut spectra = vec![0.0; all * ROUND];
    let batch = clock::duel(
        [ROUND; 2],
        unwrapped(|round| baked.radiance_batch(&scene.part(round), &mut got[..n * ROUND])),
        unwrapped(|round| {
            scene
                .spectral
                .radiance_batch(&scene.part(round), &mut spectra)
        }),
    );
    let (mut few, mut many) = (vec![0.0; n], vec![0.0; all]);
    let directions = |round| scene.directions[span(round, ROUND)].iter();
    let single = clock::duel(
        [ROUND; 2],
        unwrapped(|round| {
            directions(round).try_for_each(|&d| sky.radiance(black_box(d), &mut few))
        }),
        unwrapped(|round| {
            directions(round).try_for_each(|&d| scene.sky.radiance(black_box(d), &mut many))
        }),
    );
    Ok(vec![
        Row {
            name: "bands_baked_batch",
            peer: "baked, all wavelengths",
            ns: batch,
            p95_error: [Some(error), None],
            bytes: [baked.bytes(), scene.spectral.bytes()],
        },
        Row {
            name: "bands_single",
            peer: "sky, all wavelengths",
            ns: single,
            p95_error: [None; 2],
            bytes: [sky.bytes(), scene.sky.bytes()],
        },
    ])
}

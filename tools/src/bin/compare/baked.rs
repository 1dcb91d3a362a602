//! Prepared skies next to others whose conditions are fixed, too.

use std::hint::black_box;

use hw_skymodel::rgb::{Channel, SkyParams, SkyState};
use welkin::{Directions, Result};
use welkin_tools::WAVELENGTHS;
use welkin_tools::paper::Paper;
use welkin_tools::random::p95;
use welkin_tools::texture::Texture;

use crate::clock;
use crate::report::Row;
use crate::scene::{QUERIES, ROUND, SLOW, Scene, cell, span, unwrapped};

/// Spectra, hero wavelengths and colours, next to the paper's scheme, Hosek's model and a texture.
pub fn rows(scene: &Scene) -> Result<Vec<Row>> {
    let [x, y, z] = &scene.components;
    let directions = Directions { x, y, z };
    let n = scene.sky.wavelengths().len();
    let paper = Paper::fit(&scene.model, cell())?;
    let truth = scene.spectra(|d, out| scene.sky.radiance(d, out))?;
    let mut spectra = vec![0.0; n * QUERIES];
    scene.spectral.radiance_batch(&directions, &mut spectra)?;
    let spectral_error = p95(spectra.iter().copied().zip(truth.iter().copied()));
    let paper_spectra = scene.spectra(|d, out| {
        paper.radiance(0, &scene.conditions, d, out);
        Ok(())
    })?;
    let paper_error = p95(paper_spectra.into_iter().zip(truth.iter().copied()));
    let mut out = vec![0.0; n];
    let mut peer_out = vec![0.0; n];
    let mut paper_all = |round| {
        for &d in &scene.directions[span(round, SLOW)] {
            paper.radiance(0, &scene.conditions, black_box(d), &mut peer_out);
            black_box(&peer_out);
        }
    };
    let bytes = scene.spectral.bytes();
    let paper_row = |name, ns| Row {
        name,
        peer: "paper's scheme, fixed conditions",
        ns,
        p95_error: [Some(spectral_error), Some(paper_error)],
        bytes: [bytes, paper.bytes()],
    };
    let batch = |round| {
        scene
            .spectral
            .radiance_batch(&scene.part(round), &mut spectra[..n * ROUND])
    };
    let batch = clock::duel([ROUND, SLOW], unwrapped(batch), &mut paper_all);
    let single = |round| {
        let mut ask = |d| scene.spectral.radiance(black_box(d), &mut out);
        scene.directions[span(round, ROUND)]
            .iter()
            .try_for_each(|&d| ask(d))
    };
    let single = clock::duel([ROUND, SLOW], unwrapped(single), &mut paper_all);
    let heroes = scene.heroes();
    let mut four = vec![[0.0; 4]; QUERIES];
    scene.spectral.hero_batch(&directions, &heroes, &mut four)?;
    let hero_error = hero_error(scene, &heroes, &four)?;
    let hero = |round| {
        let (part, span) = (scene.part(round), span(round, ROUND));
        scene
            .spectral
            .hero_batch(&part, &heroes[span], &mut four[..ROUND])
    };
    let hero = clock::duel([ROUND, SLOW], unwrapped(hero), &mut paper_all);
    let mut rows = vec![
        paper_row("baked_spectral_batch", batch),
        paper_row("baked_spectral_single", single),
        Row {
            p95_error: [Some(hero_error), Some(paper_error)],
            ..paper_row("baked_hero_batch", hero)
        },
    ];
    rows.extend(colours(scene, &directions)?);
    rows.push(floor(scene, spectral_error)?);
    Ok(rows)
}

fn colours(scene: &Scene, directions: &Directions) -> Result<Vec<Row>> {
    let mut rgb = vec![[0.0; 3]; QUERIES];
    let hosek = SkyState::new(&SkyParams {
        elevation: scene.conditions.solar_elevation as f32,
        turbidity: 3.0,
        albedo: [scene.conditions.albedo as f32; 3],
    })
    .expect("within the range of Hosek-Wilkie");
    let sun = scene.sky.sun_direction();
    let mut peer = |round| {
        for &d in &scene.directions[span(round, ROUND)] {
            let [x, y, z] = black_box(d);
            let theta = z.max(0.0).acos();
            let gamma = (x * sun[0] + y * sun[1] + z * sun[2])
                .clamp(-1.0, 1.0)
                .acos();
            let channels = [Channel::R, Channel::G, Channel::B];
            black_box(channels.map(|c| hosek.radiance(theta, gamma, c)));
        }
    };
    let mut xyz = rgb.clone();
    scene.colour.xyz_batch(directions, &mut xyz)?;
    let mut pairs = Vec::new();
    for (&d, &got) in scene.directions.iter().zip(&xyz) {
        pairs.extend(got.into_iter().zip(scene.sky.xyz(d)?));
    }
    let error = p95(pairs.into_iter());
    let batch = |round| {
        let part = scene.part(round);
        scene.colour.linear_srgb_batch(&part, &mut rgb[..ROUND])
    };
    let batch = clock::duel([ROUND; 2], unwrapped(batch), &mut peer);
    let single = |round| {
        let ask = |d| {
            scene
                .colour
                .linear_srgb(black_box(d))
                .map(|c| _ = black_box(c))
        };
        scene.directions[span(round, ROUND)]
            .iter()
            .try_for_each(|&d| ask(d))
    };
    let single = clock::duel([ROUND; 2], unwrapped(single), &mut peer);
    let row = |name, ns| Row {
        name,
        peer: "hw-skymodel, RGB",
        ns,
        p95_error: [Some(error), None],
        bytes: [scene.colour.bytes(), size_of::<SkyState>()],
    };
    Ok(vec![
        row("baked_rgb_batch", batch),
        row("baked_rgb_single", single),
    ])
}

/// Against the least that a renderer could do.
fn floor(scene: &Scene, error: f64) -> Result<Row> {
    let texture = Texture::<WAVELENGTHS>::new(&scene.sky, |sky, d| {
        let mut spectrum = [0.0; WAVELENGTHS];
        sky.radiance(d, &mut spectrum)
            .expect("a direction and the model's wavelengths");
        spectrum
    });
    let truth = scene.spectra(|d, out| scene.sky.radiance(d, out))?;
    let nearest = scene.directions.iter().flat_map(|&d| texture.at(d));
    let texture_error = p95(nearest.zip(truth));
    let mut spectra = vec![0.0; scene.sky.wavelengths().len() * QUERIES];
    let n = scene.sky.wavelengths().len();
    let ours = |round| {
        let part = scene.part(round);
        scene
            .spectral
            .radiance_batch(&part, &mut spectra[..n * ROUND])
    };
    let peer = |round| {
        for &d in &scene.directions[span(round, ROUND)] {
            black_box(texture.at(black_box(d)));
        }
    };
    Ok(Row {
        name: "baked_spectral_batch_floor",
        peer: "texture 512 x 256, nearest pixel",
        ns: clock::duel([ROUND; 2], unwrapped(ours), peer),
        p95_error: [Some(error), Some(texture_error)],
        bytes: [scene.spectral.bytes(), texture.bytes()],
    })
}

fn hero_error(scene: &Scene, wavelengths: &[[f32; 4]], got: &[[f32; 4]]) -> Result<f64> {
    let mut pairs = Vec::new();
    for ((&d, wavelengths), got) in scene.directions.iter().zip(wavelengths).zip(got) {
        for (&wavelength, &got) in wavelengths.iter().zip(got) {
            pairs.push((got, scene.sky.radiance_at(d, f64::from(wavelength))?));
        }
    }
    Ok(p95(pairs.into_iter()))
}

//! Stokes vectors next to the radiance alone, both from baked tables.

use std::hint::black_box;

use welkin::{
    BakedPolarisedSky, BakedSky, PolarisationFrame, PolarisedSky, Result, Stokes, StokesSpectra,
};

use crate::clock;
use crate::report::Row;
use crate::scene::{ROUND, Scene, span, unwrapped};

/// The frame that costs most.
const FRAME: PolarisationFrame = PolarisationFrame::Axis([0.2, 0.3, 0.9]);

/// Single queries and batches of all wavelengths.
pub fn rows(scene: &Scene) -> Result<Vec<Row>> {
    let sky = scene.model.polarised_sky(&scene.conditions)?;
    let baked = sky.bake(BakedSky::TOLERANCE)?;
    let n = sky.sky().wavelengths().len();
    let [mut i, mut q, mut u] = [(); 3].map(|()| vec![0.0; n * ROUND]);
    let mut peer = i.clone();
    let error = error(scene, &sky, &baked)?;
    let batch = clock::duel(
        [ROUND; 2],
        unwrapped(|round| {
            let out = StokesSpectra {
                i: &mut i,
                q: &mut q,
                u: &mut u,
            };
            baked.stokes_batch(&scene.part(round), black_box(FRAME), out)
        }),
        unwrapped(|round| scene.spectral.radiance_batch(&scene.part(round), &mut peer)),
    );
    let single = clock::duel(
        [ROUND; 2],
        unwrapped(|round| {
            scene.directions[span(round, ROUND)]
                .iter()
                .try_for_each(|&d| {
                    let out = StokesSpectra {
                        i: &mut i[..n],
                        q: &mut q[..n],
                        u: &mut u[..n],
                    };
                    baked.stokes(black_box(d), black_box(FRAME), out)
                })
        }),
        unwrapped(|round| {
            let mut ask = |d| scene.spectral.radiance(black_box(d), &mut peer[..n]);
            scene.directions[span(round, ROUND)]
                .iter()
                .try_for_each(|&d| ask(d))
        }),
    );
    let heroes = scene.heroes();
    let mut four = vec![[Stokes::default(); 4]; ROUND];
    let mut peer_four = vec![[0.0; 4]; ROUND];
    let hero = clock::duel(
        [ROUND; 2],
        unwrapped(|round| {
            let wavelengths = &heroes[span(round, ROUND)];
            baked.hero_batch(&scene.part(round), black_box(FRAME), wavelengths, &mut four)
        }),
        unwrapped(|round| {
            let wavelengths = &heroes[span(round, ROUND)];
            scene
                .spectral
                .hero_batch(&scene.part(round), wavelengths, &mut peer_four)
        }),
    );
    let row = |name, ns| Row {
        name,
        peer: "the same without polarisation",
        ns,
        p95_error: [Some(error), None],
        bytes: [baked.bytes(), scene.spectral.bytes()],
    };
    Ok(vec![
        row("polarised_spectral_batch", batch),
        row("polarised_spectral_single", single),
        row("polarised_hero_batch", hero),
        segments(scene)?,
    ])
}

/// Light of segments of 30 m to 100 km in all directions that do not meet the ground.
fn segments(scene: &Scene) -> Result<Row> {
    const ROUND: usize = 256;
    let aerial = scene.model.aerial_perspective(&scene.conditions)?;
    let n = aerial.wavelengths().len();
    let camera = [0.0, 0.0, scene.conditions.altitude];
    let point = |(i, d): (usize, &[f32; 3])| -> [f64; 3] {
        let length = 30.0 * 3300f64.powf((i as f64 * 0.618_034).fract());
        let [x, y, z] = d.map(f64::from);
        [length * x, length * y, camera[2] + length * z.abs()]
    };
    let points: Vec<_> = scene.directions.iter().enumerate().map(point).collect();
    let [mut i, mut q, mut u] = [(); 3].map(|()| vec![0.0; n * ROUND]);
    let [mut through, mut light] = [(); 2].map(|()| vec![0.0; n * ROUND]);
    let mut peer_through = light.clone();
    let ns = clock::duel(
        [ROUND; 2],
        unwrapped(|round| {
            let points = black_box(&points[span(round, ROUND)]);
            let out = StokesSpectra {
                i: &mut i,
                q: &mut q,
                u: &mut u,
            };
            aerial.in_scattering_stokes_batch(camera, points, FRAME, out, &mut through)
        }),
        unwrapped(|round| {
            let points = black_box(&points[span(round, ROUND)]);
            aerial.in_scattering_batch(camera, points, &mut light, &mut peer_through)
        }),
    );
    Ok(Row {
        name: "polarised_segment",
        peer: "the same without polarisation",
        ns,
        p95_error: [None, None],
        bytes: [aerial.bytes(); 2],
    })
}

/// 95th percentile of the distance between (Q, U) of the tables and of the prepared sky, over the radiance.
fn error(scene: &Scene, sky: &PolarisedSky, baked: &BakedPolarisedSky) -> Result<f64> {
    let n = sky.sky().wavelengths().len();
    let mut truth = vec![Stokes::default(); n];
    let [mut i, mut q, mut u] = [(); 3].map(|()| vec![0.0; n]);
    let mut errors = Vec::new();
    for &direction in &scene.directions {
        sky.stokes(direction, FRAME, &mut truth)?;
        let out = StokesSpectra {
            i: &mut i,
            q: &mut q,
            u: &mut u,
        };
        baked.stokes(direction, FRAME, out)?;
        for (truth, (q, u)) in truth.iter().zip(q.iter().zip(&u)) {
            errors.push(f64::from((q - truth.q).hypot(u - truth.u) / truth.i));
        }
    }
    errors.sort_by(f64::total_cmp);
    Ok(errors[errors.len() * 95 / 100])
}

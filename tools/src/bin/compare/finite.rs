//! Segments of finite length next to the paper's Eq. 2: the sky from the start less the attenuated sky from the end.

use std::hint::black_box;

use welkin::{AerialPerspective, Conditions, Result};

use crate::clock;
use crate::report::Row;
use crate::scene::{QUERIES, SLOW, Scene, cell, span, unwrapped};
use welkin_tools::paper::Paper;
use welkin_tools::random::Sequence;

/// Segments of one round.
const ROUND: usize = 128;

/// Room for all wavelengths of a model.
const MOST: usize = 256;

type Ends = [[f64; 3]; 2];

/// Light and transmittance of a segment, and transmittance alone.
pub fn rows(scene: &Scene) -> Result<Vec<Row>> {
    let aerial = scene.model.aerial_perspective(&scene.conditions)?;
    let paper = Paper::fit(&scene.model, cell())?;
    let segments = segments();
    let n = aerial.wavelengths().len();
    let [mut light, mut through] = [vec![0.0; n], vec![0.0; n]];
    let [mut near, mut far, mut between] = [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
    // Not `Model::sky_difference`, whose skies are welkin's own: these are those of the paper's scheme.
    let mut difference = |copies: usize, i: usize| -> Result<()> {
        let [from, to] = black_box(segments[i]);
        let direction = [0, 1, 2].map(|k| (to[k] - from[k]) as f32);
        let length = direction.iter().map(|v| v * v).sum::<f32>().sqrt();
        let direction = direction.map(|v| v / length);
        // The ends lie in different cells of the grid; a step that visits all copies in no order that a cache knows.
        for (end, out) in [&mut near, &mut far].into_iter().enumerate() {
            paper.radiance((2 * i + end) * copies, &scene.conditions, direction, out);
        }
        aerial
            .transmittance()
            .transmittance(from, to, &mut between)?;
        for (near, (far, between)) in near.iter_mut().zip(far.iter().zip(&between)) {
            *near -= far * between;
        }
        black_box(&near);
        Ok(())
    };
    let mut segment = |copies: usize| {
        clock::duel(
            [ROUND, SLOW],
            unwrapped(|round| {
                segments[span(round, ROUND)].iter().try_for_each(|&ends| {
                    let [from, to] = black_box(ends);
                    aerial.in_scattering(from, to, &mut light, &mut through)
                })
            }),
            unwrapped(|round| span(round, SLOW).try_for_each(|i| difference(copies, i))),
        )
    };
    let (fixed, random) = (segment(0), segment(89));
    let [mut through, mut peer] = [vec![0.0; n], vec![0.0; n]];
    let transmittance = clock::duel(
        [ROUND, SLOW],
        unwrapped(|round| {
            segments[span(round, ROUND)].iter().try_for_each(|&ends| {
                let [from, to] = black_box(ends);
                aerial.transmittance().transmittance(from, to, &mut through)
            })
        }),
        |round| {
            for &direction in &scene.directions[span(round, SLOW)] {
                paper.radiance(0, &scene.conditions, black_box(direction), &mut peer);
                black_box(&peer);
            }
        },
    );
    let low_sun = low_sun(scene, &aerial, &segments)?;
    let row = |name, peer, ns, bytes| Row {
        name,
        peer,
        ns,
        p95_error: [None, None],
        bytes: [bytes, paper.bytes()],
    };
    Ok(vec![
        row(
            "segment",
            "paper's Eq. 2, fixed conditions",
            fixed,
            aerial.bytes(),
        ),
        row(
            "segment_all_random",
            "paper's Eq. 2, all random",
            random,
            aerial.bytes(),
        ),
        row(
            "segment_low_sun",
            "the same by day",
            low_sun,
            aerial.bytes(),
        ),
        row(
            "transmittance",
            "paper's scheme, one radiance",
            transmittance,
            aerial.transmittance().bytes(),
        ),
    ])
}

/// Times of segments at sunset, where shadows cross them, and by day.
fn low_sun(scene: &Scene, day: &AerialPerspective, segments: &[Ends]) -> Result<[f64; 2]> {
    let sunset = scene.model.aerial_perspective(&Conditions {
        solar_elevation: 0.0,
        ..scene.conditions
    })?;
    let n = day.wavelengths().len();
    let run = |aerial, round| -> Result<()> {
        let aerial: &AerialPerspective = aerial;
        let [mut light, mut through] = [[0.0; MOST]; 2];
        for &ends in &segments[span(round, ROUND)] {
            let [from, to] = black_box(ends);
            aerial.in_scattering(from, to, &mut light[..n], &mut through[..n])?;
            black_box(&light);
        }
        Ok(())
    };
    let ours = unwrapped(|round| run(&sunset, round));
    Ok(clock::duel(
        [ROUND; 2],
        ours,
        unwrapped(|round| run(day, round)),
    ))
}

/// Up to 100 km long, all between 0 and 14 km.
pub fn segments() -> Vec<Ends> {
    let mut sequence = Sequence::<4>::default();
    let mut segment = || {
        let [a, b, c, d] = sequence.draw();
        [[0.0, 0.0, 14e3 * a], [1e5 * b, 3e4 * c, 14e3 * d]]
    };
    (0..QUERIES).map(|_| segment()).collect()
}

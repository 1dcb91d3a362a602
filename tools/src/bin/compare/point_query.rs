//! Point queries next to the paper's scheme where all conditions are random.

use std::hint::black_box;

use welkin::{Interpolation, PointQuery, Result};
use welkin_tools::WAVELENGTHS;
use welkin_tools::paper::Paper;
use welkin_tools::random::{self, Sequence};

use crate::clock;
use crate::report::Row;
use crate::scene::{QUERIES, ROUND, SLOW, Scene, cell, span, unwrapped};

/// Everything random: ours anywhere in the model, the paper's scheme in copies of one cell of its grid.
pub fn rows(scene: &Scene) -> Result<Vec<Row>> {
    let paper = Paper::fit(&scene.model, cell())?;
    let mut sequence = Sequence::<4>::default();
    let places: Vec<_> = (0..QUERIES).map(|_| sequence.draw()).collect();
    let anywhere: Vec<_> = places
        .iter()
        .map(|&p| random::conditions(&scene.model, p))
        .collect();
    let inside: Vec<_> = places.iter().map(|&p| cell().inside(p)).collect();
    let peer_error = scene.error_in(&inside, |i, d, out| {
        paper.radiance(i, &inside[i], d, out);
        Ok(())
    })?;
    let mut rows = Vec::new();
    for (name, interpolation) in [
        ("point_query", Interpolation::Full),
        ("point_query_linear", Interpolation::Linear),
    ] {
        let general = PointQuery::new(welkin::DEFAULT_MODEL)?.with_interpolation(interpolation);
        let error = scene.error_in(&anywhere, |i, d, out| {
            general.radiance(&anywhere[i], d, out)
        })?;
        let [mut out, mut peer_out] = [[0.0; WAVELENGTHS]; 2];
        let ours = |round| {
            let mut ask =
                |i: usize| general.radiance(black_box(&anywhere[i]), scene.directions[i], &mut out);
            span(round, ROUND).try_for_each(&mut ask)
        };
        let peer = |round| {
            for i in span(round, SLOW) {
                // A step that visits all copies in no order that a cache knows.
                paper.radiance(
                    i * 89,
                    black_box(&inside[i]),
                    scene.directions[i],
                    &mut peer_out,
                );
                black_box(&peer_out);
            }
        };
        rows.push(Row {
            name,
            peer: "paper's scheme, all random",
            ns: clock::duel([ROUND, SLOW], unwrapped(ours), peer),
            p95_error: [Some(error), Some(peer_error)],
            bytes: [welkin::DEFAULT_MODEL.len(), paper.bytes()],
        });
    }
    Ok(rows)
}

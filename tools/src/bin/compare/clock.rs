//! Times of two things that alternate, so that whatever else the machine does meets both.

use std::time::Instant;

/// Rounds of a comparison.
const ROUNDS: usize = 41;

/// Median times of one of the `queries` of a round, of `ours` and of `peer`, ns.
///
/// Rounds should be short against the time slices of the system, so that few are interrupted, and long against the
/// time that it takes to get back the cache that the other one used. Both get the number of their round.
pub fn duel(
    queries: [usize; 2],
    mut ours: impl FnMut(usize),
    mut peer: impl FnMut(usize),
) -> [f64; 2] {
    let mut times = [Vec::new(), Vec::new()];
    for round in 0..ROUNDS {
        times[0].push(once(|| ours(round)));
        times[1].push(once(|| peer(round)));
    }
    let [ours, peer] = times.map(|times| median(times) * 1e9);
    [ours / queries[0] as f64, peer / queries[1] as f64]
}

fn once(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

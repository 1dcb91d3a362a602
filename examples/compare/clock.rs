//! Times of two things that alternate, so that whatever else the machine does meets both.

use std::time::Instant;

/// Repetitions.
const ROUNDS: usize = 41;

/// Median times of one of `queries` queries of `ours` and of `peer`, ns.
pub fn duel(queries: usize, mut ours: impl FnMut(), mut peer: impl FnMut()) -> [f64; 2] {
    let mut times = [Vec::new(), Vec::new()];
    for _ in 0..ROUNDS {
        times[0].push(once(&mut ours));
        times[1].push(once(&mut peer));
    }
    times.map(|times| median(times) * 1e9 / queries as f64)
}

fn once(work: &mut impl FnMut()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

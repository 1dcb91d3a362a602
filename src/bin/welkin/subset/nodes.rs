//! Which nodes of an axis a range needs.

use welkin::axis::hermite;

/// Indices of all nodes that interpolation between `low` and `high` uses: with them, nothing changes there.
pub fn needed(nodes: &[f64], low: f64, high: f64) -> Vec<usize> {
    let mut stops: Vec<f64> = nodes
        .iter()
        .copied()
        .filter(|x| (low.min(high)..=low.max(high)).contains(x))
        .chain([low, high])
        .collect();
    stops.sort_by(f64::total_cmp);
    let between = stops.windows(2).map(|w| 0.5 * (w[0] + w[1]));
    let places = stops.iter().copied().chain(between);
    let taps = |x| {
        let stencil = hermite(nodes, x);
        stencil.taps().map(|(i, _)| i).collect::<Vec<_>>()
    };
    let mut indices: Vec<usize> = places.flat_map(taps).collect();
    indices.sort_unstable();
    indices.dedup();
    indices
}

/// Whether the kept nodes still reach from `low` to `high`.
pub fn covers(nodes: &[f64], kept: &[usize], [low, high]: [f64; 2]) -> bool {
    let ends = [kept.first(), kept.last()].map(|i| i.map(|&i| nodes[i]));
    matches!(ends, [Some(first), Some(last)] if first <= low && last >= high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_needs_its_stencils_and_nothing_else() {
        let nodes = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
        assert_eq!(needed(&nodes, 2.0, 2.0), [2]);
        assert_eq!(needed(&nodes, 0.0, 0.5), [0, 1, 2]);
        assert_eq!(needed(&nodes, 2.0, 3.0), [1, 2, 3, 4]);
        assert_eq!(needed(&nodes, 2.5, 2.6), [1, 2, 3, 4]);
        let falling = [5.0, 4.0, 3.0, 2.0, 1.0];
        assert_eq!(needed(&falling, 4.0, 4.0), [1]);
        assert_eq!(needed(&falling, 3.0, 5.0), [0, 1, 2, 3]);
    }

    #[test]
    fn coverage_asks_for_both_ends() {
        let nodes = [0.0, 10.0, 20.0];
        assert!(covers(&nodes, &[0, 2], [0.0, 15.0]));
        assert!(!covers(&nodes, &[1, 2], [0.0, 15.0]));
        assert!(!covers(&nodes, &[], [0.0, 15.0]));
    }
}

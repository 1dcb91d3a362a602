//! Where a value lies between the nodes of an axis.

/// Smaller weights count as none.
const LEAST_WEIGHT: f64 = 1e-6;

/// A node before a value on an axis, and how far the value is on the way to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between {
    index: usize,
    weight: f64,
}

impl Between {
    /// Of `value` among increasing `nodes`; beyond them the nearest.
    pub fn new(nodes: &[f64], value: f64) -> Self {
        let last = nodes.len() - 1;
        let value = value.clamp(nodes[0], nodes[last]);
        let index = nodes.partition_point(|n| *n <= value).clamp(1, last + 1) - 1;
        let weight = match nodes.get(index + 1) {
            Some(next) => (value - nodes[index]) / (next - nodes[index]),
            None => 0.0,
        };
        Self {
            index,
            weight: if weight < LEAST_WEIGHT { 0.0 } else { weight },
        }
    }

    /// Nodes with weights other than zero.
    pub fn corners(self) -> impl Iterator<Item = (usize, f64)> {
        let both = [
            (self.index, 1.0 - self.weight),
            (self.index + 1, self.weight),
        ];
        both.into_iter().filter(|(_, weight)| *weight != 0.0)
    }
}

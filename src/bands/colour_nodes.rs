//! The nodes that colours are made of.

use crate::format::Head;
use crate::model::{Model, NodeSubset};

/// Wavelengths that make less than this of X, Y and Z in a sky that is as bright at all of them are left out.
const NEGLIGIBLE: f64 = 1e-5;

/// The wavelengths that count.
pub(super) fn coloured(model: &Model) -> NodeSubset {
    NodeSubset::new(model, counting(model.head()))
}

fn counting(head: &Head) -> Vec<usize> {
    let sums: [f64; 3] = std::array::from_fn(|c| head.xyz.iter().map(|row| row[c].abs()).sum());
    let counts = |row: &[f64; 3]| (0..3).any(|c| row[c].abs() > NEGLIGIBLE * sums[c]);
    let mut kept: Vec<usize> = (0..head.xyz.len())
        .filter(|&i| counts(&head.xyz[i]))
        .collect();
    if kept.is_empty() {
        kept.push(0);
    }
    kept
}

//! Where along a segment the diffuse source is looked up.

use super::quadrature_limits::{MOST_PANELS, MOST_SOURCE_NODES};
use crate::kernel::lanes::Lanes;

/// Two panels, each for a block of wavelengths.
type Pair = Lanes<8>;

/// PathPoints where the diffuse source is looked up: nodes of a Gauss-Legendre rule over what is seen.
pub(crate) struct SourceNodes {
    pub shares: &'static [f32],
    /// How much each station counts in the middle of each panel, two panels at a time.
    pub weights: [[Pair; MOST_SOURCE_NODES]; MOST_PANELS / 2],
}

/// One, two and three of them.
const SHARES: [&[f32]; 3] = [
    &[0.5],
    &[0.211_324_87, 0.788_675_1],
    &[0.112_701_67, 0.5, 0.887_298_33],
];

/// For 1 panel, 2, 4, 6 …
static SOURCE_NODES: [SourceNodes; MOST_PANELS / 2 + 1] = [
    SourceNodes::new(1, SHARES[0]),
    SourceNodes::new(2, SHARES[1]),
    SourceNodes::new(4, SHARES[2]),
    SourceNodes::new(6, SHARES[2]),
    SourceNodes::new(8, SHARES[2]),
    SourceNodes::new(10, SHARES[2]),
    SourceNodes::new(12, SHARES[2]),
];

impl SourceNodes {
    pub fn of(panels: usize) -> &'static Self {
        &SOURCE_NODES[panels / 2]
    }

    /// Lagrange's interpolation from the stations to the middles of the panels.
    const fn new(panels: usize, shares: &'static [f32]) -> Self {
        let mut weights = [[Lanes([0.0; 8]); MOST_SOURCE_NODES]; MOST_PANELS / 2];
        let mut i = 0;
        while i < panels {
            let share = (i as f32 + 0.5) / panels as f32;
            let mut s = 0;
            while s < shares.len() {
                let (mut weight, mut other) = (1.0, 0);
                while other < shares.len() {
                    if other != s {
                        weight *= (share - shares[other]) / (shares[s] - shares[other]);
                    }
                    other += 1;
                }
                let mut lane = 0;
                while lane < 4 {
                    weights[i / 2][s].0[4 * (i % 2) + lane] = weight;
                    lane += 1;
                }
                s += 1;
            }
            i += 1;
        }
        Self { shares, weights }
    }
}

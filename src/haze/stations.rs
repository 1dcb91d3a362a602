//! Where along a segment the diffuse source is looked up.

use super::panels::MOST_PANELS;
use crate::lanes::Lanes;

/// Two panels, each for a block of wavelengths.
type Pair = Lanes<8>;

/// Most stations of the diffuse source.
pub(crate) const MOST_STATIONS: usize = 3;

/// Places where the diffuse source is looked up: nodes of a Gauss-Legendre rule over what is seen.
pub(crate) struct Stations {
    /// Distances from the tangent point, m.
    pub at: [f64; MOST_STATIONS],
    pub shares: &'static [f32],
    /// How much each station counts in the middle of each panel, two panels at a time.
    pub weights: [[Pair; MOST_STATIONS]; MOST_PANELS / 2],
}

impl Stations {
    #[inline(always)]
    pub fn of(panels: usize) -> Self {
        const SHARES: [f32; 3] = [0.112_701_67, 0.5, 0.887_298_33];
        const TWO: [f32; 2] = [0.211_324_87, 0.788_675_1];
        const WEIGHTS: [[[Pair; MOST_STATIONS]; MOST_PANELS / 2]; 7] = [
            weights(1, &[0.5]),
            weights(2, &TWO),
            weights(4, &SHARES),
            weights(6, &SHARES),
            weights(8, &SHARES),
            weights(10, &SHARES),
            weights(12, &SHARES),
        ];
        let shares: &[f32] = match panels {
            1 => &[0.5],
            2 => &TWO,
            _ => &SHARES,
        };
        Self {
            at: [0.0; MOST_STATIONS],
            shares,
            weights: WEIGHTS[panels / 2],
        }
    }
}

/// Lagrange's interpolation from the stations to the middles of the panels.
const fn weights(panels: usize, shares: &[f32]) -> [[Pair; MOST_STATIONS]; MOST_PANELS / 2] {
    let mut out = [[Lanes([0.0; 8]); MOST_STATIONS]; MOST_PANELS / 2];
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
                out[i / 2][s].0[4 * (i % 2) + lane] = weight;
                lane += 1;
            }
            s += 1;
        }
        i += 1;
    }
    out
}

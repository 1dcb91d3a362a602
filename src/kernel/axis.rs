//! Interpolation along the model's axes: cubic B-splines inside a chunk, local Hermite weights between chunks.
//!
//! Format specification, section 7.1.

#[cfg(not(feature = "std"))]
use crate::kernel::real::Real;

/// A spline basis at one coordinate: the coefficients that count, four where it is cubic.
///
/// ```
/// use welkin::axis::{Ends, Taps, spline};
///
/// let taps: Taps = spline(2.0, 8, Ends::Free); // at a knot
/// assert_eq!(taps.index, [2, 3, 4, 5]);
/// assert!((taps.weight[1] - 2.0 / 3.0).abs() < 1e-6 && taps.weight[3] == 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taps {
    /// Index of each coefficient.
    pub index: [usize; 4],
    /// Weight of each coefficient; the weights sum to 1.
    pub weight: [f32; 4],
}

/// What happens beyond the ends of a spline axis.
///
/// ```
/// use welkin::axis::{Ends, coefficients, spline};
///
/// assert_eq!(coefficients(8, Ends::Free), 11);
/// assert_eq!(coefficients(8, Ends::Mirrored), 9);
/// // At the sun's azimuth the coefficient on one side counts for the other, too.
/// assert_eq!(spline(0.0, 8, Ends::Mirrored).index, [1, 0, 1, 2]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// `n + 3` coefficients, no symmetry.
    Free,
    /// `n + 1` coefficients, even at both ends (the azimuth axis).
    Mirrored,
}

/// Number of coefficients of a spline axis with `intervals` intervals.
pub const fn coefficients(intervals: usize, ends: Ends) -> usize {
    match ends {
        Ends::Free => intervals + 3,
        Ends::Mirrored => intervals + 1,
    }
}

/// Uniform cubic B-spline weights at `u` in `0..=intervals` (clamped; NaN counts as 0).
#[inline]
pub fn spline(u: f64, intervals: usize, ends: Ends) -> Taps {
    let top = intervals as f64;
    let u = if u > 0.0 { u.min(top) } else { 0.0 };
    let i = (u as usize).min(intervals - 1);
    let t = u - i as f64;
    let s = 1.0 - t;
    const SIXTH: f64 = 1.0 / 6.0;
    let weight = [
        (s * s * s * SIXTH) as f32,
        ((t * t * (3.0 * t - 6.0) + 4.0) * SIXTH) as f32,
        ((s * s * (3.0 * s - 6.0) + 4.0) * SIXTH) as f32,
        (t * t * t * SIXTH) as f32,
    ];
    let index = core::array::from_fn(|k| match ends {
        Ends::Free => i + k,
        Ends::Mirrored => reflect(i as isize + k as isize - 1, intervals as isize),
    });
    Taps { index, weight }
}

#[cfg(feature = "std")]
/// Samples at `start + i · step`, linear between them and constant beyond their ends.
pub(crate) fn sample(samples: &[f32], [start, step]: [f64; 2], x: f64) -> f64 {
    let last = samples.len() - 1;
    let u = ((x - start) / step).clamp(0.0, last as f64);
    let i = (u as usize).min(last - 1);
    let t = u - i as f64;
    (1.0 - t) * f64::from(samples[i]) + t * f64::from(samples[i + 1])
}

#[inline]
fn reflect(m: isize, n: isize) -> usize {
    let m = m.abs();
    (if m > n { 2 * n - m } else { m }) as usize
}

/// Interpolation between nodes that stand in chunks of their own: up to four nodes and their weights.
///
/// ```
/// use welkin::axis::{Stencil, hermite};
///
/// let nodes = [0.0, 1.0, 3.0, 4.0];
/// let stencil: Stencil = hermite(&nodes, 2.0);
/// // Exact for parabolas.
/// let value: f64 = stencil.taps().map(|(i, weight)| weight * nodes[i] * nodes[i]).sum();
/// assert!((value - 4.0).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stencil {
    /// Index of the first node.
    pub first: usize,
    /// How many of `weight` count (1..=4).
    pub len: usize,
    /// Weight of nodes `first..first + len`; they sum to 1.
    pub weight: [f64; 4],
}

impl Stencil {
    fn node(first: usize) -> Self {
        Self {
            first,
            len: 1,
            weight: [1.0, 0.0, 0.0, 0.0],
        }
    }

    /// The nodes with a weight other than zero.
    pub fn taps(&self) -> impl Iterator<Item = (usize, f64)> + Clone + '_ {
        (0..self.len)
            .map(|k| (self.first + k, self.weight[k]))
            .filter(|&(_, w)| w != 0.0)
    }
}

/// Cubic Hermite weights with parabolic tangents at `x` among the strictly monotone `nodes`.
///
/// `x` is clamped to the range of the nodes. `nodes` must not be empty.
pub fn hermite(nodes: &[f64], x: f64) -> Stencil {
    match locate(nodes, x) {
        None => Stencil::node(0),
        Some((i, t)) => Piece::new(nodes, i).at(t),
    }
}

/// What [`hermite`] does between two neighbouring nodes.
#[derive(Clone, Copy)]
pub(crate) struct Piece {
    /// The first of the two nodes.
    node: usize,
    /// As in [`Stencil`].
    first: usize,
    len: usize,
    /// Coefficients of the weights: `[power of t][weight]`.
    polynomials: [[f64; 4]; 4],
}

impl Piece {
    pub const NONE: Self = Self {
        node: 0,
        first: 0,
        len: 1,
        polynomials: [[1.0, 0.0, 0.0, 0.0], [0.0; 4], [0.0; 4], [0.0; 4]],
    };

    /// Between nodes `i` and `i + 1`.
    pub fn new(nodes: &[f64], i: usize) -> Self {
        let mut piece = Self::NONE;
        piece.node = i;
        if nodes.len() == 2 {
            piece.len = 2;
            piece.polynomials[1] = [-1.0, 1.0, 0.0, 0.0];
            return piece;
        }
        piece.first = i.saturating_sub(1);
        piece.len = (i + 2).min(nodes.len() - 1) - piece.first + 1;
        piece.polynomials = [[0.0; 4]; 4];
        piece.add(i, [1.0, 0.0, -3.0, 2.0]);
        piece.add(i + 1, [0.0, 0.0, 3.0, -2.0]);
        let step = nodes[i + 1] - nodes[i];
        for (k, powers) in [(i, [0.0, 1.0, -2.0, 1.0]), (i + 1, [0.0, 0.0, -1.0, 1.0])] {
            let (start, slopes) = tangent(nodes, k);
            for (j, slope) in slopes.into_iter().enumerate() {
                piece.add(start + j, powers.map(|power| power * (step * slope)));
            }
        }
        piece
    }

    fn add(&mut self, node: usize, powers: [f64; 4]) {
        for (row, power) in self.polynomials.iter_mut().zip(powers) {
            row[node - self.first] += power;
        }
    }

    /// The weights at `t`, 0..=1 of the way.
    #[inline]
    pub fn at(&self, t: f64) -> Stencil {
        if t == 0.0 || t == 1.0 {
            return Stencil::node(self.node + t as usize);
        }
        let [a, b, c, d] = &self.polynomials;
        Stencil {
            first: self.first,
            len: self.len,
            weight: core::array::from_fn(|k| a[k] + t * (b[k] + t * (c[k] + t * d[k]))),
        }
    }
}

/// Piecewise linear weights at `x` among the strictly monotone `nodes`, clamped like [`hermite`].
pub fn linear(nodes: &[f64], x: f64) -> Stencil {
    locate(nodes, x).map_or(Stencil::node(0), between)
}

/// The linear weights at a place from [`locate`].
pub(crate) fn between((i, t): (usize, f64)) -> Stencil {
    Stencil {
        first: i,
        len: 2,
        weight: [1.0 - t, t, 0.0, 0.0],
    }
}

/// The interval that holds `x` and the position in it, 0..=1; `None` for a single node.
#[inline]
pub(crate) fn locate(nodes: &[f64], x: f64) -> Option<(usize, f64)> {
    if nodes.len() < 2 {
        return None;
    }
    // Counting has no branches to guess, and the axes are short.
    let before = match nodes[1] > nodes[0] {
        true => nodes.iter().filter(|&&node| node <= x).count(),
        false => nodes.iter().filter(|&&node| node >= x).count(),
    };
    let i = before.clamp(1, nodes.len() - 1) - 1;
    let t = (x - nodes[i]) / (nodes[i + 1] - nodes[i]);
    Some((i, if t > 0.0 { t.min(1.0) } else { 0.0 }))
}

/// The slope at node `k` of the parabola through three nodes: the first of them, and the weight of each.
fn tangent(nodes: &[f64], k: usize) -> (usize, [f64; 3]) {
    let a = k.saturating_sub(1).min(nodes.len() - 3);
    let (x0, x1, x2) = (nodes[a], nodes[a + 1], nodes[a + 2]);
    let x = nodes[k];
    let slopes = [
        (2.0 * x - x1 - x2) / ((x0 - x1) * (x0 - x2)),
        (2.0 * x - x0 - x2) / ((x1 - x0) * (x1 - x2)),
        (2.0 * x - x0 - x1) / ((x2 - x0) * (x2 - x1)),
    ];
    (a, slopes)
}

/// Maps an angle from the geometric horizon to a spline coordinate (the up and down axes).
#[inline]
pub fn alpha_coordinate(angle: f64, range: f64, intervals: usize, exponent: f64) -> f64 {
    let share = (angle / range).clamp(0.0, 1.0);
    // The usual exponent has a faster root.
    let root = match exponent == 3.0 {
        true => share.cbrt(),
        false => share.powf(1.0 / exponent),
    };
    intervals as f64 * root
}

/// The inverse of [`alpha_coordinate`].
pub fn alpha_angle(u: f64, range: f64, intervals: usize, exponent: f64) -> f64 {
    range * (u / intervals as f64).powf(exponent)
}

/// The solar elevation axis: dense around `centre`, sparser with distance from it.
///
/// ```
/// use welkin::axis::ElevationAxis;
///
/// let axis = ElevationAxis { min: -0.07, max: 1.57, centre: -0.01, width: 0.06, intervals: 40 };
/// assert!((axis.coordinate(axis.elevation(12.5)) - 12.5).abs() < 1e-9);
/// // The tenth of the axis around the horizon takes almost half of the intervals.
/// assert!(axis.coordinate(0.1) > 18.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElevationAxis {
    /// Lowest elevation, rad.
    pub min: f64,
    /// Highest elevation, rad.
    pub max: f64,
    /// Where the axis is densest, rad.
    pub centre: f64,
    /// Half-width of the dense part, rad.
    pub width: f64,
    /// Number of spline intervals.
    pub intervals: usize,
}

impl ElevationAxis {
    fn g(&self, elevation: f64) -> f64 {
        let x = (elevation - self.centre) / self.width;
        // asinh, of which only the absolute precision counts.
        (x.abs() + (x * x + 1.0).sqrt()).ln().copysign(x)
    }

    /// Spline coordinate of an elevation (rad).
    pub fn coordinate(&self, elevation: f64) -> f64 {
        self.coordinate_between(self.ends(), elevation)
    }

    /// The ends of the axis before it is divided evenly.
    pub(crate) fn ends(&self) -> [f64; 2] {
        [self.g(self.min), self.g(self.max)]
    }

    /// The same as [`ElevationAxis::coordinate`] with the [ends](ElevationAxis::ends) at hand.
    #[inline]
    pub(crate) fn coordinate_between(&self, [low, high]: [f64; 2], elevation: f64) -> f64 {
        self.intervals as f64 * (self.g(elevation) - low) / (high - low)
    }

    /// Elevation (rad) of a spline coordinate.
    pub fn elevation(&self, u: f64) -> f64 {
        let low = self.g(self.min);
        let g = low + u / self.intervals as f64 * (self.g(self.max) - low);
        (self.centre + self.width * g.sinh()).clamp(self.min, self.max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hermite_reproduces_parabolas_and_is_exact_at_nodes() {
        let nodes = [0.0, 1.0, 2.5, 2.9, 6.0];
        let f = |x: f64| 3.0 - x + 0.5 * x * x;
        for k in 0..=600 {
            let x = k as f64 / 100.0;
            let value: f64 = hermite(&nodes, x)
                .taps()
                .map(|(i, w)| w * f(nodes[i]))
                .sum();
            assert!((value - f(x)).abs() < 1e-12, "{x}");
        }
        assert_eq!(hermite(&nodes, 2.5).len, 1);
    }

    #[test]
    fn splines_sum_to_one_and_mirror() {
        for k in 0..=64 {
            let u = k as f64 / 8.0;
            let free = spline(u, 8, Ends::Free);
            assert!((free.weight.iter().sum::<f32>() - 1.0).abs() < 1e-6);
            assert!(free.index.iter().all(|&i| i < 11));
            assert!(spline(u, 8, Ends::Mirrored).index.iter().all(|&i| i < 9));
        }
        assert_eq!(spline(0.0, 8, Ends::Mirrored).index, [1, 0, 1, 2]);
        assert_eq!(spline(8.0, 8, Ends::Mirrored).index, [6, 7, 8, 7]);
        assert_eq!(spline(0.5, 1, Ends::Mirrored).index, [1, 0, 1, 0]);
    }

    #[test]
    fn elevation_axis_inverts() {
        let axis = ElevationAxis {
            min: -0.0733,
            max: 1.55,
            centre: -0.01,
            width: 0.06,
            intervals: 40,
        };
        for k in 0..=40 {
            assert!((axis.coordinate(axis.elevation(k as f64)) - k as f64).abs() < 1e-9);
        }
    }
}

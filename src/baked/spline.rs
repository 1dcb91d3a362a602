//! Interpolating cubic B-splines: coefficients from values at the nodes, taps from a coordinate.

use crate::kernel::lanes::Lanes;

/// What a function is like at the low end of an axis; the high end is always free.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Start {
    /// With the curvature that a cubic through the first four nodes has.
    Free,
    /// Even.
    Mirrored,
}

/// Four consecutive coefficients and their weights, lane by lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Taps<const N: usize> {
    pub first: [u32; N],
    pub weight: [Lanes<N>; 4],
}

/// Taps at `x` in 0..=1 on an axis of `intervals` intervals.
#[inline(always)]
pub(crate) fn taps<const N: usize>(x: Lanes<N>, intervals: Lanes<N>) -> Taps<N> {
    const SIXTH: f32 = 1.0 / 6.0;
    let u = x * intervals;
    let (cell, first) = u.round_down(intervals - 1.0);
    let t = u - cell;
    let s = Lanes::splat(1.0) - t;
    let inner = |t: Lanes<N>| (t * t * (t * 3.0 - 6.0) + 4.0) * SIXTH;
    Taps {
        first,
        weight: [s * s * s * SIXTH, inner(t), inner(s), t * t * t * SIXTH],
    }
}

/// Coefficients `c_-1, c_0 … c_n, c_n+1` of the spline through the values at the nodes 0 … n, n ≥ 3, each of them
/// `(c_i-1 + 4 c_i + c_i+1) / 6`. Cubics are reproduced.
#[inline(always)]
pub(crate) fn coefficients<const N: usize>(values: &[Lanes<N>], start: Start) -> Vec<Lanes<N>> {
    let n = values.len() - 1;
    let bent = |curvature: Lanes<N>| curvature * (1.0 / 6.0);
    let end = curvature([n, n - 1, n - 2, n - 3].map(|i| values[i]));
    let begin = curvature([0, 1, 2, 3].map(|i| values[i]));
    // Downwards: each coefficient as constant + factor · successor.
    let (mut factor, mut constant) = match start {
        Start::Free => (0.0, values[0] - bent(begin)),
        Start::Mirrored => (-0.5, values[0] * 1.5),
    };
    let mut factors = vec![factor];
    let mut c = vec![Lanes::splat(0.0), constant];
    for value in &values[1..n] {
        let shrink = 1.0 / (4.0 + factor);
        constant = (*value * 6.0 - constant) * shrink;
        factor = -shrink;
        factors.push(factor);
        c.push(constant);
    }
    c.push(values[n] - bent(end));
    // Upwards: the successors are known.
    for i in (1..=n).rev() {
        c[i] = c[i] + c[i + 1] * factors[i - 1];
    }
    c.push(end + c[n + 1] * 2.0 - c[n]);
    c[0] = match start {
        Start::Free => begin + c[1] * 2.0 - c[2],
        Start::Mirrored => c[2],
    };
    c
}

/// Coefficients of the same spline with twice as many intervals.
#[inline(always)]
pub(crate) fn refined<const N: usize>(coefficients: &[Lanes<N>]) -> Vec<Lanes<N>> {
    let half = |i: usize| (coefficients[i] + coefficients[i + 1]) * 0.5;
    let node =
        |i: usize| (coefficients[i - 1] + coefficients[i] * 6.0 + coefficients[i + 1]) * 0.125;
    let last = coefficients.len() - 2;
    let pairs = (1..=last).flat_map(|i| [node(i), half(i)]);
    core::iter::once(half(0)).chain(pairs).collect()
}

/// The spline with these coefficients at `x` in 0..=1.
pub(crate) fn spline_value<const N: usize>(coefficients: &[Lanes<N>], x: f32) -> Lanes<N> {
    let taps = taps(Lanes([x]), Lanes([(coefficients.len() - 3) as f32]));
    let cells = &coefficients[taps.first[0] as usize..];
    let terms = cells.iter().zip(taps.weight);
    terms.fold(Lanes::splat(0.0), |sum, (cell, weight)| {
        sum + *cell * weight.0[0]
    })
}

/// Second difference at the first of four values in a row, exact for cubics.
fn curvature<const N: usize>([a, b, c, d]: [Lanes<N>; 4]) -> Lanes<N> {
    a * 2.0 - b * 5.0 + c * 4.0 - d
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(coefficients: &[Lanes<1>], x: f32) -> f32 {
        let intervals = (coefficients.len() - 3) as f32;
        let taps = taps(Lanes([x]), Lanes([intervals]));
        let terms = coefficients[taps.first[0] as usize..].iter();
        terms.zip(taps.weight).map(|(c, w)| c.0[0] * w.0[0]).sum()
    }

    #[test]
    fn refined_splines_are_the_same() {
        let coarse: Vec<_> = [0.3, -1.0, 2.0, 0.7, 0.1, -0.4, 1.2]
            .map(|c| Lanes([c]))
            .into();
        let fine = refined(&coarse);
        assert_eq!(fine.len() - 3, 2 * (coarse.len() - 3));
        for i in 0..=1000 {
            let x = i as f32 * 1e-3;
            assert!((value(&coarse, x) - value(&fine, x)).abs() < 2e-6, "{x}");
        }
    }

    #[test]
    fn interpolates_at_nodes_and_reproduces_cubics() {
        let n = 7;
        for (start, f) in [
            (
                Start::Free,
                (|x: f32| 1.0 + x - 2.0 * x * x + x * x * x) as fn(f32) -> f32,
            ),
            (Start::Mirrored, |x: f32| 2.0 - 3.0 * x * x),
        ] {
            let values: Vec<_> = (0..=n).map(|i| Lanes([f(i as f32 / n as f32)])).collect();
            let coefficients = coefficients(&values, start);
            for i in 0..=1000 {
                let x = i as f32 * 1e-3;
                let got = value(&coefficients, x);
                assert!((got - f(x)).abs() < 2e-6, "{start:?} {x}: {got} {}", f(x));
            }
        }
    }
}

//! How much of the sun's disc stands above a straight edge. Heights are those of its centre, in radii.

use core::f32::consts::FRAC_1_PI;

use crate::kernel::lanes::Lanes;
use crate::kernel::math::{asin, bound, one_minus_exp_neg, sqrt};

/// Height of the centroid of what is seen; 0 where nothing is.
#[inline(always)]
pub(crate) fn visible_rise<const N: usize>(rise: Lanes<N>) -> Lanes<N> {
    match rise.0.iter().all(|&rise| rise >= 1.0) {
        true => rise,
        false => rise.map(visible_height),
    }
}

/// The same of one disc.
#[inline(always)]
pub(crate) fn visible_height(rise: f32) -> f32 {
    let chord = bound(1.0 - rise * rise, 0.0, 1.0);
    let share = visible_share(rise).max(f32::MIN_POSITIVE);
    let partly = rise + chord * sqrt(chord) / share * (2.0 / 3.0 * FRAC_1_PI);
    let seen = if rise > -0.999 { partly } else { 0.0 };
    if rise >= 1.0 { rise } else { seen }
}

/// Share of the disc that is seen.
#[inline(always)]
fn visible_share(rise: f32) -> f32 {
    let rise = bound(rise, -1.0, 1.0);
    0.5 + (rise * sqrt(1.0 - rise * rise) + asin(rise)) * FRAC_1_PI
}

/// Integral of the visible share up to a rise of −1..=1.
#[inline(always)]
fn accumulated_share(x: f32) -> f32 {
    let root = sqrt(1.0 - x * x);
    0.5 * x + (root - root * root * root * (1.0 / 3.0) + x * asin(x)) * FRAC_1_PI
}

/// Mean shares of the disc that are seen from the air between two places each, over which its density falls by e to
/// these powers.
#[inline(always)]
pub(crate) fn mean_shares<const N: usize>(a: Lanes<N>, b: Lanes<N>, falls: Lanes<N>) -> Lanes<N> {
    let mut out = Lanes::splat(1.0);
    if a.min(b).0.iter().all(|&low| low >= 1.0) {
        return out;
    }
    for i in 0..N {
        out.0[i] = mean_share(a.0[i], b.0[i], falls.0[i]);
    }
    out
}

/// The mean share between two places.
#[inline(always)]
pub(crate) fn mean_share(a: f32, b: f32, fall: f32) -> f32 {
    /// Differences of smaller steps lose their digits.
    const STEP: f32 = 1e-2;
    let step = b - a;
    // In the penumbra the density counts as even; beyond it all of the disc is seen, or nothing.
    let edges = [a, b].map(|rise| bound(rise, -1.0, 1.0));
    let change = edges[1] - edges[0];
    let mean = (accumulated_share(edges[1]) - accumulated_share(edges[0])) / change;
    let middle = visible_share(0.5 * (edges[0] + edges[1]));
    let partly = if change.abs() < STEP { middle } else { mean };
    let before = passed(bound((edges[0] - a) / step, 0.0, 1.0), fall);
    let after = passed(bound((edges[1] - a) / step, 0.0, 1.0), fall);
    let start = if a >= 1.0 { before } else { 0.0 };
    let end = if b >= 1.0 { 1.0 - after } else { 0.0 };
    let uneven = start + (after - before) * partly + end;
    let even = visible_share(0.5 * (a + b));
    bound(if step.abs() < STEP { even } else { uneven }, 0.0, 1.0)
}

/// Share of the air on the first `share` of a way over which its density falls by e to the power `fall`.
#[inline(always)]
fn passed(share: f32, fall: f32) -> f32 {
    let steep = fall.abs().max(1e-3);
    let share = if fall > 0.0 { share } else { 1.0 - share };
    let passed = one_minus_exp_neg(steep * share) / one_minus_exp_neg(steep);
    if fall > 0.0 { passed } else { 1.0 - passed }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::PI;

    #[test]
    fn half_the_disc_has_its_centroid_at_four_thirds_over_pi() {
        assert!((visible_share(0.0) - 0.5).abs() < 1e-6);
        assert!((visible_height(0.0) - 4.0 / (3.0 * PI)).abs() < 1e-6);
        assert!(visible_share(0.999_999) > 0.999 && visible_share(-0.999_999) < 1e-3);
        assert!(visible_height(-0.9985).abs() < 2e-3);
        assert_eq!([-7.0, 1.0, 7.0].map(visible_height), [0.0, 1.0, 7.0]);
    }

    #[test]
    fn mean_shares_are_means() {
        for (a, b) in [
            (-3.0, 0.5),
            (2.0, -0.2),
            (-0.3, 0.4),
            (-5.0, 9.0),
            (0.1, 0.105),
            (1.5, 3.0),
            (-4.0, -1.5),
        ] {
            let n = 10_000;
            for fall in [0.0f32, 0.2, -0.4, 8.0, -5.0] {
                // All the density counts but within a penumbra.
                let steep = f32::abs(b - a) < 4.0;
                let fall = if steep { 0.1 * fall } else { fall };
                let (mut sum, mut all) = (0.0, 0.0);
                for i in 0..n {
                    let t = (f64::from(i) + 0.5) / f64::from(n);
                    let weight = (-f64::from(fall) * t).exp();
                    sum += weight * f64::from(visible_share(a + (b - a) * t as f32));
                    all += weight;
                }
                let error = f64::from(mean_share(a, b, fall)) - sum / all;
                assert!(error.abs() < 0.03, "{a} {b} {fall}: {error}");
                assert!(fall != 0.0 || error.abs() < 1e-3, "{a} {b}: {error}");
            }
        }
    }
}

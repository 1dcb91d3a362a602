//! How much of the sun's disc stands above a straight edge. Heights are those of its centre, in radii.

use core::f32::consts::FRAC_1_PI;

use super::places::BATCH;
use crate::lanes::Lanes;
use crate::math::{asin, bound, sqrt};

/// Height of the centroid of what is seen; 0 where nothing is.
#[inline(always)]
pub(crate) fn visible_rise(rise: Lanes<BATCH>) -> Lanes<BATCH> {
    match rise.0.iter().all(|&rise| rise >= 1.0) {
        true => rise,
        false => rise.map(centroid),
    }
}

#[inline(always)]
fn centroid(rise: f32) -> f32 {
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

/// Integral of the visible share up to `rise`.
#[inline(always)]
fn accumulated_share(rise: f32) -> f32 {
    let x = bound(rise, -1.0, 1.0);
    let root = sqrt(1.0 - x * x);
    let inside = 0.5 * x + (root - root * root * root * (1.0 / 3.0) + x * asin(x)) * FRAC_1_PI;
    inside + (rise - 1.0).max(0.0)
}

/// Mean shares of the disc that are seen between two places each.
#[inline(always)]
pub(crate) fn mean_shares(a: Lanes<BATCH>, b: Lanes<BATCH>) -> Lanes<BATCH> {
    let mut out = Lanes::splat(1.0);
    if a.min(b).0.iter().all(|&low| low >= 1.0) {
        return out;
    }
    for i in 0..BATCH {
        out.0[i] = mean_share(a.0[i], b.0[i]);
    }
    out
}

#[inline(always)]
fn mean_share(a: f32, b: f32) -> f32 {
    /// Differences of smaller steps lose their digits.
    const STEP: f32 = 1e-2;
    let step = b - a;
    let mean = (accumulated_share(b) - accumulated_share(a)) / step;
    let middle = visible_share(0.5 * (a + b));
    bound(if step.abs() < STEP { middle } else { mean }, 0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::PI;

    #[test]
    fn half_the_disc_has_its_centroid_at_four_thirds_over_pi() {
        assert!((visible_share(0.0) - 0.5).abs() < 1e-6);
        assert!((centroid(0.0) - 4.0 / (3.0 * PI)).abs() < 1e-6);
        assert!(visible_share(0.999_999) > 0.999 && visible_share(-0.999_999) < 1e-3);
        assert!(centroid(-0.9985).abs() < 2e-3);
        assert_eq!([-7.0, 1.0, 7.0].map(centroid), [0.0, 1.0, 7.0]);
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
            let at = |i: i32| visible_share(a + (b - a) * (i as f32 + 0.5) / n as f32);
            let mean = (0..n).map(at).sum::<f32>() / n as f32;
            assert!((mean_share(a, b) - mean).abs() < 1e-3, "{a} {b}");
        }
    }
}

//! Elementary functions that vectorise.

/// Numbers that are computed together.
pub(crate) const LANES: usize = 4;

/// Splits e^x into a power of two `s` and `e` with e^x = s + e, |e| small against s; x in −87..=88.
#[inline(always)]
fn split_exp(x: f32) -> (f32, f32) {
    // Adding 1.5 · 2^23 rounds to an integer and leaves it in the low bits.
    const ROUND: f32 = 12_582_912.0;
    const LN_2_HIGH: f32 = 0.693_359_4;
    const LN_2_LOW: f32 = -2.121_944_4e-4;
    let shifted = x * core::f32::consts::LOG2_E + ROUND;
    let n = shifted - ROUND;
    let exponent = shifted.to_bits().wrapping_sub(ROUND.to_bits());
    let power = f32::from_bits(exponent.wrapping_add(127) << 23);
    let r = (x - n * LN_2_HIGH) - n * LN_2_LOW;
    // Taylor series of (e^r − 1)/r; at |r| ≤ ln 2 / 2 the rest is below 6e-9.
    let q = 1.0 / 5040.0;
    let q = q * r + 1.0 / 720.0;
    let q = q * r + 1.0 / 120.0;
    let q = q * r + 1.0 / 24.0;
    let q = q * r + 1.0 / 6.0;
    let q = q * r + 0.5;
    let q = q * r + 1.0;
    (power, power * r * q)
}

/// `x` in `low..=high`; unlike `clamp`, NaN becomes `low`.
#[inline(always)]
pub(crate) fn bound(x: f32, low: f32, high: f32) -> f32 {
    x.max(low).min(high)
}

/// e^x with a relative error below 2e-7; x is clamped to −87..=88, NaN counts as −87.
#[inline(always)]
pub(crate) fn exp(x: f32) -> f32 {
    let (power, rest) = split_exp(bound(x, -87.0, 88.0));
    power + rest
}

/// 1 − e^−x with a relative error below 4e-7, for x ≥ 0 (clamped to 0..=87, NaN counts as 87).
#[inline(always)]
pub(crate) fn one_minus_exp_neg(x: f32) -> f32 {
    let (power, rest) = split_exp(bound(-x, -87.0, 0.0));
    (1.0 - power) - rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponentials_keep_their_promises() {
        for k in -86_999..=87_999 {
            let x = k as f32 * 1e-3;
            let truth = f64::from(x).exp();
            assert!((f64::from(exp(x)) / truth - 1.0).abs() < 2e-7, "{x}");
        }
        for k in 0..100_000 {
            let x = (k as f32 * 3e-4 - 25.0).exp();
            let truth = -f64::from(-x).exp_m1();
            let got = f64::from(one_minus_exp_neg(x));
            assert!((got / truth - 1.0).abs() < 4e-7, "{x} {got} {truth}");
        }
        assert_eq!(one_minus_exp_neg(0.0), 0.0);
        assert_eq!(one_minus_exp_neg(f32::INFINITY), 1.0);
        assert!(exp(f32::NAN) > 0.0 && exp(f32::INFINITY).is_finite());
    }
}

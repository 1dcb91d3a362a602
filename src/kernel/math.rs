//! Elementary functions that vectorise.

#[cfg(not(feature = "std"))]
use crate::kernel::real::Real;

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
    // In pairs, for short chains of operations.
    let r2 = r * r;
    let low = (1.0 + r * 0.5) + r2 * (1.0 / 6.0 + r * (1.0 / 24.0));
    let high = (1.0 / 120.0 + r * (1.0 / 720.0)) + r2 * (1.0 / 5040.0);
    (power, power * r * (low + r2 * r2 * high))
}

/// `x` in `low..=high`; unlike `clamp`, NaN becomes `low`.
#[inline(always)]
pub(crate) fn bound(x: f32, low: f32, high: f32) -> f32 {
    let x = if x > low { x } else { low };
    if x < high { x } else { high }
}

/// What absurd tables give, as a number: overflow counts as the largest, and what is none as 0.
#[inline(always)]
pub(crate) fn finite(x: f32) -> f32 {
    let x = if x.is_nan() { 0.0 } else { x };
    bound(x, f32::MIN, f32::MAX)
}

/// e^x with a relative error below 2e-7; x is clamped to −87..=88, NaN counts as −87.
#[inline(always)]
pub(crate) fn exp(x: f32) -> f32 {
    let (power, rest) = split_exp(bound(x, -87.0, 88.0));
    power + rest
}

/// 2^x with a relative error below 3e-7; x is clamped to −126..=127, NaN counts as −126.
#[inline(always)]
pub(crate) fn exp2(x: f32) -> f32 {
    // As in `split_exp`.
    const ROUND: f32 = 12_582_912.0;
    let x = bound(x, -126.0, 127.0);
    let shifted = x + ROUND;
    let r = x - (shifted - ROUND);
    let exponent = shifted.to_bits().wrapping_sub(ROUND.to_bits());
    let power = f32::from_bits(exponent.wrapping_add(127) << 23);
    // Least largest error of 2^r on −1/2..=1/2: 9e-8.
    let r2 = r * r;
    let low = core::f32::consts::LN_2 + r * 0.240_222_42;
    let high = (0.055_507_337 + r * 0.009_671_513) + r2 * 0.001_326_472_7;
    power + power * r * (low + r2 * high)
}

/// log2 x with an absolute error below 2e-7 and as much relative to the result; x is a positive normal number.
#[inline(always)]
pub(crate) fn log2(x: f32) -> f32 {
    // The bits of √½ make the mantissa 0.7..1.4.
    let bits = x.to_bits().wrapping_sub(0x3f35_04f3);
    let exponent = (bits as i32 >> 23) as f32;
    let mantissa = f32::from_bits((bits & 0x007f_ffff) + 0x3f35_04f3);
    // 2/ln 2 · artanh s.
    let s = (mantissa - 1.0) / (mantissa + 1.0);
    let s2 = s * s;
    let series =
        2.885_39 + s2 * (0.961_796_7 + s2 * (0.577_078 + s2 * (0.412_198_6 + s2 * 0.320_6)));
    exponent + s * series
}

/// 1 − e^−x with a relative error below 4e-7, for x ≥ 0 (clamped to 0..=87, NaN counts as 87).
#[inline(always)]
pub(crate) fn one_minus_exp_neg(x: f32) -> f32 {
    let (power, rest) = split_exp(bound(-x, -87.0, 0.0));
    (1.0 - power) - rest
}

/// arcsin x with an error below 3e-7, relative where |x| ≤ ½; |x| counts as 1 at most.
#[inline(always)]
pub(crate) fn asin(x: f32) -> f32 {
    let size = bound(x.abs(), 0.0, 1.0);
    // Near 1 by way of half the angle from there.
    let steep = size > 0.5;
    let square = if steep { 0.5 - 0.5 * size } else { size * size };
    let sine = if steep { sqrt(square) } else { size };
    // Least largest error of (arcsin y / y − 1) / y² on 0..=1/2: 7e-8 of the whole.
    let square2 = square * square;
    let low = 0.166_666_73 + square * 0.074_988_09;
    let high = (0.045_010_703 + square * 0.026_494_194) + square2 * 0.038_206_724;
    let angle = sine + sine * square * (low + square2 * high);
    let angle = if steep {
        core::f32::consts::FRAC_PI_2 - 2.0 * angle
    } else {
        angle
    };
    angle.copysign(x)
}

/// √x.
#[inline(always)]
pub(crate) fn sqrt(x: f32) -> f32 {
    x.sqrt()
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
        for k in -12_599..=12_699 {
            let x = k as f32 * 1e-2;
            let truth = f64::from(x).exp2();
            assert!((f64::from(exp2(x)) / truth - 1.0).abs() < 3e-7, "{x}");
        }
        for k in 0..100_000 {
            let x = (k as f32 * 1.7e-3 - 85.0).exp();
            let truth = f64::from(x).log2();
            assert!(
                (f64::from(log2(x)) - truth).abs() < 2e-7 * (1.0 + truth.abs()),
                "{x}"
            );
        }
        for k in 0..100_000 {
            let x = (k as f32 * 3e-4 - 25.0).exp();
            let truth = -f64::from(-x).exp_m1();
            let got = f64::from(one_minus_exp_neg(x));
            assert!((got / truth - 1.0).abs() < 4e-7, "{x} {got} {truth}");
        }
        for k in -100_000..=100_000 {
            let x = k as f32 * 1e-5;
            let truth = f64::from(x).asin();
            let scale = if x.abs() <= 0.5 { truth.abs() } else { 1.0 };
            let error = (f64::from(asin(x)) - truth).abs();
            assert!(error <= 3e-7 * scale, "{x} {error}");
        }
        assert_eq!(asin(-7.0), -core::f32::consts::FRAC_PI_2);
        assert_eq!(one_minus_exp_neg(0.0), 0.0);
        assert_eq!(one_minus_exp_neg(f32::INFINITY), 1.0);
        assert!(exp(f32::NAN) > 0.0 && exp(f32::INFINITY).is_finite());
    }
}

//! Half precision.

use zerocopy::little_endian::U16;

/// Widens a finite half-precision number. Without branches, so that loops over it vectorise, and
/// without subnormal arithmetic, which hosts often switch off.
pub(crate) fn widen(half: U16) -> f32 {
    let half = u32::from(half.get());
    let magnitude = (half & 0x7fff) << 13;
    let normal = f32::from_bits(magnitude + (112 << 23));
    let subnormal = f32::from_bits(magnitude + (113 << 23)) - f32::from_bits(113 << 23);
    let value = if magnitude < 1 << 23 {
        subnormal
    } else {
        normal
    };
    f32::from_bits(value.to_bits() | (half & 0x8000) << 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widening_agrees_with_the_half_crate_for_every_finite_number() {
        for bits in 0..=u16::MAX {
            let expected = ::half::f16::from_bits(bits);
            if expected.is_finite() {
                let got = widen(U16::new(bits));
                assert_eq!(got.to_bits(), expected.to_f32().to_bits(), "{bits:#x}");
            }
        }
    }
}

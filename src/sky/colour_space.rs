//! From CIE XYZ to linear sRGB.

use crate::kernel::math::finite;

pub(crate) const XYZ_TO_SRGB: [[f32; 3]; 3] = [
    [3.240_97, -1.537_383_2, -0.498_610_76],
    [-0.969_243_65, 1.875_967_5, 0.041_555_06],
    [0.055_630_08, -0.203_976_96, 1.056_971_5],
];

/// Converts CIE 1931 XYZ to linear sRGB (IEC 61966-2-1, D65 white): Y = 1 and the chromaticity of D65 give (1, 1, 1).
///
/// Colours outside the gamut have negative components. What overflows becomes the largest number.
pub fn xyz_to_linear_srgb([x, y, z]: [f32; 3]) -> [f32; 3] {
    XYZ_TO_SRGB.map(|[a, b, c]| finite(a * x + b * y + c * z))
}

#[cfg(test)]
mod tests {
    use super::xyz_to_linear_srgb;

    #[test]
    fn d65_is_white() {
        let white = [0.3127 / 0.329, 1.0, (1.0 - 0.3127 - 0.329) / 0.329];
        for component in xyz_to_linear_srgb(white) {
            assert!((component - 1.0).abs() < 2e-4, "{component}");
        }
    }
}

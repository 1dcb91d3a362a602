//! From CIE XYZ to linear RGB.

use core::fmt;
use core::str::FromStr;

use crate::error::Error;
use crate::kernel::math::finite;

/// A linear colour space, by name. Under [`ColourSpace::white`] all three components of white are equal.
///
/// Those with another white than D65 are reached by Bradford's adaptation from D65, as films and OpenColorIO do: light
/// that is white in sRGB is white in ACEScg, and a picture rendered in ACEScg is the one rendered in sRGB and converted.
///
/// ```
/// use welkin::{ColourSpace, Conditions, Model};
///
/// let sky = Model::default_model()?.colour_sky(&Conditions::default())?;
/// let xyz = sky.xyz([0.3, 0.1, 0.9])?;
/// let acescg = ColourSpace::AcesCg.from_xyz(xyz);
/// assert_eq!("rec2020".parse::<ColourSpace>()?, ColourSpace::Rec2020);
/// # assert!(acescg[2] > acescg[0]);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ColourSpace {
    /// Linear sRGB (IEC 61966-2-1, primaries of ITU-R BT.709), white D65.
    #[default]
    Srgb,
    /// Linear ITU-R BT.2020, white D65.
    Rec2020,
    /// ACEScg (Academy S-2014-004, primaries AP1), white of ACES (about D60).
    AcesCg,
    /// CIE 1931 XYZ of the 2° observer, not adapted; equal energy has equal components.
    Xyz,
}

/// From XYZ, rows of red, green and blue: inverses of the primaries and whites of [`ColourSpace::chromaticities`].
const TO_SRGB: [[f32; 3]; 3] = [
    [3.240_97, -1.537_383_2, -0.498_610_76],
    [-0.969_243_65, 1.875_967_5, 0.041_555_06],
    [0.055_630_08, -0.203_976_96, 1.056_971_5],
];
const TO_REC2020: [[f32; 3]; 3] = [
    [1.716_651_2, -0.355_670_78, -0.253_366_3],
    [-0.666_684_3, 1.616_481_2, 0.015_768_546],
    [0.017_639_857, -0.042_770_613, 0.942_103_1],
];
/// After Bradford's adaptation from D65.
const TO_ACESCG: [[f32; 3]; 3] = [
    [1.660_585_3, -0.315_295_56, -0.241_509_33],
    [-0.659_926_06, 1.608_391_5, 0.017_298_595],
    [0.009_002_569, -0.003_566_876_4, 0.913_643_3],
];
const IDENTITY: [[f32; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const FROM_SRGB: [[f32; 3]; 3] = [
    [0.412_390_8, 0.357_584_33, 0.180_480_8],
    [0.212_639, 0.715_168_65, 0.072_192_32],
    [0.019_330_818, 0.119_194_78, 0.950_532_14],
];

impl ColourSpace {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Srgb, Self::Rec2020, Self::AcesCg, Self::Xyz];

    /// `srgb`, `rec2020`, `acescg` or `xyz`, which [`str::parse`] reads.
    pub fn name(self) -> &'static str {
        match self {
            Self::Srgb => "srgb",
            Self::Rec2020 => "rec2020",
            Self::AcesCg => "acescg",
            Self::Xyz => "xyz",
        }
    }

    /// CIE 1931 chromaticities x, y of red, green, blue and white.
    pub fn chromaticities(self) -> [[f32; 2]; 4] {
        const D65: [f32; 2] = [0.3127, 0.329];
        match self {
            Self::Srgb => [[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], D65],
            Self::Rec2020 => [[0.708, 0.292], [0.17, 0.797], [0.131, 0.046], D65],
            Self::AcesCg => [
                [0.713, 0.293],
                [0.165, 0.83],
                [0.128, 0.044],
                [0.321_68, 0.337_67],
            ],
            Self::Xyz => [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [1.0 / 3.0; 2]],
        }
    }

    /// Chromaticity x, y of white.
    pub fn white(self) -> [f32; 2] {
        self.chromaticities()[3]
    }

    /// The name of white: `D65`, `ACES` or `E`.
    pub fn white_name(self) -> &'static str {
        match self {
            Self::Srgb | Self::Rec2020 => "D65",
            Self::AcesCg => "ACES",
            Self::Xyz => "E",
        }
    }

    /// The matrix of [`ColourSpace::from_xyz`], a row for each component.
    pub fn matrix(self) -> [[f32; 3]; 3] {
        match self {
            Self::Srgb => TO_SRGB,
            Self::Rec2020 => TO_REC2020,
            Self::AcesCg => TO_ACESCG,
            Self::Xyz => IDENTITY,
        }
    }

    /// Converts CIE 1931 XYZ. Colours outside the gamut have negative components; what overflows becomes the largest
    /// number.
    pub fn from_xyz(self, xyz: [f32; 3]) -> [f32; 3] {
        match self {
            Self::Xyz => xyz,
            _ => product(self.matrix(), xyz),
        }
    }

    /// Converts linear sRGB, as of [`ColourSpace::from_xyz`].
    pub fn from_linear_srgb(self, rgb: [f32; 3]) -> [f32; 3] {
        match self {
            Self::Srgb => rgb,
            _ => self.from_xyz(product(FROM_SRGB, rgb)),
        }
    }
}

impl fmt::Display for ColourSpace {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for ColourSpace {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self, Error> {
        let found = Self::ALL.into_iter().find(|space| space.name() == name);
        found.ok_or_else(|| {
            let known = Self::ALL.map(Self::name).join(", ");
            Error::invalid("colour space", format!("{name:?}: known are {known}"))
        })
    }
}

fn product(matrix: [[f32; 3]; 3], [x, y, z]: [f32; 3]) -> [f32; 3] {
    matrix.map(|[a, b, c]| finite(a * x + b * y + c * z))
}

/// Converts CIE 1931 XYZ to linear sRGB (IEC 61966-2-1, D65 white): Y = 1 and the chromaticity of D65 give (1, 1, 1).
///
/// Colours outside the gamut have negative components. What overflows becomes the largest number.
pub fn xyz_to_linear_srgb(xyz: [f32; 3]) -> [f32; 3] {
    ColourSpace::Srgb.from_xyz(xyz)
}

#[cfg(test)]
mod tests {
    use super::{ColourSpace, xyz_to_linear_srgb};

    fn xyz_of([x, y]: [f32; 2]) -> [f32; 3] {
        [x / y, 1.0, (1.0 - x - y) / y]
    }

    #[test]
    fn d65_is_white() {
        let white = xyz_of([0.3127, 0.329]);
        for component in xyz_to_linear_srgb(white) {
            assert!((component - 1.0).abs() < 2e-4, "{component}");
        }
        for space in [ColourSpace::Rec2020, ColourSpace::AcesCg] {
            for component in space.from_xyz(white) {
                assert!((component - 1.0).abs() < 2e-6, "{space}: {component}");
            }
        }
    }

    #[test]
    fn primaries_have_one_component() {
        for space in [ColourSpace::Srgb, ColourSpace::Rec2020, ColourSpace::Xyz] {
            for (i, primary) in space.chromaticities()[..3].iter().enumerate() {
                let [x, y] = *primary;
                let rgb = space.from_xyz([x, y, 1.0 - x - y]);
                for (k, component) in rgb.iter().enumerate() {
                    assert!(if k == i {
                        *component > 0.1
                    } else {
                        component.abs() < 2e-6
                    });
                }
            }
        }
    }

    /// As the transform of OpenColorIO's built-in configurations from linear Rec. 709 to ACEScg has it.
    #[test]
    fn acescg_of_srgb_is_that_of_opencolorio() {
        let red = ColourSpace::AcesCg.from_linear_srgb([1.0, 0.0, 0.0]);
        let blue = ColourSpace::AcesCg.from_linear_srgb([0.0, 0.0, 1.0]);
        for (got, expected) in [
            (red, [0.613_097_4, 0.070_193_7, 0.020_615_6]),
            (blue, [0.047_379_5, 0.013_452_4, 0.869_814_6]),
        ] {
            for k in 0..3 {
                assert!((got[k] - expected[k]).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn names_are_read_back() {
        for space in ColourSpace::ALL {
            assert_eq!(space.name().parse::<ColourSpace>().unwrap(), space);
            let srgb = [0.25, 0.5, 0.125];
            let xyz = ColourSpace::Xyz.from_linear_srgb(srgb);
            for k in 0..3 {
                assert!((space.from_linear_srgb(srgb)[k] - space.from_xyz(xyz)[k]).abs() < 1e-6);
            }
        }
        assert!("p3".parse::<ColourSpace>().is_err());
    }
}

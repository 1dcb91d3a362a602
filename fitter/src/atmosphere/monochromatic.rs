//! Light of one wavelength.

/// Light of one wavelength, and how strongly the lines of gases absorb it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Monochromatic {
    /// Wavelength, nm.
    pub wavelength: f64,
    /// Optical depth of 1 cm of precipitable water.
    pub water: f64,
    /// Optical depth of the uniformly mixed gases of all air above the ground.
    pub mixed: f64,
}

impl Monochromatic {
    /// Light beside all lines.
    pub const fn beside_lines(wavelength: f64) -> Self {
        Self {
            wavelength,
            water: 0.0,
            mixed: 0.0,
        }
    }

    /// Whether no lines absorb it.
    pub fn is_beside_lines(self) -> bool {
        self == Self::beside_lines(self.wavelength)
    }

    /// Light that the uniformly mixed gases absorb: `depth` of all air above the ground.
    pub const fn mixed(wavelength: f64, depth: f64) -> Self {
        Self {
            wavelength,
            water: 0.0,
            mixed: depth,
        }
    }

    /// Light that water vapour absorbs: `depth` per cm of precipitable water.
    pub const fn vapour(wavelength: f64, depth: f64) -> Self {
        Self {
            wavelength,
            water: depth,
            mixed: 0.0,
        }
    }
}

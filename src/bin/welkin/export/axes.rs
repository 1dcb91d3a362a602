//! World axes of scenes.

/// Which axis of a scene points to the zenith.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Up {
    Y,
    Z,
}

impl Up {
    /// A vector of the frame with +z up. +x stays; turned by −90° about it, +z becomes +y and +y becomes −z.
    pub fn turned(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Y => [x, z, -y],
            Self::Z => [x, y, z],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_are_right_handed() {
        for up in [Up::Y, Up::Z] {
            let [x, y, z] =
                [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|v| up.turned(v));
            let cross: [f64; 3] = std::array::from_fn(|i| {
                x[(i + 1) % 3] * y[(i + 2) % 3] - x[(i + 2) % 3] * y[(i + 1) % 3]
            });
            assert_eq!(cross, z);
        }
    }
}

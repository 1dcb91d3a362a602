//! A place of the sun in the sky.

use welkin::Conditions;

/// Angles of the sun's centre, rad; azimuth counter-clockwise from +x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position {
    pub elevation: f64,
    pub azimuth: f64,
}

impl Position {
    /// The same air under this sun.
    pub fn over(&self, air: &Conditions) -> Conditions {
        Conditions {
            solar_elevation: self.elevation,
            solar_azimuth: self.azimuth,
            ..*air
        }
    }
}

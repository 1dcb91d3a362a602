//! What a picture says about itself: attributes of EXR files, text of PNG files. `docs/attributes.md` lists them.

use std::fmt;

use welkin::output::printable;
use welkin::{Conditions, Model};

use crate::failure::Result;
use crate::parameter;

/// Of RGB in cd m⁻².
pub const LUMINANCE: &str = "cd.m^-2";
/// Of spectra.
pub const RADIANCE: &str = "W.m^-2.sr^-1.nm^-1";

/// Of bands.
pub const BAND_RADIANCE: &str = "W.m^-2.sr^-1";

/// The value of an attribute.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    Text(String),
    Number(f64),
    Vector([f64; 3]),
}

/// Attributes by name.
#[derive(Clone, Debug, Default)]
pub struct About {
    pub entries: Vec<(&'static str, Value)>,
    /// Above the ground, m: has an attribute of its own in EXR files.
    pub altitude: Option<f64>,
}

impl About {
    /// Sun, air, ground and observer.
    pub fn scene(model: &Model, conditions: &Conditions, view_azimuth: f64) -> Result<Self> {
        let mut about = Self {
            altitude: Some(conditions.altitude),
            ..Self::default()
        };
        let (elevation, azimuth) = (conditions.solar_elevation, conditions.solar_azimuth);
        let ((z, r), (y, x)) = (elevation.sin_cos(), azimuth.sin_cos());
        about.number("sunElevationDeg", elevation.to_degrees());
        about.number("sunAzimuthDeg", azimuth.to_degrees());
        let direction = Value::Vector([r * x, r * y, z]);
        about.entries.push(("sunDirection", direction));
        match parameter::value(model, conditions.visibility)? {
            Some((axis, value)) => {
                about.text("parameter", printable(axis.name()));
                about.number("parameterValue", value);
                about.text("parameterUnit", printable(axis.unit()));
            }
            None => about.number("visibilityKm", conditions.visibility / 1e3),
        }
        about.number("groundAlbedo", conditions.albedo);
        about.number("viewAzimuthDeg", view_azimuth.to_degrees());
        Ok(about)
    }

    pub fn number(&mut self, name: &'static str, value: f64) {
        self.entries.push((name, Value::Number(value)));
    }

    pub fn text(&mut self, name: &'static str, value: impl Into<String>) {
        self.entries.push((name, Value::Text(value.into())));
    }

    /// The same with more about it.
    pub fn with(&self, more: &[(&'static str, &str)]) -> Self {
        let mut about = self.clone();
        more.iter()
            .for_each(|&(name, value)| about.text(name, value));
        about
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text(text) => f.write_str(text),
            // As precise as EXR attributes are.
            Self::Number(value) => write!(f, "{}", *value as f32),
            Self::Vector(v) => {
                let [x, y, z] = v.map(|v| v as f32);
                write!(f, "{x} {y} {z}")
            }
        }
    }
}

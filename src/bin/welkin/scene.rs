//! Sun, air, ground and line of sight of a picture or a volume, as arguments.

use welkin::Conditions;

use crate::failure::{Failure, Result};

/// Where the sun stands, and what air and ground are like.
#[derive(clap::Args)]
pub struct Place {
    /// Solar elevation, degrees.
    #[arg(
        long,
        default_value_t = 20.0,
        allow_negative_numbers = true,
        value_name = "DEG"
    )]
    sun_elevation: f64,
    /// Solar azimuth, degrees, counter-clockwise from +x seen from above.
    #[arg(
        long,
        default_value_t = 0.0,
        allow_negative_numbers = true,
        value_name = "DEG"
    )]
    sun_azimuth: f64,
    /// Visibility (meteorological range) at the ground, km.
    #[arg(
        long,
        default_value_t = 59.4,
        allow_negative_numbers = true,
        value_name = "KM"
    )]
    visibility: f64,
    /// Albedo of the ground, 0 to 1.
    #[arg(
        long,
        default_value_t = 0.2,
        allow_negative_numbers = true,
        value_name = "SHARE"
    )]
    albedo: f64,
}

/// A place and where one looks.
#[derive(clap::Args)]
pub struct Scene {
    #[command(flatten)]
    place: Place,
    /// Azimuth that is looked to, degrees: in the middle of the picture, or at the top of the up fish-eye.
    #[arg(
        long,
        default_value_t = 0.0,
        allow_negative_numbers = true,
        value_name = "DEG"
    )]
    view_azimuth: f64,
}

impl Place {
    /// For an observer at an altitude, m.
    pub fn conditions(&self, altitude: f64) -> Conditions {
        Conditions {
            solar_elevation: self.sun_elevation.to_radians(),
            solar_azimuth: self.sun_azimuth.to_radians(),
            visibility: 1e3 * self.visibility,
            albedo: self.albedo,
            altitude,
        }
    }
}

impl Scene {
    /// For an observer at an altitude, m.
    pub fn conditions(&self, altitude: f64) -> Conditions {
        self.place.conditions(altitude)
    }

    /// Azimuth that is looked to, rad.
    pub fn view_azimuth(&self) -> Result<f64> {
        if !self.view_azimuth.is_finite() {
            let text = format!("view azimuth must be finite, got {}", self.view_azimuth);
            return Err(Failure::message(text));
        }
        Ok(self.view_azimuth.to_radians())
    }
}

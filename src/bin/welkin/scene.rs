//! Sun, air, ground and line of sight of a picture or a volume, as arguments.

use std::io::Write;

use welkin::{Conditions, Model};

use crate::failure::{Failure, Result, plain};

/// Where the sun stands, and what air and ground are like.
#[derive(clap::Args)]
pub struct Place {
    /// Solar elevation, degrees.
    #[arg(long, default_value_t = 20.0, value_name = "DEG")]
    sun_elevation: f64,
    /// Solar azimuth, degrees, counter-clockwise from +x seen from above.
    #[arg(long, default_value_t = 0.0, value_name = "DEG")]
    sun_azimuth: f64,
    /// Visibility (meteorological range) at the ground, km.
    #[arg(long, default_value_t = 59.4, value_name = "KM")]
    visibility: f64,
    /// Albedo of the ground, 0 to 1.
    #[arg(long, default_value_t = 0.2, value_name = "SHARE")]
    albedo: f64,
}

/// A place and where one looks.
#[derive(clap::Args)]
pub struct Scene {
    #[command(flatten)]
    place: Place,
    /// Azimuth that is looked to, degrees: in the middle of the picture, or at the top of the up fish-eye.
    #[arg(long, default_value_t = 0.0, value_name = "DEG")]
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

    /// The same for an observer at an altitude (m), moved to the nearest that the model reaches; says on standard error what it moved.
    pub fn clamped(&self, altitude: f64, model: &Model) -> Result<Conditions> {
        let wished = self.conditions(altitude);
        let conditions = wished.clamped(model)?;
        for line in moved(&wished, &conditions) {
            // Nobody is left to tell when standard error is closed.
            let _ = writeln!(std::io::stderr(), "welkin: {line}");
        }
        Ok(conditions)
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

/// What differs between conditions, in the units of the command line.
pub fn moved(from: &Conditions, to: &Conditions) -> Vec<String> {
    let both = |of: fn(&Conditions) -> f64| [of(from), of(to)];
    let quantities = [
        (
            "sun elevation",
            both(|c| c.solar_elevation.to_degrees()),
            " degrees",
        ),
        ("visibility", both(|c| 1e-3 * c.visibility), " km"),
        ("albedo", both(|c| c.albedo), ""),
        ("altitude", both(|c| c.altitude), " m"),
    ];
    let round = |v: f64| (v * 1e9).round() / 1e9;
    let differing = quantities
        .into_iter()
        .filter(|(_, [from, to], _)| from != to);
    differing
        .map(|(name, values, unit)| {
            let [from, to] = values.map(|v| plain(round(v)));
            format!("{name} moved from {from} to {to}{unit}")
        })
        .collect()
}

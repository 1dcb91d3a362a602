//! Where the sun stands, as arguments: by its angles, or by date, time and place.

use welkin::{Conditions, Error};

use crate::almanac::{Instants, Observer, Time};
use crate::failure::{Failure, Result};
use crate::position::Position;
use crate::span::Span;

#[derive(clap::Args)]
pub struct Sun {
    /// Geometric elevation of the sun's centre, degrees; 20 if absent. A course FROM..TO for animate and contact-sheet.
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub sun_elevation: Option<Span<f64>>,
    /// Azimuth of the sun, degrees, counter-clockwise from +x seen from above; 0 if absent. A course FROM..TO for
    /// animate and contact-sheet.
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    sun_azimuth: Option<Span<f64>>,
    /// Date instead of the sun's angles, YYYY-MM-DD, with --time; or an instant with its offset from UTC,
    /// 2026-06-21T14:30+02:00.
    /// +x is then the east and +y the north.
    #[arg(
        long,
        value_name = "DATE",
        requires_all = ["latitude", "longitude"],
        conflicts_with_all = ["sun_elevation", "sun_azimuth"]
    )]
    date: Option<String>,
    /// Time of day with its offset from UTC: 14:30+02:00, or 12:30Z. A course FROM..TO for animate and contact-sheet.
    #[arg(long, value_name = "TIME", requires = "date", value_parser = Span::<Time>::times)]
    time: Option<Span<Time>>,
    /// Latitude, degrees, north positive.
    #[arg(long, value_name = "DEG", requires = "date", value_parser = latitude)]
    latitude: Option<f64>,
    /// Longitude, degrees, east positive.
    #[arg(long, value_name = "DEG", requires = "date", value_parser = longitude)]
    longitude: Option<f64>,
}

fn latitude(text: &str) -> std::result::Result<f64, String> {
    within(text, 90.0)
}

fn longitude(text: &str) -> std::result::Result<f64, String> {
    within(text, 180.0)
}

fn within(text: &str, most: f64) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.abs() <= most => Ok(value),
        _ => Err(format!("expected degrees in -{most}..={most}")),
    }
}

impl Sun {
    /// Whether it moves.
    pub fn is_course(&self) -> bool {
        let angles = [&self.sun_elevation, &self.sun_azimuth]
            .into_iter()
            .flatten();
        angles.into_iter().any(|span| span.is_course) || self.time.is_some_and(|t| t.is_course)
    }

    /// An error if it moves.
    pub fn still(&self) -> Result<()> {
        match self.is_course() {
            true => Err(Failure::message(
                "the sun must stand still here: welkin animate and contact-sheet take A..B",
            )),
            false => Ok(()),
        }
    }

    /// Whether anything is said about it.
    pub fn is_given(&self) -> bool {
        self.sun_elevation.is_some() || self.date.is_some()
    }

    /// What is wrong with conditions under it; where a date put it is said as people would.
    pub fn failure(&self, error: Error) -> Failure {
        match (&self.date, error) {
            (
                Some(date),
                Error::OutOfRange {
                    parameter: parameter @ "solar_elevation",
                    value,
                    min,
                    max,
                    unit,
                },
            ) => {
                // Never into the range.
                let hundredths = 100.0 * value.to_degrees();
                let degrees = match value < min {
                    true => hundredths.floor() / 100.0,
                    false => hundredths.ceil() / 100.0,
                };
                let error = Error::OutOfRange {
                    parameter,
                    value: degrees.to_radians(),
                    min,
                    max,
                    unit,
                };
                Failure::from(error).about(&format!("the sun on {date}"))
            }
            (_, error) => error.into(),
        }
    }

    /// So many positions from the first to the last.
    pub fn positions(&self, steps: usize) -> Result<Vec<Position>> {
        let share = |step: usize| step as f64 / steps.saturating_sub(1).max(1) as f64;
        let shares = (0..steps).map(share);
        match (&self.date, self.latitude.zip(self.longitude)) {
            (Some(date), Some((latitude, longitude))) => {
                let instants = Instants::new(date, self.time)?;
                let observer = Observer {
                    latitude,
                    longitude,
                };
                let position = |share| observer.sun(instants.at(share));
                shares.map(position).collect()
            }
            (None, None) => Ok(shares.map(|share| self.angles(share)).collect()),
            _ => Err(Failure::message("a date needs a latitude and a longitude")),
        }
    }

    /// In the given azimuth at some elevations, degrees.
    pub fn at_elevations(&self, degrees: &[f64]) -> Vec<Position> {
        let at = |degrees: &f64| Position {
            elevation: degrees.to_radians(),
            ..self.angles(0.0)
        };
        degrees.iter().map(at).collect()
    }

    fn angles(&self, share: f64) -> Position {
        let standard = Conditions::default();
        let angle = |span: &Option<Span<f64>>, absent| {
            span.map_or(absent, |span| span.at(share).to_radians())
        };
        Position {
            elevation: angle(&self.sun_elevation, standard.solar_elevation),
            azimuth: angle(&self.sun_azimuth, standard.solar_azimuth),
        }
    }
}

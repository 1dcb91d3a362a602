//! The sun of a date, a time and a place: Reda and Andreas 2004, *Solar Position Algorithm for Solar Radiation
//! Applications*.

use jiff::Timestamp;
use jiff::civil::{Date, DateTime};
use jiff::tz::Offset;
use solar_positioning::time::JulianDate;
use solar_positioning::{Location, SolarPositions, delta_t};

use crate::failure::{Failure, Result};
use crate::position::Position;
use crate::span::Span;

/// Seconds of a day.
const DAY: f64 = 86_400.0;
/// Julian date of 1970-01-01T00:00Z.
const EPOCH: f64 = 2_440_587.5;

/// A time of day in a zone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Time {
    civil: jiff::civil::Time,
    offset: Offset,
}

impl Span<Time> {
    pub fn times(text: &str) -> std::result::Result<Self, String> {
        Self::parse(text, Time::parse)
    }
}

impl Time {
    fn parse(text: &str) -> std::result::Result<Self, String> {
        let wanted = || {
            format!("\"{text}\" is no time with an offset from UTC, such as 14:30+02:00 or 12:30Z")
        };
        let zone = text.find(['+', '-', 'Z', 'z']).ok_or_else(wanted)?;
        let civil = text[..zone].parse().map_err(|_| wanted())?;
        let offset = offset(&text[zone..]).ok_or_else(wanted)?;
        Ok(Self { civil, offset })
    }

    fn on(self, date: Date) -> Result<Timestamp> {
        instant(date.to_datetime(self.civil), self.offset)
    }
}

/// `Z`, `+02:00` or `-0330`.
fn offset(text: &str) -> Option<Offset> {
    if text.eq_ignore_ascii_case("z") {
        return Some(Offset::UTC);
    }
    // Any date will do.
    let zoned = format!("2000-01-01T00:00{text}");
    let instant: Timestamp = zoned.parse().ok()?;
    let midnight: Timestamp = "2000-01-01T00:00Z".parse().ok()?;
    Offset::from_seconds((midnight.as_second() - instant.as_second()) as i32).ok()
}

fn instant(civil: DateTime, offset: Offset) -> Result<Timestamp> {
    let instant = offset.to_timestamp(civil);
    instant.map_err(|_| Failure::message(format!("{civil} is out of reach")))
}

/// From one instant to another, as seconds since 1970 in UTC.
pub struct Instants(Span<f64>);

impl Instants {
    /// Of a date and times of that day, or of a date that has its time. A course that would go back ends on the next
    /// day.
    pub fn new(date: &str, times: Option<Span<Time>>) -> Result<Self> {
        let wrong = |what: &str| Failure::message(format!("date \"{date}\": {what}"));
        let seconds = |instant: Timestamp| instant.as_second() as f64;
        let Some(times) = times else {
            let instant = date.parse().map(seconds).map_err(|_| {
                wrong("expected YYYY-MM-DD with --time, or an instant with its offset from UTC, 2026-06-21T14:30+02:00")
            })?;
            return Ok(Self(Span {
                first: instant,
                last: instant,
                is_course: false,
            }));
        };
        let day: Date = match date.contains(['T', 't', ' ']) {
            true => return Err(wrong("it has a time already: leave --time out")),
            false => date.parse().map_err(|_| wrong("expected YYYY-MM-DD"))?,
        };
        let first = seconds(times.first.on(day)?);
        let last = seconds(times.last.on(day)?);
        Ok(Self(Span {
            first,
            last: if last < first { last + DAY } else { last },
            is_course: times.is_course,
        }))
    }

    /// Seconds since 1970 in UTC at a share of 0 to 1 of the way.
    pub fn at(&self, share: f64) -> f64 {
        self.0.at(share)
    }
}

/// Where somebody stands on the Earth, degrees.
pub struct Observer {
    pub latitude: f64,
    pub longitude: f64,
}

impl Observer {
    /// The centre of the sun at an instant (seconds since 1970 in UTC), without refraction, as the light of the model
    /// goes straight. +x is the east and +y the north.
    pub fn sun(&self, instant: f64) -> Result<Position> {
        let failed =
            |e: solar_positioning::Error| Failure::message(format!("position of the sun: {e}"));
        let date = Timestamp::from_second(instant.floor() as i64)
            .map(|t| Offset::UTC.to_datetime(t).date())
            .map_err(|_| Failure::message("the date is out of reach"))?;
        let month = date.month() as u32;
        let late = delta_t::estimate_from_date(date.year().into(), month).map_err(failed)?;
        let time = JulianDate::new(EPOCH + instant / DAY, late).map_err(failed)?;
        let place = Location {
            latitude: self.latitude,
            longitude: self.longitude,
        };
        let position = SolarPositions::new().at_from_julian(time, place, 0.0, None);
        let position = position.map_err(failed)?;
        Ok(Position {
            elevation: position.elevation_angle().to_radians(),
            // Theirs counts from the north to the east.
            azimuth: (90.0 - position.azimuth()).rem_euclid(360.0).to_radians(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The example of the report of the algorithm (NREL/TP-560-34302, table A5.1): 17 October 2003, 12:30:30 at UTC−7,
    /// 39.742476° N, 105.1786° W, 1830.14 m; zenith angle 50.11162° with 0.01632° of refraction, azimuth 194.34024°.
    #[test]
    fn the_example_of_the_report() {
        let times = Span::times("12:30:30-07:00").unwrap();
        let observer = Observer {
            latitude: 39.742476,
            longitude: -105.1786,
        };
        let instants = Instants::new("2003-10-17", Some(times)).unwrap();
        let sun = observer.sun(instants.at(0.0)).unwrap();
        let elevation = 90.0 - 50.11162 - 0.01632;
        assert!(
            (sun.elevation.to_degrees() - elevation).abs() < 5e-4,
            "{sun:?}"
        );
        let azimuth: f64 = 90.0 - 194.34024 + 360.0;
        assert!((sun.azimuth.to_degrees() - azimuth).abs() < 5e-4, "{sun:?}");
        let whole = Instants::new("2003-10-17T12:30:30-07:00", None).unwrap();
        assert_eq!(whole.at(0.0), instants.at(0.0));
    }

    #[test]
    fn times_have_offsets_and_go_over_midnight() {
        let hours = |text: &str| {
            let times = Span::times(text).unwrap();
            let instants = Instants::new("2026-06-21", Some(times)).unwrap();
            (instants.at(1.0) - instants.at(0.0)) / 3600.0
        };
        assert_eq!(hours("04:30+02:00..12:00+02:00"), 7.5);
        assert_eq!(hours("22:00Z..02:00Z"), 4.0);
        assert_eq!(hours("12:00+02:00..12:00Z"), 2.0);
        assert_eq!(hours("12:00-03:30..16:00Z"), 0.5);
        for text in [
            "12:00",
            "noon",
            "25:00Z",
            "12:00+99:00",
            "Z",
            "12:00Z..",
            "12:00Z..13:00",
        ] {
            assert!(Span::times(text).is_err(), "{text}");
        }
    }
}

//! Where was measured, and where the sun stood there: Reda and Andreas 2004, *Solar Position Algorithm for Solar
//! Radiation Applications*.

use super::capture_time::CaptureTime;
use anyhow::{Context, Result};
use solar_positioning::time::JulianDate;
use solar_positioning::{Location, SolarPositions, delta_t};

/// A place on the Earth and its clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// Degrees, north positive.
    pub latitude: f64,
    /// Degrees, east positive.
    pub longitude: f64,
    /// Above the sea, m.
    pub altitude: f64,
    /// What the local clock is ahead of UTC, h.
    pub utc_offset: f64,
}

/// The sun over a site.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// Of the centre, without refraction, rad.
    pub elevation: f64,
    /// rad, counter-clockwise from +x, which is the east; +y is the north.
    pub azimuth: f64,
    /// Irradiance outside the air relative to that at 1 AU.
    pub intensity: f64,
}

impl Site {
    /// The roof of Rhodes Hall, Cornell University, on daylight saving time.
    pub const RHODES_HALL: Self = Self {
        latitude: 42.443449,
        longitude: -76.481962,
        altitude: 325.0,
        utc_offset: -4.0,
    };

    /// The sun at a local time.
    pub fn sun(&self, time: &CaptureTime) -> Result<Sun> {
        let late = delta_t::estimate_from_date(time.year, time.month)?;
        let midnight = JulianDate::from_utc(time.year, time.month, time.day, 0, 0, 0.0, late)?;
        let days = (time.seconds - 3600.0 * self.utc_offset) / 86_400.0;
        let julian = JulianDate::new(midnight.julian_date() + days, late)?;
        let place = Location {
            latitude: self.latitude,
            longitude: self.longitude,
        };
        let position = SolarPositions::new()
            .at_from_julian(julian, place, self.altitude, None)
            .context("position of the sun")?;
        Ok(Sun {
            elevation: position.elevation_angle().to_radians(),
            // Theirs counts from the north to the east.
            azimuth: (90.0 - position.azimuth()).rem_euclid(360.0).to_radians(),
            intensity: intensity(julian.julian_date()),
        })
    }
}

/// (1 AU / distance of the sun)², within 10⁻⁴: *Astronomical Almanac*, low-precision formulas of the sun.
fn intensity(julian: f64) -> f64 {
    const J2000: f64 = 2_451_545.0;
    let anomaly = (357.528 + 0.985_600_3 * (julian - J2000)).to_radians();
    let distance = 1.000_14 - 0.016_71 * anomaly.cos() - 0.000_14 * (2.0 * anomaly).cos();
    distance.powi(-2)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wilkie et al. 2021, Fig. 7: 27 May 2013, 09:30, solar elevation 41.08°. Aphelion 2013 was on 5 July at 1.01671
    /// AU, perihelion on 2 January at 0.98329 AU.
    #[test]
    fn the_sun_of_the_paper() {
        let site = Site::RHODES_HALL;
        let at = |text| site.sun(&CaptureTime::parse(text).unwrap()).unwrap();
        let sun = at("2013.05.27.09.30.00");
        assert!((sun.elevation.to_degrees() - 41.08).abs() < 0.1, "{sun:?}");
        let near = |intensity: f64, distance: f64| (intensity * distance * distance - 1.0).abs();
        assert!(near(at("2013.07.05.12.00.00").intensity, 1.01671) < 3e-4);
        assert!(near(at("2013.01.02.12.00.00").intensity, 0.98329) < 3e-4);
    }
}

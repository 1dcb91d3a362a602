//! When something was measured, as names and lines of the measurements say it: local time.

/// A local date and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CaptureTime {
    /// Year.
    pub year: i32,
    /// 1..=12.
    pub month: u32,
    /// 1..=31.
    pub day: u32,
    /// Seconds since midnight.
    pub seconds: f64,
}

impl CaptureTime {
    /// Of six numbers from year to second with anything but digits between them: `2013.05.27.10.30.00` of the lines of
    /// a pyranometer, `2013-05-27___10.30.00` of the folder of a scan.
    pub fn parse(text: &str) -> Option<Self> {
        let parts = text.split(|c: char| !c.is_ascii_digit());
        let numbers: Vec<&str> = parts.filter(|part| !part.is_empty()).collect();
        let [year, month, day, hour, minute, second] = numbers[..] else {
            return None;
        };
        let within = |text: &str, most: u32| text.parse::<u32>().ok().filter(|&n| n <= most);
        let [hour, minute, second] = [within(hour, 23)?, within(minute, 59)?, within(second, 59)?];
        let [year, month, day] = [within(year, 9999)?, within(month, 12)?, within(day, 31)?];
        let known = year >= 1900 && month > 0 && (1..=days(year, month)).contains(&day);
        known.then_some(Self {
            year: year as i32,
            month,
            day,
            seconds: f64::from(3600 * hour + 60 * minute + second),
        })
    }

    /// Whether both are of one day.
    pub fn same_day(&self, other: &Self) -> bool {
        (self.year, self.month, self.day) == (other.year, other.month, other.day)
    }

    /// Hours, minutes and seconds.
    pub fn clock(&self) -> String {
        let s = self.seconds.round() as u32;
        format!("{:02}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60)
    }

    /// Some seconds later on the same day.
    pub fn after(&self, seconds: f64) -> Self {
        Self {
            seconds: self.seconds + seconds,
            ..*self
        }
    }
}

fn days(year: u32, month: u32) -> u32 {
    let leap = year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    match month {
        2 => 28 + u32::from(leap),
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ways_of_writing_are_one_time() {
        let line = CaptureTime::parse("2013.05.27.10.30.07").unwrap();
        assert_eq!(CaptureTime::parse("2013-05-27___10.30.07"), Some(line));
        assert_eq!(line.seconds, 37_807.0);
        assert_eq!(line.clock(), "10:30:07");
    }

    #[test]
    fn no_time_is_none() {
        for text in [
            "",
            "2013.05.27",
            "2013.05.27.10.30.00.00",
            "2013.13.27.10.30.00",
            "2013.02.29.10.30.00",
            "2013.05.27.24.00.00",
            "2013.05.27.10.60.00",
            "99999999999.05.27.10.30.00",
        ] {
            assert_eq!(CaptureTime::parse(text), None, "{text}");
        }
    }
}

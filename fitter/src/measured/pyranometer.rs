//! Global horizontal irradiance as a pyranometer logged it: lines of W m⁻² and local time.

use super::capture_time::CaptureTime;
use super::error::{MeasuredError, text};
use super::scan::entries;
use std::path::{Path, PathBuf};

/// More than reaches the top of the air, W m⁻²; clouds beside the sun give as much.
const MOST: f64 = 1500.0;

/// A log.
#[derive(Clone, Debug, PartialEq)]
pub struct Log {
    /// Times and W m⁻².
    pub readings: Vec<(CaptureTime, f64)>,
}

impl Log {
    /// Reads a log.
    pub fn read(path: &Path) -> Result<Self, MeasuredError> {
        let text = text(path)?;
        let mut readings: Vec<(CaptureTime, f64)> = vec![];
        for (i, line) in text.lines().enumerate() {
            let wrong = |detail: &str| MeasuredError::line(path, i, detail);
            if line.trim().is_empty() {
                continue;
            }
            let parts: Vec<&str> = line.split_whitespace().collect();
            let [irradiance, time] = parts[..] else {
                return Err(wrong("expected an irradiance and a time"));
            };
            let time = CaptureTime::parse(time)
                .ok_or_else(|| wrong("expected a time YYYY.MM.DD.HH.MM.SS"))?;
            let irradiance = irradiance.parse::<f64>().ok();
            let irradiance = irradiance
                .filter(|e| (0.0..MOST).contains(e))
                .ok_or_else(|| wrong("no irradiance in W m^-2"))?;
            if let Some((last, _)) = readings.last()
                && !(time.same_day(last) && time.seconds >= last.seconds)
            {
                return Err(wrong("times must not go back, nor leave the day"));
            }
            readings.push((time, irradiance));
        }
        match readings.is_empty() {
            true => Err(MeasuredError::incomplete(path, "no readings")),
            false => Ok(Self { readings }),
        }
    }

    /// The median, and the middle of the time.
    pub fn median(&self) -> (CaptureTime, f64) {
        let mut values: Vec<f64> = self.readings.iter().map(|r| r.1).collect();
        values.sort_by(f64::total_cmp);
        let (first, last) = (self.readings[0].0, self.readings[self.readings.len() - 1].0);
        let middle = first.after(0.5 * (last.seconds - first.seconds));
        (middle, values[values.len() / 2])
    }
}

/// The logs in a folder, `*.txt`; or that one file.
pub fn files(path: &Path) -> Result<Vec<PathBuf>, MeasuredError> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let all = entries(path)?.into_iter();
    let logs: Vec<PathBuf> = all
        .filter(|file| file.extension().is_some_and(|end| end == "txt") && file.is_file())
        .collect();
    match logs.is_empty() {
        true => Err(MeasuredError::incomplete(path, "no *.txt in it")),
        false => Ok(logs),
    }
}

//! Why a command stops.

use std::io;
use std::path::Path;

pub type Result<T> = std::result::Result<T, Failure>;

/// The one line that the user gets, or silence.
#[derive(Debug)]
pub enum Failure {
    /// Goes to standard error; the exit code is 2.
    Message(String),
    /// The reader of standard output went away.
    BrokenPipe,
}

impl Failure {
    pub fn message(text: impl Into<String>) -> Self {
        Self::Message(text.into())
    }

    /// Puts the file's name in front, unless the error has it already.
    pub fn in_file(path: &Path, error: welkin::Error) -> Self {
        match error {
            welkin::Error::Io { .. } => Self::Message(error.to_string()),
            _ => Self::Message(format!("{}: {error}", path.display())),
        }
    }
}

impl From<welkin::Error> for Failure {
    fn from(error: welkin::Error) -> Self {
        Self::Message(describe(&error))
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Self::BrokenPipe,
            _ => Self::Message(format!("standard output: {error}")),
        }
    }
}

/// The error's text in the units of the command line: degrees and kilometres.
pub fn describe(error: &welkin::Error) -> String {
    let welkin::Error::OutOfRange {
        parameter,
        value,
        min,
        max,
        unit,
    } = error
    else {
        return error.to_string();
    };
    let (factor, unit) = match *parameter {
        "solar_elevation" => (1f64.to_degrees(), "degrees"),
        "solar_azimuth" => return format!("solar azimuth must be finite, got {value}"),
        "visibility" => (1e-3, "km"),
        _ => (1.0, *unit),
    };
    let round = |v: f64| (v * factor * 1e9).round() / 1e9;
    let [value, min, max] = [*value, *min, *max].map(round);
    let name = parameter.replace('_', " ");
    let text = format!("{name} must be in {min}..={max} {unit}");
    format!("{}, got {value}", text.trim_end())
}

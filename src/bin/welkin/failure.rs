//! Why a command stops.

use std::io;
use std::path::Path;

use welkin::output::Target;
use welkin::output::printable;

pub type Result<T, E = Failure> = std::result::Result<T, E>;

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

    /// The same with what it is about in front.
    pub fn about(self, what: &str) -> Self {
        match self {
            Self::Message(text) => Self::Message(format!("{what}: {text}")),
            Self::BrokenPipe => self,
        }
    }

    /// Puts the file's name in front, unless the error has it already.
    pub fn in_file(path: &Path, error: welkin::Error) -> Self {
        match error {
            welkin::Error::Io { .. } => Self::Message(error.to_string()),
            _ => Self::Message(format!("{}: {}", path.display(), describe(&error))),
        }
    }
}

impl From<welkin::Error> for Failure {
    fn from(error: welkin::Error) -> Self {
        match &error {
            welkin::Error::Io { path, source }
                if source.kind() == io::ErrorKind::BrokenPipe
                    && *path == Path::new(&Target::Standard.to_string()) =>
            {
                Self::BrokenPipe
            }
            _ => Self::Message(describe(&error)),
        }
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

/// The error's text in the units of the command line: degrees, kilometres and percent.
pub fn describe(error: &welkin::Error) -> String {
    let text = match error {
        welkin::Error::OutOfRange {
            parameter,
            value,
            min,
            max,
            unit,
        } => {
            let (factor, unit) = match *parameter {
                "tolerance" => (100.0, "%"),
                "visibility" => (1e-3, "km"),
                _ if *unit == "rad" => (1f64.to_degrees(), "degrees"),
                _ => (1.0, *unit),
            };
            let [value, min, max] = [*value, *min, *max].map(|v| rounded(v, factor));
            let converted = welkin::Error::OutOfRange {
                parameter,
                value,
                min,
                max,
                unit,
            };
            let name = parameter.replace('_', " ");
            converted.to_string().replacen(parameter, &name, 1)
        }
        welkin::Error::MissingChunk {
            kind,
            altitude,
            visibility: Some(visibility),
        } => {
            let altitude = altitude.map(|h| format!(" for altitude {} m", plain(h)));
            let visibility = rounded(*visibility, 1e-3);
            format!(
                "the file has no {kind} chunk{} for visibility {} km, which these conditions need",
                altitude.unwrap_or_default(),
                plain(visibility)
            )
        }
        _ => error.to_string(),
    };
    printable(&text)
}

/// In another unit, without the digits that the conversion makes up. What is no end stays none.
fn rounded(value: f64, factor: f64) -> f64 {
    let converted = value * factor;
    if !converted.is_finite() {
        return value;
    }
    format!("{converted:.11e}").parse().unwrap_or(converted)
}

/// A number as a person would write it: with a power of ten where it would have many zeros.
pub fn plain(value: f64) -> String {
    match value == 0.0 || !value.is_finite() || (1e-4..1e15).contains(&value.abs()) {
        true => value.to_string(),
        false => format!("{value:e}"),
    }
}

/// A number with so many digits after the point, or in front of a power of ten where it is huge.
pub fn fixed(value: f64, digits: usize) -> String {
    match value.abs() < 1e9 || !value.is_finite() {
        true => format!("{value:.digits$}"),
        false => format!("{value:.digits$e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for value in [f64::MAX, f64::MIN, 5e-324, 1e15, -1e9, 0.1 + 0.2, f64::NAN] {
            assert!(
                plain(value).len() < 26 && fixed(value, 3).len() < 16,
                "{value:e}"
            );
        }
        assert_eq!([plain(59.4), plain(-1e300)], ["59.4", "-1e300"]);
        assert_eq!([fixed(0.25, 1), fixed(3e38, 2)], ["0.2", "3.00e38"]);
        assert_eq!(rounded((-4.2f64).to_radians(), 1f64.to_degrees()), -4.2);
        assert_eq!(rounded(f64::MAX, 100.0), f64::MAX);
    }
}

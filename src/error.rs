//! What can go wrong, in terms that say what to do about it.

use core::fmt;
#[cfg(feature = "std")]
use std::path::PathBuf;

/// Text that says what is wrong; without the standard library it does not hold the values.
#[cfg(feature = "std")]
pub type Detail = String;
/// Text that says what is wrong.
#[cfg(not(feature = "std"))]
pub type Detail = &'static str;

/// Result with this crate's [`Error`].
///
/// ```
/// use welkin::{Conditions, Model};
///
/// fn zenith_luminance(model: &Model) -> welkin::Result<f32> {
///     let sky = model.sky(&Conditions::default())?;
///     Ok(sky.xyz([0.0, 0.0, 1.0])?[1]) // cd m⁻²
/// }
/// assert!(zenith_luminance(&Model::default_model()?)? > 100.0);
/// # Ok::<(), welkin::Error>(())
/// ```
pub type Result<T> = core::result::Result<T, Error>;

/// Why a file, a parameter or a query was refused.
///
/// ```
/// use welkin::{Conditions, Error, Model};
///
/// let model = Model::default_model()?;
/// let fog = Conditions { visibility: 50.0, ..Conditions::default() };
/// match model.sky(&fog) {
///     Err(Error::OutOfRange { parameter, min, .. }) => {
///         assert_eq!(parameter, "visibility");
///         assert_eq!(min, model.visibility_range()[0]);
///     }
///     _ => unreachable!("no model of clear skies knows fog"),
/// }
/// assert_eq!(Model::from_bytes(*b"no model").unwrap_err().class(), "magic");
/// # Ok::<(), Error>(())
/// ```
#[derive(Debug)]
#[non_exhaustive]
pub enum Error {
    #[cfg(feature = "std")]
    /// The operating system refused to read or write a file.
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    #[cfg(feature = "std")]
    /// The source of a streamed model failed.
    Read {
        /// First byte of the request.
        offset: u64,
        /// What the source said.
        source: std::io::Error,
    },
    /// The bytes do not start like a welkin file.
    NotWelkin,
    /// The file has a major version that this reader does not know.
    Version {
        /// Version this reader knows.
        expected: u16,
        /// Version of the file.
        got: u16,
    },
    /// The file needs features that this reader does not have.
    Feature {
        /// The unknown bits of `required_features`.
        bits: u32,
    },
    /// A chunk is stored in an encoding that this reader cannot decode.
    Encoding {
        /// Index of the chunk in the directory.
        chunk: usize,
        /// The encoding's number.
        got: u32,
    },
    /// Something has the wrong length (bytes or elements).
    Length {
        /// What.
        what: &'static str,
        /// The length it must have.
        expected: u64,
        /// The length it has.
        got: u64,
    },
    /// Stored and computed CRC-32 differ: the file is damaged.
    Checksum {
        /// The damaged chunk's index in the directory; `None`: the head of the file.
        chunk: Option<usize>,
        /// The stored checksum.
        expected: u32,
        /// The checksum of the bytes.
        got: u32,
    },
    /// A value in a model file, or handed to the writer, breaks the format specification.
    Invalid {
        /// The name of the value in the format specification.
        what: &'static str,
        /// What it must be and what it is.
        detail: Detail,
    },
    /// The file lacks a chunk that the conditions need.
    MissingChunk {
        /// What the chunk holds: "radiance", "column", "polarisation" …
        kind: &'static str,
        /// Altitude of the chunk, m, if it has one.
        altitude: Option<f64>,
        /// Visibility of the chunk, m, if it has one.
        visibility: Option<f64>,
    },
    /// A parameter is not finite or outside the range of the model.
    OutOfRange {
        /// Name of the parameter.
        parameter: &'static str,
        /// The refused value.
        value: f64,
        /// Smallest allowed value.
        min: f64,
        /// Largest allowed value.
        max: f64,
        /// Unit of the three values.
        unit: &'static str,
    },
    #[cfg(feature = "std")]
    /// A value of the quantity that the model's maker chose is not finite or outside the range of the model.
    OutOfAxis {
        /// What the file calls the quantity.
        name: String,
        /// The refused value.
        value: f64,
        /// Smallest allowed value.
        min: f64,
        /// Largest allowed value.
        max: f64,
        /// What the file says that the three are measured in.
        unit: String,
    },
    /// No table is large enough for the wanted error.
    Tolerance {
        /// The wanted error.
        expected: f64,
        /// The error of the largest table.
        got: f64,
    },
    /// A point has a coordinate that is not finite or beyond 10⁹ m.
    Point {
        /// The refused point, m.
        got: [f64; 3],
    },
    /// The air of a segment goes too far from where an aerial perspective was prepared.
    Reach {
        /// The end of that air that is too far, m.
        got: [f64; 3],
        /// How far it may be, as an angle at the planet's centre, rad.
        reach: f64,
    },
    /// A model is too large for the fixed arrays of an evaluator without allocation.
    Limit {
        /// What there is too much of.
        what: &'static str,
        /// How many there may be.
        most: usize,
        /// How many there are.
        got: usize,
    },
    /// A direction has length zero or a component that is not finite.
    Direction {
        /// The refused vector.
        got: [f32; 3],
    },
}

impl Error {
    /// The class of the error in the terms of the format specification, section 8.
    pub fn class(&self) -> &'static str {
        match self {
            #[cfg(feature = "std")]
            Error::Io { .. } | Error::Read { .. } => "io",
            Error::NotWelkin => "magic",
            Error::Version { .. } => "version",
            Error::Feature { .. } => "feature",
            Error::Encoding { .. } => "encoding",
            Error::Length { .. } => "length",
            Error::Checksum { .. } => "checksum",
            Error::Invalid { .. } => "value",
            Error::MissingChunk { .. } => "missing",
            Error::OutOfRange { .. } => "range",
            #[cfg(feature = "std")]
            Error::OutOfAxis { .. } => "range",
            Error::Tolerance { .. } => "tolerance",
            Error::Limit { .. } => "limit",
            Error::Direction { .. } => "direction",
            Error::Point { .. } | Error::Reach { .. } => "point",
        }
    }

    pub(crate) fn invalid(what: &'static str, detail: impl Into<Detail>) -> Self {
        Error::Invalid {
            what,
            detail: detail.into(),
        }
    }
}

/// A number as a person would write it: with a power of ten where it would have many zeros.
pub(crate) struct Number(pub f64);

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Number(value) = *self;
        let size = value.abs();
        match value == 0.0 || !value.is_finite() || (1e-4..1e15).contains(&size) {
            true => write!(f, "{value}"),
            false => write!(f, "{value:e}"),
        }
    }
}

/// The same of a number in single precision.
struct Single(f32);

impl fmt::Display for Single {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Single(value) = *self;
        match value == 0.0 || !value.is_finite() || (1e-4..1e9).contains(&value.abs()) {
            true => write!(f, "{value}"),
            false => write!(f, "{value:e}"),
        }
    }
}

/// What a value must be, in words where there is no end: "in 0..=1 m", "at least 3 m", "finite".
pub(crate) struct Range<'a> {
    pub min: f64,
    pub max: f64,
    pub unit: &'a str,
}

impl fmt::Display for Range<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (min, max) = (Number(self.min), Number(self.max));
        match (self.min <= f64::MIN, self.max >= f64::MAX) {
            (true, true) => return write!(f, "finite"),
            (true, false) => write!(f, "at most {max}")?,
            (false, true) => write!(f, "finite and at least {min}")?,
            (false, false) if self.min == self.max => write!(f, "{min}")?,
            (false, false) => write!(f, "in {min}..={max}")?,
        }
        let space = if self.unit.is_empty() { "" } else { " " };
        write!(f, "{space}{}", self.unit)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            #[cfg(feature = "std")]
            Error::Io { path, source } => write!(f, "{}: {source}", path.display()),
            #[cfg(feature = "std")]
            Error::Read { offset, source } => write!(f, "cannot read at byte {offset}: {source}"),
            Error::NotWelkin => write!(
                f,
                "not a welkin file: the magic bytes are missing (is it another format, or was it sent in text mode?)"
            ),
            Error::Version { expected, got } => write!(
                f,
                "file has format version {got}, this reader knows version {expected}: use a newer welkin or a file of version {expected}"
            ),
            Error::Feature { bits } => write!(
                f,
                "file requires features {bits:#x} that this reader does not know: use a newer welkin"
            ),
            Error::Encoding { chunk, got } => write!(
                f,
                "chunk {chunk} has encoding {got}, which this reader cannot decode: use a welkin with zstd, a newer one, or a raw file"
            ),
            Error::Length {
                what,
                expected,
                got,
            } => write!(f, "{what}: expected length {expected}, got {got}"),
            Error::Checksum {
                chunk,
                expected,
                got,
            } => {
                match chunk {
                    Some(index) => write!(f, "chunk {index}")?,
                    None => write!(f, "head")?,
                }
                write!(
                    f,
                    " is damaged: expected CRC-32 {expected:08x}, got {got:08x}: fetch the file again"
                )
            }
            Error::Invalid { what, detail } => write!(f, "invalid {what}: {detail}"),
            Error::MissingChunk {
                kind,
                altitude,
                visibility,
            } => {
                write!(f, "the file has no {kind} chunk")?;
                if let Some(altitude) = altitude {
                    write!(f, " for altitude {} m", Number(*altitude))?;
                }
                if let Some(visibility) = visibility {
                    write!(f, " for visibility {} m", Number(*visibility))?;
                }
                write!(f, ", which these conditions need")
            }
            Error::OutOfRange {
                parameter,
                value,
                min,
                max,
                unit,
            } => refused(f, parameter, *value, [*min, *max], unit),
            #[cfg(feature = "std")]
            Error::OutOfAxis {
                name,
                value,
                min,
                max,
                unit,
            } => {
                // Text from strangers.
                let [name, unit] = [name, unit].map(|text| text.escape_debug().to_string());
                refused(f, &name, *value, [*min, *max], &unit)
            }
            Error::Limit { what, most, got } => write!(
                f,
                "the model has {got} {what}, this evaluator has room for {most}: prepare a sky instead"
            ),
            Error::Tolerance { expected, got } => write!(
                f,
                "the largest table has an error of {}, wanted at most {}: allow more",
                Number(*got),
                Number(*expected)
            ),
            Error::Point { got: [x, y, z] } => write!(
                f,
                "coordinates of a point must lie within ±1e9 m, got ({}, {}, {}) m",
                Number(*x),
                Number(*y),
                Number(*z)
            ),
            Error::Reach {
                got: [x, y, z],
                reach,
            } => write!(
                f,
                "the air of a segment must lie within {reach} rad (angle at the planet's centre) of where the aerial perspective was prepared, got ({x}, {y}, {z}): prepare one nearer to it"
            ),
            Error::Direction { got: [x, y, z] } => write!(
                f,
                "direction must be finite and not zero, got ({}, {}, {})",
                Single(*x),
                Single(*y),
                Single(*z)
            ),
        }
    }
}

/// A value that is not in its range.
fn refused(
    f: &mut fmt::Formatter<'_>,
    name: &str,
    value: f64,
    [min, max]: [f64; 2],
    unit: &str,
) -> fmt::Result {
    let range = Range { min, max, unit };
    write!(f, "{name} must be {range}, got {}", Number(value))?;
    match unit.is_empty() || !value.is_finite() {
        true => Ok(()),
        false => write!(f, " {unit}"),
    }
}

impl core::error::Error for Error {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            #[cfg(feature = "std")]
            Error::Io { source, .. } | Error::Read { source, .. } => Some(source),
            _ => None,
        }
    }
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::*;

    fn out_of_range(
        parameter: &'static str,
        [value, min, max]: [f64; 3],
        unit: &'static str,
    ) -> String {
        let error = Error::OutOfRange {
            parameter,
            value,
            min,
            max,
            unit,
        };
        error.to_string()
    }

    #[test]
    fn ranges_are_told_as_people_tell_them() {
        let every = [f64::NAN, f64::MIN, f64::MAX];
        assert_eq!(
            out_of_range("solar_azimuth", every, "rad"),
            "solar_azimuth must be finite, got NaN"
        );
        assert_eq!(
            out_of_range("solar_elevation", [2.0, -0.0625, 1.5], "rad"),
            "solar_elevation must be in -0.0625..=1.5 rad, got 2 rad"
        );
        assert_eq!(
            out_of_range("visibility", [2e4, 3e4, 3e4], "m"),
            "visibility must be 30000 m, got 20000 m"
        );
        assert_eq!(
            out_of_range("x", [-1e300, f64::MIN_POSITIVE, f64::MAX], ""),
            "x must be finite and at least 2.2250738585072014e-308, got -1e300"
        );
        assert_eq!(
            out_of_range("x", [1e300, f64::MIN, 3.0], "m"),
            "x must be at most 3 m, got 1e300 m"
        );
    }

    #[test]
    fn no_number_has_hundreds_of_digits() {
        for value in [
            f64::MAX,
            f64::MIN,
            5e-324,
            f64::MIN_POSITIVE,
            0.1 + 0.2,
            f64::NAN,
        ] {
            let errors = [
                Error::Tolerance {
                    expected: value,
                    got: value,
                },
                Error::Point { got: [value; 3] },
                Error::Direction {
                    got: [value as f32; 3],
                },
                Error::MissingChunk {
                    kind: "radiance",
                    altitude: Some(value),
                    visibility: Some(value),
                },
            ];
            for error in errors {
                assert!(error.to_string().len() < 160, "{error}");
            }
        }
    }
}

//! Why a measurement is refused.

use std::fmt;
use std::path::{Path, PathBuf};

/// Why a file or a folder of measurements is refused.
#[derive(Debug)]
pub enum MeasuredError {
    /// The system would not let it be read.
    Read {
        /// File or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A name that says neither what nor when was measured.
    Name {
        /// File or folder.
        path: PathBuf,
        /// What is wrong with it.
        detail: String,
    },
    /// A line that is none of this kind of file.
    Line {
        /// The file.
        path: PathBuf,
        /// Counted from 1.
        line: usize,
        /// What is wrong with it.
        detail: String,
    },
    /// A scan of which too many values are no light.
    Dark {
        /// Which, and how many are taken.
        detail: String,
    },
    /// Files that do not make one measurement.
    Incomplete {
        /// File or folder.
        path: PathBuf,
        /// What is missing or does not fit.
        detail: String,
    },
}

impl MeasuredError {
    /// [`MeasuredError::Read`] of a path, for `map_err`.
    pub fn read(path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Read { path, source }
    }

    /// [`MeasuredError::Name`].
    pub fn name(path: &Path, detail: impl Into<String>) -> Self {
        Self::Name {
            path: path.to_owned(),
            detail: detail.into(),
        }
    }

    /// [`MeasuredError::Line`], with the line counted from 0.
    pub fn line(path: &Path, index: usize, detail: impl Into<String>) -> Self {
        Self::Line {
            path: path.to_owned(),
            line: index + 1,
            detail: detail.into(),
        }
    }

    /// [`MeasuredError::Incomplete`].
    pub fn incomplete(path: &Path, detail: impl Into<String>) -> Self {
        Self::Incomplete {
            path: path.to_owned(),
            detail: detail.into(),
        }
    }
}

impl fmt::Display for MeasuredError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Read { path, source } => write!(f, "{}: {source}", path.display()),
            Self::Name { path, detail } | Self::Incomplete { path, detail } => {
                write!(f, "{}: {detail}", path.display())
            }
            Self::Dark { detail } => f.write_str(detail),
            Self::Line { path, line, detail } => {
                write!(f, "{}, line {line}: {detail}", path.display())
            }
        }
    }
}

impl std::error::Error for MeasuredError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Read { source, .. } => Some(source),
            _ => None,
        }
    }
}

/// The text of a file.
pub fn text(path: &Path) -> Result<String, MeasuredError> {
    std::fs::read_to_string(path).map_err(MeasuredError::read(path))
}

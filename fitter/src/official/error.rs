//! Why a file of the official model, or a question about it, is refused.

use std::fmt;

/// The sections of a file, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Section {
    /// Axes and breaks.
    Header,
    /// Factors of the radiance.
    Radiance,
    /// Factors of the transmittance.
    Transmittance,
    /// Factors of the polarisation.
    Polarisation,
}

impl fmt::Display for Section {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Header => "header",
            Self::Radiance => "radiance",
            Self::Transmittance => "transmittance",
            Self::Polarisation => "polarisation",
        })
    }
}

/// Why a file or a question is refused.
#[derive(Debug)]
pub enum OfficialError {
    /// The source failed.
    Read {
        /// First byte that was asked for.
        offset: u64,
        /// What the system said.
        source: std::io::Error,
    },
    /// The target failed.
    Write(std::io::Error),
    /// Something was written out of its order, or not all of a section.
    Order(Section),
    /// The file ends within a section.
    Truncated {
        /// The section.
        section: Section,
        /// Bytes that the file must have for it.
        needed: u64,
        /// Bytes that it has.
        length: u64,
    },
    /// A number that nothing official has.
    Value {
        /// The section.
        section: Section,
        /// Its name.
        what: &'static str,
        /// What is wrong with it.
        detail: String,
    },
    /// The file has no such section, or not all of it.
    Missing(Section),
    /// A condition that is not finite.
    Condition(&'static str),
    /// A condition that may be infinite, but not below 0.
    Negative(&'static str),
    /// A view direction of no length, or not finite.
    Direction,
}

impl OfficialError {
    pub(super) fn value(section: Section, what: &'static str, detail: impl Into<String>) -> Self {
        Self::Value {
            section,
            what,
            detail: detail.into(),
        }
    }
}

impl fmt::Display for OfficialError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Read { offset, source } => write!(f, "cannot read from byte {offset}: {source}"),
            Self::Write(source) => write!(f, "cannot write: {source}"),
            Self::Order(section) => write!(
                f,
                "the {section} section is not written as a whole and in its order"
            ),
            Self::Truncated {
                section,
                needed,
                length,
            } => write!(
                f,
                "the file ends within its {section} section: {needed} bytes are needed, it has {length}"
            ),
            Self::Value {
                section,
                what,
                detail,
            } => write!(f, "{what} in the {section} section: {detail}"),
            Self::Missing(section) => write!(f, "the file has no whole {section} section"),
            Self::Condition(what) => write!(f, "{what} is not a finite number"),
            Self::Negative(what) => write!(f, "{what} must be ≥ 0"),
            Self::Direction => f.write_str("the view direction is zero or not finite"),
        }
    }
}

impl std::error::Error for OfficialError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Read { source, .. } | Self::Write(source) => Some(source),
            _ => None,
        }
    }
}

/// Result with an [`OfficialError`].
pub type Result<T> = std::result::Result<T, OfficialError>;

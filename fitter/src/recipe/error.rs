//! What is wrong with a recipe, and where.

use std::fmt;
use std::path::PathBuf;

/// Why there is no atmosphere.
#[derive(Debug)]
pub enum RecipeError {
    /// A file cannot be read.
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        why: std::io::Error,
    },
    /// The text is no TOML, or has a field that recipes do not have.
    Syntax(String),
    /// A field has a value that it cannot have.
    Field {
        /// The field, as `layers.dust.top_km`.
        place: String,
        /// What is wrong.
        what: String,
    },
    /// There are more altitude profiles than the solver takes.
    TooManyProfiles {
        /// Those of the particles, after those that can be one have become one.
        particles: usize,
        /// How many there may be.
        most: usize,
    },
}

impl fmt::Display for RecipeError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Unreadable { path, why } => write!(f, "cannot read {}: {why}", path.display()),
            Self::Syntax(what) => f.write_str(what.trim_end()),
            Self::Field { place, what } => write!(f, "{place}: {what}"),
            Self::TooManyProfiles { particles, most } => write!(
                f,
                "layers: {particles} different altitude profiles of particles, at most {most} can be traced beside \
                 the gases; give layers the same bottom, top and scale height or the same particles"
            ),
        }
    }
}

impl std::error::Error for RecipeError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Unreadable { why, .. } => Some(why),
            _ => None,
        }
    }
}

/// What is wrong with the field at `place`.
pub fn field(place: impl Into<String>, what: impl Into<String>) -> RecipeError {
    RecipeError::Field {
        place: place.into(),
        what: what.into(),
    }
}

//! Where a command writes, as its arguments say it.

use std::fmt;
use std::fs;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

use super::path_kind::in_file;
use super::printable::printable;
use super::replace::{check, replace_files};
use crate::error::Result;

/// Names of standard output. As a file, what the command says would go over what it writes.
const STANDARD: [&str; 4] = ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"];

/// Where a command writes a file.
///
/// ```
/// use welkin::output::Target;
///
/// assert_eq!(Target::new("-"), Target::Standard);
/// let target = Target::new("sky.png");
/// assert_eq!(target.to_string(), "sky.png");
/// assert!(!target.is_stream());
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// Standard output.
    Standard,
    /// What is at a path.
    Path(PathBuf),
}

impl Target {
    /// From an argument: `-` and `/dev/stdout` are standard output.
    pub fn new(argument: impl AsRef<Path>) -> Self {
        let path = argument.as_ref();
        match STANDARD.iter().any(|name| path == Path::new(name)) {
            true => Self::Standard,
            false => Self::Path(path.to_owned()),
        }
    }

    /// Refuses, before the work, what could not be written to after it.
    ///
    /// # Errors
    /// As [`check`]; also if standard output is a terminal, where nobody wants the bytes of a picture.
    pub fn check(&self) -> Result<()> {
        match self {
            Self::Standard if io::stdout().is_terminal() => {
                let text = "is a terminal: pipe it or name a file";
                Err(in_file(&self.path(), io::Error::other(text)))
            }
            Self::Standard => Ok(()),
            Self::Path(path) => check(path),
        }
    }

    /// Whether it keeps no bytes, so that its name says nothing about them: standard output, FIFOs, devices and
    /// sockets.
    pub fn is_stream(&self) -> bool {
        match self {
            Self::Standard => true,
            Self::Path(path) => fs::metadata(path).is_ok_and(|m| !m.is_file() && !m.is_dir()),
        }
    }

    /// Where to say what was done, which is not where the bytes go: standard output, or else standard error, as what is
    /// no file may be standard output by another name.
    pub fn report(&self) -> Box<dyn Write> {
        match self.is_stream() {
            true => Box::new(io::stderr()),
            false => Box::new(io::stdout()),
        }
    }

    /// The path that errors name.
    fn path(&self) -> PathBuf {
        match self {
            Self::Standard => PathBuf::from("standard output"),
            Self::Path(path) => path.clone(),
        }
    }
}

/// For people: without what a terminal would obey.
impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&printable(&self.path().display().to_string()))
    }
}

/// Writes files that belong together, as [`replace_files`] does.
///
/// # Errors
/// As [`replace_files`]; those of standard output name it so.
pub fn write(files: &[(&Target, &[u8])]) -> Result<()> {
    let mut others = Vec::new();
    for &(target, bytes) in files {
        match target {
            Target::Path(path) => others.push((path.as_path(), bytes)),
            Target::Standard => {
                let mut out = io::stdout().lock();
                let written = out.write_all(bytes).and_then(|()| out.flush());
                written.map_err(|e| in_file(&target.path(), e))?;
            }
        }
    }
    replace_files(&others)
}

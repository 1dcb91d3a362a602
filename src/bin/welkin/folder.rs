//! The folder that files of a command go to.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use crate::failure::{Failure, Result};

/// Makes it unless it is there; the folder that it lies in must be.
pub fn make(path: &Path) -> Result<()> {
    if path.as_os_str().is_empty() || path.is_dir() {
        return Ok(());
    }
    fs::create_dir(path).map_err(|error| {
        let why = match error.kind() {
            ErrorKind::AlreadyExists => "is no folder".to_owned(),
            _ => format!("no folder can be made: {error}"),
        };
        Failure::message(format!("{}: {why}", path.display()))
    })
}

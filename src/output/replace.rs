//! Replaces files: written beside their targets, then renamed.

use std::path::Path;

use super::path_kind::{PathKind, in_file};
use super::temporary::{self, Temporary};
use crate::error::Result;

/// Writes `bytes` to `path`: readers of a regular file see the old one or the new one, never a part, even after a full
/// disk, a killed process or a power cut.
///
/// # Errors
/// [`Error::Io`](crate::Error::Io) with `path`: of kind [`std::io::ErrorKind::InvalidInput`] if it names no file (it is
/// empty, or ends in a separator, `.` or `..`), of kind [`std::io::ErrorKind::IsADirectory`] if it is a folder. The
/// temporary file is removed, and the old file is as it was.
pub fn replace_file(path: impl AsRef<Path>, bytes: &[u8]) -> Result<()> {
    replace_files(&[(path.as_ref(), bytes)])
}

/// Writes files that belong together: none is touched before the bytes of all are on disk, then they are renamed in the
/// order given. A process that is killed leaves all old or all new, except in the instant between two renames.
///
/// # Errors
/// As [`replace_file`], with the path of the file that failed.
pub fn replace_files(files: &[(&Path, &[u8])]) -> Result<()> {
    let mut streams = Vec::new();
    let mut temporaries = Vec::new();
    for &(path, bytes) in files {
        let place = PathKind::of(path).map_err(|e| in_file(path, e))?;
        match place {
            PathKind::Stream(stream) => streams.push((path, stream, bytes)),
            PathKind::File { path: target, old } => {
                let written = Temporary::beside(&target, old.as_ref())
                    .and_then(|temporary| temporary.fill(bytes, old.as_ref()));
                temporaries.push((path, written.map_err(|e| in_file(path, e))?, target));
            }
        }
    }
    for (path, stream, bytes) in streams {
        stream.write(path, bytes).map_err(|e| in_file(path, e))?;
    }
    temporary::rename_all(temporaries)
}

/// Finds out whether [`replace_file`] could write to `path`, without changing what is there: for the moment before long
/// work.
///
/// # Errors
/// As [`replace_file`].
pub fn check(path: impl AsRef<Path>) -> Result<()> {
    let path = path.as_ref();
    let place = PathKind::of(path).map_err(|e| in_file(path, e))?;
    match place {
        // Opening a FIFO waits for a reader, and a device may act on it.
        PathKind::Stream(_) => Ok(()),
        PathKind::File { path: target, old } => {
            let temporary = Temporary::beside(&target, old.as_ref());
            temporary.map(drop).map_err(|e| in_file(path, e))
        }
    }
}

//! Writes files whole or not at all.
//!
//! What a regular file, or nothing, is at gets replaced in one step: the bytes go to a temporary file in the same
//! folder, which is renamed when they are on disk. Symbolic links are followed, so that they stay and what they point
//! to is replaced or created. A replaced file keeps its mode and, as far as the system lets this process give files
//! away, its owner and group; if it does not, the set-user-ID and set-group-ID bits go. Other hard links to it keep the
//! old bytes.
//!
//! What is neither a regular file nor a folder (FIFOs, devices, sockets, and descriptors such as `/dev/stdout`) is
//! written straight to.
//!
//! Temporary files are named `.welkin-HASH-N.tmp`, `HASH` being that of the target's name, and locked as long as their
//! writer lives. One that a killed process has left behind is removed by the next write of the same target, or by
//! [`sweep`]. With the feature `signals`, `abandon_on_signals` leaves none behind where a process is asked to end.

mod path_kind;
#[cfg(all(unix, feature = "signals"))]
mod signals;
mod target;
mod temporary;

use std::io;
use std::path::Path;

use crate::error::{Error, Result};
use path_kind::PathKind;
use temporary::Temporary;

#[cfg(all(unix, feature = "signals"))]
pub use signals::abandon_on_signals;
pub use target::{Target, write};
pub use temporary::{abandon, sweep};

/// Writes `bytes` to `path`: readers of a regular file see the old one or the new one, never a part, even after a full
/// disk, a killed process or a power cut.
///
/// # Errors
/// [`Error::Io`] with `path`: of kind [`io::ErrorKind::InvalidInput`] if it names no file (it is empty, or ends in a separator, `.`
/// or `..`), of kind [`io::ErrorKind::IsADirectory`] if it is a folder. The temporary file is removed, and the old file
/// is as it was.
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

fn in_file(path: &Path, source: io::Error) -> Error {
    Error::Io {
        path: path.to_owned(),
        source,
    }
}

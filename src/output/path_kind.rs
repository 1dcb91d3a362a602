//! What is at a path.

use std::fs::{self, FileType, Metadata, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf, is_separator};

use crate::error::Error;

/// As many links as the kernel follows.
const MOST_LINKS: usize = 40;

/// Where bytes for a path go.
pub enum PathKind {
    /// A regular file, or nothing yet.
    File {
        /// After all links.
        path: PathBuf,
        old: Option<Metadata>,
    },
    /// What keeps no bytes, or a descriptor.
    Stream(Stream),
}

/// What is written straight to.
pub enum Stream {
    #[cfg(unix)]
    Socket,
    /// `/dev/stdout` and its like may stand for a regular file, whose bytes so far are not ours.
    Descriptor,
    Other,
}

impl PathKind {
    pub fn of(path: &Path) -> io::Result<Self> {
        check_name(path)?;
        let old = match fs::metadata(path) {
            Ok(old) if old.is_dir() => return Err(ErrorKind::IsADirectory.into()),
            Ok(old) if !old.is_file() => return Ok(Self::Stream(Stream::of(old.file_type()))),
            Ok(old) => Some(old),
            Err(error) if error.kind() == ErrorKind::NotFound => None,
            Err(error) => return Err(error),
        };
        let mut path = path.to_owned();
        for _ in 0..MOST_LINKS {
            let Ok(target) = fs::read_link(&path) else {
                check_name(&path)?;
                return Ok(Self::File { path, old });
            };
            if is_descriptor(&path) {
                return Ok(Self::Stream(Stream::Descriptor));
            }
            path = folder(&path).join(target);
        }
        Err(io::Error::other("too many symbolic links"))
    }
}

/// Refuses what can only be a folder, where adding to the name or replacing it would write to surprising places.
fn check_name(path: &Path) -> io::Result<()> {
    let text = path.as_os_str().as_encoded_bytes();
    let last = text
        .rsplit(|&byte| is_separator(byte.into()))
        .next()
        .unwrap_or_default();
    match last {
        b"" | b"." | b".." => {
            let text = "the name of a file is missing";
            Err(io::Error::new(ErrorKind::InvalidInput, text))
        }
        _ => Ok(()),
    }
}

/// Whether a link is one of the system's names of open files.
fn is_descriptor(link: &Path) -> bool {
    let real = fs::canonicalize(folder(link));
    real.is_ok_and(|real| real.starts_with("/proc") && real.ends_with("fd"))
}

/// The folder that a file is in.
pub fn folder(path: &Path) -> &Path {
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty());
    parent.unwrap_or(Path::new("."))
}

impl Stream {
    #[cfg(unix)]
    fn of(kind: FileType) -> Self {
        use std::os::unix::fs::FileTypeExt;
        match kind.is_socket() {
            true => Self::Socket,
            false => Self::Other,
        }
    }

    #[cfg(not(unix))]
    fn of(_: FileType) -> Self {
        Self::Other
    }

    pub fn write(&self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        match self {
            #[cfg(unix)]
            Self::Socket => send(path, bytes),
            Self::Descriptor => OpenOptions::new().append(true).open(path)?.write_all(bytes),
            Self::Other => OpenOptions::new().write(true).open(path)?.write_all(bytes),
        }
    }
}

#[cfg(unix)]
fn send(path: &Path, bytes: &[u8]) -> io::Result<()> {
    std::os::unix::net::UnixStream::connect(path)?.write_all(bytes)
}

/// An error with the path of its file.
pub(super) fn in_file(path: &Path, source: io::Error) -> Error {
    Error::Io {
        path: path.to_owned(),
        source,
    }
}

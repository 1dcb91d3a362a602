//! Temporary files beside their targets, which nobody has to clean up after.

use std::ffi::OsStr;
use std::fs::{self, File, Metadata, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use super::path_kind::{folder, in_file};
use crate::error::Result;

/// Where files cannot be locked, what is older than this has no writer any more.
const LONGEST_WRITE: Duration = Duration::from_secs(24 * 3600);
/// So many free names in a row: no writer of this target has come farther.
const FREE_IN_A_ROW: usize = 8;
/// More writers of one target at a time than anybody starts.
const MOST_WRITERS: usize = 10_000;

/// The temporary files of this process. Whoever creates, renames or removes one holds the lock.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes the temporary files of all writes that go on in this process; writers then wait for ever. For programs that
/// are asked to end by a signal, in the thread that ends them.
pub fn abandon() {
    let files = unfinished();
    for file in files.iter() {
        let _ = fs::remove_file(file);
    }
    std::mem::forget(files);
}

/// A locked file that is removed when it is dropped.
pub struct Temporary {
    path: PathBuf,
    file: File,
    /// The name may be another's by now.
    renamed: bool,
}

impl Temporary {
    /// Creates an empty one that nobody may read who may not read the `old` file, and removes those that dead writers
    /// have left.
    pub fn beside(target: &Path, old: Option<&Metadata>) -> io::Result<Self> {
        // A folder may be one that cannot be listed.
        let _ = sweep(folder(target));
        let name = target.file_name().unwrap_or_default();
        let mut temporary = None;
        let mut free = 0;
        for number in 0..MOST_WRITERS {
            let path = folder(target).join(name_of(name, number));
            remove_if_dead(&path);
            if temporary.is_none() {
                temporary = Self::create(&path, old)?;
                continue;
            }
            free = if exists(&path) { 0 } else { free + 1 };
            if free == FREE_IN_A_ROW {
                break;
            }
        }
        temporary.ok_or_else(|| ErrorKind::ResourceBusy.into())
    }

    /// `None` if another writer has the name.
    fn create(path: &Path, old: Option<&Metadata>) -> io::Result<Option<Self>> {
        let mut unfinished = unfinished();
        let file = match options(old).open(path) {
            Ok(file) => file,
            Err(error) if error.kind() == ErrorKind::AlreadyExists => return Ok(None),
            Err(error) => return Err(error),
        };
        // Until it was locked, another process may have taken it for a dead one's.
        if matches!(file.try_lock(), Err(TryLockError::WouldBlock)) || !is_at(&file, path) {
            return Ok(None);
        }
        unfinished.push(path.to_owned());
        Ok(Some(Self {
            path: path.to_owned(),
            file,
            renamed: false,
        }))
    }

    /// Writes all bytes down to the disk, and makes mode and owner those of the `old` file.
    pub fn fill(mut self, bytes: &[u8], old: Option<&Metadata>) -> io::Result<Self> {
        self.file.write_all(bytes)?;
        if let Some(old) = old {
            resemble(&self.file, old)?;
        }
        self.file.sync_all()?;
        Ok(self)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if !self.renamed {
            let mut unfinished = unfinished();
            unfinished.retain(|path| *path != self.path);
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Gives files the names of their targets, one after the other; the first of each three is what errors name.
pub fn rename_all(mut files: Vec<(&Path, Temporary, PathBuf)>) -> Result<()> {
    let mut unfinished_files = unfinished();
    let mut renamed = Ok(());
    for (path, temporary, target) in &mut files {
        renamed = fs::rename(&temporary.path, &*target).map_err(|e| in_file(path, e));
        if renamed.is_err() {
            break;
        }
        temporary.renamed = true;
        unfinished_files.retain(|path| *path != temporary.path);
    }
    drop(unfinished_files);
    renamed?;
    for (path, _, target) in &files {
        sync_folder(folder(target)).map_err(|e| in_file(path, e))?;
    }
    Ok(())
}

/// Its length does not depend on that of the target's name.
fn name_of(target: &OsStr, number: usize) -> String {
    let hash = crc32fast::hash(target.as_encoded_bytes());
    format!(".welkin-{hash:08x}-{number}.tmp")
}

fn exists(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok()
}

/// Best effort: what stays is tried again by the next write.
fn remove_if_dead(path: &Path) {
    let Ok(metadata) = fs::symlink_metadata(path) else {
        return;
    };
    if !metadata.is_file() {
        return;
    }
    let Ok(file) = OpenOptions::new().write(true).open(path) else {
        return;
    };
    let dead = match file.try_lock() {
        Ok(()) => true,
        Err(TryLockError::WouldBlock) => false,
        Err(TryLockError::Error(_)) => {
            let age = metadata.modified().ok().and_then(|at| at.elapsed().ok());
            age.is_some_and(|age| age > LONGEST_WRITE)
        }
    };
    // Between opening and locking it may have become its target, and the name another's.
    if dead && is_at(&file, path) {
        let _ = fs::remove_file(path);
    }
}

/// Removes the temporary files of dead writers of any target from a folder, as every write does, too.
///
/// # Errors
/// [`Error::Io`](crate::Error::Io) if the folder cannot be read.
pub fn sweep(folder: impl AsRef<Path>) -> Result<()> {
    let folder = folder.as_ref();
    for entry in fs::read_dir(folder).map_err(|e| in_file(folder, e))? {
        let entry = entry.map_err(|e| in_file(folder, e))?;
        if is_temporary(&entry.file_name()) {
            remove_if_dead(&entry.path());
        }
    }
    Ok(())
}

/// Whether a name is one of [`name_of`].
fn is_temporary(name: &OsStr) -> bool {
    let inner = |name: &str| -> Option<(String, String)> {
        let inner = name.strip_prefix(".welkin-")?.strip_suffix(".tmp")?;
        let (hash, number) = inner.split_once('-')?;
        Some((hash.to_owned(), number.to_owned()))
    };
    name.to_str().and_then(inner).is_some_and(|(hash, number)| {
        u32::from_str_radix(&hash, 16).is_ok() && number.parse::<usize>().is_ok()
    })
}

/// Whether an open file is the one at a path.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let identity = |m: Metadata| (m.dev(), m.ino());
    match (file.metadata(), fs::symlink_metadata(path)) {
        (Ok(a), Ok(b)) => identity(a) == identity(b),
        _ => false,
    }
}

#[cfg(not(unix))]
fn is_at(_: &File, path: &Path) -> bool {
    exists(path)
}

#[cfg(unix)]
fn options(old: Option<&Metadata>) -> OpenOptions {
    use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
    let mut options = OpenOptions::new();
    options.write(true).create_new(true);
    if let Some(old) = old {
        options.mode(old.mode() & 0o777);
    }
    options
}

#[cfg(not(unix))]
fn options(_: Option<&Metadata>) -> OpenOptions {
    let mut options = OpenOptions::new();
    options.write(true).create_new(true);
    options
}

/// Mode, owner and group of the `old` file, the last two as far as the system permits.
#[cfg(unix)]
fn resemble(file: &File, old: &Metadata) -> io::Result<()> {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
    let (uid, gid) = (Some(old.uid()), Some(old.gid()));
    let given = fchown(file, uid, gid).is_ok();
    if !given {
        let _ = fchown(file, None, gid);
    }
    // To run as somebody is for files of that somebody.
    let bits = if given { 0o7777 } else { 0o777 };
    let new = file.metadata()?;
    let mode = old.mode() & bits;
    if new.mode() & 0o7777 == mode {
        return Ok(());
    }
    file.set_permissions(fs::Permissions::from_mode(mode))
}

#[cfg(not(unix))]
fn resemble(_: &File, _: &Metadata) -> io::Result<()> {
    Ok(())
}

/// Makes new names durable. Only Unix can open a folder as a file, and only one that may be read; some file systems
/// cannot sync it.
fn sync_folder(folder: &Path) -> io::Result<()> {
    if cfg!(not(unix)) {
        return Ok(());
    }
    use ErrorKind::{InvalidInput, PermissionDenied, Unsupported};
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        Err(error) if matches!(error.kind(), InvalidInput | PermissionDenied | Unsupported) => {
            Ok(())
        }
        done => done,
    }
}

//! Where the bytes of a model come from when they are not in memory.

use std::io;
use std::sync::Arc;

/// A file that can be read in pieces: on disk, or behind a server that answers range requests.
///
/// [`Model::stream`](crate::Model::stream) asks for the head and then for the chunks of each scene, nothing else.
///
/// ```
/// use std::io;
/// use welkin::{Conditions, Model, ReadAt};
///
/// /// A file of which some bytes are at hand.
/// struct Remote(&'static [u8]);
///
/// impl ReadAt for Remote {
///     fn read_at(&self, offset: u64, buffer: &mut [u8]) -> io::Result<usize> {
///         self.0.read_at(offset, buffer) // here would be a request to a server
///     }
/// }
///
/// let model = Model::stream(Remote(welkin::DEFAULT_MODEL))?;
/// model.sky(&Conditions::default())?;
/// assert!(model.traffic().bytes < model.file_bytes() as u64 / 10);
/// # Ok::<(), welkin::Error>(())
/// ```
pub trait ReadAt: Send + Sync {
    /// Fills `buffer` with the bytes from `offset` on and returns how many they are: fewer than `buffer.len()` only
    /// where the file ends.
    ///
    /// # Errors
    /// Whatever keeps the bytes from coming. The reader does not try again.
    fn read_at(&self, offset: u64, buffer: &mut [u8]) -> io::Result<usize>;
}

impl ReadAt for [u8] {
    fn read_at(&self, offset: u64, buffer: &mut [u8]) -> io::Result<usize> {
        let start = usize::try_from(offset).unwrap_or(usize::MAX);
        let rest = self.get(start..).unwrap_or_default();
        let length = rest.len().min(buffer.len());
        buffer[..length].copy_from_slice(&rest[..length]);
        Ok(length)
    }
}

impl ReadAt for Vec<u8> {
    fn read_at(&self, offset: u64, buffer: &mut [u8]) -> io::Result<usize> {
        self.as_slice().read_at(offset, buffer)
    }
}

impl<T: ReadAt + ?Sized> ReadAt for Arc<T> {
    fn read_at(&self, offset: u64, buffer: &mut [u8]) -> io::Result<usize> {
        (**self).read_at(offset, buffer)
    }
}

#[cfg(any(unix, windows))]
mod file {
    use std::fs::File;
    use std::io;

    use crate::model::read_at::ReadAt;

    impl ReadAt for File {
        fn read_at(&self, offset: u64, buffer: &mut [u8]) -> io::Result<usize> {
            let mut filled = 0;
            while filled < buffer.len() {
                match read_some(self, offset + filled as u64, &mut buffer[filled..]) {
                    Ok(0) => break,
                    Ok(n) => filled += n,
                    Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                    Err(error) => return Err(error),
                }
            }
            Ok(filled)
        }
    }

    #[cfg(unix)]
    fn read_some(file: &File, offset: u64, buffer: &mut [u8]) -> io::Result<usize> {
        std::os::unix::fs::FileExt::read_at(file, buffer, offset)
    }

    #[cfg(windows)]
    fn read_some(file: &File, offset: u64, buffer: &mut [u8]) -> io::Result<usize> {
        std::os::windows::fs::FileExt::seek_read(file, buffer, offset)
    }
}

//! Files as memory. The one unsafe step is kept here, away from all that reads the bytes.

use std::fs::File;
use std::path::Path;

use memmap2::Mmap;

/// Maps a regular file; anything else (a pipe, say) cannot be mapped.
pub fn map(path: &Path) -> std::io::Result<Option<Mmap>> {
    let file = File::open(path)?;
    if !file.metadata()?.is_file() {
        return Ok(None);
    }
    // SAFETY: the map is read-only and private to the model; that nobody changes the file meanwhile is the caller's
    // part, stated at `Model::open`. All bytes are treated as untrusted integers and floats, of which every bit
    // pattern is valid.
    unsafe { Mmap::map(&file) }.map(Some)
}

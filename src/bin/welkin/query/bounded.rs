//! Input of which no row takes more than some memory, whatever is in it.

use std::cell::Cell;
use std::io::{self, ErrorKind, Read};

/// Reads no more than what was allowed since the last row.
pub struct Bounded<R> {
    input: R,
    left: Cell<usize>,
}

impl<R> Bounded<R> {
    pub fn new(input: R, bytes: usize) -> Self {
        Self {
            input,
            left: Cell::new(bytes),
        }
    }

    /// Begins another row of at most so many bytes.
    pub fn allow(&self, bytes: usize) {
        self.left.set(bytes);
    }
}

impl<R: Read> Read for Bounded<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let most = buffer.len().min(self.left.get());
        if most == 0 && !buffer.is_empty() {
            let text = "a row is too long: is a quotation mark open?";
            return Err(io::Error::new(ErrorKind::InvalidData, text));
        }
        let read = self.input.read(&mut buffer[..most])?;
        self.left.set(self.left.get() - read);
        Ok(read)
    }
}

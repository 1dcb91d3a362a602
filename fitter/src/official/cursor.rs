//! Reads numbers one after the other, never past the end and never more than was announced.

use super::error::{OfficialError, Result, Section};
use super::layout::check_count;
use welkin::ReadAt;

/// Where the next number stands.
pub struct Cursor<'a> {
    source: &'a dyn ReadAt,
    length: u64,
    /// Offset of the next byte.
    pub offset: u64,
    /// The section that errors name.
    pub section: Section,
}

impl<'a> Cursor<'a> {
    /// At the start of a source of `length` bytes.
    pub fn new(source: &'a dyn ReadAt, length: u64) -> Self {
        Self {
            source,
            length,
            offset: 0,
            section: Section::Header,
        }
    }

    /// Bytes up to the end.
    pub fn rest(&self) -> u64 {
        self.length.saturating_sub(self.offset)
    }

    /// Goes over `count` bytes if the file has them.
    pub fn skip(&mut self, count: u64) -> Result<()> {
        self.require(count)?;
        self.offset += count;
        Ok(())
    }

    /// A count within `1..=most`.
    pub fn count(&mut self, what: &'static str, most: usize) -> Result<usize> {
        let got = self.i32()?;
        check_count(self.section, what, got.into(), most)
    }

    /// A number.
    pub fn f64(&mut self) -> Result<f64> {
        Ok(self.f64s(1)?[0])
    }

    /// `count` numbers.
    pub fn f64s(&mut self, count: usize) -> Result<Vec<f64>> {
        let bytes = self.bytes(8 * count as u64)?;
        let (words, _) = bytes.as_chunks();
        Ok(words.iter().map(|w| f64::from_le_bytes(*w)).collect())
    }

    /// `count` numbers in single precision.
    pub fn f32s(&mut self, count: usize) -> Result<Vec<f32>> {
        let bytes = self.bytes(4 * count as u64)?;
        let (words, _) = bytes.as_chunks();
        Ok(words.iter().map(|w| f32::from_le_bytes(*w)).collect())
    }

    /// The next bytes.
    pub fn bytes(&mut self, count: u64) -> Result<Vec<u8>> {
        self.require(count)?;
        let mut bytes = vec![0; count as usize];
        let read = self.source.read_at(self.offset, &mut bytes);
        let read = read.map_err(|source| OfficialError::Read {
            offset: self.offset,
            source,
        })?;
        // A file that shrinks while it is read.
        if read < bytes.len() {
            return Err(self.truncated(count));
        }
        self.offset += count;
        Ok(bytes)
    }

    fn i32(&mut self) -> Result<i32> {
        let bytes = self.bytes(4)?;
        Ok(i32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
    }

    fn require(&self, count: u64) -> Result<()> {
        match count <= self.rest() {
            true => Ok(()),
            false => Err(self.truncated(count)),
        }
    }

    fn truncated(&self, count: u64) -> OfficialError {
        OfficialError::Truncated {
            section: self.section,
            needed: self.offset.saturating_add(count),
            length: self.length,
        }
    }
}

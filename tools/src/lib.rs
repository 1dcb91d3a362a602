//! What the measuring tools share: the same questions to everybody, the peers that answer them, and the book that
//! tells.

pub mod book;
pub mod evidence;
pub mod figures;
pub mod http_file;
pub mod paper;
pub mod peers;
pub mod random;
pub mod texture;

/// Wavelengths of the embedded model: bytes 40 and 41 of a file.
pub const WAVELENGTHS: usize =
    u16::from_le_bytes([welkin::DEFAULT_MODEL[40], welkin::DEFAULT_MODEL[41]]) as usize;

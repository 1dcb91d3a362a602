//! What the measuring tools share: the same questions to everybody, the peers that answer them, and the book that
//! tells.

pub mod book;
pub mod figures;
pub mod http_file;
pub mod paper;
pub mod random;
pub mod texture;

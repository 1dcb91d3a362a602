//! What the measuring tools share: the same questions to everybody, and the peers that answer them.

pub mod http_file;
pub mod paper;
pub mod random;
pub mod texture;

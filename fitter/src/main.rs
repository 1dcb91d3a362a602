//! `welkin-fit`: traces atmospheres and fits welkin model files.
fn main() {}

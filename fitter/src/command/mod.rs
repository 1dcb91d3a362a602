//! The subcommands of `welkin-fit`.

pub mod bench;
pub mod trace;
pub mod validate;

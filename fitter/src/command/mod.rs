//! The subcommands of `welkin-fit`.

pub mod trace;
pub mod validate;

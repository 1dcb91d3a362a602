//! The subcommands of `welkin-fit`.

pub mod assess;
pub mod bench;
pub mod build;
pub mod judge;
pub mod trace;
pub mod validate;

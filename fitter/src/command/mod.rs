//! The subcommands of `welkin-fit`.

pub mod assess;
pub mod build;

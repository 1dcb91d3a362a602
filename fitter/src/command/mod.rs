//! The subcommands of `welkin-fit`.

pub mod build;

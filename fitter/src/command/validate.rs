//! `welkin-fit validate`: the tracer against outside references.

use anyhow::Result;
use clap::Args as ClapArgs;

/// Arguments of `validate`.
#[derive(ClapArgs)]
pub struct Args {}

/// Runs the command.
pub fn run(_: &Args) -> Result<()> {
    Ok(())
}

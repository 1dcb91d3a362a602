//! `welkin-fit`: traces atmospheres and fits welkin model files.

mod command;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

#[derive(Parser)]
#[command(name = "welkin-fit", version, about)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Compute the radiance of lines of sight through an atmosphere.
    Trace(command::trace::Args),
    /// Measure how fast the tracer is.
    TraceBench(command::bench::Args),
    /// Compare the tracer with outside references.
    Validate(command::validate::Args),
}

fn main() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Trace(args) => command::trace::run(&args),
        Command::TraceBench(args) => command::bench::run(&args),
        Command::Validate(args) => command::validate::run(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}

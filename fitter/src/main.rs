//! `welkin-fit`: traces atmospheres and fits welkin model files.

#![forbid(unsafe_code)]

mod command;
mod said;

use clap::{Arg, CommandFactory, FromArgMatches, Parser, Subcommand};
use std::process::ExitCode;

#[derive(Parser)]
#[command(name = "welkin-fit", version, about)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Trace the atmospheres of a grid and fit a model file to them.
    Build(command::build::Args),
    /// Make a model file from a recipe of the air.
    Make(command::make::Args),
    /// Compare a model file with freshly traced radiance between its nodes.
    Assess(command::assess::Args),
    /// Chart ways to represent a sky: bytes and time against held-out error.
    Chart(command::chart::Args),
    /// Compare methods for the light of finite segments with exact integrals.
    Finite(command::finite::Args),
    /// Compare traced data with the unbiased tracer.
    CrossCheck(command::cross_check::Args),
    /// Learn what lies between the wavelength nodes, and judge a model there.
    Spectrum(command::spectrum::Args),
    /// List, do and describe the work units of a model, on one machine or many.
    Units(command::units::Args),
    /// Compute the radiance of lines of sight through an atmosphere.
    Trace(command::trace::Args),
    /// Write the real atmosphere as the JSON that `trace` reads.
    Atmosphere(command::atmosphere::Args),
    /// Turn a welkin file into one of another model.
    Export(command::export::Args),
    /// Turn a file of another model into a welkin file.
    Import(command::import::Args),
    /// Compare the model with skies that were measured.
    Measure(command::measure::Args),
    /// Look into files of the official model of Wilkie et al. 2021, or evaluate them exactly.
    Official(command::official::Args),
    /// Path-trace a picture of sky, ground and simple things on it.
    Picture(command::picture::Args),
    /// Compare models with the tracer about the sun, with full scattering matrices.
    Aureole(command::aureole::Args),
    /// Say how well a few Henyey-Greenstein functions make the phase functions of a recipe's particles.
    Lobes(command::lobes::Args),
    /// Measure how fast the tracer is.
    TraceBench(command::bench::Args),
    /// Compare the tracer with outside references.
    Validate(command::validate::Args),
}

/// Every option takes negative numbers: what they mean is for the command to say.
fn parse() -> Cli {
    let takes_numbers = |argument: Arg| match argument.get_value_delimiter() {
        Some(_) => argument.allow_hyphen_values(true),
        None if argument.get_action().takes_values() => argument.allow_negative_numbers(true),
        None => argument,
    };
    let command = Cli::command().mut_subcommands(|command| {
        let command = command.mut_args(takes_numbers);
        command.mut_subcommands(|command| command.mut_args(takes_numbers))
    });
    Cli::from_arg_matches(&command.get_matches()).unwrap_or_else(|error| error.exit())
}

fn main() -> ExitCode {
    #[cfg(unix)]
    // Without, the next write cleans up.
    let _ = welkin::output::abandon_on_signals();
    let result = match parse().command {
        Command::Build(args) => command::build::run(&args),
        Command::Make(args) => command::make::run(&args),
        Command::Assess(args) => command::assess::run(&args),
        Command::Chart(args) => command::chart::run(&args),
        Command::Finite(args) => command::finite::run(&args),
        Command::CrossCheck(args) => command::cross_check::run(&args),
        Command::Spectrum(args) => command::spectrum::run(&args),
        Command::Units(args) => command::units::run(&args),
        Command::Trace(args) => command::trace::run(&args),
        Command::Atmosphere(args) => command::atmosphere::run(&args),
        Command::Export(args) => command::export::run(&args),
        Command::Import(args) => command::import::run(&args),
        Command::Measure(args) => command::measure::run(&args),
        Command::Official(args) => command::official::run(&args),
        Command::Picture(args) => command::picture::run(&args),
        Command::Aureole(args) => command::aureole::run(&args),
        Command::Lobes(args) => command::lobes::run(&args),
        Command::TraceBench(args) => command::bench::run(&args),
        Command::Validate(args) => command::validate::run(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        // Whoever read the output has gone.
        Err(error) if is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {}", welkin::output::printable(&said::said(&error)));
            ExitCode::from(2)
        }
    }
}

fn is_broken_pipe(error: &anyhow::Error) -> bool {
    let cause = error.root_cause().downcast_ref::<std::io::Error>();
    cause.is_some_and(|cause| cause.kind() == std::io::ErrorKind::BrokenPipe)
}

//! The `welkin` command: renders, queries and describes clear-sky models.

#![forbid(unsafe_code)]

mod about;
mod albedo;
mod almanac;
mod animate;
mod camera;
mod cells;
mod difference;
mod disc;
mod edges;
mod encoding;
mod export;
mod exposure;
mod failure;
mod folder;
mod froxels;
mod ground;
mod header;
mod image;
mod info;
mod irradiance;
mod landscape;
mod light;
mod manual;
mod moonlight;
mod naming;
mod octahedral;
mod outputs;
mod parallel;
mod parameter;
mod picture;
mod plan;
mod polarised;
mod position;
mod projection;
mod query;
mod render;
mod scene;
mod sensor;
mod sheet;
mod space;
mod span;
mod subset;
mod sun;
mod terrain;
mod tone;
mod turbidity;
mod verify;
mod view;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{Arg, CommandFactory, FromArgMatches, Parser, Subcommand};
use failure::{Failure, Result};
use welkin::Model;
use welkin::output::printable;

/// Clear-sky radiance from a compact model.
#[derive(Parser)]
#[command(name = "welkin", version)]
struct Arguments {
    /// Read model files into memory instead of mapping them. A mapped file that somebody truncates meanwhile ends the
    /// command with SIGBUS, and one that somebody changes can give wrong numbers; files that are replaced by renaming,
    /// as this command does, are safe either way. Costs time and memory for the whole file.
    #[arg(long, global = true)]
    no_map: bool,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Render a sky to EXR and PNG.
    Render(render::Options),
    /// Render a frame at every step of the sun's course, for a time-lapse.
    Animate(animate::Options),
    /// Render skies from all over the model into one PNG.
    ContactSheet(sheet::Options),
    /// Write the sky and the sun as lights for a renderer: an environment map and a scene that refers to it.
    Export(export::Options),
    /// Write aerial perspective as a camera-aligned volume for real-time engines.
    Froxels(froxels::Options),
    /// Say what sun and sky give a level plane, and how bright the sun's disc is: lights to go with an environment map.
    Light(light::Options),
    /// Answer the rows of a CSV table with values.
    Query(query::Options),
    /// Describe a model file.
    Info(info::Options),
    /// Say what a scene needs of a model: bytes and errors.
    Plan(plan::Options),
    /// Write a smaller file for a part of the conditions.
    Subset(subset::Options),
    /// Check a model file against the format specification: exit code 1 if it breaks a rule.
    Verify(verify::Options),
    /// Write completions for a shell to standard output: welkin completions bash > /etc/bash_completion.d/welkin.
    Completions(manual::Completions),
    /// Write man pages, one for the command and one for each subcommand, into a folder.
    Man(manual::Man),
}

/// Which model a command works on.
#[derive(clap::Args)]
struct Source {
    /// Model file; the embedded default model if absent.
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
    #[arg(from_global)]
    no_map: bool,
}

impl Source {
    fn open(&self) -> Result<Model> {
        match &self.model {
            Some(path) => {
                let open = if self.no_map {
                    Model::read
                } else {
                    Model::open
                };
                open(path).map_err(|error| Failure::in_file(path, error))
            }
            None => Ok(Model::default_model()?),
        }
    }

    /// The file as a whole.
    fn bytes(&self) -> Result<Vec<u8>> {
        match &self.model {
            Some(path) => {
                let unreadable = |e| Failure::message(format!("{}: {e}", path.display()));
                std::fs::read(path).map_err(unreadable)
            }
            None => Ok(welkin::DEFAULT_MODEL.to_vec()),
        }
    }

    fn name(&self) -> String {
        match &self.model {
            Some(path) => printable(&path.display().to_string()),
            None => "embedded default model".to_owned(),
        }
    }
}

fn main() -> ExitCode {
    #[cfg(unix)]
    // Without, the next write cleans up.
    let _ = welkin::output::abandon_on_signals();
    let arguments = match parse() {
        Ok(arguments) => arguments,
        Err(error) => return refuse_arguments(&error),
    };
    let outcome = match &arguments.command {
        Command::Render(options) => render::run(options).map(done),
        Command::Animate(options) => animate::run(options).map(done),
        Command::ContactSheet(options) => sheet::run(options).map(done),
        Command::Export(options) => export::run(options).map(done),
        Command::Froxels(options) => froxels::run(options).map(done),
        Command::Light(options) => light::run(options).map(done),
        Command::Query(options) => query::run(options).map(done),
        Command::Info(options) => info::run(options).map(done),
        Command::Plan(options) => plan::run(options).map(done),
        Command::Subset(options) => subset::run(options).map(done),
        Command::Verify(options) => verify::run(options),
        Command::Completions(options) => manual::complete(options, command()).map(done),
        Command::Man(options) => manual::write(options, command()).map(done),
    };
    match outcome {
        Ok(code) => code,
        // Whoever closed the pipe has seen enough.
        Err(Failure::BrokenPipe) => ExitCode::SUCCESS,
        Err(Failure::Message(message)) => complain(&message),
    }
}

/// Every option takes negative numbers: what they mean is for the command to say.
fn command() -> clap::Command {
    let takes_numbers = |argument: Arg| match argument.get_action().takes_values() {
        true => argument.allow_negative_numbers(true),
        false => argument,
    };
    Arguments::command().mut_subcommands(|command| command.mut_args(takes_numbers))
}

fn parse() -> std::result::Result<Arguments, clap::Error> {
    Arguments::from_arg_matches(&command().try_get_matches()?)
}

fn done((): ()) -> ExitCode {
    ExitCode::SUCCESS
}

/// Help goes out as clap writes it; errors become one line.
fn refuse_arguments(error: &clap::Error) -> ExitCode {
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
            // A closed pipe is no failure here either.
            let _ = error.print();
            ExitCode::SUCCESS
        }
        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            complain("a command is missing, such as render or query: see welkin --help")
        }
        _ => {
            let text = error.render().to_string();
            let about = |line: &&str| !line.trim().is_empty();
            let first: Vec<&str> = text.lines().take_while(about).map(str::trim).collect();
            complain(first.join(" ").trim_start_matches("error: "))
        }
    }
}

fn complain(message: &str) -> ExitCode {
    use std::io::Write;
    let line = printable(&message.replace(['\n', '\r'], " "));
    // Nobody is left to tell when standard error is closed.
    let _ = writeln!(std::io::stderr(), "welkin: {line}");
    ExitCode::from(2)
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    /// Clap refuses others, but only in builds with debug assertions.
    #[test]
    fn groups_of_a_command_have_names_of_their_own() {
        for command in super::command().get_subcommands() {
            let mut names = HashSet::new();
            for group in command.get_groups() {
                let name = group.get_id();
                assert!(names.insert(name), "{}: {name} twice", command.get_name());
            }
        }
    }
}

//! `welkin completions` and `welkin man`: what shells and people want to know of the command.

use std::io::Write;
use std::path::PathBuf;

use clap::Command;
use clap_complete::Shell;
use clap_mangen::Man as Page;
use welkin::output;

use crate::failure::Result;
use crate::folder;

#[derive(clap::Args)]
pub struct Completions {
    /// The shell.
    #[arg(value_enum)]
    shell: Shell,
}

#[derive(clap::Args)]
pub struct Man {
    /// The folder; it is made if it is not there.
    #[arg(long, default_value = ".", value_name = "DIR")]
    out: PathBuf,
}

pub fn complete(options: &Completions, mut command: Command) -> Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(options.shell, &mut command, "welkin", &mut script);
    Ok(std::io::stdout().lock().write_all(&script)?)
}

pub fn write(options: &Man, mut command: Command) -> Result<()> {
    folder::make(&options.out)?;
    command.build();
    let subcommands = command.get_subcommands().cloned();
    let pages: Vec<_> = [command.clone()]
        .into_iter()
        .chain(subcommands.filter(|command| command.get_name() != "help"))
        .map(|command| page(&command))
        .collect::<Result<_>>()?;
    let files = pages
        .iter()
        .map(|(name, text)| (options.out.join(name), text.as_slice()));
    let files: Vec<_> = files.collect();
    let files: Vec<_> = files
        .iter()
        .map(|(path, text)| (path.as_path(), *text))
        .collect();
    output::replace_files(&files)?;
    let mut out = std::io::stdout().lock();
    for (path, _) in files {
        writeln!(out, "wrote {}", path.display())?;
    }
    Ok(())
}

/// The name of a page and its text.
fn page(command: &Command) -> Result<(String, Vec<u8>)> {
    let mut text = Vec::new();
    let name = command
        .get_display_name()
        .unwrap_or_else(|| command.get_name());
    let page = Page::new(command.clone()).title(name);
    page.render(&mut text)?;
    Ok((format!("{name}.1"), text))
}

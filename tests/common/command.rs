//! The command `welkin`, run as its users run it.

use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// The quantities that `query` answers.
pub const QUANTITIES: [&str; 8] = [
    "radiance",
    "relative_radiance",
    "polarisation",
    "stokes_q",
    "stokes_u",
    "transmittance",
    "in_scattering",
    "sun_radiance",
];

/// The command in a folder.
pub fn welkin(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_welkin"));
    command.args(arguments).current_dir(folder);
    command
}

/// Runs it to its end with this on its standard input.
pub fn run(folder: &Path, arguments: &[&str], input: impl AsRef<[u8]>) -> Output {
    let mut child = welkin(folder, arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let (mut pipe, input) = (child.stdin.take().unwrap(), input.as_ref().to_vec());
    // While it answers; it may stop before it has read all.
    let writing = std::thread::spawn(move || pipe.write_all(&input));
    let output = child.wait_with_output().unwrap();
    let _ = writing.join().unwrap();
    output
}

/// Runs a command line, whose words have no spaces.
pub fn call(folder: &Path, line: &str) -> Output {
    run(folder, &line.split_whitespace().collect::<Vec<_>>(), "")
}

/// A pipe with a name.
pub fn fifo(path: &Path) {
    let made = Command::new("mkfifo").arg(path).status().unwrap();
    assert!(made.success());
}

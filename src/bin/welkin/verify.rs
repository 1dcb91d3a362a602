//! `welkin verify`.

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use serde_json::{Value, json};
use welkin::format::{Problem, parse, verify};
use welkin::output::{printable, printable_json};

use crate::failure::{Failure, Result};

/// Exit code of a file that breaks the specification; 2 is for files that cannot be read.
const NOT_CONFORMING: u8 = 1;

#[derive(clap::Args)]
pub struct Options {
    /// Model file.
    file: PathBuf,
    /// Write JSON.
    #[arg(long)]
    json: bool,
}

pub fn run(options: &Options) -> Result<ExitCode> {
    let unreadable = |e| Failure::message(format!("{}: {e}", options.file.display()));
    // A copy: a file that changes meanwhile cannot make the verdict wrong.
    let bytes = std::fs::read(&options.file).map_err(unreadable)?;
    let mut problems: Vec<Value> = verify(&bytes).iter().map(problem).collect();
    problems.extend(metadata_problem(&bytes));
    let report = json!({
        "file": options.file.display().to_string(),
        "bytes": bytes.len(),
        "chunks": parse(&bytes).map_or(0, |contents| contents.directory.len()),
        "conforming": problems.is_empty(),
        "problems": problems,
    });
    let mut out = std::io::stdout().lock();
    if options.json {
        writeln!(out, "{}", printable_json(&format!("{report:#}")))?;
    } else {
        write_text(&mut out, &report, &problems)?;
    }
    Ok(match problems.is_empty() {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(NOT_CONFORMING),
    })
}

fn problem(problem: &Problem) -> Value {
    json!({
        "chunk": problem.chunk,
        "class": problem.error.class(),
        "message": problem.error.to_string(),
    })
}

/// The library does not read metadata, so that it needs no JSON.
fn metadata_problem(bytes: &[u8]) -> Option<Value> {
    let metadata = parse(bytes).ok()?.head.metadata;
    let message = match serde_json::from_str::<Value>(&metadata) {
        Ok(Value::Object(_)) => return None,
        Ok(_) => "metadata: expected a JSON object".to_owned(),
        Err(error) => format!("metadata: expected a JSON object: {error}"),
    };
    Some(json!({ "chunk": null, "class": "value", "message": message }))
}

fn write_text(out: &mut impl Write, report: &Value, problems: &[Value]) -> Result<()> {
    for problem in problems {
        let place = match &problem["chunk"] {
            Value::Null => "head".to_owned(),
            index => format!("chunk {index}"),
        };
        let text = |key: &str| printable(problem[key].as_str().unwrap_or_default());
        writeln!(out, "{place}: {}: {}", text("class"), text("message"))?;
    }
    let verdict = match problems.len() {
        0 => "conforms to the format specification".to_owned(),
        n => format!("breaks the format specification in {n} places"),
    };
    let (bytes, chunks) = (&report["bytes"], &report["chunks"]);
    let file = printable(report["file"].as_str().unwrap_or_default());
    writeln!(out, "{file}: {bytes} bytes, {chunks} chunks: {verdict}")?;
    Ok(())
}

//! `welkin query`: a CSV table in, the same table with values out.

mod answer;
mod band_answer;
mod block;
mod bounded;
mod columns;
mod kept;
mod progress;
mod quantity;
pub mod shared;

use std::fmt;
use std::fs::File;
use std::io::{self, Read, Write};
use std::path::PathBuf;
use std::sync::Mutex;

use csv::ByteRecord;

use crate::Source;
use crate::albedo::Ground;
use crate::failure::{Failure, Result};
use crate::parameter;
use crate::sensor::{self, Sensor};
use block::Block;
use bounded::Bounded;
use columns::Columns;
use progress::Progress;
use shared::Shared;

#[derive(clap::Args)]
pub struct Options {
    #[command(flatten)]
    source: Source,
    #[command(flatten)]
    sensor: sensor::Options,
    /// Fail (exit code 2) if a row got an error.
    #[arg(long)]
    strict: bool,
    /// Albedo of the ground in all rows, in place of the column albedo: a number; grass, snow, sand, sea or urban; by
    /// wavelength (nm) a list such as 400:0.05,690:0.06,740:0.5, or a CSV table with the columns wavelength_nm and albedo.
    /// Each row has that of its wavelength, so --bands and --wavelengths take a number only.
    #[arg(long, value_name = "SHARE|NM:SHARE,…|FILE", value_parser = Ground::parse)]
    albedo: Option<Ground>,
    /// Value in all rows, in place of the column visibility_km, of the quantity that the model's file has in place of the
    /// visibility, in its unit: welkin info tells which.
    #[arg(long, value_name = "VALUE", allow_negative_numbers = true)]
    parameter: Option<f64>,
    /// Move conditions that the model does not reach to its nearest.
    #[arg(long)]
    clamp: bool,
    /// Threads that answer rows; all cores if absent. Answers do not depend on it.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Table with a header; standard input if absent or "-".
    file: Option<PathBuf>,
}

pub fn run(options: &Options) -> Result<()> {
    if options.sensor.is_wanted() && matches!(options.albedo, Some(Ground::ByWavelength(_))) {
        let text = "a row has the albedo of its wavelength_nm: --bands and --wavelengths take a number as --albedo";
        return Err(Failure::message(text));
    }
    let model = options.source.open()?;
    let input = input(options)?;
    let threads = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads.map_or(0, usize::from))
        .build()
        .map_err(|error| Failure::message(format!("cannot start threads: {error}")))?;
    let sensor = options.sensor.sensor(&model)?;
    let output = io::stdout().lock();
    let visibility = options.parameter;
    let visibility = visibility.map(|value| parameter::visibility(&model, value, options.clamp));
    let shared = Shared::new(&model, options.clamp, sensor.map(|s| s.bands.clone()))
        .over(options.albedo.as_ref())
        .in_air(visibility.transpose()?);
    let summary = answer(&shared, sensor, &threads, input, output)?;
    if summary.moved {
        // Nobody is left to tell when standard error is closed.
        let text =
            "welkin: rows whose conditions the model does not reach were moved to its nearest";
        let _ = writeln!(io::stderr(), "{text}");
    }
    let Summary { rows, failures, .. } = summary;
    if options.strict && failures > 0 {
        let text = format!("{failures} of {rows} rows failed (see their column \"error\")");
        return Err(Failure::message(text));
    }
    Ok(())
}

/// What became of a table.
pub struct Summary {
    pub rows: u64,
    /// Rows that got an error.
    pub failures: u64,
    /// Whether conditions of any row were moved.
    pub moved: bool,
}

/// Answers a table, in the bands of a sensor if there is one; returns how many rows it has and how many of them failed.
pub fn answer<'a>(
    shared: &'a Shared<'a>,
    sensor: Option<&Sensor>,
    threads: &rayon::ThreadPool,
    input: impl Read,
    output: impl io::Write,
) -> Result<Summary> {
    let names = match sensor {
        Some(sensor) => sensor.names.clone(),
        None => vec!["value".to_owned()],
    };
    answer_columns(shared, &names, threads, input, output)
}

/// Answers a table with so many columns of values.
fn answer_columns<'a>(
    shared: &'a Shared<'a>,
    names: &[String],
    threads: &rayon::ThreadPool,
    input: impl Read,
    output: impl io::Write,
) -> Result<Summary> {
    let mut reader = csv::ReaderBuilder::new()
        .flexible(true)
        .buffer_capacity(BUFFER)
        .from_reader(Bounded::new(input, block::MOST_BYTES));
    let header = reader.byte_headers().map_err(unreadable)?.clone();
    let columns = Columns::find(&header, names, shared)?;
    let mut writer = csv::WriterBuilder::new()
        .buffer_capacity(BUFFER)
        .from_writer(output);
    write_row(&mut writer, &header, header.len(), names, "error")?;
    let answerers = Mutex::new(Vec::new());
    let mut progress = Progress::new();
    let (mut rows, mut failures) = (0u64, 0u64);
    let mut block = Block::default();
    let mut texts = vec![String::new(); names.len()];
    loop {
        let read = block.read(&mut reader);
        if block.rows().is_empty() {
            read.map_err(unreadable)?;
            break;
        }
        let width = names.len();
        let answers = threads.install(|| block.answer(&columns, width, shared, &answerers));
        let values = answers.values.chunks(width).zip(&answers.errors);
        for (row, (values, error)) in block.rows().iter().zip(values) {
            for (text, value) in texts.iter_mut().zip(values) {
                text.clear();
                if error.is_ok() {
                    // Writing to a string never fails.
                    let _ = fmt::Write::write_fmt(text, format_args!("{value:?}"));
                }
            }
            failures += u64::from(error.is_err());
            let error = error.as_ref().err().map_or("", String::as_str);
            write_row(&mut writer, row, header.len(), &texts, error)?;
        }
        rows += answers.errors.len() as u64;
        progress.rows(rows);
        read.map_err(unreadable)?;
    }
    writer.flush()?;
    Ok(Summary {
        rows,
        failures,
        moved: shared.has_moved(),
    })
}

/// Bytes that are read and written at once.
const BUFFER: usize = 1 << 16;

fn input(options: &Options) -> Result<Box<dyn Read>> {
    match &options.file {
        Some(path) if path.as_os_str() != "-" => {
            let unreadable = |e: io::Error| Failure::message(format!("{}: {e}", path.display()));
            Ok(Box::new(File::open(path).map_err(unreadable)?))
        }
        _ => Ok(Box::new(io::stdin().lock())),
    }
}

fn unreadable(error: csv::Error) -> Failure {
    Failure::message(format!("cannot read the table: {error}"))
}

fn write_row(
    writer: &mut csv::Writer<impl io::Write>,
    row: &ByteRecord,
    columns: usize,
    values: &[String],
    error: &str,
) -> Result<()> {
    let cells = (0..columns).map(|i| row.get(i).unwrap_or(b"").trim_ascii());
    let values = values.iter().map(String::as_bytes);
    let written = writer.write_record(cells.chain(values).chain([error.as_bytes()]));
    written.map_err(|error| match error.into_kind() {
        csv::ErrorKind::Io(error) => Failure::from(error),
        other => Failure::message(format!("cannot write the table: {other:?}")),
    })
}

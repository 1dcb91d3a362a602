//! `welkin subset`: a smaller file for a part of the conditions.

mod cells;
mod colour;
mod nodes;
mod reduce;
mod samples;

use std::io::Write;
use std::path::PathBuf;

use serde_json::{Value, json};
use welkin::Model;
use welkin::format::{Chunk, ENCODING_RAW, ENCODING_ZSTD, Payload, encode, parse, recode, unpack};
use welkin::output::{self, Target, printable, printable_json};

use crate::Source;
use crate::failure::{Failure, Result, fixed, plain};
use reduce::{Reducer, Wish};
use samples::{Differences, Quantity, Samples, Scope};

/// Skies of the final comparison.
const SKIES: usize = 256;
/// Share of the tolerance below which a search for a model that keeps it gives up.
const LEAST_SHARE: f64 = 0.3;
/// Its skies are not those of the search.
const HELD_OUT: usize = 1_000_000;

#[derive(clap::Args)]
pub struct Options {
    #[command(flatten)]
    source: Source,
    /// Altitudes that must stay, m.
    #[arg(long, value_name = "LOW..HIGH", value_parser = range, allow_hyphen_values = true)]
    altitudes: Option<[f64; 2]>,
    /// Visibilities that must stay, km.
    #[arg(long, value_name = "LOW..HIGH", value_parser = range, allow_hyphen_values = true)]
    visibilities: Option<[f64; 2]>,
    /// Wavelengths that must stay, nm.
    #[arg(long, value_name = "LOW..HIGH", value_parser = range, conflicts_with = "rgb")]
    wavelengths: Option<[f64; 2]>,
    /// Keep as few wavelengths as colour needs.
    #[arg(long)]
    rgb: bool,
    /// Leave out what changes 99 % of all values by less than this; without it, nothing changes (with --rgb: 1 %).
    #[arg(long, value_name = "PERCENT", value_parser = percent, allow_hyphen_values = true)]
    tolerance: Option<f64>,
    /// Leave out what the file can do besides radiance.
    #[arg(long, value_name = "WHAT", value_enum, value_delimiter = ',')]
    without: Vec<Extra>,
    /// Compress the chunks.
    #[arg(long)]
    zstd: bool,
    /// The new file; - for standard output.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Write the report as JSON.
    #[arg(long)]
    json: bool,
}

/// What a file can hold besides radiance.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Extra {
    Polarisation,
    Transmittance,
    AerialPerspective,
}

impl Extra {
    /// What needs a chunk, if it is not radiance. Aerial perspective needs the transmittance too.
    fn of(payload: &Payload) -> Option<Self> {
        match payload {
            Payload::Polarisation(_) | Payload::PolarisationBasis(_) => Some(Self::Polarisation),
            Payload::Transmittance(_) => Some(Self::Transmittance),
            Payload::Source(_) | Payload::SourceBasis(_) => Some(Self::AerialPerspective),
            _ => None,
        }
    }
}

pub fn run(options: &Options) -> Result<()> {
    let target = Target::new(&options.out);
    target.check()?;
    let bytes = options.source.bytes()?;
    let name = options.source.name();
    let in_source = |error: welkin::Error| Failure::message(format!("{name}: {error}"));
    let model = Model::from_bytes(bytes.clone()).map_err(in_source)?;
    let scope = scope(options, &model)?;
    let (head, mut chunks) = unpack(&bytes).map_err(in_source)?;
    chunks.retain(|chunk| {
        Extra::of(&chunk.payload).is_none_or(|extra| !options.without.contains(&extra))
    });
    let quantity = match options.rgb {
        true => Quantity::Colour,
        false => Quantity::Spectrum,
    };
    let samples = Samples::new(&model, &scope, SKIES, HELD_OUT);
    let mut reducer = Reducer::new(&model, (head, chunks), wish(options, scope))?;
    let (mut head, chunks, differences) = loop {
        let (head, chunks, kept) = reducer.reduce()?;
        let smaller = Model::from_bytes(encode(&head, &chunks)?)?;
        let all: Vec<usize> = (0..kept.len()).collect();
        let differences = Differences::between(
            &samples.values(&smaller, quantity, &all)?,
            &samples.values(&model, quantity, &kept)?,
        );
        let promise = reducer.promise();
        if differences.quantile(0.99) <= promise || !reducer.strive(LEAST_SHARE) {
            break (head, chunks, differences);
        }
    };
    let mut report = report(&scope, quantity, &differences);
    report["error_against_data"] = promise(&chunks, &differences);
    head.metadata = with_report(&head.metadata, &report);
    let encoding = match options.zstd {
        true => ENCODING_ZSTD,
        false => ENCODING_RAW,
    };
    let file = recode(&encode(&head, &chunks)?, encoding)?;
    output::write(&[(&target, &file)])?;

    report["file"] = json!(options.out.display().to_string());
    report["bytes"] = json!(file.len());
    report["source_bytes"] = json!(bytes.len());
    report["chunks"] = json!(parse(&file)?.directory.len());
    report["altitudes_m"] = json!(head.altitudes);
    report["visibilities_km"] = json!(kilometres(&head.visibilities));
    report["wavelengths_nm"] = json!(head.wavelengths);
    print(&report, options.json, target.report())
}

fn wish(options: &Options, scope: Scope) -> Wish {
    Wish {
        scope,
        wavelengths: options.wavelengths,
        rgb: options.rgb,
        tolerance: options.tolerance,
    }
}

fn scope(options: &Options, model: &Model) -> Result<Scope> {
    let visibilities = options.visibilities.map(|range| range.map(|v| v * 1e3));
    Ok(Scope {
        altitudes: within(
            "altitudes",
            options.altitudes,
            model.altitude_range(),
            "m",
            1.0,
        )?,
        visibilities: within(
            "visibilities",
            visibilities,
            model.visibility_range(),
            "km",
            1e-3,
        )?,
    })
}

/// The wished range, which the model must have.
fn within(
    what: &str,
    wish: Option<[f64; 2]>,
    model: [f64; 2],
    unit: &str,
    factor: f64,
) -> Result<[f64; 2]> {
    let [low, high] = wish.unwrap_or(model);
    if model[0] <= low && high <= model[1] {
        return Ok([low, high]);
    }
    let is_reversed = low > high;
    let [low, high, first, last] = [low, high, model[0], model[1]].map(|v| plain(v * factor));
    if is_reversed {
        return Err(Failure::message(format!(
            "{what} {low}..{high} are in the wrong order: the lower end comes first, {high}..{low}"
        )));
    }
    Err(Failure::message(format!(
        "{what} must be in {first}..{last} {unit}, got {low}..{high}"
    )))
}

fn report(scope: &Scope, quantity: Quantity, differences: &Differences) -> Value {
    let what = match quantity {
        Quantity::Colour => "CIE XYZ",
        Quantity::Spectrum => "spectral radiance",
    };
    json!({
        "for_altitudes_m": scope.altitudes,
        "for_visibilities_km": kilometres(&scope.visibilities),
        "difference_to_source": {
            "of": what,
            "count": differences.count(),
            "median": differences.quantile(0.5),
            "p95": differences.quantile(0.95),
            "p99": differences.quantile(0.99),
            "max": differences.quantile(1.0),
        },
    })
}

/// What the new file promises: the errors of its worst chunk, which are those of the source since chunks do not change,
/// plus the difference to the source, which is all that fewer nodes and wavelengths add. Null if the source does not
/// know its errors.
fn promise(chunks: &[Chunk], differences: &Differences) -> Value {
    let radiance = chunks
        .iter()
        .filter(|chunk| matches!(chunk.payload, Payload::Radiance(_)));
    let worst = |error: fn(&Chunk) -> f32| {
        let errors = radiance.clone().map(error);
        let worst = errors.reduce(|a, b| if a > 0.0 && b > 0.0 { a.max(b) } else { 0.0 });
        worst.map(|error| (f64::from(error) * 1e9).round() / 1e9)
    };
    let sum = |error: fn(&Chunk) -> f32, quantile: f64| {
        let known = worst(error).filter(|&error| error > 0.0);
        known.map(|error| error + differences.quantile(quantile))
    };
    json!({
        "median": sum(|chunk| chunk.error_median, 0.5),
        "p99": sum(|chunk| chunk.error_p99, 0.99),
        "worst_chunk_median": worst(|chunk| chunk.error_median),
        "worst_chunk_p99": worst(|chunk| chunk.error_p99),
    })
}

/// The provenance of the source with what happened to it since.
fn with_report(metadata: &str, report: &Value) -> String {
    let mut metadata: Value = serde_json::from_str(metadata).unwrap_or_else(|_| json!({}));
    match metadata.as_object_mut() {
        Some(object) => object.insert("subset".to_owned(), report.clone()),
        None => return json!({ "subset": report }).to_string(),
    };
    metadata.to_string()
}

fn kilometres(metres: &[f64]) -> Vec<f64> {
    let rounded = |m: &f64| (m * 1e6).round() / 1e9;
    metres.iter().map(rounded).collect()
}

fn print(report: &Value, json: bool, mut out: impl Write) -> Result<()> {
    if json {
        writeln!(out, "{}", printable_json(&format!("{report:#}")))?;
        return Ok(());
    }
    let size = |key: &str| report[key].as_u64().unwrap_or_default();
    let share = 100.0 * size("bytes") as f64 / size("source_bytes") as f64;
    let file = printable(report["file"].as_str().unwrap_or_default());
    writeln!(
        out,
        "{file}: {} bytes, {share:.1} % of the source",
        size("bytes")
    )?;
    for (name, key) in [
        ("altitudes, m", "altitudes_m"),
        ("visibilities, km", "visibilities_km"),
        ("wavelengths, nm", "wavelengths_nm"),
    ] {
        writeln!(out, "{name:18} {}", report[key])?;
    }
    let difference = &report["difference_to_source"];
    let percent = |key: &str| fixed(100.0 * difference[key].as_f64().unwrap_or_default(), 3);
    writeln!(
        out,
        "difference of {} to the source over {} values: median {} %, p95 {} %, p99 {} %, max {} %",
        difference["of"].as_str().unwrap_or_default(),
        difference["count"],
        percent("median"),
        percent("p95"),
        percent("p99"),
        percent("max"),
    )?;
    let promise = |key: &str| report["error_against_data"][key].as_f64();
    if let (Some(median), Some(p99)) = (promise("median"), promise("p99")) {
        let [median, p99] = [median, p99].map(|error| fixed(100.0 * error, 3));
        writeln!(
            out,
            "error against the data of the source, at most: median {median} %, p99 {p99} % (its worst chunk plus the difference)"
        )?;
    }
    Ok(())
}

pub fn range(text: &str) -> std::result::Result<[f64; 2], String> {
    let (low, high) = text.split_once("..").unwrap_or((text, text));
    let number = |part: &str| {
        part.trim()
            .parse::<f64>()
            .map_err(|_| format!("\"{part}\" is no number"))
    };
    match [number(low)?, number(high)?] {
        [low, high] if low <= high => Ok([low, high]),
        _ => Err("expected LOW..HIGH with LOW not above HIGH".to_owned()),
    }
}

pub fn percent(text: &str) -> std::result::Result<f64, String> {
    let number = text.trim_end_matches('%').trim().parse::<f64>();
    match number {
        Ok(value) if value > 0.0 && value <= 100.0 => Ok(value / 100.0),
        _ => Err("expected a percentage above 0 and up to 100".to_owned()),
    }
}

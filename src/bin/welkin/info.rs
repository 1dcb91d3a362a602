//! `welkin info`.

use std::io::Write;
use std::path::PathBuf;

use serde_json::{Value, json};
use welkin::Model;
use welkin::format::{Entry, Kind, VERSION_MAJOR};
use welkin::output::printable_json;

use crate::Source;
use crate::failure::{Result, fixed, plain};

#[derive(clap::Args)]
pub struct Options {
    #[command(flatten)]
    source: Source,
    /// Model file, instead of --model.
    #[arg(value_name = "FILE", conflicts_with = "model")]
    file: Option<PathBuf>,
    /// Write JSON.
    #[arg(long)]
    json: bool,
}

pub fn run(options: &Options) -> Result<()> {
    let source = Source {
        model: options
            .file
            .clone()
            .or_else(|| options.source.model.clone()),
        no_map: options.source.no_map,
    };
    let model = source.open()?;
    let description = describe(&model);
    let mut out = std::io::stdout().lock();
    if options.json {
        writeln!(out, "{}", printable_json(&format!("{description:#}")))?;
        return Ok(());
    }
    writeln!(out, "{}", source.name())?;
    let Value::Object(entries) = &description else {
        return Ok(());
    };
    for (key, value) in entries.iter().filter(|(key, _)| *key != "chunks") {
        writeln!(out, "{key:24} {}", printable_json(&value.to_string()))?;
    }
    chunk_table(&mut out, &model)
}

fn describe(model: &Model) -> Value {
    let head = model.head();
    let metadata: Value = serde_json::from_str(&head.metadata).unwrap_or(Value::Null);
    let chunks: Vec<Value> = model.directory().iter().map(|e| chunk(model, e)).collect();
    let mut description = json!({
        "format_version": VERSION_MAJOR,
        "file_bytes": model.file_bytes(),
        "head_bytes": model.head_bytes(),
        "chunk_count": chunks.len(),
        "wavelengths_nm": head.wavelengths,
        "wavelength_range_nm": model.wavelength_range().ok(),
        "altitudes_m": head.altitudes,
        "visibilities_km": head.visibilities.iter().map(|v| v / 1e3).collect::<Vec<_>>(),
        "solar_elevation_deg": model.solar_elevation_range().map(|e| rounded(e.to_degrees())),
        "albedo": [0, 1],
        "planet_radius_m": head.planet.radius,
        "top_altitude_m": head.planet.top,
        "constituents": head.constituents,
        "fields": head.fields.iter().map(|f| format!("{:?}{}", f.phase, if f.ground { " (ground)" } else { "" })).collect::<Vec<_>>(),
        "intervals": {
            "up": head.up.intervals,
            "down": head.down.intervals,
            "phi": head.phi_intervals,
            "elevation": head.elevation.intervals,
        },
        "worst_error_median": worst(model, Kind::Radiance, |e| e.error_median),
        "worst_error_p99": worst(model, Kind::Radiance, |e| e.error_p99),
        "worst_polarisation_error_median": worst(model, Kind::Polarisation, |e| e.error_median),
        "worst_polarisation_error_p99": worst(model, Kind::Polarisation, |e| e.error_p99),
        "metadata": metadata,
        "chunks": chunks,
    });
    // A damaged one is welkin verify's business.
    if let Ok(Some(axis)) = model.axis() {
        description["axis"] = json!({
            "name": axis.name(),
            "unit": axis.unit(),
            "values": axis.values(),
        });
    }
    description
}

fn rounded(value: f64) -> f64 {
    (value * 1e9).round() / 1e9
}

fn worst(model: &Model, kind: Kind, error: impl Fn(&Entry) -> f32) -> f64 {
    let entries = model.directory().iter().filter(|e| e.kind == kind);
    rounded(f64::from(entries.map(error).fold(0.0, f32::max)))
}

fn chunk(model: &Model, entry: &Entry) -> Value {
    let head = model.head();
    // Of other kinds nothing else is known.
    if let Kind::Unknown(_) = entry.kind {
        return json!({
            "kind": entry.kind.name(),
            "offset": entry.offset,
            "bytes": entry.length,
        });
    }
    json!({
        "kind": entry.kind.name(),
        "altitude_m": entry.altitude.and_then(|i| head.altitudes.get(i)),
        "visibility_km": entry.visibility.and_then(|i| head.visibilities.get(i)).map(|v| v / 1e3),
        "offset": entry.offset,
        "bytes": entry.length,
        "encoding": entry.encoding,
        "rank": entry.rank,
        "error_median": rounded(entry.error_median.into()),
        "error_p99": rounded(entry.error_p99.into()),
    })
}

fn chunk_table(out: &mut impl Write, model: &Model) -> Result<()> {
    writeln!(
        out,
        "\n{:10} {:>10} {:>13} {:>9} {:>5} {:>12} {:>9}",
        "chunk", "altitude m", "visibility km", "bytes", "rank", "error median", "error p99"
    )?;
    let head = model.head();
    let node = |axis: &[f64], i: Option<usize>, scale: f64| {
        let value = i.and_then(|i| axis.get(i));
        value.map_or("-".to_owned(), |v| plain(v * scale))
    };
    for entry in model.directory() {
        if let Kind::Unknown(_) = entry.kind {
            let [kind, bytes] = [entry.kind.name().to_owned(), entry.length.to_string()];
            writeln!(
                out,
                "{kind:10} {0:>10} {0:>13} {bytes:>9} {0:>5} {0:>12} {0:>9}",
                "-"
            )?;
            continue;
        }
        writeln!(
            out,
            "{:10} {:>10} {:>13} {:>9} {:>5} {:>12} {:>9}",
            entry.kind.name(),
            node(&head.altitudes, entry.altitude, 1.0),
            node(&head.visibilities, entry.visibility, 1e-3),
            entry.length,
            entry.rank,
            fixed(entry.error_median.into(), 5),
            fixed(entry.error_p99.into(), 5),
        )?;
    }
    Ok(())
}

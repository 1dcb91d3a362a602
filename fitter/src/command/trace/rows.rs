//! Lines of sight from a CSV or from the atmosphere's own file.

use super::atmosphere_choice::Source;
use anyhow::{Context, Result, bail, ensure};
use std::path::Path;
use welkin_fitter::tracer::Query;

/// A query with the ground under it, as read from a file.
#[derive(Debug)]
pub struct Row {
    /// The line of sight.
    pub query: Query,
    /// Albedo of the ground.
    pub albedo: f64,
    /// The row as it stood in the file.
    pub cells: Vec<String>,
}

fn row(
    source: &Source,
    cells: Vec<String>,
    field: impl Fn(&str) -> Result<Option<f64>>,
) -> Result<Row> {
    let need = |name: &str| field(name)?.with_context(|| format!("{name} is missing"));
    let query = Query {
        altitude: need("altitude_m")?,
        view_zenith: need("view_zenith_deg")?.to_radians(),
        view_azimuth: need("view_azimuth_deg")?.to_radians(),
        sun_elevation: field("solar_elevation_deg")?
            .or(source.solar_elevation)
            .context("solar_elevation_deg is missing; give the column or --solar-elevation")?
            .to_radians(),
        distance: field("distance_m")?,
    };
    query.check(source.atmosphere.top())?;
    let albedo = field("albedo")?
        .or(source.albedo)
        .context("albedo is missing; give the column or --albedo")?;
    ensure!(
        (0.0..=1.0).contains(&albedo),
        "albedo {albedo:?} is outside 0..1"
    );
    Ok(Row {
        query,
        albedo,
        cells,
    })
}

/// Rows of a CSV file, and its header.
pub fn from_csv(path: &Path, source: &Source) -> Result<(Vec<String>, Vec<Row>)> {
    let name = path.display().to_string();
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .from_path(path)
        .with_context(|| name.clone())?;
    let header: Vec<String> = reader.headers()?.iter().map(str::to_owned).collect();
    for column in ["altitude_m", "view_zenith_deg", "view_azimuth_deg"] {
        ensure!(
            header.iter().any(|h| h == column),
            "{name}: no column {column}"
        );
    }
    let mut rows = vec![];
    for (i, record) in reader.records().enumerate() {
        let context = || format!("{name}, row {}", i + 1);
        let cells: Vec<String> = record
            .with_context(context)?
            .iter()
            .map(str::to_owned)
            .collect();
        let field = |column: &str| -> Result<Option<f64>> {
            let cell = header.iter().position(|h| h == column).map(|c| &cells[c]);
            match cell.map(|text| text.trim()) {
                None | Some("") => Ok(None),
                Some(text) => match text.parse::<f64>() {
                    Ok(value) if value.is_finite() => Ok(Some(value)),
                    _ => bail!("{column} \"{text}\" is not a number"),
                },
            }
        };
        rows.push(row(source, cells.clone(), field).with_context(context)?);
    }
    ensure!(!rows.is_empty(), "{name} has no rows");
    Ok((header, rows))
}

/// The lines of sight of the atmosphere file itself.
pub fn from_case(source: &Source) -> Result<(Vec<String>, Vec<Row>)> {
    const NAMES: [&str; 3] = ["altitude_m", "view_zenith_deg", "view_azimuth_deg"];
    let case = source
        .case
        .as_ref()
        .context("the real atmosphere has no lines of sight of its own; give --queries")?;
    ensure!(
        !case.rows.is_empty(),
        "no rows with lines of sight; give --queries"
    );
    let altitude = if case.column("obs_alt_m").is_some() {
        "obs_alt_m"
    } else {
        "altitude_m"
    };
    let rows = (0..case.rows.len()).map(|i| {
        let field = |name: &str| match name {
            "altitude_m" => case.value(i, altitude).map(Some),
            name if NAMES.contains(&name) => case.value(i, name).map(Some),
            _ => Ok(None),
        };
        let cells = NAMES
            .iter()
            .map(|name| Ok(field(name)?.map_or(String::new(), |v| v.to_string())))
            .collect::<Result<_>>()?;
        row(source, cells, field).with_context(|| format!("rows[{i}]"))
    });
    let rows = rows.collect::<Result<_>>()?;
    Ok((NAMES.map(str::to_owned).to_vec(), rows))
}

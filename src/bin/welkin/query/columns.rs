//! From the cells of a row to what it asks.

use csv::ByteRecord;
use welkin::Conditions;
use welkin::output::printable;

use super::quantity::{Quantity, Question, Ray};
use crate::failure::{Failure, Result, plain};

const QUANTITY: &str = "quantity";
const DISTANCE: &str = "distance_m";
const NUMBERS: [&str; 7] = [
    "visibility_km",
    "albedo",
    "altitude_m",
    "solar_elevation_deg",
    "view_zenith_deg",
    "view_azimuth_deg",
    "wavelength_nm",
];

/// Where the columns stand.
pub struct Columns {
    /// Cells of a row.
    pub count: usize,
    quantity: usize,
    numbers: [usize; 7],
    distance: Option<usize>,
}

impl Columns {
    pub fn find(header: &ByteRecord) -> Result<Self> {
        for reserved in ["value", "error"] {
            if position(header, reserved)?.is_some() {
                let text = format!("the table has a column \"{reserved}\" already: rename it");
                return Err(Failure::message(text));
            }
        }
        let wanted = |name: &str| {
            position(header, name)?.ok_or_else(|| {
                Failure::message(format!(
                    "the table lacks the column \"{name}\"; it needs {QUANTITY}, {}{}",
                    NUMBERS.join(", "),
                    separator_hint(header)
                ))
            })
        };
        let mut numbers = [0; 7];
        for (index, name) in numbers.iter_mut().zip(NUMBERS) {
            *index = wanted(name)?;
        }
        Ok(Self {
            count: header.len(),
            quantity: wanted(QUANTITY)?,
            numbers,
            distance: position(header, DISTANCE)?,
        })
    }

    /// What a row asks, or what to write in its error column.
    pub fn question(&self, row: &ByteRecord) -> std::result::Result<Question, String> {
        if row.len() != self.count {
            let hint = match row.len() > self.count {
                true => " (decimals are written with a point, not with a comma)",
                false => "",
            };
            let (count, got) = (self.count, row.len());
            return Err(format!("expected {count} cells, got {got}{hint}"));
        }
        let cell = |index: usize| row[index].trim_ascii();
        let quantity = Quantity::parse(cell(self.quantity))?;
        let mut numbers = [0.0; 7];
        for ((number, &index), name) in numbers.iter_mut().zip(&self.numbers).zip(NUMBERS) {
            *number = parse_number(name, cell(index))?;
        }
        let distance = match self.distance.map(cell) {
            Some(cell) if !cell.is_empty() => parse_number(DISTANCE, cell)?,
            _ => f64::INFINITY,
        };
        if !quantity.is_of_segments() && distance != f64::INFINITY {
            return Err("distance_m must be empty: radiance is along the whole ray".to_owned());
        }
        if distance.is_nan() || distance < 0.0 {
            return Err(format!(
                "distance_m must not be negative, got {}",
                plain(distance)
            ));
        }
        question(quantity, numbers, distance)
    }
}

fn question(
    quantity: Quantity,
    [
        visibility,
        albedo,
        altitude,
        elevation,
        zenith,
        azimuth,
        wavelength,
    ]: [f64; 7],
    distance: f64,
) -> std::result::Result<Question, String> {
    if !(0.0..=180.0).contains(&zenith) {
        return Err(format!(
            "view_zenith_deg must be in 0..=180, got {}",
            plain(zenith)
        ));
    }
    if !azimuth.is_finite() {
        return Err(format!("view_azimuth_deg must be finite, got {azimuth}"));
    }
    Ok(Question {
        quantity,
        conditions: Conditions {
            solar_elevation: elevation.to_radians(),
            solar_azimuth: 0.0,
            visibility: visibility * 1e3,
            albedo,
            altitude,
        },
        ray: Ray {
            direction: direction(zenith, azimuth),
            distance,
        },
        wavelength,
    })
}

/// The index of a column; two of the same name are an error.
fn position(header: &ByteRecord, name: &str) -> Result<Option<usize>> {
    let bytes = name.as_bytes();
    let mut found = header.iter().enumerate().filter(|(_, cell)| {
        // Some programs put a byte order mark before the first column.
        let cell = cell.strip_prefix(b"\xef\xbb\xbf").unwrap_or(cell);
        cell.trim_ascii() == bytes
    });
    let first = found.next().map(|(i, _)| i);
    match found.next() {
        None => Ok(first),
        Some(_) => Err(Failure::message(format!(
            "the table has two columns \"{name}\""
        ))),
    }
}

/// What may be wrong with a header of which a column is not found.
fn separator_hint(header: &ByteRecord) -> String {
    for (mark, name) in [(b';', "semicolons"), (b'\t', "tabs"), (b'|', "bars")] {
        if header.iter().any(|cell| cell.contains(&mark)) {
            return format!(
                ". It seems to be separated by {name}: commas are expected, and points in decimals"
            );
        }
    }
    String::new()
}

fn parse_number(name: &str, cell: &[u8]) -> std::result::Result<f64, String> {
    let number = std::str::from_utf8(cell)
        .ok()
        .and_then(|text| text.parse().ok());
    number.ok_or_else(|| not_a_number(name, cell))
}

#[cold]
fn not_a_number(name: &str, cell: &[u8]) -> String {
    if cell.is_empty() {
        return format!("{name} is empty");
    }
    let text = printable(&String::from_utf8_lossy(cell));
    let pointed = text.replacen(',', ".", 1);
    let hint = match pointed != text && pointed.parse::<f64>().is_ok() {
        true => format!(": decimals are written with a point, {pointed}"),
        false => String::new(),
    };
    format!("{name} must be a number, got \"{text}\"{hint}")
}

/// Unit vector at a zenith angle and an azimuth from the sun, degrees; exact at the poles and the horizon.
fn direction(zenith: f64, azimuth: f64) -> [f64; 3] {
    let elevation = (90.0 - zenith).to_radians();
    let (z, horizontal) = elevation.sin_cos();
    let horizontal = if zenith == 0.0 || zenith == 180.0 {
        0.0
    } else {
        horizontal
    };
    let (y, x) = (azimuth % 360.0).to_radians().sin_cos();
    [horizontal * x, horizontal * y, z]
}

//! From the cells of a row to what it asks.

use csv::ByteRecord;
use welkin::Conditions;

use super::quantity::{Quantity, Question, Ray};
use super::shared::Shared;
use crate::albedo::Ground;
use crate::cells;
use crate::failure::{Failure, Result, plain};

const QUANTITY: &str = "quantity";
const ERROR: &str = "error";
const DISTANCE: &str = "distance_m";
const VISIBILITY: &str = "visibility_km";
const ALBEDO: &str = "albedo";
const NUMBERS: [&str; 6] = [
    VISIBILITY,
    ALBEDO,
    "altitude_m",
    "solar_elevation_deg",
    "view_zenith_deg",
    "view_azimuth_deg",
];
const WAVELENGTH: &str = "wavelength_nm";

/// Where the columns stand.
pub struct Columns {
    /// Cells of a row.
    pub count: usize,
    quantity: usize,
    /// Those of visibility and albedo may be absent where they are given for all rows.
    numbers: [Option<usize>; 6],
    /// Not in the table where bands are asked for.
    wavelength: Option<usize>,
    distance: Option<usize>,
    /// In place of the column.
    ground: Option<Ground>,
    /// In place of the column, m.
    visibility: Option<f64>,
}

impl Columns {
    /// `values` are the columns of the answers: those of bands need no wavelength in the table.
    pub fn find(header: &ByteRecord, values: &[String], shared: &Shared) -> Result<Self> {
        let bands = shared.bands.is_some();
        let is_given = |name: &str| match name {
            VISIBILITY => shared.visibility.is_some(),
            ALBEDO => shared.ground.is_some(),
            _ => false,
        };
        if values.iter().any(|name| name == ERROR) {
            let text = format!("a band cannot be called \"{ERROR}\": that is the column of errors");
            return Err(Failure::message(text));
        }
        for reserved in values.iter().map(String::as_str).chain([ERROR]) {
            if position(header, reserved)?.is_some() {
                let text = format!("the table has a column \"{reserved}\" already: rename it");
                return Err(Failure::message(text));
            }
        }
        let wanted = |name: &str| {
            position(header, name)?.ok_or_else(|| {
                Failure::message(format!(
                    "the table lacks the column \"{name}\"; it needs {QUANTITY}, {}{}{}",
                    NUMBERS.join(", "),
                    if bands { "" } else { ", wavelength_nm" },
                    cells::separator_hint(header)
                ))
            })
        };
        let mut numbers = [None; 6];
        for (index, name) in numbers.iter_mut().zip(NUMBERS) {
            *index = match is_given(name) {
                true => None,
                false => Some(wanted(name)?),
            };
        }
        Ok(Self {
            count: header.len(),
            quantity: wanted(QUANTITY)?,
            numbers,
            wavelength: match bands {
                true => None,
                false => Some(wanted(WAVELENGTH)?),
            },
            distance: position(header, DISTANCE)?,
            ground: shared.ground.cloned(),
            visibility: shared.visibility,
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
        let mut numbers = [0.0; 6];
        for ((number, &index), name) in numbers.iter_mut().zip(&self.numbers).zip(NUMBERS) {
            if let Some(index) = index {
                *number = cells::number(name, cell(index))?;
            }
        }
        let wavelength = match self.wavelength.map(cell) {
            Some(cell) => cells::number(WAVELENGTH, cell)?,
            None => 0.0,
        };
        let distance = match self.distance.map(cell) {
            Some(cell) if !cell.is_empty() => cells::number(DISTANCE, cell)?,
            _ => f64::INFINITY,
        };
        if self.wavelength.is_none() && quantity == Quantity::RelativeRadiance {
            return Err("relative_radiance has no bands: ask for radiance".to_owned());
        }
        if !quantity.is_of_segments() && distance != f64::INFINITY {
            return Err("distance_m must be empty: radiance is along the whole ray".to_owned());
        }
        if distance.is_nan() || distance < 0.0 {
            return Err(format!(
                "distance_m must not be negative, got {}",
                plain(distance)
            ));
        }
        if let Some(ground) = &self.ground {
            numbers[1] = ground.at(wavelength);
        }
        let mut question = question(quantity, numbers, wavelength, distance)?;
        if let Some(visibility) = self.visibility {
            question.conditions.visibility = visibility;
        }
        Ok(question)
    }
}

fn question(
    quantity: Quantity,
    [visibility, albedo, altitude, elevation, zenith, azimuth]: [f64; 6],
    wavelength: f64,
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
            above: None,
        },
        wavelength,
    })
}

/// The index of a column; two of the same name are an error.
fn position(header: &ByteRecord, name: &str) -> Result<Option<usize>> {
    let bytes = name.as_bytes();
    let mut found = header
        .iter()
        .enumerate()
        .filter(|(_, cell)| cells::name(cell) == bytes);
    let first = found.next().map(|(i, _)| i);
    match found.next() {
        None => Ok(first),
        Some(_) => Err(Failure::message(format!(
            "the table has two columns \"{name}\""
        ))),
    }
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

//! Spectra of typical skies at the nodes of a model: what weights are fitted to.

use crate::conditions::{Conditions, direction};
use crate::error::{Error, Result};
use crate::model::Model;

/// Fewer say too little.
const ENOUGH: usize = 32;
/// Logarithms of relative radiance below this are no light.
const DARKEST: f64 = -60.0;
/// Solar elevations, as shares of their axis.
const SUNS: [f64; 6] = [0.1, 0.25, 0.4, 0.6, 0.8, 1.0];
/// Elevations of views (rad) with azimuths from the sun.
const VIEWS: [[f64; 2]; 14] = [
    [1.5, 0.0],
    [1.1, 0.4],
    [1.1, 2.5],
    [0.7, 1.5],
    [0.45, 0.1],
    [0.45, 3.0],
    [0.25, 0.8],
    [0.25, 2.0],
    [0.1, 0.05],
    [0.1, 3.1],
    [0.03, 1.2],
    [0.005, 2.6],
    [-0.1, 0.6],
    [-0.6, 2.2],
];

/// Light at a node counts as at least this share of the brightest, in a file with a spectrum: 2⁻²⁷.
const FLOOR: f64 = -27.0 * core::f64::consts::LN_2;

/// ln L (L per unit of solar irradiance) at the nodes: examples of the file, or what the model gives.
pub(super) fn examples(model: &Model) -> Result<Vec<Vec<f64>>> {
    let stored = match model.spectrum_chunk()? {
        Some(spectrum) => {
            let rows = spectrum.example.chunks(model.head().wavelengths.len());
            rows.map(|row| floored(row.iter().map(|v| f64::from(v.get())).collect()))
                .collect()
        }
        None => Vec::new(),
    };
    match stored.len() {
        0..ENOUGH => made(model),
        _ => Ok(widened(stored)),
    }
}

/// How far from one example towards another others are taken: between the two, and beyond.
const BESIDE: [f64; 2] = [0.5, 1.1];

/// More examples than the file has: what differs between skies is how long they are for each constituent, so straight
/// lines between logarithms are skies, too.
fn widened(mut rows: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let stored = rows.len();
    for (k, share) in BESIDE.into_iter().enumerate() {
        for i in 0..stored {
            let [from, to] = [i, (i + 17 + 12 * k) % stored].map(|i| &rows[i]);
            let beside = from.iter().zip(to).map(|(a, b)| a + share * (b - a));
            rows.push(floored(beside.collect()));
        }
    }
    rows
}

fn floored(row: Vec<f64>) -> Vec<f64> {
    let brightest = row.iter().copied().fold(f64::MIN, f64::max);
    row.into_iter().map(|l| l.max(brightest + FLOOR)).collect()
}

/// Skies at nodes of the model, each of which costs one chunk. What the file lacks is left out.
fn made(model: &Model) -> Result<Vec<Vec<f64>>> {
    let model = &model.over_grey();
    let mut out = Vec::new();
    let mut missing = None;
    for conditions in scenes(model) {
        match model.sky(&conditions) {
            Ok(sky) => {
                let mut values = vec![0.0; sky.wavelengths().len()];
                for [elevation, azimuth] in VIEWS {
                    let view = direction(elevation, azimuth).map(|v| v as f32);
                    sky.relative_radiance(view, &mut values)?;
                    out.push(values.iter().map(|&v| f64::from(v).ln()).collect());
                }
            }
            Err(error @ Error::MissingChunk { .. }) => missing = Some(error),
            Err(error) => return Err(error),
        }
    }
    out.retain(|row: &Vec<f64>| row.iter().all(|&v| v > DARKEST));
    match (out.is_empty(), missing) {
        (false, _) => Ok(out),
        (true, Some(error)) => Err(error),
        (true, None) => Err(Error::invalid(
            "model",
            "has no light that bands can be fitted to",
        )),
    }
}

/// Few chunks, all suns, grounds of both kinds.
fn scenes(model: &Model) -> impl Iterator<Item = Conditions> {
    let head = model.head();
    let (altitudes, visibilities) = (head.altitudes.clone(), head.visibilities.clone());
    let axis = head.elevation;
    let (low, high) = (0, altitudes.len() / 2);
    let (clear, middle) = (visibilities.len() - 1, visibilities.len() / 2);
    let mut places = vec![(low, 0), (low, middle), (low, clear), (high, middle)];
    places.dedup();
    places
        .into_iter()
        .enumerate()
        .flat_map(move |(p, (altitude, visibility))| {
            let (altitude, visibility) = (altitudes[altitude], visibilities[visibility]);
            SUNS.into_iter()
                .enumerate()
                .map(move |(s, share)| Conditions {
                    altitude,
                    visibility,
                    solar_elevation: axis.elevation(share * axis.intervals as f64),
                    albedo: if (p + s) % 2 == 0 { 0.1 } else { 0.7 },
                    ..Conditions::default()
                })
        })
}

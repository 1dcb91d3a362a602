//! OPAC's particles as the spheres that they are in it: scattering matrices at any humidity and wavelength.

use super::lognormal::{Lognormal, Scattered};
use crate::atmosphere::Phase;
use crate::atmosphere::matrix::{Elements, Matrix};
use anyhow::{Context, Result};
use nalgebra::Complex;
use serde::Deserialize;
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex};

/// nm per µm.
const NM: f64 = 1e3;

#[derive(Deserialize)]
struct SizeRow {
    component: String,
    humidity: f64,
    r_min: f64,
    r_max: f64,
    r_mode: f64,
    sigma: f64,
}

#[derive(Deserialize)]
struct IndexRow {
    component: String,
    humidity: f64,
    wavelength: f64,
    n: f64,
    k: f64,
}

/// Particles of a kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Spheres {
    name: String,
    /// By humidity, percent: sizes in µm, and n and k by wavelength in nm.
    states: Vec<State>,
    humidity: f64,
}

#[derive(Clone, Debug, PartialEq)]
struct State {
    humidity: f64,
    sizes: Lognormal,
    index: Vec<(f64, [f64; 2])>,
}

impl Spheres {
    /// OPAC's particles of that name, if it says of what sizes they are, at a relative humidity (percent).
    pub fn new(name: &str, humidity: f64) -> Result<Option<Self>> {
        let sizes = rows::<SizeRow>(include_str!("../../data/opac_sizes.csv"));
        let indices = rows::<IndexRow>(include_str!("../../data/opac_refraction.csv"));
        let (sizes, indices) = (
            sizes.context("opac_sizes.csv")?,
            indices.context("opac_refraction.csv")?,
        );
        let own = sizes.iter().filter(|row| row.component == name);
        let states: Vec<State> = own.map(|row| State::new(row, &indices)).collect();
        Ok((!states.is_empty()).then_some(Self {
            name: name.to_owned(),
            states,
            humidity,
        }))
    }

    /// Their scattering matrices at wavelengths in nm.
    pub fn phase(&self, wavelengths: &[f64]) -> Result<Phase> {
        let angles = angles();
        let rows: Vec<Vec<Elements>> = wavelengths
            .iter()
            .map(|&nm| self.remembered(nm, &angles))
            .collect();
        let matrix = Matrix::resample(&angles, &rows);
        let matrix = matrix.with_context(|| format!("spheres of {}", self.name))?;
        Ok(Phase::Tabulated(Arc::new(matrix)))
    }

    /// Scattering at a wavelength in nm, at angles in degrees; cross sections in µm².
    pub fn scatter(&self, wavelength: f64, angles: &[f64]) -> Scattered {
        let (sizes, index) = self.between(wavelength);
        let angles: Vec<f64> = angles.iter().map(|a| a.to_radians()).collect();
        sizes.scatter(wavelength / NM, index, &angles)
    }

    fn remembered(&self, wavelength: f64, angles: &[f64]) -> Vec<Elements> {
        type Known = HashMap<(String, u64, u64), Vec<Elements>>;
        static KNOWN: LazyLock<Mutex<Known>> = LazyLock::new(Mutex::default);
        let key = (
            self.name.clone(),
            self.humidity.to_bits(),
            wavelength.to_bits(),
        );
        let known = || {
            KNOWN
                .lock()
                .unwrap_or_else(|poisoned| poisoned.into_inner())
        };
        if let Some(found) = known().get(&key) {
            return found.clone();
        }
        let elements = self.scatter(wavelength, angles).elements;
        known().insert(key, elements.clone());
        elements
    }

    /// Sizes and refractive index at the humidity, and at a wavelength.
    fn between(&self, wavelength: f64) -> (Lognormal, Complex<f64>) {
        let last = self.states.len() - 1;
        let above = self.states.partition_point(|s| s.humidity <= self.humidity);
        let (a, b) = (
            &self.states[above.saturating_sub(1)],
            &self.states[above.min(last)],
        );
        let t = match b.humidity > a.humidity {
            true => (self.humidity - a.humidity) / (b.humidity - a.humidity),
            false => 0.0,
        };
        let mix = |a: f64, b: f64| a + t * (b - a);
        let sizes = Lognormal {
            range: std::array::from_fn(|k| mix(a.sizes.range[k], b.sizes.range[k])),
            median: mix(a.sizes.median, b.sizes.median),
            sigma: a.sizes.sigma,
        };
        let [dry, wet] = [a, b].map(|state| state.index_at(wavelength));
        (
            sizes,
            Complex::new(mix(dry[0], wet[0]), mix(dry[1], wet[1])),
        )
    }
}

impl State {
    fn new(row: &SizeRow, indices: &[IndexRow]) -> Self {
        let own = indices
            .iter()
            .filter(|i| i.component == row.component && i.humidity == row.humidity);
        Self {
            humidity: row.humidity,
            sizes: Lognormal {
                range: [row.r_min, row.r_max],
                median: row.r_mode,
                sigma: row.sigma,
            },
            index: own.map(|i| (i.wavelength, [i.n, i.k])).collect(),
        }
    }

    /// Linear between wavelengths, constant beyond the ends.
    fn index_at(&self, wavelength: f64) -> [f64; 2] {
        let last = self.index.len() - 1;
        let i = self.index.partition_point(|(nm, _)| *nm <= wavelength);
        let ((from, a), (to, b)) = (
            self.index[i.saturating_sub(1).min(last)],
            self.index[i.min(last)],
        );
        let t = if to > from {
            (wavelength - from) / (to - from)
        } else {
            0.0
        };
        std::array::from_fn(|k| a[k] + t * (b[k] - a[k]))
    }
}

fn rows<T: for<'a> Deserialize<'a>>(text: &str) -> Result<Vec<T>> {
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    Ok(reader.deserialize().collect::<Result<_, _>>()?)
}

/// Scattering angles, degrees: dense in the forward peak.
fn angles() -> Vec<f64> {
    let parts = [
        (0.0, 1.0, 0.1),
        (1.0, 3.0, 0.25),
        (3.0, 10.0, 0.5),
        (10.0, 180.0, 1.0),
    ];
    let inner = parts
        .into_iter()
        .flat_map(|(from, to, step): (f64, f64, f64)| {
            let n = ((to - from) / step).round() as usize;
            (0..n).map(move |i| from + step * i as f64)
        });
    inner.chain([180.0]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::matrix::NODES;
    use crate::atmosphere::mie;
    use crate::atmosphere::table::Table;

    /// The committed tables, which another Mie code made of the same microphysics.
    #[test]
    fn matrices_are_those_of_the_committed_tables() {
        for (name, humidity) in [("waso", 50.0), ("inso", 0.0), ("soot", 0.0)] {
            let wavelengths = [340.0, 550.0, 740.0];
            let committed = mie::matrix(name, &wavelengths).unwrap();
            let spheres = Spheres::new(name, humidity).unwrap().unwrap();
            let Phase::Tabulated(own) = spheres.phase(&wavelengths).unwrap() else {
                panic!("no matrix");
            };
            for (w, wavelength) in wavelengths.iter().enumerate() {
                let mut worst = [0.0f64; 2];
                for i in 0..NODES {
                    let (a, b) = (own.at(w, i), committed.at(w, i));
                    worst[0] = worst[0].max((a[0] / b[0] - 1.0).abs());
                    let degree = (a[1] / a[0] - b[1] / b[0]).abs();
                    worst[1] = worst[1].max(degree);
                }
                println!("{name} {wavelength} {worst:?}");
                assert!(worst[0] < 0.01 && worst[1] < 0.01, "{name}: {worst:?}");
            }
        }
    }

    #[test]
    fn cross_sections_are_those_of_opac() {
        let table = |humid| match humid {
            true => Table::parse("", include_str!("../../data/opac_hygroscopic.csv")).unwrap(),
            false => Table::parse("", include_str!("../../data/opac_dry.csv")).unwrap(),
        };
        for (name, humid) in [
            ("waso", true),
            ("ssam", true),
            ("suso", true),
            ("inso", false),
            ("soot", false),
            ("minm", false),
            ("miam", false),
            ("mitr", false),
        ] {
            let table = table(humid);
            let (nm, ext) = (
                table.column("wavelength_nm").unwrap(),
                table.column(&format!("{name}_ext")).unwrap(),
            );
            let albedo = table.column(&format!("{name}_ssa")).unwrap();
            // The first block of humidities: dry.
            let row = nm.iter().position(|&nm| nm == 550.0).unwrap();
            let spheres = Spheres::new(name, 0.0).unwrap().unwrap();
            let [scattering, extinction] = spheres.scatter(550.0, &[0.0]).cross_sections;
            let error = extinction * 1e-12 / ext[row] - 1.0;
            println!("{name}: extinction {error:+.4}");
            assert!(error.abs() < 0.01, "{name}: {error}");
            assert!(
                (scattering / extinction - albedo[row]).abs() < 0.01,
                "{name}"
            );
        }
    }

    #[test]
    fn droplets_of_fog_have_no_sizes() {
        assert!(Spheres::new("fogr", 50.0).unwrap().is_none());
    }
}

//! The transmittance of a file as extinction coefficients of fixed profiles.
//!
//! Official tables say how much light passes between points; welkin's form is a sum over constituents, extinction times
//! profile. Profiles are those of the gases and particles of the published atmosphere, and tents over altitude for what
//! they miss; the extinction coefficients, which are not negative, are fitted to the tables ray by ray.

use super::bare_head::bare_head;
use super::sites::PLANET;
use crate::atmosphere::{Atmosphere, real};
use crate::non_negative::least_squares;
use crate::official::ray::Ray;
use crate::official::transmittance::Transmittance;
use anyhow::Result;
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;
use welkin::format::{Chunk, DensityTable, Head, Payload, encode};
use welkin::{Model, Transmittance as Ours};

/// Tops of the tents, m; each falls to 0 at its neighbours.
const TENTS: [f64; 8] = [
    0.0, 600.0, 1500.0, 2500.0, 5000.0, 9000.0, 14_000.0, 26_000.0,
];
/// Angles of the rays to the geometric horizon, degrees, above and below it.
const ANGLES: [f64; 9] = [0.4, 1.0, 2.0, 4.0, 8.0, 16.0, 30.0, 55.0, 85.0];
/// Lengths of the rays, m.
const LENGTHS: [f64; 5] = [500.0, 3e3, 15e3, 70e3, f64::INFINITY];
/// Less light than this says nothing of the air.
const LEAST: f64 = 1e-3;

/// Air that a file says enough of.
pub struct Air {
    /// Extinction where the profile is 1, m⁻¹, `[visibility][constituent][channel]`.
    pub extinction: Vec<f64>,
    /// Its constituents.
    pub constituents: usize,
    /// Their profiles; none without a transmittance.
    pub profiles: Option<DensityTable>,
}

impl Air {
    /// Nothing is known of it.
    pub fn unknown() -> Self {
        Self {
            extinction: vec![],
            constituents: 0,
            profiles: None,
        }
    }

    /// Fits the extinction to `table` at visibilities (m).
    pub fn new(table: &Transmittance, visibilities: &[f64]) -> Result<Self> {
        let (profiles, constituents) = profiles()?;
        let columns = Columns::new(&profiles, constituents)?;
        let rays = rays(table);
        let rows = columns.of(&rays)?;
        let channels = table.channels().count;
        let mut extinction = vec![0.0; visibilities.len() * constituents * channels];
        for (v, visibility) in visibilities.iter().enumerate() {
            let through = |ray: &Ray| table.at(ray.altitude, ray.theta, ray.length, *visibility);
            let truth: Vec<Vec<f64>> = rays.iter().map(through).collect::<Result<_, _>>()?;
            let fits = (0..channels).into_par_iter().map(|c| fit(&rows, &truth, c));
            let fits: Vec<Vec<f64>> = fits.collect();
            for (c, fit) in fits.iter().enumerate() {
                for (k, value) in fit.iter().enumerate() {
                    extinction[(v * constituents + k) * channels + c] = *value;
                }
            }
        }
        Ok(Self {
            extinction,
            constituents,
            profiles: Some(profiles),
        })
    }
}

/// Rays in all directions from the stored altitudes.
pub fn rays(table: &Transmittance) -> Vec<Ray> {
    let mut out = vec![];
    for &altitude in table.altitudes() {
        let dip = PLANET.dip(altitude);
        for angle in ANGLES.iter().flat_map(|a| [*a, -*a]) {
            let elevation = angle.to_radians() - dip;
            if elevation < -FRAC_PI_2 || angle < 0.0 && altitude < 1.0 {
                continue;
            }
            out.extend(LENGTHS.iter().map(|&length| Ray {
                altitude,
                theta: FRAC_PI_2 - elevation,
                length,
            }));
        }
    }
    out
}

/// Least squares of the transmittance, to first order.
fn fit(rows: &[Vec<f64>], truth: &[Vec<f64>], channel: usize) -> Vec<f64> {
    let constituents = rows.first().map_or(0, Vec::len);
    let mut scale = vec![1e-300; constituents];
    let (mut weighted, mut wanted) = (vec![], vec![]);
    for (row, truth) in rows.iter().zip(truth) {
        let through = truth[channel].min(1.0);
        if through < LEAST {
            continue;
        }
        weighted.push(row.iter().map(|c| through * c).collect::<Vec<f64>>());
        wanted.push(-through * through.ln());
        for (scale, c) in scale.iter_mut().zip(row) {
            *scale = f64::max(*scale, through * c);
        }
    }
    if weighted.is_empty() {
        return vec![0.0; constituents];
    }
    for row in &mut weighted {
        row.iter_mut().zip(&scale).for_each(|(c, s)| *c /= s);
    }
    let x = least_squares(&weighted, &wanted);
    x.iter().zip(&scale).map(|(x, s)| x / s).collect()
}

/// Profiles of all constituents, and how many they are.
fn profiles() -> Result<(DensityTable, usize)> {
    // Any visibility and wavelength: profiles depend on neither.
    let air: Atmosphere = real(59_400.0, &[550.0])?;
    let tent = |k: usize, h: f64| {
        let (top, below) = (TENTS[k], k.checked_sub(1).map(|i| TENTS[i]));
        let above = TENTS.get(k + 1).copied().unwrap_or(PLANET.top);
        match (h < top, below) {
            (true, Some(below)) => ((h - below) / (top - below)).max(0.0),
            _ => ((above - h) / (above - top)).clamp(0.0, 1.0),
        }
    };
    let constituents = air.constituents.len() + TENTS.len();
    let at = |i: usize| -> Vec<f64> {
        let own = air.constituents.iter().map(|c| c.profile[i]);
        let tents = (0..TENTS.len()).map(|k| tent(k, air.altitudes[i]));
        own.chain(tents).collect()
    };
    let mut density: Vec<f32> = at(0).iter().map(|v| *v as f32).collect();
    for i in 1..air.altitudes.len() {
        let (below, above) = (at(i - 1), at(i));
        let middle = below
            .iter()
            .zip(&above)
            .map(|(a, b)| (0.5 * (a + b)) as f32);
        density.extend(middle);
        density.extend(above.iter().map(|v| *v as f32));
    }
    let edges = air.altitudes.clone();
    Ok((DensityTable { edges, density }, constituents))
}

/// Columns of the profiles along lines: the optical depths of a model with as many wavelengths as constituents, each of
/// which only one of them dims.
struct Columns(Ours, usize);

impl Columns {
    fn new(profiles: &DensityTable, constituents: usize) -> Result<Self> {
        let head = probe(constituents);
        let chunk = Chunk::new(None, None, Payload::Transmittance(profiles.clone()));
        let model = Model::from_bytes(encode(&head, &[chunk])?)?;
        Ok(Self(
            model.transmittance(head.visibilities[0])?,
            constituents,
        ))
    }

    fn of(&self, rays: &[Ray]) -> Result<Vec<Vec<f64>>> {
        let one = |ray: &Ray| -> Result<Vec<f64>> {
            let mut depth = vec![0.0; self.1];
            let to = ray.end();
            self.0
                .optical_depth([0.0, 0.0, ray.altitude], to, &mut depth)?;
            Ok(depth.into_iter().map(f64::from).collect())
        };
        rays.iter().map(one).collect()
    }
}

/// A head whose wavelengths are the constituents.
fn probe(constituents: usize) -> Head {
    let mut extinction = vec![0.0; constituents * constituents];
    for k in 0..constituents {
        extinction[k * constituents + k] = 1.0;
    }
    bare_head(constituents, extinction)
}

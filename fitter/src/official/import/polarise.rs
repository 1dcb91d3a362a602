//! Q and U of the skies of a file, fitted as their radiance is.

use super::albedo::AlbedoLaw;
use super::fields::Fields;
use super::fit::{Tensor, decompose_all, row_weights};
use crate::decompose::{Fit, Options};
use crate::official::OfficialData;
use crate::official::error::Result;
use crate::official::layout::Node;
use rayon::prelude::*;

/// Q and U/sin φ over black ground, then of light from the ground.
const PARTS: usize = 4;
/// What an error of light from the ground counts against one of other light.
const GROUND: f64 = 0.5;
/// Squared sine of the angle to the sun below which there is no plane of polarisation.
const NO_PLANE: f64 = 1e-6;

/// Fits the polarisation of all chunks together.
///
/// # Errors
/// If the file cannot be read or has factors that are not finite.
pub fn fit(
    data: &OfficialData,
    (chunks, places): (&[Fields], &[[usize; 2]]),
    laws: &[AlbedoLaw],
    options: Options,
    progress: &dyn Fn(usize, f64),
) -> Result<Fit> {
    let values: Vec<Vec<f32>> = chunks
        .par_iter()
        .zip(places)
        .map(|(chunk, place)| sample(data, chunk, *place, &laws[place[1]]))
        .collect::<Result<_>>()?;
    let tensors: Vec<Tensor> = chunks
        .iter()
        .zip(&values)
        .map(|(chunk, values)| Tensor {
            shape: chunk.sites.shape(),
            values,
            weights: row_weights(chunk),
        })
        .collect();
    let channels = data.header().channels.count;
    let weights: Vec<f64> = (0..PARTS * channels)
        .map(|c| if c < 2 * channels { 1.0 } else { GROUND })
        .collect();
    Ok(decompose_all(&tensors, &weights, options, progress))
}

/// Relative to the level, `[site][part][channel]`.
fn sample(
    data: &OfficialData,
    chunk: &Fields,
    [altitude, visibility]: [usize; 2],
    law: &AlbedoLaw,
) -> Result<Vec<f32>> {
    let [views, azimuths, suns] = chunk.sites.shape();
    let (albedos, channels) = (chunk.albedos, chunk.channels);
    let mut out = vec![0.0; views * azimuths * suns * PARTS * channels];
    for sun in 0..suns {
        let node = |albedo| Node {
            visibility,
            albedo,
            altitude,
            elevation: sun,
        };
        let skies = (0..albedos).map(|a| data.stored_polarisation(node(a)));
        let skies = skies.collect::<Result<Vec<_>>>()?;
        for v in 0..views {
            for p in 0..azimuths {
                let site = chunk.sites.index(v, p, sun);
                let direction = chunk.sites.direction(v, p);
                let degrees = skies.iter().map(|s| s.degree(direction));
                let degrees = degrees.collect::<Result<Vec<_>>>()?;
                let [q, u] = turns(chunk, v, p, sun);
                let cell = &mut out[site * PARTS * channels..][..PARTS * channels];
                for c in 0..channels {
                    let light: Vec<f64> = (0..albedos)
                        .map(|a| f64::from(chunk.radiance(site, a, c)))
                        .collect();
                    let polarised = light.iter().zip(&degrees);
                    // Noise of the tables beyond what light can be.
                    let polarised: Vec<f64> =
                        polarised.map(|(l, d)| l * d[c].clamp(-1.0, 1.0)).collect();
                    let [black, ground] = law.split_by(&polarised, &light, c);
                    cell[c] = (black * q) as f32;
                    cell[channels + c] = (black * u) as f32;
                    cell[2 * channels + c] = (ground * q) as f32;
                    cell[3 * channels + c] = (ground * u) as f32;
                }
            }
        }
    }
    Ok(out)
}

/// Q and U/sin φ of light that is wholly polarised across the plane of view and sun.
fn turns(chunk: &Fields, view: usize, azimuth: usize, sun: usize) -> [f64; 2] {
    let (sv, cv) = chunk.sites.views[view].1.sin_cos();
    let (sp, cp) = chunk.sites.azimuths[azimuth].sin_cos();
    let (se, ce) = chunk.sites.suns[sun].sin_cos();
    let (up, right) = (cv * se - sv * ce * cp, ce * sp);
    let squared = up * up + right * right;
    match squared > NO_PLANE {
        true => [
            (right * right - up * up) / squared,
            -2.0 * up * ce / squared,
        ],
        false => [0.0, 0.0],
    }
}

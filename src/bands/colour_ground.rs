//! The albedos that a ground has in colours.

use super::colour_matching::matching;
use super::colour_nodes::coloured;
use super::effective_albedo::{GroundSpectrum, Sum, TypicalLight, fit};
use super::spectral_axis::SpectralAxis;
use crate::conditions::Conditions;
use crate::error::Result;
use crate::ground::Albedo;
use crate::kernel::axis::linear;
use crate::model::{Model, NodeSubset};

/// The nodes that colours are made of, with the albedos there under checked conditions: over a ground whose albedo
/// depends on wavelength those with which the sum over the nodes is the integral over the spectrum.
pub(crate) fn coloured_over(
    model: &Model,
    conditions: &Conditions,
) -> Result<(NodeSubset, Vec<f64>)> {
    let nodes = coloured(model);
    let Some(ground) = model.spectral_ground() else {
        let albedos = vec![conditions.albedo; nodes.kept().len()];
        return Ok((nodes, albedos));
    };
    let albedos = model.colour_albedos(|| albedos(model, ground, nodes.kept()))?;
    Ok((nodes, albedos.to_vec()))
}

fn albedos(model: &Model, albedo: &Albedo, kept: &[usize]) -> Result<Vec<f64>> {
    let ground = GroundSpectrum::new(model, albedo);
    let light = TypicalLight::new(model)?;
    let axis = SpectralAxis::new(model)?;
    let head = model.head();
    let [first, last] = axis.range();
    let seen = matching().filter(|(l, _)| (first..=last).contains(l));
    let seen: Vec<Seen> = seen
        .map(|(wavelength, row)| {
            let sun = head.solar_irradiance_at(wavelength);
            Seen {
                wavelength,
                weights: row.map(|m| m * sun),
                tau: ground.tau(wavelength),
                light: light.at(&axis, wavelength),
            }
        })
        .collect();
    let parts = |c: usize| {
        let part = |&n: &usize| {
            light
                .at_node(n)
                .iter()
                .map(|l| l * head.xyz[n][c])
                .collect()
        };
        kept.iter().map(part).collect()
    };
    let sum = |c: usize| Sum {
        parts: parts(c),
        mean: means(&seen, c),
    };
    let nodes: Vec<f64> = kept.iter().map(|&n| head.wavelengths[n]).collect();
    let tau = fit(&[0, 1, 2].map(sum), &around(&seen, &nodes, &ground));
    let albedo = |(&n, tau)| ground.albedo(n, tau);
    Ok(kept.iter().zip(tau).map(albedo).collect())
}

/// A wavelength of the observer.
struct Seen {
    wavelength: f64,
    /// Of X, Y, Z, with the sunlight in them.
    weights: [f64; 3],
    tau: f64,
    /// Of each example.
    light: Vec<f64>,
}

/// The mean of τ over X, Y or Z of each example.
fn means(seen: &[Seen], c: usize) -> Vec<f64> {
    let examples = seen.first().map_or(0, |at| at.light.len());
    let mean = |e: usize| {
        let (mut sum, mut whole) = (0.0, 0.0);
        for at in seen {
            let light = at.weights[c] * at.light[e];
            sum += light * at.tau;
            whole += light;
        }
        sum / whole
    };
    (0..examples).map(mean).collect()
}

/// The mean of τ around each node, up to its neighbours.
fn around(seen: &[Seen], nodes: &[f64], ground: &GroundSpectrum) -> Vec<f64> {
    let (mut sums, mut wholes) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
    for at in seen {
        let weight: f64 = at.weights.iter().sum();
        for (n, near) in linear(nodes, at.wavelength).taps() {
            sums[n] += near * weight * at.tau;
            wholes[n] += near * weight;
        }
    }
    let mean = |n: usize| match wholes[n] > 0.0 {
        true => sums[n] / wholes[n],
        false => ground.tau(nodes[n]),
    };
    (0..nodes.len()).map(mean).collect()
}

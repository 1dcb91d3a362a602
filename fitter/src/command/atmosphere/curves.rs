//! The curves of a plot: profiles, optical depths and phase functions.

use super::draw::{Panel, Series};
use anyhow::Result;
use welkin_fitter::atmosphere::matrix::{NODES, angle};
use welkin_fitter::atmosphere::{Atmosphere, Constituent, Monochromatic, Phase};
use welkin_fitter::recipe::Recipe;

const GREEN: f64 = 550.0;
/// Altitudes above are not drawn, km.
const HIGHEST: f64 = 40.0;
/// Every so many nodes of the phase function are drawn.
const THINNED: usize = 5;

/// Three panels.
pub fn panels(recipe: &Recipe) -> Result<[Panel; 3]> {
    Ok([profiles(recipe)?, depths(recipe)?, phases(recipe)?])
}

fn profiles(recipe: &Recipe) -> Result<Panel> {
    let air = recipe.air(&[Monochromatic::beside_lines(GREEN)])?;
    let (nodes, layers) = recipe.particles(&[GREEN])?;
    let line = |name: &str, nodes: &[f64], constituents: &[&Constituent]| {
        let extinction = |i: usize| {
            let parts = constituents.iter().map(|c| c.profile[i] * c.extinction[0]);
            1000.0 * parts.sum::<f64>()
        };
        let points = nodes
            .iter()
            .enumerate()
            .map(|(i, z)| (extinction(i), z / 1000.0));
        let shown = points.filter(|p| p.1 <= HIGHEST);
        Series::new(name, shown.collect())
    };
    let ozone = ozone(&air);
    let mut series = vec![
        line("molecules", &air.altitudes, &[&air.constituents[0]]),
        line("ozone", &air.altitudes, &ozone),
    ];
    series.extend(
        layers
            .iter()
            .map(|layer| line(&layer.name, &nodes, &[layer])),
    );
    let largest = series
        .iter()
        .flat_map(|s| &s.points)
        .fold(0.0, |m: f64, p| m.max(p.0));
    Ok(Panel {
        title: "extinction at 550 nm",
        below: "1/km",
        beside: "altitude, km",
        x: (largest * 1e-5, largest * 2.0),
        y: (0.0, HIGHEST),
        log: (true, false),
        series,
    })
}

fn ozone(air: &Atmosphere) -> Vec<&Constituent> {
    air.constituents
        .iter()
        .filter(|c| c.name.starts_with("ozone"))
        .collect()
}

fn depths(recipe: &Recipe) -> Result<Panel> {
    let wavelengths: Vec<f64> = (0..=440).map(|i| 300.0 + 5.0 * f64::from(i)).collect();
    let lights: Vec<_> = wavelengths
        .iter()
        .map(|&w| Monochromatic::beside_lines(w))
        .collect();
    let air = recipe.air(&lights)?;
    let of = |name: &str, depths: Vec<f64>| {
        Series::new(name, wavelengths.iter().copied().zip(depths).collect())
    };
    let gas = |constituents: &[usize]| -> Vec<f64> {
        let at = |w: usize| {
            constituents
                .iter()
                .map(|&k| air.vertical_optical_depth(k, w))
                .sum()
        };
        (0..wavelengths.len()).map(at).collect()
    };
    let is_ozone = |k: &usize| air.constituents[*k].name.starts_with("ozone");
    let ozone: Vec<usize> = (0..air.constituents.len()).filter(is_ozone).collect();
    let mut series = vec![of("molecules", gas(&[0])), of("ozone", gas(&ozone))];
    for layer in recipe.layers(&wavelengths)? {
        series.push(of(&layer.name, layer.optical_depth));
    }
    let largest = series
        .iter()
        .flat_map(|s| &s.points)
        .fold(0.0, |m: f64, p| m.max(p.1));
    Ok(Panel {
        title: "vertical optical depth beside lines",
        below: "wavelength, nm",
        beside: "",
        x: (300.0, 2500.0),
        // Room for the legend.
        y: (largest * 1e-5, largest * 20.0),
        log: (false, true),
        series,
    })
}

fn phases(recipe: &Recipe) -> Result<Panel> {
    let air = recipe.air(&[Monochromatic::beside_lines(GREEN)])?;
    let (_, layers) = recipe.particles(&[GREEN])?;
    let line = |name: &str, constituent: &Constituent| {
        let points = (0..NODES).step_by(THINNED);
        let at = |i: usize| (angle(i).to_degrees(), phase_function(constituent, i));
        Series::new(name, points.map(at).collect())
    };
    let mut series = vec![
        line("molecules", &air.constituents[0]),
        Series::new("ozone", vec![]),
    ];
    series.extend(layers.iter().map(|layer| line(&layer.name, layer)));
    let values = || {
        series
            .iter()
            .flat_map(|s| &s.points)
            .map(|p| p.1)
            .filter(|v| *v > 0.0)
    };
    let (least, most) = (values().fold(1.0, f64::min), values().fold(1.0, f64::max));
    Ok(Panel {
        title: "phase function at 550 nm, mean 1",
        below: "scattering angle, degrees",
        beside: "",
        x: (0.0, 180.0),
        y: (least / 1.5, most * 1.5),
        log: (false, true),
        series,
    })
}

/// Mean of the scatterers' phase functions at node `i`, by how much they scatter.
fn phase_function(constituent: &Constituent, i: usize) -> f64 {
    let parts = constituent.scatterers.iter();
    let all: f64 = parts.clone().map(|s| s.scattering[0]).sum();
    let sum: f64 = parts.map(|s| s.scattering[0] * value(&s.phase, i)).sum();
    if all > 0.0 { sum / all } else { 0.0 }
}

/// At the first wavelength.
fn value(phase: &Phase, i: usize) -> f64 {
    let cosine = angle(i).cos();
    match phase {
        Phase::Rayleigh { depolarisation } => {
            let gamma = depolarisation[0] / (2.0 - depolarisation[0]);
            0.75 / (1.0 + 2.0 * gamma) * (1.0 + 3.0 * gamma + (1.0 - gamma) * cosine * cosine)
        }
        Phase::HenyeyGreenstein { g } => {
            let g = g[0];
            (1.0 - g * g) / (1.0 + g * g - 2.0 * g * cosine).powf(1.5)
        }
        Phase::Tabulated(matrix) => matrix.at(0, i)[0],
    }
}

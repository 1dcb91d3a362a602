//! Layers that the light field's grid of altitudes may be too coarse for.

use super::shape::{Edge, Shape};
use crate::successive_orders::moments::ALTITUDES;

/// An edge is safe if the grid about it is no coarser than this many of its widths: the built-in inversion, 0.15 km,
/// has nodes every 150 m.
const COARSEST: f64 = 1.5;
/// … or if what is between two nodes there has no more optical depth than this: the tropopause ends little.
const HARMLESS: f64 = 0.02;

/// What to say about the edges of the layer `name`; `extinction` is that where its profile is 1, 550 nm, m⁻¹.
pub fn cautions(name: &str, shape: &Shape, extinction: f64) -> Vec<String> {
    let risky = |edge: &Edge| {
        // Half of the layer is left at its edge.
        let full = 2.0 * shape.at(edge.altitude) * extinction;
        let spacing = spacing(edge.altitude);
        spacing > COARSEST * edge.width && full * spacing > HARMLESS
    };
    let say = |edge: Edge| {
        format!(
            "layers.{name}: its edge at {} km is {} km wide where the solver has a node every {} km; a wider edge \
             traces more exactly",
            edge.altitude / 1000.0,
            edge.width / 1000.0,
            spacing(edge.altitude) / 1000.0
        )
    };
    shape.edges().filter(risky).map(say).collect()
}

/// Distance of the nodes about an altitude, m.
fn spacing(altitude: f64) -> f64 {
    let last = ALTITUDES.len() - 1;
    let i = ALTITUDES.partition_point(|&z| z < altitude).clamp(1, last);
    ALTITUDES[i] - ALTITUDES[i - 1]
}

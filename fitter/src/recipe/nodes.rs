//! Altitudes between which all profiles are linear.

use super::shape::Shape;
use crate::atmosphere::AerosolProfile;
use crate::atmosphere::real::altitude_nodes;

/// Nodes about an edge, in its widths.
const REACH: f64 = 5.0;
/// Distance of the nodes there, in its widths.
const STEP: f64 = 1.0 / 3.0;
/// Nodes nearer to each other than this, m, are one.
const NEAREST: f64 = 5.0;

/// Nodes of the model's own air, and more where an edge of a layer is sharper than they are dense or where a table
/// bends.
pub fn altitudes<'a>(shapes: impl Iterator<Item = &'a Shape>, gases: &[f64]) -> Vec<f64> {
    let mut nodes = altitude_nodes(AerosolProfile::Smooth);
    let top = nodes[nodes.len() - 1];
    let mut more: Vec<f64> = gases.to_vec();
    for shape in shapes {
        more.extend(shape.bends());
        for edge in shape.edges() {
            let steps = (REACH / STEP).round() as i32;
            let at = |i: i32| edge.altitude + f64::from(i) * STEP * edge.width;
            more.extend((-steps..=steps).map(at));
        }
    }
    for z in more.into_iter().filter(|z| (0.0..top).contains(z)) {
        insert(&mut nodes, z);
    }
    nodes
}

fn insert(nodes: &mut Vec<f64>, z: f64) {
    let i = nodes.partition_point(|&node| node < z);
    let near = |j: usize| nodes.get(j).is_some_and(|node| (node - z).abs() < NEAREST);
    let before = i.checked_sub(1).is_some_and(near);
    if !near(i) && !before {
        nodes.insert(i, z);
    }
}

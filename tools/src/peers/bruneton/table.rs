//! A table over the four coordinates.

use super::coordinates::{Node, Place, SIZE, between, radius, sun, view};
use crate::peers::lanes::Lanes;
use crate::peers::medium::{Medium, rayleigh_phase};
use crate::peers::parallel::in_parallel;

/// Values at all nodes: altitude, view, sun, angle between, the last nearest in memory.
#[derive(Clone)]
pub struct ScatteringTable<const K: usize>(Vec<Lanes<K>>);

/// Distance in memory from one node to the next, per axis.
const STRIDE: [usize; 4] = [SIZE[1] * SIZE[2] * SIZE[3], SIZE[2] * SIZE[3], SIZE[3], 1];

impl<const K: usize> ScatteringTable<K> {
    /// Fills it by layers of altitude, in parallel: `layer` gets the index and appends all values.
    pub fn by_layers(layer: impl Fn(usize) -> Vec<Lanes<K>> + Sync) -> Self {
        Self(in_parallel(SIZE[0], layer).concat())
    }

    /// A value of every node from its own value.
    pub fn mapped(
        medium: &Medium<K>,
        value: impl Fn(&Node, usize) -> Lanes<K> + Sync,
    ) -> Self {
        Self::by_layers(|i| {
            let nodes = layer_nodes(medium, i);
            let first = i * STRIDE[0];
            nodes.enumerate().map(|(n, node)| value(&node, first + n)).collect()
        })
    }

    /// The value at the index of a node.
    pub fn node(&self, index: usize) -> Lanes<K> {
        self.0[index]
    }

    /// Linear between the 16 nodes around a place.
    pub fn at(&self, place: &Place) -> Lanes<K> {
        let start: usize = (0..4).map(|axis| place.first[axis] * STRIDE[axis]).sum();
        let mut sum = Lanes::default();
        for corner in 0..8usize {
            let (mut weight, mut index) = (1.0, start);
            for axis in 0..3 {
                let next = corner >> axis & 1;
                let share = place.share[axis];
                weight *= if next == 1 { share } else { 1.0 - share };
                index += next * STRIDE[axis];
            }
            if weight > 0.0 {
                sum += self.0[index].mixed(self.0[index + 1], place.share[3]) * weight;
            }
        }
        sum
    }

    /// Adds another over the phase function of molecules.
    pub fn add_over_rayleigh_phase(&mut self, other: &RadianceTable<K>) {
        let nodes = other.nu.iter().zip(&other.table.0);
        for (sum, (nu, value)) in self.0.iter_mut().zip(nodes) {
            *sum += *value * (1.0 / rayleigh_phase(*nu));
        }
    }

    /// Memory of the nodes.
    pub fn bytes(&self) -> usize {
        size_of_val(self.0.as_slice())
    }
}

/// Radiance of one order, with the angle between view and sun that each node has.
pub struct RadianceTable<const K: usize> {
    /// Of all nodes.
    pub table: ScatteringTable<K>,
    nu: Vec<f32>,
}

impl<const K: usize> RadianceTable<K> {
    /// Pairs a table with the angles of its nodes.
    pub fn new(medium: &Medium<K>, table: ScatteringTable<K>) -> Self {
        let layers = in_parallel(SIZE[0], |i| {
            layer_nodes(medium, i).map(|node| node.nu as f32).collect::<Vec<_>>()
        });
        Self {
            table,
            nu: layers.concat(),
        }
    }
}

/// Nodes of a layer of altitude, in the order of the table.
pub fn layer_nodes<const K: usize>(medium: &Medium<K>, i: usize) -> impl Iterator<Item = Node> {
    let shell = medium.shell;
    let r = radius(&shell, i);
    (0..SIZE[1]).flat_map(move |j| {
        let (mu, ground) = view(&shell, r, j);
        (0..SIZE[2]).flat_map(move |k| {
            let mu_sun = sun(&shell, k);
            (0..SIZE[3]).map(move |l| Node {
                r,
                mu,
                mu_sun,
                nu: between(l, mu, mu_sun),
                ground,
            })
        })
    })
}

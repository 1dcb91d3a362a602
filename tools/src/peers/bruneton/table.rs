//! A table over the four coordinates.

use super::coordinates::{Place, SIZE, between, radius, sun, view};
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

    /// Two at once, layer by layer.
    pub fn two_by_layers(layer: impl Fn(usize) -> [Vec<Lanes<K>>; 2] + Sync) -> [Self; 2] {
        let layers = in_parallel(SIZE[0], layer);
        let part = |kind: usize| Self(layers.iter().flat_map(|l| &l[kind]).copied().collect());
        [part(0), part(1)]
    }

    /// Another from the values of two and the cosine between view and sun at each node.
    pub fn combined(
        medium: &Medium<K>,
        [a, b]: [&Self; 2],
        value: impl Fn(Lanes<K>, Lanes<K>, f32) -> Lanes<K> + Sync,
    ) -> Self {
        Self::by_layers(|i| {
            let pairs = a.0[i * STRIDE[0]..].iter().zip(&b.0[i * STRIDE[0]..]);
            let nodes = layer_angles(medium, i).zip(pairs);
            nodes.map(|(nu, (a, b))| value(*a, *b, nu)).collect()
        })
    }

    /// Linear between the 16 nodes around a place.
    pub fn at(&self, place: &Place) -> Lanes<K> {
        let start: usize = (0..4).map(|axis| place.first[axis] * STRIDE[axis]).sum();
        let mut sum = Lanes::default();
        for corner in 0..8usize {
            let (mut weight, mut index) = (1.0, start);
            for (axis, stride) in STRIDE[..3].iter().enumerate() {
                let next = corner >> axis & 1;
                let share = place.share[axis];
                weight *= if next == 1 { share } else { 1.0 - share };
                index += next * stride;
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
        let layers = in_parallel(SIZE[0], |i| layer_angles(medium, i).collect::<Vec<_>>());
        Self {
            table,
            nu: layers.concat(),
        }
    }
}

/// Cosine of the angle between view and sun at the nodes of a layer of altitude, in the order of the table.
fn layer_angles<const K: usize>(medium: &Medium<K>, i: usize) -> impl Iterator<Item = f32> {
    let shell = medium.shell;
    let r = radius(&shell, i);
    (0..SIZE[1]).flat_map(move |j| {
        let (mu, _) = view(&shell, r, j);
        (0..SIZE[2]).flat_map(move |k| {
            let mu_sun = sun(&shell, k);
            (0..SIZE[3]).map(move |l| between(l, mu, mu_sun) as f32)
        })
    })
}

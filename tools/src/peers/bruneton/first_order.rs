//! Light that is scattered once.

use super::coordinates::{SIZE, between, radius, sun, view};
use super::table::{RadianceTable, ScatteringTable};
use crate::peers::lanes::Lanes;
use crate::peers::medium::{Medium, mie_phase, rayleigh_phase};
use crate::peers::transmittance::TransmittanceTable;

/// Steps of each integral, as published.
const STEPS: usize = 50;

/// A point of a line of sight: what molecules and particles there scatter towards its start.
struct Stop<const K: usize> {
    distance: f64,
    r: f64,
    sent: [Lanes<K>; 2],
}

/// Of molecules and of particles, over their phase functions.
pub fn tables<const K: usize>(
    medium: &Medium<K>,
    transmittance: &TransmittanceTable<K>,
) -> [ScatteringTable<K>; 2] {
    let kind = |kind: usize| {
        ScatteringTable::by_layers(|i| {
            let r = radius(&medium.shell, i);
            let mut values = Vec::with_capacity(SIZE[1] * SIZE[2] * SIZE[3]);
            for j in 0..SIZE[1] {
                let (mu, ground) = view(&medium.shell, r, j);
                let stops = stops(medium, transmittance, r, mu, ground);
                for k in 0..SIZE[2] {
                    let mu_sun = sun(&medium.shell, k);
                    for l in 0..SIZE[3] {
                        let nu = between(l, mu, mu_sun);
                        let mut sum = Lanes::default();
                        for stop in &stops {
                            let there = (r * mu_sun + stop.distance * nu) / stop.r;
                            let sunlight = transmittance.to_sun(stop.r, there.clamp(-1.0, 1.0));
                            sum += stop.sent[kind] * sunlight;
                        }
                        values.push(sum);
                    }
                }
            }
            values
        })
    };
    [kind(0), kind(1)]
}

fn stops<const K: usize>(
    medium: &Medium<K>,
    transmittance: &TransmittanceTable<K>,
    r: f64,
    mu: f64,
    ground: bool,
) -> Vec<Stop<K>> {
    let step = medium.shell.to_end(r, mu, ground) / STEPS as f64;
    let stop = |i: usize| {
        let distance = step * i as f64;
        let weight = step * if i == 0 || i == STEPS { 0.5 } else { 1.0 };
        let (there, _) = medium.shell.advanced(r, mu, distance);
        let through = transmittance.between(r, mu, distance, ground) * weight as f32;
        let [molecules, particles, _] = medium.densities(medium.altitude(there));
        Stop {
            distance,
            r: there,
            sent: [
                medium.rayleigh * through * molecules,
                medium.mie_scattering * through * particles,
            ],
        }
    };
    (0..=STEPS).map(stop).collect()
}

/// Radiance of all nodes from both tables.
pub fn with_phase<const K: usize>(
    medium: &Medium<K>,
    rayleigh: &ScatteringTable<K>,
    mie: &ScatteringTable<K>,
) -> RadianceTable<K> {
    let table = ScatteringTable::mapped(medium, |node, index| {
        let nu = node.nu as f32;
        rayleigh.node(index) * rayleigh_phase(nu) + mie.node(index) * mie_phase(medium.g, nu)
    });
    RadianceTable::new(medium, table)
}

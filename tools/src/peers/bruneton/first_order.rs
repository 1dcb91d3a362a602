//! Light that is scattered once.

use super::coordinates::{SIZE, between, radius, sun, view};
use super::table::{RadianceTable, ScatteringTable};
use crate::peers::lanes::Lanes;
use crate::peers::medium::{Medium, rayleigh_phase};
use crate::peers::transmittance::TransmittanceTable;

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
    steps: usize,
) -> [ScatteringTable<K>; 2] {
    ScatteringTable::two_by_layers(|i| {
        let r = radius(&medium.shell, i);
        let mut values = [Vec::new(), Vec::new()];
        for j in 0..SIZE[1] {
            let (mu, ground) = view(&medium.shell, r, j);
            let stops = stops(medium, transmittance, [r, mu], ground, steps);
            for k in 0..SIZE[2] {
                let mu_sun = sun(&medium.shell, k);
                for l in 0..SIZE[3] {
                    let nu = between(l, mu, mu_sun);
                    let [molecules, particles] = sums(transmittance, &stops, r * mu_sun, nu);
                    values[0].push(molecules);
                    values[1].push(particles);
                }
            }
        }
        values
    })
}

/// What all stops send; `height` is that of the start over the plane across the sun's direction.
fn sums<const K: usize>(
    transmittance: &TransmittanceTable<K>,
    stops: &[Stop<K>],
    height: f64,
    nu: f64,
) -> [Lanes<K>; 2] {
    let mut sums = [Lanes::default(); 2];
    for stop in stops {
        let mu_sun = (height + stop.distance * nu) / stop.r;
        let sunlight = transmittance.to_sun(stop.r, mu_sun.clamp(-1.0, 1.0));
        sums[0] += stop.sent[0] * sunlight;
        sums[1] += stop.sent[1] * sunlight;
    }
    sums
}

fn stops<const K: usize>(
    medium: &Medium<K>,
    transmittance: &TransmittanceTable<K>,
    [r, mu]: [f64; 2],
    ground: bool,
    steps: usize,
) -> Vec<Stop<K>> {
    let step = medium.shell.to_end(r, mu, ground) / steps as f64;
    let stop = |i: usize| {
        let distance = step * i as f64;
        let weight = step * if i == 0 || i == steps { 0.5 } else { 1.0 };
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
    (0..=steps).map(stop).collect()
}

/// Radiance of all nodes from both tables.
pub fn with_phase<const K: usize>(
    medium: &Medium<K>,
    rayleigh: &ScatteringTable<K>,
    mie: &ScatteringTable<K>,
) -> RadianceTable<K> {
    let table = ScatteringTable::combined(medium, [rayleigh, mie], |rayleigh, mie, nu| {
        rayleigh * rayleigh_phase(nu) + mie * medium.mie_phase(nu)
    });
    RadianceTable::new(medium, table)
}

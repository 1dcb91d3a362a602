//! Steps of the factor matrices of a single chunk.

use super::equation::equations;
use super::factors::{Basis, Own, Pass, add, random, row};
use super::normal::Normal;
use crate::decompose::Chunk;

pub fn views(chunk: &Chunk, nodes: &[usize], own: &mut Own, basis: &Basis, pass: Pass) {
    let rank = basis.rank;
    let [views, phis, elevations] = chunk.sites;
    let mut rng = random(pass.seed, chunk, 1);
    let mut mixed = vec![0.0; rank];
    for v in 0..views {
        let mut normal = Normal::new(rank);
        let view = row(&own.view, v, rank);
        for p in 0..phis {
            let phi = row(&basis.phi, p, rank);
            for e in 0..elevations {
                let elevation = row(&own.elevation, e, rank);
                for equation in equations(chunk, nodes, chunk.site(v, p, e), &mut rng) {
                    equation.mix(basis, &mut mixed);
                    equation.push(&mut normal, view, |r| mixed[r] * phi[r] * elevation[r]);
                }
            }
        }
        add(&mut own.view, v, rank, &normal.step(), pass.step);
    }
}

pub fn elevations(chunk: &Chunk, nodes: &[usize], own: &mut Own, basis: &Basis, pass: Pass) {
    let rank = basis.rank;
    let [views, phis, elevations] = chunk.sites;
    let mut rng = random(pass.seed, chunk, 2);
    let mut mixed = vec![0.0; rank];
    for e in 0..elevations {
        let mut normal = Normal::new(rank);
        let elevation = row(&own.elevation, e, rank);
        for v in 0..views {
            let view = row(&own.view, v, rank);
            for p in 0..phis {
                let phi = row(&basis.phi, p, rank);
                for equation in equations(chunk, nodes, chunk.site(v, p, e), &mut rng) {
                    equation.mix(basis, &mut mixed);
                    equation.push(&mut normal, elevation, |r| mixed[r] * phi[r] * view[r]);
                }
            }
        }
        add(&mut own.elevation, e, rank, &normal.step(), pass.step);
    }
}

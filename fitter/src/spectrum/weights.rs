//! Weights of the nodes for a term, learned by least squares.
//!
//! Along the lines of sight of the training set ln L of a term is a sum of ln L of few nodes, with weights that add up
//! to 1: a factor that is the same at all wavelengths stays what it is.

use crate::atmosphere::Monochromatic;
use nalgebra::{DMatrix, DVector};

/// Nodes that a term is made of.
pub const TAPS: usize = 8;
/// So many nodes beside lines may help on either side of light beside lines, and of light that gases absorb: what looks
/// at a part of the spectrum needs the nodes of that part.
const NEIGHBOURS: [usize; 2] = [5, 9];
/// Radiance counts as at least this share of the largest among the nodes; format specification, section 7.3.
pub const FLOOR: f64 = 1.0 / (1u64 << 27) as f64;
/// Absorption by lines below this is none.
const CLEAR: f64 = 1e-3;
/// Error of ln L of a node in a model: weights that are large against each other would multiply it.
const NOISE: f64 = 0.003;
/// What is left of ln L in a typical sample, beyond which samples count less.
const TYPICAL: f64 = 0.003;

/// Nodes and their weights, of sum 1; at most [`TAPS`].
pub type Taps = Vec<(usize, f64)>;

/// What is to be made of the nodes.
pub struct Target<'a> {
    /// The light of the term.
    pub light: Monochromatic,
    /// ln L per sample.
    pub logarithm: &'a [f64],
    /// Share of the term in the radiance of its cell, per sample.
    pub share: &'a [f64],
}

/// ln L of the nodes as a reader takes it.
pub fn floored(radiance: &[f64]) -> Vec<f64> {
    let largest = radiance.iter().copied().fold(0.0, f64::max);
    let least = (FLOOR * largest).max(f64::MIN_POSITIVE);
    radiance.iter().map(|l| l.max(least).ln()).collect()
}

/// Weights for `target` of `nodes`, whose ln L per sample is `x[sample][node]`.
pub fn learn(nodes: &[Monochromatic], x: &[Vec<f64>], target: &Target) -> Taps {
    let (base, allowed) = candidates(nodes, target.light);
    let absorbs = absorption(target.light) > CLEAR;
    // Terms of little share have to be right where they have one; beside lines all samples count the same.
    let least = if absorbs { 1e-5 } else { 1e-4 };
    let count = |share: &f64| share.min(1.0).powi(2) + least;
    let importance: Vec<f64> = target.share.iter().map(count).collect();
    let mut moments = Moments::new(x, target.logarithm, &importance, absorbs);
    let mut taps = moments.select(base, &allowed);
    if !absorbs {
        for _ in 0..2 {
            let left = x
                .iter()
                .zip(target.logarithm)
                .map(|(x, y)| value(&taps, x) - y);
            let weight = |(w, r): (&f64, f64)| w / (1.0 + (r / TYPICAL).powi(2));
            let robust: Vec<f64> = importance.iter().zip(left).map(weight).collect();
            moments = Moments::new(x, target.logarithm, &robust, absorbs);
            taps = moments.select(base, &allowed);
        }
    }
    taps
}

/// Σ weight · ln L.
pub fn value(taps: &Taps, x: &[f64]) -> f64 {
    taps.iter().map(|&(n, w)| w * x[n]).sum()
}

fn absorption(light: Monochromatic) -> f64 {
    light.water.max(light.mixed)
}

/// The node that is most like `light`, and all others that may help: neighbours beside lines, and the nearest with more
/// and with less absorption of the same gas.
fn candidates(nodes: &[Monochromatic], light: Monochromatic) -> (usize, Vec<usize>) {
    let gases: [fn(&Monochromatic) -> f64; 2] = [|l| l.water, |l| l.mixed];
    let clear = |n: &usize| absorption(nodes[*n]) < CLEAR;
    let mut allowed: Vec<usize> = (0..nodes.len()).filter(clear).collect();
    let before = allowed.partition_point(|&n| nodes[n].wavelength <= light.wavelength);
    let neighbours = NEIGHBOURS[usize::from(absorption(light) > CLEAR)];
    allowed.truncate(before + neighbours);
    allowed.drain(..before.saturating_sub(neighbours));
    let by_wavelength =
        |n: &&usize| ((nodes[**n].wavelength - light.wavelength).abs() * 1e3) as u64;
    let mut base = *allowed
        .iter()
        .min_by_key(by_wavelength)
        .expect("nodes beside lines");
    for gas in gases.into_iter().filter(|gas| gas(&light) > CLEAR) {
        let strength = gas(&light);
        let absorbing = || (0..nodes.len()).filter(|&n| gas(&nodes[n]) >= CLEAR);
        let order = |a: &usize, b: &usize| gas(&nodes[*a]).total_cmp(&gas(&nodes[*b]));
        let weaker = absorbing()
            .filter(|&n| gas(&nodes[n]) <= strength)
            .max_by(order);
        let stronger = absorbing()
            .filter(|&n| gas(&nodes[n]) > strength)
            .min_by(order);
        let found: Vec<usize> = weaker.into_iter().chain(stronger).collect();
        let distance = |n: &usize| (gas(&nodes[*n]) / strength).ln().abs();
        let nearest = found
            .iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)));
        base = *nearest.unwrap_or(&base);
        allowed.extend(found);
    }
    allowed.retain(|&n| n != base);
    (base, allowed)
}

/// Weighted mean products of ln L of all nodes and, last, of the target.
struct Moments {
    products: DMatrix<f64>,
    ridge: f64,
}

impl Moments {
    fn new(x: &[Vec<f64>], y: &[f64], importance: &[f64], absorbs: bool) -> Self {
        let n = x[0].len() + 1;
        let mut products = DMatrix::zeros(n, n);
        let mut row = vec![0.0; n];
        for ((x, y), w) in x.iter().zip(y).zip(importance) {
            // Differences are what counts, so that the products keep their digits.
            let middle = x.iter().sum::<f64>() / x.len() as f64;
            row[..n - 1]
                .iter_mut()
                .zip(x)
                .for_each(|(r, x)| *r = x - middle);
            row[n - 1] = y - middle;
            for j in 0..n {
                let wj = w * row[j];
                for i in 0..=j {
                    products[(i, j)] += wj * row[i];
                }
            }
        }
        products /= importance.iter().sum::<f64>();
        products.fill_lower_triangle_with_upper_triangle();
        (0..n - 1).for_each(|i| products[(i, i)] += NOISE * NOISE);
        Self {
            products,
            ridge: if absorbs { 1e-4 } else { 1e-6 },
        }
    }

    /// Takes in the node that helps most, again and again.
    fn select(&self, base: usize, allowed: &[usize]) -> Taps {
        let mut chosen = vec![base];
        let (mut weights, mut left) = (vec![1.0], self.solve(&chosen).1);
        while chosen.len() < TAPS && left > 1e-10 {
            let free = allowed.iter().filter(|n| !chosen.contains(n));
            let tried = free.map(|&n| (n, self.solve(&[&chosen[..], &[n]].concat())));
            let best = tried.min_by(|a, b| a.1.1.total_cmp(&b.1.1));
            let Some((n, better)) = best.filter(|b| b.1.1 < 0.98 * left) else {
                break;
            };
            chosen.push(n);
            (weights, left) = better;
        }
        chosen.into_iter().zip(weights).collect()
    }

    /// Weights of the `chosen` nodes that add up to 1, and the mean square of what is left.
    fn solve(&self, chosen: &[usize]) -> (Vec<f64>, f64) {
        let (base, rest, m) = (chosen[0], &chosen[1..], &self.products);
        let target = m.ncols() - 1;
        // Products of differences to the first node.
        let between =
            |i: usize, j: usize| m[(i, j)] - m[(i, base)] - m[(base, j)] + m[(base, base)];
        let normal = DMatrix::from_fn(rest.len(), rest.len(), |i, j| {
            let ridge = if i == j { 1.0 + self.ridge } else { 1.0 };
            between(rest[i], rest[j]) * ridge
        });
        let right = DVector::from_fn(rest.len(), |i, _| between(rest[i], target));
        let Some(solved) = normal.clone().cholesky().map(|c| c.solve(&right)) else {
            return (vec![0.0; chosen.len()], f64::INFINITY);
        };
        let left =
            between(target, target) - 2.0 * solved.dot(&right) + solved.dot(&(&normal * &solved));
        let first = std::iter::once(1.0 - solved.sum());
        (first.chain(solved.iter().copied()).collect(), left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three nodes that are unlike each other, a target that is a mixture of two of them, and one that is a node.
    #[test]
    fn mixtures_are_found() {
        let nodes = [400.0, 500.0, 600.0].map(Monochromatic::beside_lines);
        let x: Vec<Vec<f64>> = (0..50)
            .map(|i| {
                (2..5)
                    .map(|j| -3.0 + (f64::from(i * j) * 0.37).sin())
                    .collect()
            })
            .collect();
        let all = vec![1.0; 50];
        let learned = |wavelength: f64, y: fn(&Vec<f64>) -> f64| {
            let logarithm: Vec<f64> = x.iter().map(y).collect();
            let mut taps = learn(
                &nodes,
                &x,
                &Target {
                    light: Monochromatic::beside_lines(wavelength),
                    logarithm: &logarithm,
                    share: &all,
                },
            );
            taps.sort_by_key(|t| t.0);
            taps
        };
        let mixture = learned(410.0, |x| 1.4 * x[0] - 0.4 * x[2]);
        assert_eq!(mixture.iter().map(|t| t.0).collect::<Vec<_>>(), [0, 2]);
        assert!((mixture[0].1 - 1.4).abs() < 1e-4 && (mixture[1].1 + 0.4).abs() < 1e-4);
        assert_eq!(learned(500.0, |x| x[1]), [(1, 1.0)]);
    }

    #[test]
    fn a_term_of_a_gas_takes_nodes_of_that_gas() {
        let nodes = [
            Monochromatic::beside_lines(700.0),
            Monochromatic::mixed(762.0, 0.1),
            Monochromatic::vapour(820.0, 0.1),
            Monochromatic::vapour(940.0, 1.0),
            Monochromatic::vapour(941.0, 5.0),
        ];
        let between = candidates(&nodes, Monochromatic::vapour(900.0, 0.8));
        assert_eq!(between, (3, vec![0, 2]));
        let beyond = candidates(&nodes, Monochromatic::vapour(900.0, 50.0));
        assert_eq!(beyond, (4, vec![0]));
        assert_eq!(
            candidates(&nodes, Monochromatic::beside_lines(900.0)),
            (0, vec![])
        );
    }

    #[test]
    fn what_is_dark_counts_as_a_share_of_the_brightest() {
        assert_eq!(floored(&[1.0, 0.0]), [0.0, FLOOR.ln()]);
        assert!(floored(&[0.0, 0.0]).iter().all(|l| l.is_finite()));
    }
}

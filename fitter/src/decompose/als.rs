//! Canonical polyadic decomposition of a four-mode core by alternating least squares with extrapolation.
//!
//! Plain ALS crawls through swamps where components nearly cancel. After each sweep the factors are extrapolated along their last
//! step; a step that makes the fit worse is taken back and the extrapolation is shortened. A small ridge keeps components from
//! growing against each other.

use super::tucker::Dense;
use faer::linalg::solvers::{Llt, Solve};
use faer::{Mat, Side};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// How hard to try.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Number of components.
    pub rank: usize,
    /// Sweeps over all modes.
    pub sweeps: usize,
    /// Seed of the starting factors.
    pub seed: u64,
}

/// Factor matrices `[mode length][rank]` and the relative error ‖X − X̂‖ / ‖X‖.
pub struct Cpd {
    /// Factors per mode.
    pub factors: [Mat<f64>; 4],
    /// Relative error in the Frobenius norm.
    pub error: f64,
}

/// Weight of the components' squared norms in the objective.
const RIDGE: f64 = 1e-9;

/// Decomposes `core`.
pub fn decompose(core: &Dense, options: Options) -> Cpd {
    let problem = Problem::new(core);
    let mut best = start(core.shape, options);
    let mut least = WORST;
    let mut factors = best.clone();
    let mut momentum: f64 = 0.5;
    let mut extrapolated = false;
    for _ in 0..options.sweeps {
        let cost = problem.sweep(&mut factors);
        if cost.objective > least.objective && extrapolated {
            // The extrapolation overshot: go on from the best factors with a shorter one.
            factors = best.clone();
            momentum *= 0.7;
            extrapolated = false;
            continue;
        }
        let previous = std::mem::replace(&mut best, factors.clone());
        least = cost;
        momentum = (momentum * 1.05).min(0.99);
        extrapolated = true;
        for (f, p) in factors.iter_mut().zip(&previous) {
            *f = &*f + (&*f - p) * faer::Scale(momentum);
        }
    }
    Cpd {
        factors: best,
        error: least.error,
    }
}

#[derive(Clone, Copy)]
struct Cost {
    error: f64,
    /// Squared error plus the ridge: what every update lowers.
    objective: f64,
}

const WORST: Cost = Cost {
    error: f64::INFINITY,
    objective: f64::INFINITY,
};

struct Problem {
    /// Unfolding `[modes 0, 1][modes 2, 3]`.
    matrix: Mat<f64>,
    shape: [usize; 4],
    energy: f64,
}

impl Problem {
    fn new(core: &Dense) -> Self {
        let [a, b, c, d] = core.shape;
        let matrix = Mat::from_fn(a * b, c * d, |i, j| core.values[i * c * d + j]);
        let energy = core.values.iter().map(|v| v * v).sum();
        Self {
            matrix,
            shape: core.shape,
            energy,
        }
    }

    /// Updates all factors in turn; returns what is left afterwards.
    fn sweep(&self, factors: &mut [Mat<f64>; 4]) -> Cost {
        let [a, b, c, d] = self.shape;
        let right = &self.matrix * khatri_rao(&factors[2], &factors[3]);
        update(factors, 0, &contract_second(&right, &factors[1], a, b));
        update(factors, 1, &contract_first(&right, &factors[0], a, b));
        let left = self.matrix.transpose() * khatri_rao(&factors[0], &factors[1]);
        update(factors, 2, &contract_second(&left, &factors[3], c, d));
        let product = contract_first(&left, &factors[2], c, d);
        update(factors, 3, &product);
        let overlap = dot(&product, &factors[3]);
        let gram = gram_of_others(factors, 3);
        let last = factors[3].transpose() * &factors[3];
        let components: f64 = (0..gram.nrows()).map(|r| gram[(r, r)] * last[(r, r)]).sum();
        let residual = (self.energy - 2.0 * overlap + dot(&gram, &last)).max(0.0);
        balance(factors);
        Cost {
            error: (residual / self.energy).sqrt(),
            objective: (residual + RIDGE * components) / self.energy,
        }
    }
}

/// Solves for factor `mode` given the product of the tensor with all others.
fn update(factors: &mut [Mat<f64>; 4], mode: usize, product: &Mat<f64>) {
    let mut gram = gram_of_others(factors, mode);
    // Relative to each component, so that small ones are not put down.
    for i in 0..gram.nrows() {
        gram[(i, i)] *= 1.0 + RIDGE;
    }
    if let Ok(llt) = Llt::new(gram.as_ref(), Side::Lower) {
        factors[mode] = llt.solve(product.transpose()).transpose().to_owned();
    }
}

/// Gives all factors of a component the same norm.
fn balance(factors: &mut [Mat<f64>; 4]) {
    for r in 0..factors[0].ncols() {
        let norms: [f64; 4] = std::array::from_fn(|m| factors[m].col(r).norm_l2().max(1e-300));
        let mean = norms.iter().map(|n| n.ln()).sum::<f64>() / 4.0;
        for (factor, norm) in factors.iter_mut().zip(norms) {
            for i in 0..factor.nrows() {
                factor[(i, r)] *= mean.exp() / norm;
            }
        }
    }
}

fn gram_of_others(factors: &[Mat<f64>; 4], mode: usize) -> Mat<f64> {
    let rank = factors[0].ncols();
    let mut gram = Mat::full(rank, rank, 1.0);
    for (m, factor) in factors.iter().enumerate() {
        if m != mode {
            let g = factor.transpose() * factor;
            for j in 0..rank {
                for i in 0..rank {
                    gram[(i, j)] *= g[(i, j)];
                }
            }
        }
    }
    gram
}

/// `[(i, j)][r] = a[i][r] · b[j][r]`.
fn khatri_rao(a: &Mat<f64>, b: &Mat<f64>) -> Mat<f64> {
    let n = b.nrows();
    Mat::from_fn(a.nrows() * n, a.ncols(), |i, r| {
        a[(i / n, r)] * b[(i % n, r)]
    })
}

/// Sums `[(i, j)][r]` times `b[j][r]` over j.
fn contract_second(m: &Mat<f64>, b: &Mat<f64>, first: usize, second: usize) -> Mat<f64> {
    Mat::from_fn(first, b.ncols(), |i, r| {
        (0..second)
            .map(|j| m[(i * second + j, r)] * b[(j, r)])
            .sum()
    })
}

/// Sums `[(i, j)][r]` times `a[i][r]` over i.
fn contract_first(m: &Mat<f64>, a: &Mat<f64>, first: usize, second: usize) -> Mat<f64> {
    Mat::from_fn(second, a.ncols(), |j, r| {
        (0..first).map(|i| m[(i * second + j, r)] * a[(i, r)]).sum()
    })
}

fn dot(a: &Mat<f64>, b: &Mat<f64>) -> f64 {
    (0..a.ncols())
        .map(|j| a.col(j).transpose() * b.col(j))
        .sum()
}

fn start(shape: [usize; 4], options: Options) -> [Mat<f64>; 4] {
    let mut rng = Pcg64Mcg::seed_from_u64(options.seed);
    std::array::from_fn(|m| {
        // Leading singular directions first: random weights that fall off with their index.
        Mat::from_fn(shape[m], options.rank, |i, _| {
            let uniform = (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64 - 0.5;
            uniform / (1.0 + 0.3 * i as f64)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recovers_a_sum_of_three_outer_products() {
        let shape = [6, 5, 7, 4];
        let truth = start(
            shape,
            Options {
                rank: 3,
                sweeps: 0,
                seed: 9,
            },
        );
        let mut values = vec![];
        for i in 0..6 {
            for j in 0..5 {
                for k in 0..7 {
                    for l in 0..4 {
                        values.push(
                            (0..3)
                                .map(|r| {
                                    truth[0][(i, r)]
                                        * truth[1][(j, r)]
                                        * truth[2][(k, r)]
                                        * truth[3][(l, r)]
                                })
                                .sum(),
                        );
                    }
                }
            }
        }
        let cpd = decompose(
            &Dense { shape, values },
            Options {
                rank: 3,
                sweeps: 500,
                seed: 1,
            },
        );
        assert!(cpd.error < 1e-4, "{}", cpd.error);
    }
}

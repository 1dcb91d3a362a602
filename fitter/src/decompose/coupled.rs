//! Coupled canonical polyadic decomposition of many four-mode cores: some factor matrices are shared by all of them.
//!
//! Alternating least squares with extrapolation. Plain sweeps crawl through swamps where components nearly cancel.
//! After each sweep the factors are extrapolated along their last step; a step that makes the fit worse is taken back
//! and the extrapolation is shortened. A small ridge keeps components from growing against each other.

use super::tucker::Dense;
use faer::linalg::solvers::{Llt, Solve};
use faer::{Mat, Side};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;

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

/// Factor matrices `[mode length][rank]` of every tensor; shared ones are equal in all of them.
#[derive(Clone)]
pub struct Factors(pub Vec<[Mat<f64>; 4]>);

/// A decomposition and what it leaves.
pub struct Cpd {
    /// The factors.
    pub factors: Factors,
    /// Relative error ‖X − X̂‖ / ‖X‖ of every tensor.
    pub errors: Vec<f64>,
}

/// Weight of the components' squared norms in the objective.
const RIDGE: f64 = 1e-9;

/// Decomposes `cores`, which have equal lengths in the modes that `shared` marks; the first mode is never shared.
/// `progress` is told the sweeps and the root mean square of the relative errors.
pub fn decompose(
    cores: &[Dense],
    shared: [bool; 4],
    options: Options,
    progress: &dyn Fn(usize, f64),
) -> Cpd {
    let problem = Problem::new(cores, shared);
    let mut best = problem.start(cores, options);
    let mut least = Cost::worst();
    let mut factors = best.clone();
    let mut momentum: f64 = 0.5;
    let mut extrapolated = false;
    for sweep in 0..options.sweeps {
        let cost = problem.sweep(&mut factors);
        let worse = cost.objective > least.objective || cost.objective.is_nan();
        if worse && extrapolated {
            // The extrapolation overshot: go on from the best factors with a shorter one.
            factors = best.clone();
            momentum *= 0.7;
            extrapolated = false;
            continue;
        }
        if cost.objective.is_nan() && !least.errors.is_empty() {
            break;
        }
        let previous = std::mem::replace(&mut best, factors.clone());
        least = cost;
        progress(sweep, least.rms());
        momentum = (momentum * 1.05).min(0.99);
        extrapolated = true;
        factors.extrapolate(&previous, momentum);
    }
    problem.restore(&mut best);
    Cpd {
        factors: best,
        errors: least.errors,
    }
}

struct Cost {
    errors: Vec<f64>,
    /// Mean squared error plus the ridge: what every update lowers.
    objective: f64,
}

impl Cost {
    fn worst() -> Self {
        Self {
            errors: vec![],
            objective: f64::INFINITY,
        }
    }

    fn rms(&self) -> f64 {
        let sum: f64 = self.errors.iter().map(|e| e * e).sum();
        (sum / self.errors.len() as f64).sqrt()
    }
}

impl Factors {
    fn extrapolate(&mut self, previous: &Self, momentum: f64) {
        self.0
            .par_iter_mut()
            .zip(&previous.0)
            .for_each(|(now, was)| {
                for (f, p) in now.iter_mut().zip(was) {
                    *f = &*f + (&*f - p) * faer::Scale(momentum);
                }
            });
    }
}

struct Problem {
    /// Unfoldings `[modes 0, 1][modes 2, 3]`, each of norm 1.
    matrices: Vec<Mat<f64>>,
    shapes: Vec<[usize; 4]>,
    norms: Vec<f64>,
    shared: [bool; 4],
}

impl Problem {
    fn new(cores: &[Dense], shared: [bool; 4]) -> Self {
        let norm = |core: &Dense| {
            let square = core.values.iter().map(|v| v * v).sum::<f64>();
            square.sqrt().max(f64::MIN_POSITIVE)
        };
        let norms: Vec<f64> = cores.par_iter().map(norm).collect();
        let unfold = |(core, norm): (&Dense, &f64)| {
            let [a, b, c, d] = core.shape;
            Mat::from_fn(a * b, c * d, |i, j| core.values[i * c * d + j] / norm)
        };
        Self {
            matrices: cores.par_iter().zip(&norms).map(unfold).collect(),
            norms,
            shapes: cores.iter().map(|c| c.shape).collect(),
            shared,
        }
    }

    /// Gives the tensors back their norms, through the first factors, of which each tensor has its own.
    fn restore(&self, factors: &mut Factors) {
        for (f, norm) in factors.0.iter_mut().zip(&self.norms) {
            f[0] *= faer::Scale(*norm);
        }
    }

    /// Updates all factors in turn; returns what is left afterwards.
    fn sweep(&self, factors: &mut Factors) -> Cost {
        let right = self.products(factors, |m, f| m * khatri_rao(&f[2], &f[3]));
        self.update(factors, 0, |k, f| {
            contract_second(&right[k], &f[1], self.shapes[k][0], self.shapes[k][1])
        });
        self.update(factors, 1, |k, f| {
            contract_first(&right[k], &f[0], self.shapes[k][0], self.shapes[k][1])
        });
        let left = self.products(factors, |m, f| m.transpose() * khatri_rao(&f[0], &f[1]));
        self.update(factors, 2, |k, f| {
            contract_second(&left[k], &f[3], self.shapes[k][2], self.shapes[k][3])
        });
        let last = |k: usize, f: &[Mat<f64>; 4]| {
            contract_first(&left[k], &f[2], self.shapes[k][2], self.shapes[k][3])
        };
        self.update(factors, 3, last);
        let parts: Vec<(f64, f64)> = (0..self.matrices.len())
            .into_par_iter()
            .map(|k| residual(&factors.0[k], &last(k, &factors.0[k])))
            .collect();
        self.balance(factors);
        let n = parts.len() as f64;
        Cost {
            errors: parts.iter().map(|(r, _)| r.sqrt()).collect(),
            objective: parts.iter().map(|(r, c)| r + RIDGE * c).sum::<f64>() / n,
        }
    }

    fn products(
        &self,
        factors: &Factors,
        f: impl Fn(&Mat<f64>, &[Mat<f64>; 4]) -> Mat<f64> + Sync,
    ) -> Vec<Mat<f64>> {
        let pairs = self.matrices.par_iter().zip(&factors.0);
        pairs.map(|(matrix, factors)| f(matrix, factors)).collect()
    }

    /// Solves for the factors of `mode`, given the product of each tensor with all others.
    fn update(
        &self,
        factors: &mut Factors,
        mode: usize,
        product: impl Fn(usize, &[Mat<f64>; 4]) -> Mat<f64> + Sync,
    ) {
        let system = |(k, f): (usize, &[Mat<f64>; 4])| (gram_of_others(f, mode), product(k, f));
        if !self.shared[mode] {
            factors.0.par_iter_mut().enumerate().for_each(|(k, f)| {
                let (gram, product) = system((k, f));
                if let Some(new) = solve(gram, &product) {
                    f[mode] = new;
                }
            });
            return;
        }
        let systems: Vec<_> = factors.0.par_iter().enumerate().map(system).collect();
        let sum = systems.into_iter().reduce(|a, b| (a.0 + b.0, a.1 + b.1));
        if let Some(new) = sum.and_then(|(gram, product)| solve(gram, &product)) {
            factors.0.iter_mut().for_each(|f| f[mode] = new.clone());
        }
    }

    /// Gives all factors of a component the same norm, as far as shared ones allow.
    fn balance(&self, factors: &mut Factors) {
        let rank = factors.0[0][0].ncols();
        let count = factors.0.len() as f64;
        for r in 0..rank {
            // Root mean square over the tensors.
            let norm = |m: usize| {
                let sum: f64 = factors
                    .0
                    .iter()
                    .map(|f| f[m].col(r).squared_norm_l2())
                    .sum();
                (sum / count).sqrt().max(1e-300)
            };
            let norms: [f64; 4] = std::array::from_fn(norm);
            let mean = (norms.iter().map(|n| n.ln()).sum::<f64>() / 4.0).exp();
            for f in &mut factors.0 {
                for (factor, norm) in f.iter_mut().zip(norms) {
                    for i in 0..factor.nrows() {
                        factor[(i, r)] *= mean / norm;
                    }
                }
            }
        }
    }

    fn start(&self, cores: &[Dense], options: Options) -> Factors {
        let mut rng = Pcg64Mcg::seed_from_u64(options.seed);
        // Leading singular directions first: random weights that fall off with their index.
        let mut random = |rows: usize| {
            Mat::from_fn(rows, options.rank, |i, _| {
                let uniform = (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64 - 0.5;
                uniform / (1.0 + 0.3 * i as f64)
            })
        };
        let mut all: Vec<[Mat<f64>; 4]> = vec![];
        for core in cores {
            let next = std::array::from_fn(|m| match all.first() {
                Some(first) if self.shared[m] => first[m].clone(),
                _ => random(core.shape[m]),
            });
            all.push(next);
        }
        Factors(all)
    }
}

/// Squared error of a tensor of norm 1 and the sum of its components' squared norms, given its product with the first
/// three factors.
fn residual(factors: &[Mat<f64>; 4], product: &Mat<f64>) -> (f64, f64) {
    let overlap = dot(product, &factors[3]);
    let gram = gram_of_others(factors, 3);
    let last = factors[3].transpose() * &factors[3];
    let components = (0..gram.nrows()).map(|r| gram[(r, r)] * last[(r, r)]).sum();
    (
        (1.0 - 2.0 * overlap + dot(&gram, &last)).max(0.0),
        components,
    )
}

fn solve(mut gram: Mat<f64>, product: &Mat<f64>) -> Option<Mat<f64>> {
    // Relative to each component, so that small ones are not put down.
    for i in 0..gram.nrows() {
        gram[(i, i)] *= 1.0 + RIDGE;
    }
    let llt = Llt::new(gram.as_ref(), Side::Lower).ok()?;
    Some(llt.solve(product.transpose()).transpose().to_owned())
}

fn gram_of_others(factors: &[Mat<f64>; 4], mode: usize) -> Mat<f64> {
    let rank = factors[0].ncols();
    let mut gram = Mat::full(rank, rank, 1.0);
    for (m, factor) in factors.iter().enumerate() {
        if m != mode {
            let g = factor.transpose() * factor;
            faer::zip!(&mut gram, &g).for_each(|faer::unzip!(a, b)| *a *= *b);
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
        let (m, b) = (m.col_as_slice(r), b.col_as_slice(r));
        let row = &m[i * second..][..second];
        row.iter().zip(b).map(|(x, y)| x * y).sum()
    })
}

/// Sums `[(i, j)][r]` times `a[i][r]` over i.
fn contract_first(m: &Mat<f64>, a: &Mat<f64>, first: usize, second: usize) -> Mat<f64> {
    let mut out = Mat::zeros(second, a.ncols());
    for r in 0..a.ncols() {
        let (m, a) = (m.col_as_slice(r), a.col_as_slice(r));
        let out = out.col_as_slice_mut(r);
        for i in 0..first {
            for (o, x) in out.iter_mut().zip(&m[i * second..][..second]) {
                *o += a[i] * x;
            }
        }
    }
    out
}

fn dot(a: &Mat<f64>, b: &Mat<f64>) -> f64 {
    (0..a.ncols())
        .map(|j| a.col(j).transpose() * b.col(j))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn compose(factors: &[Mat<f64>; 4]) -> Dense {
        let shape: [usize; 4] = std::array::from_fn(|m| factors[m].nrows());
        let [a, b, c, d] = shape;
        let matrix =
            khatri_rao(&factors[0], &factors[1]) * khatri_rao(&factors[2], &factors[3]).transpose();
        let values = (0..a * b)
            .flat_map(|i| (0..c * d).map(move |j| (i, j)))
            .map(|(i, j)| matrix[(i, j)])
            .collect();
        Dense { shape, values }
    }

    #[test]
    fn recovers_tensors_that_share_two_factor_matrices() {
        let empty = |shape: [usize; 4]| Dense {
            shape,
            values: vec![1.0; shape.iter().product()],
        };
        let cores = [empty([6, 5, 7, 4]), empty([8, 5, 3, 4])];
        let shared = [false, true, false, true];
        let options = |sweeps, seed| Options {
            rank: 3,
            sweeps,
            seed,
        };
        let truth = Problem::new(&cores, shared).start(&cores, options(0, 9));
        let cores: Vec<Dense> = truth.0.iter().map(compose).collect();
        let cpd = decompose(&cores, shared, options(500, 1), &|_, _| {});
        assert!(cpd.errors.iter().all(|e| *e < 1e-4), "{:?}", cpd.errors);
        for (f, core) in cpd.factors.0.iter().zip(&cores) {
            let pairs = compose(f).values.into_iter().zip(core.values.clone());
            assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-3));
        }
        assert_eq!(cpd.factors.0[0][1], cpd.factors.0[1][1]);
    }
}

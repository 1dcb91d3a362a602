//! A phase function as a sum of Henyey-Greenstein functions, which is what a model file can say.

use super::simplex::minimise;
use crate::atmosphere::matrix::{Matrix, NODES, angle};
use crate::non_negative;
use nalgebra::{DMatrix, DVector};

/// Weight and asymmetry parameter of each function; the weights add up to 1, and may be negative.
pub type Lobes = Vec<[f64; 2]>;

/// Sharper lobes would lose digits in single precision: at the centre, 1 + g² − 2g cos θ is (1 − g)².
const SHARPEST: f64 = 0.992;
/// Errors count relative to the phase function, evenly over the logarithm of the angle from here (rad) on.
const INNERMOST: f64 = 0.02;
/// How much the sum of the weights counts, and their size: large ones that cancel lose digits.
const SUM: f64 = 100.0;
const SIZE: f64 = 0.03;
/// Every so many nodes of the matrix are fitted: in the forward peak and beyond.
const STRIDE: [usize; 2] = [2, 4];
/// Most trials from one start.
const TRIALS: usize = 600;
/// Relative error that is small enough.
const ENOUGH: f64 = 0.03;

/// Asymmetries to start from; any number of lobes takes the first so many.
const STARTS: [[f64; 6]; 3] = [
    [0.6, 0.83, -0.3, 0.15, 0.95, 0.98],
    [0.95, 0.6, -0.6, 0.1, 0.98, 0.3],
    [0.7, 0.9, -0.4, 0.3, 0.97, -0.8],
];

/// Most lobes.
pub const MOST: usize = STARTS[0].len();

/// What weights may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Signs {
    /// Anything.
    Any,
    /// Not negative.
    Positive,
}

/// As few lobes as make the phase functions well, at most `most`, for every wavelength of `matrix`.
pub fn fit_well(matrix: &Matrix, most: usize) -> Vec<Lobes> {
    let middle = Target::new(matrix, matrix.wavelengths() / 2, Signs::Any);
    let well = |count: &usize| middle.error(&middle.first(*count).1) < ENOUGH;
    fit(matrix, (1..most).find(well).unwrap_or(most), Signs::Any)
}

/// The best `count` lobes for every wavelength of `matrix`; each starts from those of its neighbour, so that they change
/// smoothly.
pub fn fit(matrix: &Matrix, count: usize, signs: Signs) -> Vec<Lobes> {
    let count = count.clamp(1, MOST);
    let wavelengths = matrix.wavelengths();
    let middle = wavelengths / 2;
    let (mut first, _) = Target::new(matrix, middle, signs).first(count);
    first.sort_by(|a, b| b.total_cmp(a));
    let mut out = vec![vec![]; wavelengths];
    let mut follow = |order: &mut dyn Iterator<Item = usize>| {
        let mut at = first.clone();
        for w in order {
            let target = Target::new(matrix, w, signs);
            at = target.best(&at).0;
            out[w] = target.lobes(&at);
        }
    };
    follow(&mut (middle..wavelengths));
    follow(&mut (0..middle).rev());
    out
}

/// Value of a sum of lobes at the cosine of a scattering angle.
pub fn value(lobes: &[[f64; 2]], cosine: f64) -> f64 {
    lobes
        .iter()
        .map(|[weight, g]| weight * henyey_greenstein(*g, cosine))
        .sum()
}

/// A phase function at the angles that are fitted.
struct Target {
    cosine: Vec<f64>,
    value: Vec<f64>,
    /// Roots of weights.
    weight: Vec<f64>,
    signs: Signs,
}

impl Target {
    fn new(matrix: &Matrix, w: usize, signs: Signs) -> Self {
        let fine = (0..100).step_by(STRIDE[0]);
        let nodes: Vec<usize> = fine.chain((100..NODES).step_by(STRIDE[1])).collect();
        let width = |i: usize| if i < 100 { 0.2f64 } else { 1.0 };
        let weight = |i: &usize| (width(*i).to_radians() / (angle(*i) + INNERMOST)).sqrt();
        Self {
            cosine: nodes.iter().map(|&i| angle(i).cos()).collect(),
            value: nodes.iter().map(|&i| matrix.at(w, i)[0]).collect(),
            weight: nodes.iter().map(weight).collect(),
            signs,
        }
    }

    /// The best of so many lobes, as coordinates and as they are.
    fn first(&self, count: usize) -> (Vec<f64>, Lobes) {
        let starts = STARTS.iter().map(|g| coordinates(&g[..count]));
        let tries = starts.map(|start| self.best(&start));
        let best = tries.min_by(|a, b| a.1.total_cmp(&b.1));
        let (x, _) = best.expect("there are starts");
        let lobes = self.lobes(&x);
        (x, lobes)
    }

    /// Coordinates of the best asymmetries from a start, and their cost.
    fn best(&self, start: &[f64]) -> (Vec<f64>, f64) {
        let cost = |x: &[f64]| self.cost(x);
        let (x, _) = minimise(&cost, start, 0.4, TRIALS);
        minimise(&cost, &x, 0.1, TRIALS)
    }

    fn cost(&self, x: &[f64]) -> f64 {
        let lobes = self.lobes(x);
        let size: f64 = lobes.iter().map(|l| (SIZE * l[0]).powi(2)).sum();
        self.squares(&lobes) + size
    }

    fn squares(&self, lobes: &[[f64; 2]]) -> f64 {
        let sites = self.cosine.iter().zip(&self.value).zip(&self.weight);
        sites
            .map(|((c, p), weight)| (weight * (value(lobes, *c) / p - 1.0)).powi(2))
            .sum()
    }

    /// Root mean square of the relative error.
    fn error(&self, lobes: &[[f64; 2]]) -> f64 {
        let total: f64 = self.weight.iter().map(|w| w * w).sum();
        (self.squares(lobes) / total).sqrt()
    }

    /// The lobes with the best weights for these asymmetries.
    fn lobes(&self, x: &[f64]) -> Lobes {
        let g: Vec<f64> = x.iter().map(|x| asymmetry(*x)).collect();
        let sites = self.cosine.iter().zip(&self.value).zip(&self.weight);
        let row = |((c, p), weight): ((&f64, &f64), &f64)| -> Vec<f64> {
            let one = |g: &f64| weight * henyey_greenstein(*g, *c) / p;
            g.iter().map(one).collect()
        };
        let mut rows: Vec<Vec<f64>> = sites.map(row).collect();
        let mut wanted = self.weight.clone();
        rows.push(vec![SUM; g.len()]);
        wanted.push(SUM);
        let weights = match self.signs {
            Signs::Positive => non_negative::least_squares(&rows, &wanted),
            Signs::Any => least_squares(&rows, &wanted),
        };
        let sum: f64 = weights.iter().sum();
        let pairs = weights.iter().zip(g);
        pairs.map(|(weight, g)| [weight / sum, g]).collect()
    }
}

/// With weights of any sign, none of them large.
fn least_squares(rows: &[Vec<f64>], wanted: &[f64]) -> Vec<f64> {
    let n = rows[0].len();
    let mut normal = DMatrix::from_diagonal_element(n, n, SIZE * SIZE);
    let mut right = DVector::zeros(n);
    for (row, wanted) in rows.iter().zip(wanted) {
        for i in 0..n {
            right[i] += wanted * row[i];
            for j in 0..n {
                normal[(i, j)] += row[i] * row[j];
            }
        }
    }
    match normal.cholesky() {
        Some(cholesky) => cholesky.solve(&right).iter().copied().collect(),
        None => vec![1.0 / n as f64; n],
    }
}

fn asymmetry(x: f64) -> f64 {
    SHARPEST * x.tanh()
}

fn coordinates(g: &[f64]) -> Vec<f64> {
    g.iter().map(|g| (g / SHARPEST).atanh()).collect()
}

fn henyey_greenstein(g: f64, c: f64) -> f64 {
    let d = 1.0 + g * g - 2.0 * g * c;
    (1.0 - g * g) / (d * d.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::Phase;
    use crate::particles::opac::Spheres;

    fn matrix(name: &str, wavelengths: &[f64]) -> std::sync::Arc<Matrix> {
        let spheres = Spheres::new(name, 0.0).unwrap().unwrap();
        match spheres.phase(wavelengths).unwrap() {
            Phase::Tabulated(matrix) => matrix,
            _ => panic!("no matrix"),
        }
    }

    #[test]
    fn more_lobes_are_nearer_and_their_mean_is_one() {
        let matrix = matrix("inso", &[550.0]);
        let error = |count: usize| {
            let lobes = fit(&matrix, count, Signs::Any).remove(0);
            let sum: f64 = lobes.iter().map(|l| l[0]).sum();
            assert!((sum - 1.0).abs() < 1e-9);
            let errors = (0..NODES).map(|i| {
                let p = matrix.at(0, i)[0];
                (value(&lobes, angle(i).cos()) / p - 1.0).abs()
            });
            errors.sum::<f64>() / NODES as f64
        };
        let errors = [1, 2, 3, 5].map(error);
        println!("{errors:?}");
        assert!(errors.windows(2).all(|e| e[1] < e[0]), "{errors:?}");
        assert!(errors[3] < 0.05, "{errors:?}");
    }

    #[test]
    fn what_is_two_lobes_is_found() {
        let angles: Vec<f64> = (0..=720).map(|i| 0.25 * f64::from(i)).collect();
        let truth = vec![[0.7, 0.8], [0.3, -0.3]];
        let row = |a: &f64| [value(&truth, a.to_radians().cos()).ln(), 0.0, 0.0];
        let matrix = Matrix::resample(&angles, &[angles.iter().map(row).collect()]).unwrap();
        let found = fit(&matrix, 2, Signs::Positive).remove(0);
        for (a, b) in found.iter().zip(&truth) {
            assert!(
                (a[0] - b[0]).abs() < 0.01 && (a[1] - b[1]).abs() < 0.01,
                "{found:?}"
            );
        }
    }
}

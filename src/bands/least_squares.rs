//! Least squares with weights that are not negative, after Lawson & Hanson 1974, and a choice of few columns.

/// A matrix and a right side, with the matrix compressed to about as many rows as it has columns.
pub(super) struct Problem {
    /// Columns of the original matrix, `[column][row]`.
    columns: Vec<Vec<f64>>,
    right: Vec<f64>,
    /// The same after orthogonal transformations that leave squares of residuals as they are; unit columns.
    compressed: Vec<Vec<f64>>,
    compressed_right: Vec<f64>,
    /// Length of the columns.
    scale: Vec<f64>,
}

/// How many times as many rows as columns are worth compressing.
const WORTHWHILE: usize = 2;

/// A column that counts, with its weight.
pub(super) type Weights = Vec<(usize, f64)>;

impl Problem {
    pub fn new(columns: Vec<Vec<f64>>, right: Vec<f64>) -> Self {
        let scale: Vec<f64> = columns.iter().map(|c| dot(c, c).sqrt()).collect();
        let unit = |(c, &s): (&Vec<f64>, &f64)| scaled(c, if s > 0.0 { 1.0 / s } else { 0.0 });
        let mut compressed: Vec<Vec<f64>> = columns.iter().zip(&scale).map(unit).collect();
        compressed.push(right.clone());
        if right.len() > WORTHWHILE * compressed.len() {
            let rows = triangularise(&mut compressed);
            compressed.iter_mut().for_each(|c| c.truncate(rows));
        }
        let compressed_right = compressed.pop().unwrap_or_default();
        Self {
            columns,
            right,
            compressed,
            compressed_right,
            scale,
        }
    }

    /// How many columns there are.
    pub fn len(&self) -> usize {
        self.columns.len()
    }

    /// The best weights, none negative, of some columns.
    pub fn solve(&self, allowed: &[usize]) -> Weights {
        let mut kept: Weights = Vec::new();
        // Every column enters and leaves a few times at most.
        for _ in 0..3 * allowed.len() {
            let Some(entering) = self.steepest(allowed, &kept) else {
                break;
            };
            kept.push((entering, 0.0));
            if !self.descend(&mut kept, entering) {
                break;
            }
        }
        kept.sort_unstable_by_key(|&(column, _)| column);
        let unscale = |(c, w): (usize, f64)| (c, w / self.scale[c]);
        kept.into_iter()
            .map(unscale)
            .filter(|w| w.1 > 0.0)
            .collect()
    }

    /// The column that lessens the residual most, if any does.
    fn steepest(&self, allowed: &[usize], kept: &Weights) -> Option<usize> {
        const STEEP: f64 = 1e-12;
        let mut residual = self.compressed_right.clone();
        for &(column, weight) in kept {
            add(&mut residual, -weight, &self.compressed[column]);
        }
        let outside = |&&c: &&usize| !kept.iter().any(|k| k.0 == c);
        let slopes = allowed.iter().filter(outside);
        let slopes = slopes.map(|&c| (c, dot(&self.compressed[c], &residual)));
        let best = slopes.max_by(|a, b| a.1.total_cmp(&b.1))?;
        let enough = STEEP * dot(&self.compressed_right, &self.compressed_right).sqrt();
        (best.1 > enough).then_some(best.0)
    }

    /// Goes to the least residual of the kept columns, dropping those that would turn negative on the way. False if the
    /// one that enters is among these: then rounding decides, and there is nothing to gain.
    fn descend(&self, kept: &mut Weights, entering: usize) -> bool {
        loop {
            let target = self.unbounded(kept);
            let blocking = kept.iter().zip(&target).filter(|(_, t)| **t <= 0.0);
            let share = |(k, t): (&(usize, f64), &f64)| k.1 / (k.1 - t).max(f64::MIN_POSITIVE);
            let Some(step) = blocking.map(share).min_by(f64::total_cmp) else {
                let pairs = kept.iter_mut().zip(target);
                pairs.for_each(|(k, t)| k.1 = t);
                return true;
            };
            let pairs = kept.iter_mut().zip(&target);
            pairs.for_each(|(k, t)| k.1 += step * (t - k.1));
            let gone = |(k, t): (&(usize, f64), &f64)| *t <= 0.0 && k.1 <= 1e-15;
            let mut gone: Vec<usize> = (kept.iter().zip(&target).enumerate())
                .filter(|(_, pair)| gone(*pair))
                .map(|(i, _)| i)
                .collect();
            if gone.iter().any(|&i| kept[i].0 == entering) || gone.is_empty() {
                kept.retain(|k| k.1 > 1e-15);
                return false;
            }
            while let Some(i) = gone.pop() {
                kept.remove(i);
            }
        }
    }

    /// The best weights of the kept columns, whatever their signs.
    fn unbounded(&self, kept: &Weights) -> Vec<f64> {
        let column = |&(c, _): &(usize, f64)| self.compressed[c].clone();
        let mut matrix: Vec<Vec<f64>> = kept.iter().map(column).collect();
        matrix.push(self.compressed_right.clone());
        triangularise(&mut matrix);
        let n = kept.len();
        let mut out = vec![0.0; n];
        for i in (0..n).rev() {
            let known: f64 = (i + 1..n).map(|j| matrix[j][i] * out[j]).sum();
            let pivot = matrix[i][i];
            // A column that depends on the others has nothing to say.
            let dependent = pivot.abs() < 1e-13;
            out[i] = match dependent {
                true => 0.0,
                false => (matrix[n][i] - known) / pivot,
            };
        }
        out
    }

    /// Largest residuals but for a share of them, and their median: of absolute values.
    pub fn residuals(&self, weights: &Weights, share: f64) -> [f64; 2] {
        let mut residual = self.right.clone();
        for &(column, weight) in weights {
            add(&mut residual, -weight, &self.columns[column]);
        }
        let mut sizes: Vec<f64> = residual.into_iter().map(f64::abs).collect();
        sizes.sort_unstable_by(f64::total_cmp);
        let last = sizes.len().saturating_sub(1) as f64;
        [0.5, share].map(|q| {
            sizes
                .get((q * last).round() as usize)
                .copied()
                .unwrap_or(0.0)
        })
    }
}

/// Householder reflections that make a matrix of columns upper triangular; how many rows are left.
fn triangularise(columns: &mut [Vec<f64>]) -> usize {
    let rows = columns.first().map_or(0, Vec::len);
    for i in 0..columns.len().min(rows) {
        let (done, rest) = columns.split_at_mut(i + 1);
        let tail = &done[i][i..];
        let norm = dot(tail, tail).sqrt();
        if norm == 0.0 {
            continue;
        }
        let mut mirror = tail.to_vec();
        mirror[0] += norm.copysign(mirror[0]);
        let square = dot(&mirror, &mirror);
        let reflect = |column: &mut Vec<f64>| {
            let share = 2.0 * dot(&mirror, &column[i..]) / square;
            add(&mut column[i..], -share, &mirror);
        };
        reflect(&mut done[i]);
        done[i][i + 1..].fill(0.0);
        rest.iter_mut().for_each(reflect);
    }
    columns.len().min(rows)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn add(sum: &mut [f64], weight: f64, values: &[f64]) {
    sum.iter_mut()
        .zip(values)
        .for_each(|(s, v)| *s += weight * v);
}

fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|v| v * factor).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pseudo-random numbers in 0..1.
    fn noise(seed: u64) -> impl Iterator<Item = f64> {
        let mut state = seed;
        std::iter::repeat_with(move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 53) as f64
        })
    }

    #[test]
    fn finds_weights_that_are_exact() {
        let mut random = noise(1);
        let columns: Vec<Vec<f64>> = (0..9).map(|_| random.by_ref().take(50).collect()).collect();
        let mut right = vec![0.0; 50];
        let truth = [(1, 0.5), (4, 2.0), (7, 0.01)];
        truth
            .iter()
            .for_each(|&(c, w)| add(&mut right, w, &columns[c]));
        let found = Problem::new(columns, right).solve(&[0, 1, 2, 3, 4, 5, 6, 7, 8]);
        assert_eq!(found.len(), 3);
        for ((c, w), (column, weight)) in found.into_iter().zip(truth) {
            assert!(c == column && (w / weight - 1.0).abs() < 1e-9, "{c} {w}");
        }
    }

    /// At the minimum no column that counts has a slope, and no other one a slope that helps.
    #[test]
    fn satisfies_the_conditions_of_a_minimum() {
        for seed in 1..40 {
            let mut random = noise(seed);
            let columns: Vec<Vec<f64>> =
                (0..8).map(|_| random.by_ref().take(30).collect()).collect();
            let right: Vec<f64> = random.by_ref().take(30).map(|v| v - 0.3).collect();
            let all: Vec<usize> = (0..8).collect();
            let problem = Problem::new(columns.clone(), right.clone());
            let found = problem.solve(&all);
            let mut residual = right;
            found
                .iter()
                .for_each(|&(c, w)| add(&mut residual, -w, &columns[c]));
            for (c, column) in columns.iter().enumerate() {
                let slope = dot(column, &residual);
                match found.iter().any(|&(f, w)| f == c && w > 0.0) {
                    true => assert!(slope.abs() < 1e-8, "{seed} {c} {slope}"),
                    false => assert!(slope < 1e-8, "{seed} {c} {slope}"),
                }
            }
        }
    }

    #[test]
    fn columns_that_are_the_same_do_no_harm() {
        let column = vec![1.0, 2.0, 3.0];
        let problem = Problem::new(vec![column.clone(), column.clone(), vec![0.0; 3]], column);
        let found = problem.solve(&[0, 1, 2]);
        let sum: f64 = found.iter().map(|w| w.1).sum();
        assert!((sum - 1.0).abs() < 1e-12);
        assert!(problem.residuals(&found, 0.99)[1] < 1e-12);
    }
}

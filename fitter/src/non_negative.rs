//! Least squares with weights that are not negative.

use nalgebra::{DMatrix, DVector};

/// The `x ≥ 0` that makes the sum of squares of `rows · x − wanted` least (Lawson & Hanson 1974).
pub fn least_squares(rows: &[Vec<f64>], wanted: &[f64]) -> Vec<f64> {
    let columns = rows[0].len();
    let a = DMatrix::from_fn(rows.len(), columns, |i, j| rows[i][j]);
    let b = DVector::from_column_slice(wanted);
    let (normal, right) = (a.tr_mul(&a), a.tr_mul(&b));
    let mut x = DVector::zeros(columns);
    let mut free: Vec<usize> = vec![];
    let tolerance = 1e-11 * right.amax().max(1e-300);
    for _ in 0..10 * columns {
        let gradient = &right - &normal * &x;
        let idle = (0..columns).filter(|j| !free.contains(j));
        let best = idle.max_by(|&i, &j| gradient[i].total_cmp(&gradient[j]));
        match best {
            Some(j) if gradient[j] > tolerance => free.push(j),
            _ => break,
        }
        while let Some(z) = solve(&normal, &right, &free) {
            if z.iter().all(|&v| v > 0.0) {
                x.fill(0.0);
                free.iter().zip(z.iter()).for_each(|(&j, &v)| x[j] = v);
                break;
            }
            // As far towards z as all stay positive; those that reach 0 are fixed there.
            let ratio = |(k, &j): (usize, &usize)| x[j] / (x[j] - z[k]);
            let falling = free.iter().enumerate().filter(|&(k, _)| z[k] <= 0.0);
            let step = falling.map(ratio).fold(1.0, f64::min);
            for (k, &j) in free.iter().enumerate() {
                x[j] += step * (z[k] - x[j]);
            }
            free.retain(|&j| x[j] > 1e-14);
            if free.is_empty() {
                break;
            }
        }
    }
    x.iter().map(|v: &f64| v.max(0.0)).collect()
}

/// Least squares in the columns `free` alone.
fn solve(normal: &DMatrix<f64>, right: &DVector<f64>, free: &[usize]) -> Option<DVector<f64>> {
    let n = free.len();
    let a = DMatrix::from_fn(n, n, |i, j| {
        let ridge = if i == j { 1.0 + 1e-12 } else { 1.0 };
        normal[(free[i], free[j])] * ridge
    });
    let b = DVector::from_fn(n, |i, _| right[free[i]]);
    a.cholesky().map(|c| c.solve(&b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_answer_is_the_best_of_those_that_are_not_negative() {
        let rows = vec![
            vec![1.0, 1.0, 0.0],
            vec![0.0, 1.0, 1.0],
            vec![1.0, 0.0, 1.0],
        ];
        let x = least_squares(&rows, &[1.0, 2.0, 3.0]);
        let expected = [1.0, 0.0, 2.0];
        assert!(
            x.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6),
            "{x:?}"
        );
        // Without the bound the second would be −1.
        let x = least_squares(&[vec![1.0, 1.0], vec![0.0, 1.0]], &[1.0, -1.0]);
        assert!((x[0] - 1.0).abs() < 1e-6 && x[1] == 0.0, "{x:?}");
    }
}

//! Least squares within bounds: Levenberg and Marquardt, with derivatives by differences.

use anyhow::Result;
use nalgebra::{DMatrix, DVector};

/// What is varied.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Where it starts.
    pub start: f64,
    /// Least and most.
    pub bounds: [f64; 2],
    /// Step of the differences.
    pub step: f64,
}

const ROUNDS: usize = 40;

/// The parameters with the least sum of squares of `residuals`, which are as many for all of them.
pub fn minimise(
    parameters: &[Parameter],
    residuals: impl Fn(&[f64]) -> Result<Vec<f64>>,
) -> Result<Vec<f64>> {
    let mut at: Vec<f64> = parameters.iter().map(|p| p.start).collect();
    let mut now = residuals(&at)?;
    let mut damping = 1e-3;
    for _ in 0..ROUNDS {
        let slopes = slopes(parameters, &at, &now, &residuals)?;
        let mut better = None;
        while better.is_none() && damping < 1e8 {
            let next = moved(parameters, &at, &slopes, &now, damping);
            let there = residuals(&next)?;
            if square(&there) < square(&now) {
                better = Some((next, there));
                damping *= 0.3;
            } else {
                damping *= 4.0;
            }
        }
        let Some((next, there)) = better else { break };
        let gain = 1.0 - square(&there) / square(&now);
        (at, now) = (next, there);
        if gain < 1e-9 {
            break;
        }
    }
    Ok(at)
}

fn square(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum()
}

fn slopes(
    parameters: &[Parameter],
    at: &[f64],
    now: &[f64],
    residuals: &impl Fn(&[f64]) -> Result<Vec<f64>>,
) -> Result<DMatrix<f64>> {
    let mut slopes = DMatrix::zeros(now.len(), parameters.len());
    for (j, parameter) in parameters.iter().enumerate() {
        let mut beside = at.to_vec();
        let up = at[j] + parameter.step <= parameter.bounds[1];
        let step = if up { parameter.step } else { -parameter.step };
        beside[j] += step;
        for (i, there) in residuals(&beside)?.into_iter().enumerate() {
            slopes[(i, j)] = (there - now[i]) / step;
        }
    }
    Ok(slopes)
}

fn moved(
    parameters: &[Parameter],
    at: &[f64],
    slopes: &DMatrix<f64>,
    now: &[f64],
    damping: f64,
) -> Vec<f64> {
    let mut normal = slopes.transpose() * slopes;
    for j in 0..parameters.len() {
        normal[(j, j)] = normal[(j, j)] * (1.0 + damping) + 1e-12;
    }
    let down = slopes.transpose() * DVector::from_row_slice(now);
    let step = normal.lu().solve(&down).unwrap_or(down);
    let to = |(j, parameter): (usize, &Parameter)| {
        let [least, most] = parameter.bounds;
        (at[j] - step[j]).clamp(least, most)
    };
    parameters.iter().enumerate().map(to).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exponential_is_found_again_and_bounds_hold() {
        let truth = [1.7, 0.4];
        let value = |p: &[f64], x: f64| p[0] * (-p[1] * x).exp();
        let x: Vec<f64> = (0..20).map(|i| 0.3 * f64::from(i)).collect();
        let residuals = |p: &[f64]| -> Result<Vec<f64>> {
            Ok(x.iter().map(|&x| value(p, x) - value(&truth, x)).collect())
        };
        let parameter = |start: f64, bounds: [f64; 2]| Parameter {
            start,
            bounds,
            step: 1e-4,
        };
        let free = [parameter(1.0, [0.0, 9.0]), parameter(1.0, [0.0, 9.0])];
        let found = minimise(&free, residuals).unwrap();
        assert!((found[0] - 1.7).abs() < 1e-4 && (found[1] - 0.4).abs() < 1e-4);
        let bound = [parameter(1.0, [0.0, 1.5]), parameter(1.0, [0.0, 9.0])];
        assert_eq!(minimise(&bound, residuals).unwrap()[0], 1.5);
    }
}

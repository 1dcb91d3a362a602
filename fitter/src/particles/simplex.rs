//! The least of a function of a few variables (Nelder and Mead 1965).

/// A point that makes `cost` least, from `start` with steps of `size`, by at most `most` trials.
pub fn minimise(
    cost: &dyn Fn(&[f64]) -> f64,
    start: &[f64],
    size: f64,
    most: usize,
) -> (Vec<f64>, f64) {
    let valued = |x: Vec<f64>| {
        let value = cost(&x);
        (x, value)
    };
    let mut points = vec![valued(start.to_vec())];
    for k in 0..start.len() {
        let mut x = start.to_vec();
        x[k] += size;
        points.push(valued(x));
    }
    let last = start.len();
    for _ in 0..most {
        points.sort_by(|a, b| a.1.total_cmp(&b.1));
        if points[last].1 - points[0].1 <= 1e-9 * points[0].1.abs() {
            break;
        }
        let middle: Vec<f64> = (0..last)
            .map(|k| points[..last].iter().map(|p| p.0[k]).sum::<f64>() / last as f64)
            .collect();
        let beyond = |factor: f64| {
            let worst = &points[last].0;
            let pairs = middle.iter().zip(worst);
            valued(pairs.map(|(m, w)| m + factor * (m - w)).collect())
        };
        let reflected = beyond(1.0);
        let better = match reflected.1 {
            v if v < points[0].1 => {
                let far = beyond(2.0);
                Some(if far.1 < v { far } else { reflected })
            }
            v if v < points[last - 1.min(last)].1 => Some(reflected),
            v => {
                let near = beyond(if v < points[last].1 { 0.5 } else { -0.5 });
                (near.1 < points[last].1).then_some(near)
            }
        };
        match better {
            Some(point) => points[last] = point,
            None => {
                let best = points[0].0.clone();
                for point in &mut points[1..] {
                    let pairs = point.0.iter().zip(&best);
                    *point = valued(pairs.map(|(x, b)| 0.5 * (x + b)).collect());
                }
            }
        }
    }
    points.sort_by(|a, b| a.1.total_cmp(&b.1));
    points.swap_remove(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rosenbrock's valley.
    #[test]
    fn the_end_of_a_bent_valley_is_found() {
        let valley = |x: &[f64]| (1.0 - x[0]).powi(2) + 100.0 * (x[1] - x[0] * x[0]).powi(2);
        let (x, value) = minimise(&valley, &[-1.2, 1.0], 0.3, 500);
        assert!(value < 1e-8, "{value}");
        assert!(
            (x[0] - 1.0).abs() < 1e-3 && (x[1] - 1.0).abs() < 1e-3,
            "{x:?}"
        );
    }

    #[test]
    fn one_variable_is_enough() {
        let (x, _) = minimise(&|x: &[f64]| (x[0] - 3.0).powi(2), &[0.0], 0.5, 200);
        assert!((x[0] - 3.0).abs() < 1e-3, "{x:?}");
    }
}

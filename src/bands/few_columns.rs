//! Few columns that many least-squares problems share.

use super::least_squares::{Problem, Weights};

/// The share of residuals that must keep a tolerance.
pub(super) const MOST: f64 = 0.99;

/// How much worse than with all columns a problem may get that misses the tolerance even with them.
const SLACK: f64 = 1.1;

/// For each problem weights with residuals up to `tolerance` (p99), or close to the least there are, of at most `most`
/// columns. `given` ones cost nothing.
pub(super) fn choose(
    problems: &[Problem],
    given: &[usize],
    tolerance: f64,
    most: usize,
) -> Vec<Weights> {
    let best: Vec<Weights> = problems.iter().map(|p| p.solve(&all(p))).collect();
    let goals = problems.iter().zip(&best);
    let goals: Vec<f64> = goals
        .map(|(p, w)| tolerance.max(SLACK * p.residuals(w, MOST)[1]))
        .collect();
    let mut candidates: Vec<usize> = best.iter().flatten().map(|w| w.0).collect();
    candidates.sort_unstable();
    candidates.dedup();
    let mut chosen = given.to_vec();
    while let Some(worst) = worst(problems, &goals, &chosen).filter(|_| chosen.len() < most) {
        let left = candidates.iter().filter(|c| !chosen.contains(c));
        let tried = left.map(|&c| {
            let columns: Vec<usize> = chosen.iter().copied().chain([c]).collect();
            (c, residual(&problems[worst], &columns))
        });
        let Some((next, _)) = tried.min_by(|a, b| a.1.total_cmp(&b.1)) else {
            break;
        };
        chosen.push(next);
    }
    prune(problems, &goals, &mut chosen, given.len());
    problems.iter().map(|p| p.solve(&chosen)).collect()
}

/// The problem that misses its goal most, if one does.
fn worst(problems: &[Problem], goals: &[f64], chosen: &[usize]) -> Option<usize> {
    let misses = problems.iter().zip(goals).enumerate();
    misses
        .map(|(i, (p, goal))| (i, residual(p, chosen) / goal))
        .filter(|&(_, miss)| miss > 1.0)
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(i, _)| i)
}

/// Drops columns that later ones have made needless.
fn prune(problems: &[Problem], goals: &[f64], chosen: &mut Vec<usize>, given: usize) {
    for i in (given..chosen.len()).rev() {
        let mut fewer = chosen.clone();
        fewer.remove(i);
        if worst(problems, goals, &fewer).is_none() {
            *chosen = fewer;
        }
    }
}

fn residual(problem: &Problem, columns: &[usize]) -> f64 {
    problem.residuals(&problem.solve(columns), MOST)[1]
}

fn all(problem: &Problem) -> Vec<usize> {
    (0..problem.len()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Exponentials in a parameter, of which sums are to be expressed by few.
    fn problem(of: impl Fn(f64) -> f64) -> Problem {
        let rows: Vec<f64> = (0..60).map(|i| f64::from(i) / 20.0).collect();
        let column = |k: u32| {
            let values = rows
                .iter()
                .map(|t| (-f64::from(k) * t / 4.0).exp() / of(*t));
            values.collect()
        };
        Problem::new((0..16).map(column).collect(), vec![1.0; rows.len()])
    }

    #[test]
    fn takes_as_few_as_the_tolerance_asks_for() {
        let sum = |t: f64| (-t).exp() + 0.5 * (-3.0 * t).exp();
        let exact = choose(&[problem(sum)], &[], 1e-6, 16);
        assert_eq!(exact[0].iter().map(|w| w.0).collect::<Vec<_>>(), [4, 12]);
        // What two columns make, one makes where that is good enough.
        let rough = choose(&[problem(sum)], &[], 0.5, 16);
        assert_eq!(rough[0].len(), 1);
    }

    #[test]
    fn given_columns_are_used_first() {
        let near = |t: f64| (-1.02 * t).exp();
        let found = choose(&[problem(near)], &[4], 0.1, 16);
        assert_eq!(found[0].iter().map(|w| w.0).collect::<Vec<_>>(), [4]);
    }
}

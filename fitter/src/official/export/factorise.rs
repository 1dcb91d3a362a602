//! Σ_r s_r(γ) z_r(α) with piecewise linear s and z, by alternating least squares on scattered points.
//!
//! With one of the two held, the other is the solution of normal equations with few diagonals. What no point tells, a
//! small weight on second differences between breaks makes a straight line.

use crate::official::tables::Place;

/// A value of the product at two places, and the root of its weight.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// Among the breaks of s.
    pub sun: Place,
    /// Among the breaks of z.
    pub zenith: Place,
    /// What the sum is to be times, as emphasis.
    pub factor: f64,
    /// The value.
    pub value: f64,
    /// Root of the weight.
    pub weight: f64,
}

/// Values at the breaks, `[break][rank]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Factors {
    /// Components.
    pub rank: usize,
    /// Of the angle to the sun.
    pub sun: Vec<f64>,
    /// Of the zenith angle.
    pub zenith: Vec<f64>,
}

/// Weight of the squared second differences between breaks, relative to the mean weight of a break.
const SMOOTHNESS: f64 = 3e-3;
/// Weight of the squared values, likewise.
const RIDGE: f64 = 1e-7;

impl Factors {
    /// Lobes of several widths around the sun, and nothing in the zenith angle yet.
    pub fn start(rank: usize, sun_breaks: &[f64], zenith_breaks: usize) -> Self {
        let row = |angle: &f64| {
            let angle = *angle;
            (0..rank).map(move |r| match r {
                0 => 1.0,
                r if r % 2 == 1 => (-angle.abs() / (1.2 * 0.5f64.powi(r as i32 / 2))).exp(),
                r => (r as f64 / 2.0 * angle).cos(),
            })
        };
        Self {
            rank,
            sun: sun_breaks.iter().flat_map(row).collect(),
            zenith: vec![0.0; zenith_breaks * rank],
        }
    }

    /// Alternates `sweeps` times; what stands for the zenith angle is found first, and last once more.
    pub fn improve(&mut self, points: &[Point], sweeps: usize) {
        self.solve_zenith(points);
        for _ in 0..sweeps {
            let sun = solve(points, self.rank, &self.zenith, self.sun.len(), |p| {
                [p.sun, p.zenith]
            });
            self.sun = sun;
            self.balance();
            self.solve_zenith(points);
        }
    }

    /// Finds what is best for the factors of the sun as they are.
    pub fn solve_zenith(&mut self, points: &[Point]) {
        let length = self.zenith.len();
        self.zenith = solve(points, self.rank, &self.sun, length, |p| [p.zenith, p.sun]);
    }

    /// Largest magnitude of each component of the sun to 1.
    fn balance(&mut self) {
        for r in 0..self.rank {
            let column = self.sun.iter().skip(r).step_by(self.rank);
            let largest = column.fold(0.0f64, |m, v| m.max(v.abs()));
            if largest > 0.0 {
                let own = self.sun.iter_mut().skip(r).step_by(self.rank);
                own.for_each(|v| *v /= largest);
                let other = self.zenith.iter_mut().skip(r).step_by(self.rank);
                other.for_each(|v| *v *= largest);
            }
        }
    }
}

/// The unknown factors of length `length` where the others are `known`; `places` gives the place among the unknown, then
/// that among the known.
fn solve(
    points: &[Point],
    rank: usize,
    known: &[f64],
    length: usize,
    places: impl Fn(&Point) -> [Place; 2],
) -> Vec<f64> {
    let mut normal = Band::new(length, 2 * rank + 1);
    let mut right = vec![0.0; length];
    let mut taps = vec![0.0; 2 * rank];
    for point in points {
        let [own, other] = places(point);
        let row = |segment: usize| &known[segment * rank..][..rank];
        let ([i, j], [low, high]) = ([own.segment(), other.segment()], own.weights());
        let [a, b] = other.weights();
        let scale = point.factor * point.weight;
        for (r, (x, y)) in row(j).iter().zip(row(j + 1)).enumerate() {
            let value = scale * (a * x + b * y);
            taps[r] = low * value;
            taps[rank + r] = high * value;
        }
        normal.add(i * rank, &taps);
        let target = point.weight * point.value;
        let rows = right[i * rank..].iter_mut();
        rows.zip(&taps).for_each(|(sum, t)| *sum += target * t);
    }
    let mean = normal.mean_diagonal();
    for i in 0..length {
        normal.add_at(i, i, RIDGE * mean + 1e-300);
        if i + 2 * rank < length {
            normal.add_bent(i, rank, SMOOTHNESS * mean);
        }
    }
    normal.solve(right)
}

/// A symmetric positive definite matrix whose entries beyond `width` − 1 from the diagonal are 0; rows of the lower
/// triangle.
struct Band {
    width: usize,
    rows: Vec<f64>,
}

impl Band {
    fn new(length: usize, width: usize) -> Self {
        Self {
            width,
            rows: vec![0.0; length * width],
        }
    }

    fn position(&self, i: usize, j: usize) -> usize {
        i * self.width + self.width - 1 + j - i
    }

    fn add_at(&mut self, i: usize, j: usize, value: f64) {
        let position = self.position(i, j);
        self.rows[position] += value;
    }

    /// Adds the square of a row that begins at a column.
    fn add(&mut self, first: usize, row: &[f64]) {
        for (i, a) in row.iter().enumerate() {
            let start = self.position(first + i, first);
            let own = self.rows[start..=start + i].iter_mut();
            own.zip(row).for_each(|(sum, b)| *sum += a * b);
        }
    }

    /// Adds a weight to the squared second difference of every `rank`th number from the `i`th on.
    fn add_bent(&mut self, i: usize, rank: usize, weight: f64) {
        let bend = [1.0, -2.0, 1.0];
        for (a, x) in bend.iter().enumerate() {
            for (b, y) in bend[..=a].iter().enumerate() {
                self.add_at(i + a * rank, i + b * rank, weight * x * y);
            }
        }
    }

    fn mean_diagonal(&self) -> f64 {
        let diagonal = self.rows.iter().skip(self.width - 1).step_by(self.width);
        diagonal.sum::<f64>() * self.width as f64 / self.rows.len() as f64
    }

    /// By Cholesky's decomposition.
    fn solve(mut self, mut right: Vec<f64>) -> Vec<f64> {
        let n = right.len();
        let w = self.width;
        for i in 0..n {
            let first = (i + 1).saturating_sub(w);
            for j in first..=i {
                let start = first.max((j + 1).saturating_sub(w));
                let [a, b] = [self.position(i, start), self.position(j, start)];
                let terms = j - start;
                let dot: f64 = (0..terms)
                    .map(|k| self.rows[a + k] * self.rows[b + k])
                    .sum();
                let at = self.position(i, j);
                let rest = self.rows[at] - dot;
                self.rows[at] = match i == j {
                    // Rounding may leave nothing of a direction that no point tells.
                    true => rest.max(1e-300).sqrt(),
                    false => rest / self.rows[self.position(j, j)],
                };
            }
            let start = self.position(i, first);
            let dot: f64 = (first..i)
                .map(|k| self.rows[start + k - first] * right[k])
                .sum();
            right[i] = (right[i] - dot) / self.rows[self.position(i, i)];
        }
        for i in (0..n).rev() {
            right[i] /= self.rows[self.position(i, i)];
            let x = right[i];
            let first = (i + 1).saturating_sub(w);
            let start = self.position(i, first);
            let above = right[first..i].iter_mut();
            let row = &self.rows[start..start + i - first];
            above.zip(row).for_each(|(sum, l)| *sum -= l * x);
        }
        right
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_is_solved() {
        let (n, w) = (40, 6);
        let mut band = Band::new(n, w);
        let mut dense = vec![vec![0.0; n]; n];
        for first in 0..=n - w {
            let row: Vec<f64> = (0..w)
                .map(|k| ((first * 7 + k * 13) as f64).sin())
                .collect();
            band.add(first, &row);
            for (i, a) in row.iter().enumerate() {
                for (j, b) in row.iter().enumerate() {
                    dense[first + i][first + j] += a * b;
                }
            }
        }
        for (i, row) in dense.iter_mut().enumerate() {
            band.add_at(i, i, 0.5);
            row[i] += 0.5;
        }
        let x: Vec<f64> = (0..n).map(|i| (i as f64).cos()).collect();
        let right = dense
            .iter()
            .map(|row| row.iter().zip(&x).map(|(a, b)| a * b).sum())
            .collect();
        let solved = band.solve(right);
        let worst = solved.iter().zip(&x).map(|(a, b)| (a - b).abs());
        assert!(worst.fold(0.0, f64::max) < 1e-10);
    }

    #[test]
    fn products_of_low_rank_are_found() {
        let breaks: Vec<f64> = (0..=20).map(|i| i as f64 * 0.05).collect();
        let piecewise = |f: &dyn Fn(f64) -> f64, u: f64| {
            let i = ((u / 0.05) as usize).min(19);
            let t = u / 0.05 - i as f64;
            f(breaks[i]) * (1.0 - t) + f(breaks[i + 1]) * t
        };
        let value = |s: f64, z: f64| {
            piecewise(&|s| (-3.0 * s).exp(), s) * piecewise(&|z| 1.0 + z * z, z)
                + piecewise(&|s| s, s) * piecewise(&|z| (4.0 * z).cos(), z)
        };
        let points: Vec<Point> = (0..4000)
            .map(|i| {
                let (s, z) = (
                    (i as f64 * 0.618_034).fract(),
                    (i as f64 * 0.754_878).fract(),
                );
                Point {
                    sun: Place::new(&breaks, s),
                    zenith: Place::new(&breaks, z),
                    factor: 1.0,
                    value: value(s, z),
                    weight: 1.0,
                }
            })
            .collect();
        let mut factors = Factors::start(3, &breaks, breaks.len());
        factors.improve(&points, 30);
        let got = |p: &Point| -> f64 {
            let at = |matrix: &[f64], place: Place, r: usize| {
                let [a, b] = place.weights();
                a * matrix[place.segment() * 3 + r] + b * matrix[(place.segment() + 1) * 3 + r]
            };
            (0..3)
                .map(|r| at(&factors.sun, p.sun, r) * at(&factors.zenith, p.zenith, r))
                .sum()
        };
        let worst = points.iter().map(|p| (got(p) - p.value).abs());
        assert!(worst.fold(0.0, f64::max) < 2e-3);
    }
}

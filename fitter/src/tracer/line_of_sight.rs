//! The line of sight of a query, prepared for sampling its first scattering point.

use super::medium::{Columns, MAX_CONSTITUENTS, Medium};
use super::shell_crossings::Line;
use super::stokes::Frame;
use glam::DVec3;

/// Longest piece, m, and largest optical depth of a piece.
const LONGEST: f64 = 10_000.0;
const THICK: f64 = 0.1;
/// Length of a line of sight that counts as none, m.
const NOTHING: f64 = 1e-6;

/// See the module's documentation.
pub struct Sight<const N: usize> {
    /// The ray from the observer.
    pub line: Line,
    /// Its polarisation frame.
    pub frame: Frame,
    /// Distance where it ends: at the query's distance, on the ground or in space, m.
    pub end: f64,
    /// Whether it ends on the ground.
    pub hits_ground: bool,
    /// Transmittance over its length.
    pub transmittance: [f64; N],
    breaks: Vec<f64>,
    columns: Vec<Columns>,
    cumulative: Vec<f64>,
}

impl<const N: usize> Sight<N> {
    /// The line of sight from `origin` in `frame`, cut at `distance` if given.
    pub fn new(medium: &Medium<N>, origin: DVec3, frame: Frame, distance: Option<f64>) -> Self {
        let line = Line::new(origin, frame.w);
        let ground = line.ground_distance(medium.radius);
        let natural = ground.unwrap_or_else(|| line.space_distance(medium.top));
        // Rounding leaves nanometres of air to who looks down from the ground, or up from the top.
        let natural = if natural < NOTHING { 0.0 } else { natural };
        let end = distance.unwrap_or(f64::INFINITY).min(natural);
        let mut sight = Self {
            line,
            frame,
            end,
            hits_ground: ground.is_some() && end == natural,
            transmittance: [1.0; N],
            breaks: subdivided(medium, &line, &crossings(medium, &line, end)),
            columns: vec![],
            cumulative: vec![0.0],
        };
        sight.accumulate(medium);
        sight
    }

    /// Where the line crosses profile nodes, turns, starts and ends.
    pub fn node_breaks(&self, medium: &Medium<N>) -> Vec<f64> {
        crossings(medium, &self.line, self.end)
    }

    fn accumulate(&mut self, medium: &Medium<N>) {
        let mut total = [0.0; MAX_CONSTITUENTS];
        let mut weights: Vec<[f64; N]> = vec![];
        self.columns.push(total);
        for pair in self.breaks.windows(2) {
            let part = medium.columns(&self.line, pair[0], pair[1]);
            let middle: Columns = std::array::from_fn(|k| total[k] + 0.5 * part[k]);
            let (through, scattering) =
                (medium.transmittance(&middle), medium.scattering_of(&part));
            weights.push(std::array::from_fn(|w| through[w] * scattering[w]));
            for k in 0..MAX_CONSTITUENTS {
                total[k] += part[k];
            }
            self.columns.push(total);
        }
        self.transmittance = medium.transmittance(&total);
        let sums: [f64; N] = std::array::from_fn(|w| weights.iter().map(|x| x[w]).sum());
        let mut sum = 0.0;
        for weight in &weights {
            let share = |w: usize| {
                if sums[w] > 0.0 {
                    weight[w] / sums[w]
                } else {
                    0.0
                }
            };
            sum += (0..medium.active).map(share).sum::<f64>() / medium.active as f64;
            self.cumulative.push(sum);
        }
    }

    /// Column densities from the observer to distance `t`.
    pub fn columns_to(&self, medium: &Medium<N>, t: f64) -> Columns {
        let i = self
            .breaks
            .partition_point(|&b| b <= t)
            .clamp(1, self.breaks.len())
            - 1;
        let part = medium.columns(&self.line, self.breaks[i], t);
        std::array::from_fn(|k| self.columns[i][k] + part[k])
    }

    /// A first scattering point: its distance and density (m⁻¹). `None` where nothing scatters.
    pub fn sample(&self, u: f64) -> Option<(f64, f64)> {
        let total = *self.cumulative.last()?;
        if total <= 0.0 {
            return None;
        }
        let x = u * total;
        let n = self.cumulative.len() - 1;
        let i = self.cumulative.partition_point(|&c| c <= x).clamp(1, n) - 1;
        let share = self.cumulative[i + 1] - self.cumulative[i];
        let length = self.breaks[i + 1] - self.breaks[i];
        let inside = ((x - self.cumulative[i]) / share).clamp(0.0, 1.0);
        Some((self.breaks[i] + inside * length, share / (total * length)))
    }
}

fn crossings<const N: usize>(medium: &Medium<N>, line: &Line, end: f64) -> Vec<f64> {
    let both = medium
        .radii()
        .iter()
        .filter_map(|&r| line.crossing(r))
        .flat_map(|s| [s - line.start, -s - line.start]);
    let mut t: Vec<f64> = both
        .chain([-line.start])
        .filter(|&t| t > 0.0 && t < end)
        .chain([0.0, end])
        .collect();
    t.sort_by(f64::total_cmp);
    t.dedup();
    t
}

fn subdivided<const N: usize>(medium: &Medium<N>, line: &Line, breaks: &[f64]) -> Vec<f64> {
    let mut fine = vec![breaks[0]];
    for pair in breaks.windows(2) {
        let length = pair[1] - pair[0];
        let tau = medium.extinction_of(&medium.columns(line, pair[0], pair[1]));
        let depth = tau.iter().fold(0.0_f64, |a, &b| a.max(b));
        let n = (length / LONGEST)
            .max(depth / THICK)
            .ceil()
            .clamp(1.0, 200.0) as usize;
        fine.extend((1..n).map(|i| pair[0] + length * i as f64 / n as f64));
        fine.push(pair[1]);
    }
    fine
}

//! Where along a ray to look for sunlight: a piecewise linear density that follows scattering × transmittance ×
//! sunlight.

use super::linear_density::linear;
use super::medium::Medium;
use super::shell_crossings::Line;
use super::sun::{GUIDES, SunGuide};
use glam::DVec3;

/// Longest piece, m.
const LONGEST: f64 = 30_000.0;
/// Optical depth above which a piece is divided.
const THICK: f64 = 0.7;
/// Transmittance behind which pieces are no longer divided.
const NOTHING: f64 = 1e-6;
/// Pieces of a segment; the last one takes what is left.
const MOST_PIECES: usize = 1 << 16;

struct Piece {
    from: f64,
    to: f64,
    /// Unnormalised density at both ends, per guide.
    ends: [[f64; GUIDES]; 2],
}

/// Scratch space for the density along one ray at a time.
#[derive(Default)]
pub struct Segment {
    pieces: Vec<Piece>,
    factors: [f64; GUIDES],
}

/// State of the march along the ray, at one end of a piece.
struct End {
    t: f64,
    extinction: [f64; GUIDES],
    light: [f64; GUIDES],
}

/// What a density is built from.
pub struct Scene<'a, const N: usize> {
    /// The atmosphere.
    pub medium: &'a Medium<N>,
    /// Approximate sunlight.
    pub guide: &'a SunGuide,
    /// Extinction of each constituent at the guiding lanes.
    pub extinction: Vec<[f64; GUIDES]>,
    /// Scattering of each constituent at the guiding lanes.
    pub scattering: Vec<[f64; GUIDES]>,
    /// Direction to the sun.
    pub sun: DVec3,
}

impl<'a, const N: usize> Scene<'a, N> {
    /// Gathers the guiding lanes of `medium`.
    pub fn new(medium: &'a Medium<N>, guide: &'a SunGuide, sun: DVec3) -> Self {
        let lanes = medium.guides();
        let pick = |all: &Vec<[f64; N]>| {
            all.iter()
                .map(|c| std::array::from_fn(|g| c[lanes[g.min(lanes.len() - 1)]]))
                .collect()
        };
        Self {
            extinction: pick(&medium.extinction),
            scattering: pick(&medium.scattering),
            medium,
            guide,
            sun,
        }
    }

    /// Extinction, and scattering times sunlight, at distance `t`.
    fn end(&self, line: &Line, t: f64) -> End {
        let r = line.radius(line.start + t);
        let profile = self.medium.profile((r - self.medium.radius).max(0.0));
        let (mut extinction, mut light) = ([0.0; GUIDES], [0.0; GUIDES]);
        for (k, (e, s)) in self.extinction.iter().zip(&self.scattering).enumerate() {
            for g in 0..guides::<N>() {
                extinction[g] += e[g] * profile[k];
                light[g] += s[g] * profile[k];
            }
        }
        match self.guide.depth(r, line.at(t).dot(self.sun) / r) {
            Some(depth) => {
                for g in 0..guides::<N>() {
                    light[g] *= (-depth[g]).exp();
                }
            }
            None => light = [0.0; GUIDES],
        }
        End {
            t,
            extinction,
            light,
        }
    }
}

/// How many guides tell something new.
const fn guides<const N: usize>() -> usize {
    if N == 1 { 1 } else { GUIDES }
}

impl Segment {
    /// Builds the density along `line` up to distance `end`.
    pub fn build<const N: usize>(&mut self, scene: &Scene<N>, line: &Line, end: f64) {
        self.pieces.clear();
        let shells = &scene.medium.layers;
        let mut shell = Medium::<N>::shell(shells, line.origin.length());
        let mut at = scene.end(line, 0.0);
        let mut through = [0.0; GUIDES];
        through[..guides::<N>()].fill(1.0);
        while at.t < end {
            let s = line.start + at.t;
            let down = (s < 0.0)
                .then(|| line.crossing(shells[shell].lower))
                .flatten();
            let exit = match down {
                Some(crossing) => -crossing,
                None => line.crossing(shells[shell].upper).unwrap_or(0.0),
            };
            let last = exit - line.start >= end;
            let to = if last { end } else { exit - line.start };
            at = self.divide(scene, line, at, to, &mut through);
            match down {
                _ if last => break,
                Some(_) if shell == 0 => break,
                Some(_) => shell -= 1,
                None if shell + 1 == shells.len() => break,
                None => shell += 1,
            }
        }
        self.normalise();
    }

    /// Adds pieces from `at` to distance `to`.
    fn divide<const N: usize>(
        &mut self,
        scene: &Scene<N>,
        line: &Line,
        mut at: End,
        to: f64,
        through: &mut [f64; GUIDES],
    ) -> End {
        while at.t < to {
            let extinction = at.extinction.iter().fold(1e-300_f64, |a, &b| a.max(b));
            let mut step = LONGEST.min(THICK / extinction);
            let full = self.pieces.len() >= MOST_PIECES;
            if full || at.t + 1.3 * step > to || through.iter().all(|&x| x < NOTHING) {
                step = to - at.t;
            }
            let next = scene.end(line, if at.t + step < to { at.t + step } else { to });
            self.push(guides::<N>(), &at, &next, through);
            at = next;
        }
        at
    }

    fn push(&mut self, guides: usize, a: &End, b: &End, through: &mut [f64; GUIDES]) {
        let length = b.t - a.t;
        let mut ends = [[0.0; GUIDES]; 2];
        for g in 0..guides {
            let next = through[g] * (-0.5 * length * (a.extinction[g] + b.extinction[g])).exp();
            let (x, y) = (through[g] * a.light[g], next * b.light[g]);
            // The edge of the shadow may lie inside: leave something at a dark end.
            let floor = 0.1 * x.max(y);
            ends[0][g] = x + floor;
            ends[1][g] = y + floor;
            through[g] = next;
        }
        self.pieces.push(Piece {
            from: a.t,
            to: b.t,
            ends,
        });
    }

    /// Scales every guide's density to an equal share of 1.
    fn normalise(&mut self) {
        let mut sums = [0.0; GUIDES];
        for piece in &self.pieces {
            let half = 0.5 * (piece.to - piece.from);
            for (g, sum) in sums.iter_mut().enumerate() {
                *sum += half * (piece.ends[0][g] + piece.ends[1][g]);
            }
        }
        let lit = sums.iter().filter(|&&s| s > 0.0).count() as f64;
        self.factors = sums.map(|s| if s > 0.0 { 1.0 / (s * lit) } else { 0.0 });
    }

    /// A distance and its density (m⁻¹); `None` where no sunlight reaches the ray.
    pub fn sample(&self, u: f64) -> Option<(f64, f64)> {
        let mut left = u;
        let mut chosen = None;
        for piece in &self.pieces {
            let [a, b] = piece.ends.map(|end| {
                let terms = end.iter().zip(&self.factors);
                terms.map(|(x, factor)| x * factor).sum::<f64>()
            });
            let length = piece.to - piece.from;
            let share = 0.5 * length * (a + b);
            if share <= 0.0 {
                continue;
            }
            let inside = linear(a, b, (left / share).min(1.0));
            chosen = Some((piece.from + inside * length, a + inside * (b - a)));
            if left < share {
                break;
            }
            left -= share;
        }
        chosen
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_density_is_inverted() {
        for (a, b) in [(1.0, 1.0), (0.0, 2.0), (3.0, 0.5), (1.0, 0.0)] {
            for i in 1..=10 {
                let u = f64::from(i) / 10.0;
                let x = linear(a, b, u);
                let mass = (a * x + 0.5 * (b - a) * x * x) / (0.5 * (a + b));
                assert!((mass - u).abs() < 1e-12, "{a} {b} {u}");
            }
        }
    }

    /// Pieces 0..1 of density 1 and 1..3 falling from 1 to 0: masses 1/2 and 1/2.
    #[test]
    fn samples_follow_the_density() {
        let piece = |from, to, a, b| Piece {
            from,
            to,
            ends: [[a; GUIDES], [b; GUIDES]],
        };
        let mut segment = Segment {
            pieces: vec![piece(0.0, 1.0, 1.0, 1.0), piece(1.0, 3.0, 1.0, 0.0)],
            factors: [0.0; GUIDES],
        };
        segment.normalise();
        for i in 0..100 {
            let (t, density) = segment.sample((f64::from(i) + 0.5) / 100.0).unwrap();
            let expected = if t < 1.0 { 0.5 } else { 0.25 * (3.0 - t) };
            assert!((density - expected).abs() < 1e-12, "{t} {density}");
            assert_eq!(t < 1.0, i < 50);
        }
    }
}

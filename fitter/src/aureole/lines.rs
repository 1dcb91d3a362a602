//! Lines of sight about the sun, over the whole sky and along the vertical through the sun.

use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::f64::consts::{FRAC_PI_2, PI};

/// Why a line is looked along.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// Near the sun.
    Aureole,
    /// Anywhere farther away.
    Sky,
    /// In the vertical plane of the sun, at this angle from the horizon below it, rad, through the zenith.
    Vertical(f64),
}

/// A line of sight from the ground.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// Elevation of the sun, rad.
    pub sun: f64,
    /// Elevation and azimuth from the sun, rad.
    pub view: [f64; 2],
    /// Why.
    pub place: Place,
}

/// Angles from the sun that are looked at, degrees.
const RINGS: [f64; 8] = [0.3, 0.5, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0];
/// Directions of each: up, across, down, from the vertical, degrees.
const ROUND: [f64; 4] = [0.0, 60.0, 120.0, 180.0];
/// Directions of the whole sky.
const SKY: usize = 48;
/// Lowest line of sight, rad.
const LOWEST: f64 = 0.01;

impl Line {
    /// Angle to the sun, rad.
    pub fn to_sun(&self) -> f64 {
        let [view, sun] = [unit(self.view), unit([self.sun, 0.0])];
        let square: f64 = view.iter().zip(sun).map(|(a, b)| (a - b).powi(2)).sum();
        2.0 * (0.5 * square.sqrt()).clamp(0.0, 1.0).asin()
    }

    /// Direction in a frame whose +x points towards the sun.
    pub fn direction(&self) -> [f32; 3] {
        unit(self.view).map(|x| x as f32)
    }
}

/// Lines about suns of these elevations (rad) and over the whole sky.
pub fn all(suns: &[f64]) -> Vec<Line> {
    let about = |&sun: &f64| [aureole(sun), sky(sun)].concat();
    suns.iter().flat_map(about).collect()
}

/// Lines along the vertical through the sun, denser near it.
pub fn vertical(sun: f64) -> Vec<Line> {
    let near = [0.3, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0].map(f64::to_radians);
    let about = near.iter().flat_map(|a| [sun - a, sun + a]);
    let even = (1..60).map(|i| PI * f64::from(i) / 60.0);
    let mut angles: Vec<f64> = about
        .chain(even.filter(|a| (a - sun).abs() > 9f64.to_radians()))
        .filter(|a| (LOWEST..PI - LOWEST).contains(a))
        .collect();
    angles.sort_by(f64::total_cmp);
    let line = |a: f64| Line {
        sun,
        view: if a > FRAC_PI_2 {
            [PI - a, PI]
        } else {
            [a, 0.0]
        },
        place: Place::Vertical(a),
    };
    angles.into_iter().map(line).collect()
}

fn aureole(sun: f64) -> Vec<Line> {
    let mut out = vec![];
    for ring in RINGS {
        for round in ROUND {
            let view = beside(sun, ring.to_radians(), round.to_radians());
            if view[0] > LOWEST {
                out.push(Line {
                    sun,
                    view,
                    place: Place::Aureole,
                });
            }
        }
    }
    out
}

fn sky(sun: f64) -> Vec<Line> {
    let mut rng = Pcg64Mcg::seed_from_u64(7);
    let mut uniform = || (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    let mut out = vec![];
    while out.len() < SKY {
        let line = Line {
            sun,
            view: [
                (LOWEST.sin() + (1.0 - LOWEST.sin()) * uniform()).asin(),
                PI * uniform(),
            ],
            place: Place::Sky,
        };
        if line.to_sun() > 10f64.to_radians() {
            out.push(line);
        }
    }
    out
}

/// Elevation and azimuth at `angle` from the sun, `round` from the vertical.
fn beside(sun: f64, angle: f64, round: f64) -> [f64; 2] {
    let ((ss, cs), (sa, ca)) = (sun.sin_cos(), angle.sin_cos());
    let (sr, cr) = round.sin_cos();
    let up = ca * ss + sa * cr * cs;
    let along = ca * cs - sa * cr * ss;
    [up.clamp(-1.0, 1.0).asin(), (sa * sr).atan2(along).abs()]
}

fn unit([elevation, azimuth]: [f64; 2]) -> [f64; 3] {
    let ((se, ce), (sa, ca)) = (elevation.sin_cos(), azimuth.sin_cos());
    [ce * ca, ce * sa, se]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_are_where_they_should_be() {
        let lines = aureole(0.4);
        assert_eq!(lines.len(), RINGS.len() * ROUND.len());
        for (line, ring) in lines.iter().zip(RINGS.map(|r| [r; 4]).concat()) {
            assert!((line.to_sun().to_degrees() - ring).abs() < 1e-9);
        }
    }

    #[test]
    fn all_lines_are_above_the_horizon() {
        for sun in [0.02, 0.5, 1.5] {
            let lines = [all(&[sun]), vertical(sun)].concat();
            assert!(lines.iter().all(|l| l.view[0] > 0.0));
        }
    }
}

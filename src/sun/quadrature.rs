//! Sums over the visible part of the disc: along lines of equal elevation, where the air is the same, and over those.

use core::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use super::cap::{Cap, Line};

/// Nodes and weights of the 8-point Gauss-Legendre rule on −1..1, of which the other half mirrors these.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_3),
];

/// ∫ μ^k · (cosine to a normal or 1) over a line, per unit of y, k = 0 … 5; μ is the cosine of the heliocentric angle.
pub(super) type Moments = [f64; 6];

/// Hands the elevation (rad) and the moments of lines whose sum is the integral over the visible part over the area of
/// the disc. With a normal, what is behind its plane does not count.
pub(super) fn each_line(cap: &Cap, normal: Option<[f64; 3]>, mut visit: impl FnMut(f64, Moments)) {
    let last = cap.last_line();
    // The integrand is smooth but for where the plane's edge comes in.
    let edges = normal.and_then(|normal| cap.lines_at_edge(normal));
    let [a, b] = edges.unwrap_or([0.0; 2]).map(|edge| edge.min(last));
    let stops = [0.0, a.min(b), a.max(b), last];
    for pair in stops.windows(2) {
        let panels = ((pair[1] - pair[0]) / FRAC_PI_4).ceil();
        let width = (pair[1] - pair[0]) / panels;
        for i in 0..panels as usize {
            let start = pair[0] + width * i as f64;
            for (theta, weight) in gauss(start, start + width) {
                let line = cap.line(theta);
                let weight = weight * line.height / core::f64::consts::PI;
                let moments = moments(&line, normal).map(|m| weight * m);
                visit(line.elevation(), moments);
            }
        }
    }
}

fn moments(line: &Line, normal: Option<[f64; 3]>) -> Moments {
    let mut sums = [0.0; 6];
    let cosine = |x: f64| match normal {
        Some(normal) => {
            let direction = line.direction(x);
            (0..3).map(|i| direction[i] * normal[i]).sum()
        }
        None => 1.0,
    };
    let Some([from, to]) = lit(line.half, &cosine) else {
        return sums;
    };
    for (chi, weight) in gauss(from, to) {
        let (sine, share) = chi.sin_cos();
        let x = line.half * sine;
        let mut term = weight * line.half * share * cosine(x).max(0.0);
        for sum in &mut sums {
            *sum += term;
            term *= line.height * share;
        }
    }
    sums
}

/// The angles, sines of which are x over its largest value, between which `cosine` is positive; it is nearly linear.
fn lit(half: f64, cosine: &impl Fn(f64) -> f64) -> Option<[f64; 2]> {
    let (left, right) = (cosine(-half), cosine(half));
    if left >= 0.0 && right >= 0.0 {
        return Some([-FRAC_PI_2, FRAC_PI_2]);
    }
    if left <= 0.0 && right <= 0.0 {
        return None;
    }
    let slope = (right - left) / (2.0 * half);
    let guess = -half - left / slope;
    let root = guess - cosine(guess) / slope;
    let edge = (root / half).clamp(-1.0, 1.0).asin();
    Some(match right > left {
        true => [edge, FRAC_PI_2],
        false => [-FRAC_PI_2, edge],
    })
}

/// Nodes and weights between two numbers.
fn gauss(from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    GAUSS
        .into_iter()
        .flat_map(move |(x, weight)| [-x, x].map(|x| (middle + half * x, half * weight)))
}

//! Directions that a sky is fitted in: many where it changes fast.

use crate::official::angles::PLANET_RADIUS;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A sky is never looked at closer to the horizon than this, rad: the emphasis ramps there.
pub const BESIDE: f64 = 0.05 * PI / 180.0;
/// Below the horizon the ramp is as long as this, rad.
pub const RAMP: f64 = 0.3 * PI / 180.0;

/// `count` directions from an altitude (m) under a sun in azimuth 0: an even share over the sphere, one about the
/// horizon, one about the sun.
pub fn directions(altitude: f64, solar_elevation: f64, count: usize) -> Vec<[f64; 3]> {
    let dip = (PLANET_RADIUS / (PLANET_RADIUS + altitude)).acos();
    let all = (0..).map(|i| match i % 4 {
        0 => about_horizon(i / 4, dip),
        1 => about_sun(i / 4, solar_elevation),
        _ => even(i),
    });
    let seen = all.filter(|d: &[f64; 3]| {
        let above = d[2].clamp(-1.0, 1.0).asin() + dip;
        above > BESIDE || altitude > 0.0 && above < -RAMP
    });
    seen.take(count).collect()
}

/// Two numbers in 0..1 that fill the square evenly.
fn pair(i: usize) -> [f64; 2] {
    let n = i as f64 + 0.5;
    [
        (n * 0.754_877_666_246_692_7).fract(),
        (n * 0.569_840_290_998_053_2).fract(),
    ]
}

fn even(i: usize) -> [f64; 3] {
    let [a, b] = pair(i);
    let z = 2.0 * a - 1.0;
    let across = (1.0 - z * z).sqrt();
    let (sine, cosine) = (PI * b).sin_cos();
    [across * cosine, across * sine, z]
}

fn about_horizon(i: usize, dip: f64) -> [f64; 3] {
    let [a, b] = pair(i);
    let signed = 2.0 * a - 1.0;
    let elevation = signed * signed.abs() * 12f64.to_radians() - dip;
    let (sine, cosine) = (PI * b).sin_cos();
    let elevation = elevation.clamp(-FRAC_PI_2, FRAC_PI_2);
    [
        elevation.cos() * cosine,
        elevation.cos() * sine,
        elevation.sin(),
    ]
}

fn about_sun(i: usize, solar_elevation: f64) -> [f64; 3] {
    let [a, b] = pair(i);
    let (sine, cosine) = (a * a * 30f64.to_radians()).sin_cos();
    let (sw, cw) = (TAU * b).sin_cos();
    let (se, ce) = solar_elevation.sin_cos();
    // Axes across the sun: up in its vertical plane, and horizontal.
    [
        cosine * ce - sine * cw * se,
        sine * sw,
        cosine * se + sine * cw * ce,
    ]
}

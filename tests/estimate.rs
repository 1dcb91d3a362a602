//! Estimates: positive, continuous across stops, the same wherever they are asked.

mod common;

use common::random::Random;
use welkin::estimate::{Estimates, Sightline};
use welkin::format::{EstimateView, Kind, parse};
use welkin::geometry::{Planet, Side};

const EARTH: Planet = Planet {
    radius: 6_378_000.0,
    top: 100_000.0,
};

fn estimates() -> Estimates {
    let file = common::estimated_bytes();
    let contents = parse(&file).unwrap();
    let head = &contents.head;
    let place = contents.index[&(Kind::Estimate, None, None)];
    let entry = &contents.directory[place];
    let (nk, nw) = (head.constituents, head.wavelengths.len());
    let view = EstimateView::new(&file[entry.offset..][..entry.length], nk, nw, EARTH.top).unwrap();
    Estimates::new(EARTH, &view, &head.extinction[..nk * nw])
}

/// A ray that does not leave its side of the horizon with small changes.
fn any(random: &mut Random) -> (f64, f64, f64, f64) {
    let altitude = 30e3 * random.share().powi(2);
    let steep = random.share() < 0.5;
    let elevation = (random.share() - 0.5) * if steep { 3.1 } else { 0.3 };
    let sun = 0.4 * random.share() - 0.2;
    (
        altitude,
        elevation,
        sun,
        std::f64::consts::PI * random.share(),
    )
}

fn line((altitude, elevation, sun, azimuth): (f64, f64, f64, f64)) -> Sightline {
    Sightline {
        altitude,
        ray: elevation.sin_cos().into(),
        side: EARTH.ray(altitude, elevation).side,
        sun: sun.sin_cos().into(),
        azimuth: azimuth.cos(),
    }
}

#[test]
fn they_are_positive_and_nothing_jumps() {
    let estimates = estimates();
    let mut random = Random(3);
    let mut row = vec![0.0; estimates.len()];
    let mut near = row.clone();
    let mut worst = 0.0f32;
    for _ in 0..20_000 {
        let place = any(&mut random);
        estimates.along(&line(place), &mut row);
        assert!(row.iter().all(|v| v.is_finite() && *v >= 0.0), "{place:?}");
        let (altitude, elevation, sun, azimuth) = place;
        let step = |r: &mut Random| 1e-6 * (r.share() - 0.5);
        let beside = (
            altitude * (1.0 + step(&mut random)),
            elevation + step(&mut random),
            sun + step(&mut random),
            azimuth + step(&mut random),
        );
        if line(place).side != line(beside).side {
            continue;
        }
        estimates.along(&line(beside), &mut near);
        let most = row.iter().copied().fold(0.0, f32::max);
        for (a, b) in row.iter().zip(&near) {
            let change = (a - b).abs() / (a.max(*b) + 1e-3 * most);
            worst = worst.max(change);
        }
    }
    println!("largest relative change: {worst:.1e}");
    assert!(worst < 1e-2, "{worst}");
}

/// Where a ray comes to touch a cylinder around the shadow, it gets two stops more.
#[test]
fn nothing_jumps_where_stops_appear() {
    let estimates = estimates();
    let mut before: Option<Vec<f32>> = None;
    for i in 0..4000 {
        let azimuth = (102.39 + 1e-5 * f64::from(i)).to_radians();
        let place = (6000.0, 0.05f64.to_radians(), -1f64.to_radians(), azimuth);
        let mut row = vec![0.0; estimates.len()];
        estimates.along(&line(place), &mut row);
        if let Some(before) = before {
            for (a, b) in row.iter().zip(&before) {
                assert!((a / b - 1.0).abs() < 2e-3, "{i}: {a} {b}");
            }
        }
        before = Some(row);
    }
}

#[test]
fn an_observer_on_the_ground_sees_nothing_below() {
    let estimates = estimates();
    let mut row = vec![1.0; estimates.len()];
    let down = Sightline {
        side: Side::Down,
        ..line((0.0, -0.3, 0.5, 1.0))
    };
    estimates.along(&down, &mut row);
    assert!(row.iter().all(|v| *v == 0.0), "{row:?}");
}

/// In the shadow of the Earth no sunlight is seen but the rest that keeps fields finite.
#[test]
fn the_shadow_is_dark() {
    let estimates = estimates();
    let mut row = vec![0.0; estimates.len()];
    let nw = row.len() / 3;
    // Along level ground, away from a sun that has long set.
    estimates.along(&line((0.0, 0.0, -0.19, std::f64::consts::PI)), &mut row);
    for w in 0..nw {
        let rest = 1e-3 * row[2 * nw + w];
        assert!(row[w] < 1.5 * rest && row[nw + w] < 1.5 * rest, "{row:?}");
    }
}

//! Between its samples the embedded model bends no more than the sky does: every parameter is walked across all of its
//! nodes.

mod common;

use welkin::{Conditions, Model};

/// View directions: near the sun's azimuth, beside it, near the horizon, near the zenith, below the horizon.
const DIRECTIONS: [[f32; 3]; 5] = [
    [0.6, 0.3, 0.7],
    [-0.2, 0.9, 0.4],
    [0.7, -0.7, 0.03],
    [0.1, 0.05, 0.99],
    [0.6, 0.6, -0.5],
];
const WAVELENGTHS: [f64; 3] = [360.0, 520.0, 720.0];
/// Steps per interval between nodes.
const STEPS: usize = 6;
/// Where second differences are taken, in parts of an interval to either side.
const REACH: f64 = 1.0 / 48.0;

/// The sharpest kink of ln L and where it is: by how much the slope jumps, times the interval, for every direction and
/// wavelength.
///
/// A jump shows in second differences over any reach alike, curvature in proportion to the reach; of two reaches it
/// drops out.
fn sharpest(nodes: &[f64], logarithms: impl Fn(f64) -> Vec<f64>) -> (f64, f64) {
    let mut worst = (0.0, f64::NAN);
    for pair in nodes.windows(2) {
        let interval = pair[1] - pair[0];
        for step in 0..STEPS {
            let x = pair[0] + interval * step as f64 / STEPS as f64;
            if x - REACH * interval < nodes[0] {
                continue;
            }
            let here = logarithms(x);
            let turn = |reach: f64| -> Vec<f64> {
                let before = logarithms(x - reach * interval);
                let after = logarithms(x + reach * interval);
                let three = before.iter().zip(&here).zip(after);
                three.map(|((a, b), c)| (a - 2.0 * b + c) / reach).collect()
            };
            for (near, far) in turn(REACH / 2.0).into_iter().zip(turn(REACH)) {
                let kink = (2.0 * near - far).abs();
                if kink > worst.0 {
                    worst = (kink, x);
                }
            }
        }
    }
    worst
}

fn logarithms(model: &Model, conditions: &Conditions) -> Vec<f64> {
    let sky = model.sky(conditions).unwrap();
    let pairs = DIRECTIONS.iter().flat_map(|d| WAVELENGTHS.map(|w| (*d, w)));
    let lit = pairs.filter(|(d, _)| conditions.altitude > 10.0 || d[2] > 0.0);
    lit.map(|(d, w)| f64::from(sky.relative_radiance_at(d, w).unwrap()).ln())
        .collect()
}

/// The sun high, low, and below the horizon.
fn suns() -> [f64; 3] {
    [35.0, 4.0, -2.5].map(f64::to_radians)
}

fn bounded(parameter: &str, (kink, at): (f64, f64), bound: f64) {
    println!("{parameter}: {:.2} % at {at}", 100.0 * kink);
    assert!(kink < bound, "{parameter}: {kink} at {at}");
}

#[test]
fn solar_elevation_has_no_kinks() {
    let model = Model::default_model().unwrap();
    let axis = model.head().elevation;
    let nodes: Vec<f64> = (0..=axis.intervals)
        .map(|u| axis.elevation(u as f64))
        .collect();
    for (altitude, visibility) in [(0.0, 59.4e3), (2500.0, 24e3)] {
        let worst = sharpest(&nodes, |solar_elevation| {
            let conditions = Conditions {
                solar_elevation: solar_elevation.min(axis.max),
                altitude,
                visibility,
                ..Conditions::default()
            };
            logarithms(&model, &conditions)
        });
        // The tables of the estimates are linear, so that there are kinks where the disc of the sun comes out and in
        // deep twilight: half a per cent over a hundredth of an interval at most.
        bounded("solar elevation", worst, 0.25);
    }
}

#[test]
fn altitude_has_no_kinks() {
    let model = Model::default_model().unwrap();
    // From 30 m: looking down from the ground itself there is nothing to see. Above 40 km the linear table of densities
    // is seen, of which a kink is as large as 0.8 of what changes over an interval of 24 km.
    let nodes: Vec<f64> = model
        .head()
        .altitudes
        .iter()
        .copied()
        .filter(|h| (30.0..=40e3).contains(h))
        .collect();
    for solar_elevation in suns() {
        let worst = sharpest(&nodes, |altitude| {
            let conditions = Conditions {
                solar_elevation,
                altitude,
                ..Conditions::default()
            };
            logarithms(&model, &conditions)
        });
        bounded("altitude", worst, 0.2);
    }
}

#[test]
fn visibility_has_no_kinks() {
    let model = Model::default_model().unwrap();
    let nodes = model.head().visibilities.clone();
    for solar_elevation in suns() {
        for altitude in [0.0, 3000.0] {
            let worst = sharpest(&nodes, |visibility| {
                let conditions = Conditions {
                    solar_elevation,
                    altitude,
                    visibility,
                    ..Conditions::default()
                };
                logarithms(&model, &conditions)
            });
            bounded("visibility", worst, 0.012);
        }
    }
}

#[test]
fn albedo_has_no_kinks() {
    let model = Model::default_model().unwrap();
    let nodes: Vec<f64> = (0..=12).map(|k| f64::from(k) / 12.0).collect();
    for solar_elevation in suns() {
        let worst = sharpest(&nodes, |albedo| {
            let conditions = Conditions {
                solar_elevation,
                albedo: albedo.min(1.0),
                ..Conditions::default()
            };
            logarithms(&model, &conditions)
        });
        bounded("albedo", worst, 0.001);
    }
}

/// In a file without a spectrum; with one, ln L is straight between cells.
#[test]
fn wavelength_has_no_kinks() {
    let model = Model::from_bytes(common::long_bytes()).unwrap();
    let nodes = model.head().wavelengths.clone();
    for solar_elevation in suns() {
        let conditions = Conditions {
            solar_elevation,
            ..Conditions::default()
        };
        let sky = model.sky(&conditions).unwrap();
        let worst = sharpest(&nodes, |wavelength| {
            let above = DIRECTIONS.iter().filter(|d| d[2] > 0.0);
            let value = |d: &[f32; 3]| sky.relative_radiance_at(*d, wavelength).unwrap();
            above.map(|d| f64::from(value(d)).ln()).collect()
        });
        bounded("wavelength", worst, 0.001);
    }
}

/// What the measure says of linear interpolation: the same sky read linearly between two visibilities has a kink that
/// would not pass.
#[test]
fn linear_interpolation_would_be_noticed() {
    let model = Model::default_model().unwrap();
    let nodes = model.head().visibilities.clone();
    let node = |visibility: f64| {
        let conditions = Conditions {
            solar_elevation: 4f64.to_radians(),
            visibility,
            ..Conditions::default()
        };
        logarithms(&model, &conditions)
    };
    let (kink, at) = sharpest(&nodes, |visibility| {
        let i = nodes
            .partition_point(|n| *n <= visibility)
            .clamp(1, nodes.len() - 1);
        let share = (visibility - nodes[i - 1]) / (nodes[i] - nodes[i - 1]);
        let pairs = node(nodes[i - 1]).into_iter().zip(node(nodes[i]));
        pairs
            .map(|(a, b)| (a.exp() * (1.0 - share) + b.exp() * share).ln())
            .collect()
    });
    println!("linear: {:.2} % at {at}", 100.0 * kink);
    assert!(kink > 0.04, "{kink}");
}

//! Points on the ground and under it: polders, depressions, vertices that rounding put below the sphere.
#![cfg(feature = "default-model")]

mod common;

use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

use common::unit;
use proptest::prelude::*;
use welkin::{AerialPerspective, Conditions, DEFAULT_MODEL, Error, Model, PointQuery};

static MODEL: LazyLock<Model> = LazyLock::new(|| Model::default_model().unwrap());
static AERIAL: LazyLock<AerialPerspective> =
    LazyLock::new(|| MODEL.aerial_perspective(&Conditions::default()).unwrap());

fn to_end(from: [f64; 3], direction: [f64; 3]) -> (Vec<f32>, Vec<f32>) {
    let n = AERIAL.wavelengths().len();
    let (mut light, mut through) = (vec![0.0; n], vec![0.0; n]);
    AERIAL
        .to_end(from, direction, &mut light, &mut through)
        .unwrap();
    (light, through)
}

fn to_space(from: [f64; 3], direction: [f64; 3]) -> Vec<f32> {
    let mut out = vec![0.5; AERIAL.wavelengths().len()];
    AERIAL
        .transmittance()
        .transmittance_to_space(from, direction, &mut out)
        .unwrap();
    out
}

/// A place at an angle from the origin, its vertical, and a direction there.
fn local(away: f64, around: f64, [elevation, azimuth]: [f64; 2]) -> ([f64; 3], [f64; 3]) {
    let up = unit(FRAC_PI_2 - away, around);
    let across = [-around.sin(), around.cos(), 0.0];
    let along = unit(-away, around);
    let [x, y, z] = unit(elevation, azimuth);
    (
        up,
        std::array::from_fn(|k| x * along[k] + y * across[k] + z * up[k]),
    )
}

#[test]
fn a_nanometre_under_the_ground_is_the_limit_from_above() {
    let down = [1.0, 0.0, -0.1763];
    for depth in [0.0, -1e-9, -1e-3, -1.0, -430.0, -5e4, -6e6] {
        let (light, through) = to_end([0.0, 0.0, depth], down);
        assert!(light.iter().all(|&l| l == 0.0), "{depth}: {light:?}");
        assert!(through.iter().all(|&t| t == 1.0), "{depth}: {through:?}");
        assert!(to_space([0.0, 0.0, depth], down).iter().all(|&t| t == 0.0));
    }
    let (light, through) = to_end([0.0, 0.0, 1e-9], down);
    assert!(light.iter().all(|&l| l < 1e-9) && through.iter().all(|&t| t == 1.0));
}

#[test]
fn in_depressions_the_air_goes_on() {
    let upwards = [0.6, 0.2, 0.3];
    let mut before = to_end([0.0; 3], upwards);
    for depth in [-1e-9, -0.5, -10.0, -430.0, -3000.0] {
        let now = to_end([0.0, 0.0, depth], upwards);
        for (near, far) in before.1.iter().zip(&now.1) {
            assert!(far <= near, "{depth}");
        }
        let step = -depth / 430.0;
        let pairs = before
            .0
            .iter()
            .chain(&before.1)
            .zip(now.0.iter().chain(&now.1));
        for (a, b) in pairs {
            assert!(
                f64::from((a / b).ln().abs()) < 1e-6 + 0.5 * step,
                "{depth}: {a} {b}"
            );
        }
        before = now;
    }
}

proptest! {
    #![proptest_config(common::cases(4000))]

    /// Wherever, in double and in single precision, with the coordinates rounded to either side.
    #[test]
    fn points_on_the_sphere_never_see_through_the_planet(
        away in prop_oneof![0.0..0.17f64, 0.0..3.1f64],
        around in -3.1..3.1f64,
        elevation in prop_oneof![-1.5..1.5f64, -0.01..0.01f64],
        azimuth in -3.1..3.1f64,
        lift in prop_oneof![Just(0.0), -1e-9..1e-9f64, -0.01..0.01f64],
        single in any::<bool>(),
    ) {
        let radius = MODEL.head().planet.radius;
        let (up, direction) = local(away, around, [elevation, azimuth]);
        let exact: [f64; 3] =
            std::array::from_fn(|k| (radius + lift) * up[k] - if k == 2 { radius } else { 0.0 });
        let point = match single {
            true => exact.map(|v| f64::from(v as f32)),
            false => exact,
        };
        // How far the point may stand above the sphere, and how deep under its horizon the ray must go not to pass
        // that.
        let height = if single { 1.0 } else { 1e-8 } + lift.abs();
        let dip = (2.0 * height / radius).sqrt();
        let space = to_space(point, direction);
        // Farther away the aerial perspective of the origin does not reach.
        let asked = away < 0.17;
        let (light, through) = if asked { to_end(point, direction) } else { Default::default() };
        if elevation < -1.01 * dip - 1e-9 {
            prop_assert!(space.iter().all(|&t| t == 0.0));
            // No more than the way from that height down to the ground.
            let way = (2.0 * height / -elevation.sin()) as f32;
            for (l, t) in light.iter().zip(&through) {
                prop_assert!(1.0 - t <= 3e-4 * way && *l <= 3e-4 * way, "{way}: {l} {t}");
            }
        } else if asked && elevation > dip + 1e-6 {
            let (above, clear) = to_end(
                std::array::from_fn(|k| exact[k] + 2.0 * height * up[k]),
                direction,
            );
            let apart = 4.0 * height * (1.0 / elevation.sin().max(dip)).min(1e5) * 3e-4 + 1e-3;
            for ((a, b), (t, c)) in light.iter().zip(&above).zip(through.iter().zip(&clear)) {
                prop_assert!(f64::from((a / b - 1.0).abs()) < apart, "{a} {b}");
                prop_assert!(f64::from((t - c).abs()) < apart, "{t} {c}");
            }
        }
    }
}

#[test]
fn observers_in_depressions_stand_on_the_ground() {
    let conditions = |altitude| Conditions {
        altitude,
        ..Conditions::default()
    };
    let query = PointQuery::new(DEFAULT_MODEL).unwrap();
    let direction = [0.4, -0.3, -0.1];
    let answers = |altitude: f64| {
        let sky = MODEL.polarised_sky(&conditions(altitude)).unwrap();
        assert_eq!(sky.sky().conditions().altitude, 0.0);
        let mut at_once = vec![0.0; MODEL.wavelengths().len()];
        let asked = conditions(altitude);
        query
            .relative_radiance(&asked, direction, &mut at_once)
            .unwrap();
        let aerial = MODEL.aerial_perspective(&asked).unwrap();
        assert_eq!(aerial.conditions().altitude, 0.0);
        (common::radiance(sky.sky(), [0.4, -0.3, 0.1]), at_once)
    };
    let ground = answers(0.0);
    for altitude in [-0.0, -1e-9, -0.3, -430.0, -500.0] {
        assert_eq!(answers(altitude), ground, "{altitude}");
    }
    for altitude in [-500.1, -1e4, f64::NAN, f64::NEG_INFINITY] {
        let refused = |error: Error| {
            matches!(
                error,
                Error::OutOfRange {
                    parameter: "altitude",
                    ..
                }
            )
        };
        assert!(refused(MODEL.sky(&conditions(altitude)).unwrap_err()));
        assert!(refused(
            MODEL.aerial_perspective(&conditions(altitude)).unwrap_err()
        ));
        let mut out = vec![0.0; MODEL.wavelengths().len()];
        let asked = conditions(altitude);
        assert!(refused(
            query
                .relative_radiance(&asked, direction, &mut out)
                .unwrap_err()
        ));
    }
}

//! Plans promise no less than scenes use.

mod common;

use proptest::prelude::*;
use welkin::{Budget, Channels, Conditions, Error, Interpolation, Model};

fn budget(altitude: [f64; 2], visibility: [f64; 2]) -> Budget {
    Budget {
        altitude,
        visibility,
        solar_elevation: [-0.05, 1.5],
        tolerance: 0.01,
        channels: Channels::Spectral,
    }
}

fn sorted(a: f64, b: f64) -> [f64; 2] {
    [a.min(b), a.max(b)]
}

proptest! {
    #![proptest_config(common::cases(256))]

    #[test]
    fn scenes_read_what_was_planned_and_no_more(
        (a, b) in (0.0..2000.0f64, 0.0..2000.0f64),
        (v, w) in (20e3..131.8e3f64, 20e3..131.8e3f64),
        places in prop::collection::vec((0.0..=1.0f64, 0.0..=1.0f64), 1..8),
    ) {
        let model = Model::stream(common::model_bytes()).unwrap();
        let plan = model.plan(&budget(sorted(a, b), sorted(v, w))).unwrap();
        prop_assert_eq!(model.touched_bytes(), model.head_bytes());
        model.load(&plan).unwrap();
        prop_assert_eq!(model.touched_bytes(), plan.file_bytes);
        let requests = model.traffic().requests;
        let query = model.point_query(&plan).unwrap().with_interpolation(Interpolation::Full);
        for (s, t) in places {
            let ([low, high], [hazy, clear]) = (sorted(a, b), sorted(v, w));
            let conditions = Conditions {
                altitude: low + s * (high - low),
                visibility: hazy + t * (clear - hazy),
                ..Conditions::default()
            };
            let sky = model.sky(&conditions).unwrap();
            let (mut got, mut expected) = (vec![0.0; 6], vec![0.0; 6]);
            query.radiance(&conditions, [0.2, 0.1, 0.3], &mut got).unwrap();
            sky.radiance([0.2, 0.1, 0.3], &mut expected).unwrap();
            for (got, expected) in got.iter().zip(&expected) {
                prop_assert!((got - expected).abs() <= 3e-5 * expected, "{got} {expected}");
            }
        }
        prop_assert_eq!(model.touched_bytes(), plan.file_bytes);
        prop_assert_eq!(model.traffic().requests, requests);
    }
}

#[test]
fn polarised_scenes_read_what_was_planned() {
    let model = Model::stream(common::polarised_bytes(0.02)).unwrap();
    for (altitude, visibility) in [([0.0, 0.0], [20e3, 20e3]), ([0.0, 900.0], [25e3, 90e3])] {
        let budget = Budget {
            channels: Channels::Stokes,
            ..budget(altitude, visibility)
        };
        let plan = model.plan(&budget).unwrap();
        model.load(&plan).unwrap();
        let requests = model.traffic().requests;
        for t in [0.0, 0.4, 1.0] {
            let between = |[low, high]: [f64; 2]| low + t * (high - low);
            let conditions = Conditions {
                altitude: between(altitude),
                visibility: between(visibility),
                ..Conditions::default()
            };
            model.polarised_sky(&conditions).unwrap();
        }
        assert_eq!(model.touched_bytes(), plan.file_bytes);
        assert_eq!(model.traffic().requests, requests);
        model.point_query(&plan).unwrap();
    }
    let plain = Model::from_bytes(common::model_bytes()).unwrap();
    let error = plain.plan(&Budget {
        channels: Channels::Stokes,
        ..budget([0.0, 0.0], [20e3, 20e3])
    });
    assert!(matches!(error, Err(Error::MissingChunk { .. })));
}

#[test]
fn bad_budgets_are_typed_errors() {
    let model = Model::from_bytes(common::model_bytes()).unwrap();
    let sound = budget([0.0, 100.0], [20e3, 30e3]);
    for broken in [
        budget([100.0, 0.0], [20e3, 30e3]),
        budget([0.0, 1e6], [20e3, 30e3]),
        budget([0.0, f64::NAN], [20e3, 30e3]),
        budget([0.0, 100.0], [1e3, 30e3]),
        Budget {
            solar_elevation: [-0.5, 0.5],
            ..sound
        },
        Budget {
            tolerance: 0.0,
            ..sound
        },
        Budget {
            tolerance: f64::NAN,
            ..sound
        },
    ] {
        assert!(
            matches!(model.plan(&broken), Err(Error::OutOfRange { .. })),
            "{broken:?}"
        );
    }
}

#[test]
fn plans_and_bakes_take_the_same_tolerances() {
    let model = Model::from_bytes(common::model_bytes()).unwrap();
    let sky = model.sky(&welkin::Conditions::default()).unwrap();
    let (mut taken, mut refused) = (0, 0);
    for tolerance in [
        f64::NAN,
        f64::NEG_INFINITY,
        -1.0,
        0.0,
        5e-324,
        f64::MIN_POSITIVE,
        1e-9,
        2.9e-4,
        3e-4,
        2.5e-3,
        1.0,
        2.0,
        1e9,
        f64::MAX,
        f64::INFINITY,
    ] {
        let plan = model.plan(&Budget {
            tolerance,
            ..budget([0.0, 100.0], [20e3, 30e3])
        });
        let out_of_range = |error: &Error| {
            matches!(
                error,
                Error::OutOfRange {
                    parameter: "tolerance",
                    ..
                }
            )
        };
        let planned = !plan.as_ref().is_err_and(out_of_range);
        // A tolerance that this sky is too hard for was taken all the same.
        let baked = !sky.bake(tolerance).as_ref().is_err_and(out_of_range);
        let coloured = !sky.bake_colour(tolerance).as_ref().is_err_and(out_of_range);
        assert_eq!([planned, planned], [baked, coloured], "{tolerance}");
        match planned {
            true => taken += 1,
            false => refused += 1,
        }
    }
    assert_eq!([taken, refused], [6, 9]);
}

#[test]
#[cfg(feature = "default-model")]
fn baked_skies_keep_the_promises_of_the_plan() {
    let model = Model::default_model().unwrap();
    for tolerance in [0.01, 0.0025, 0.0012] {
        for channels in [Channels::Spectral, Channels::Colour, Channels::Stokes] {
            let plan = model
                .plan(&Budget {
                    tolerance,
                    channels,
                    ..budget([0.0, 0.0], [59.4e3, 59.4e3])
                })
                .unwrap();
            assert!(plan.error_p99 > 0.0 && plan.file_bytes < model.file_bytes() / 10);
            let degree = plan
                .degree_error
                .map(|[median, p99]| 0.0 < median && median < p99);
            assert_eq!(degree, (channels == Channels::Stokes).then_some(true));
            for elevation in [-3.0f64, 4.0, 60.0] {
                let conditions = Conditions {
                    solar_elevation: elevation.to_radians(),
                    ..Conditions::default()
                };
                let sky = model.sky(&conditions).unwrap();
                let (bytes, error) = match channels {
                    Channels::Spectral => sky
                        .bake(tolerance)
                        .map(|b| (b.bytes(), b.bake_error()))
                        .unwrap(),
                    Channels::Colour => sky
                        .bake_colour(tolerance)
                        .map(|b| (b.bytes(), b.bake_error()))
                        .unwrap(),
                    Channels::Stokes => {
                        let sky = model.polarised_sky(&conditions).unwrap();
                        let baked = sky.bake(tolerance).unwrap();
                        assert!(baked.sky().bake_error().p95 <= plan.bake_p95);
                        (baked.bytes(), baked.polarisation_error())
                    }
                };
                assert!(bytes <= plan.sky_bytes, "{bytes} {plan:?}");
                assert!(error.p95 <= plan.bake_p95);
            }
        }
    }
}

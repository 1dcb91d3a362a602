//! Queries without preparation give what prepared skies give.

mod common;
#[allow(dead_code)]
#[path = "../tools/src/random.rs"]
mod random;

use proptest::prelude::*;
use welkin::{Conditions, Error, Interpolation, Model, PointQuery};

/// Relative differences from skies at random conditions of the default model: median, 95th and 99th percentile.
fn differences(interpolation: Interpolation) -> [f64; 3] {
    let model = Model::default_model().unwrap();
    let query = PointQuery::new(welkin::DEFAULT_MODEL)
        .unwrap()
        .with_interpolation(interpolation);
    let (mut places, mut views) = (
        random::Sequence::<4>::default(),
        random::Sequence::<2>::default(),
    );
    let mut differences = Vec::new();
    for _ in 0..400 {
        let conditions = random::conditions(&model, places.draw());
        let sky = model.sky(&conditions).unwrap();
        for _ in 0..4 {
            let direction = random::sphere(views.draw());
            let [mut got, mut expected] = [(); 2].map(|()| vec![0.0; model.wavelengths().len()]);
            query.radiance(&conditions, direction, &mut got).unwrap();
            sky.radiance(direction, &mut expected).unwrap();
            let judged =
                |w: &usize| expected[*w] > 0.0 && common::CLEAR.contains(&model.wavelengths()[*w]);
            let apart = |w: usize| f64::from((got[w] / expected[w] - 1.0).abs());
            differences.extend((0..got.len()).filter(judged).map(apart));
        }
    }
    differences.sort_by(f64::total_cmp);
    [0.5, 0.95, 0.99].map(|q| differences[(q * differences.len() as f64) as usize])
}

#[test]
fn fewer_chunks_cost_as_much_accuracy_as_is_said() {
    let [linear, full] = [Interpolation::Linear, Interpolation::Full].map(differences);
    println!("linear {linear:.6?}\nfull   {full:.8?}");
    let below = |got: [f64; 3], limits: [f64; 3]| got.iter().zip(limits).all(|(&g, l)| g < l);
    assert!(below(full, [1e-6, 2e-6, 4e-6]));
    assert!(below(linear, [1e-3, 8e-3, 1.6e-2]));
}

#[test]
fn it_fits_where_there_is_no_heap() {
    assert!(size_of::<PointQuery>() < 76_000);
}

#[test]
fn at_the_nodes_all_interpolations_agree() {
    let prepared = |i| {
        PointQuery::new(welkin::DEFAULT_MODEL)
            .unwrap()
            .with_interpolation(i)
    };
    let model = Model::default_model().unwrap();
    let [altitudes, visibilities] = [&model.head().altitudes, &model.head().visibilities];
    for share in [0.0, 0.5, 1.0] {
        let node = |nodes: &[f64]| nodes[(share * (nodes.len() - 1) as f64) as usize];
        let (altitude, visibility) = (node(altitudes), node(visibilities));
        let conditions = Conditions {
            altitude,
            visibility,
            ..Conditions::default()
        };
        let n = model.wavelengths().len();
        let [mut linear, mut full] = [(); 2].map(|()| vec![0.0; n]);
        let direction = [0.3, 0.4, 0.2];
        for (interpolation, out) in [
            (Interpolation::Linear, &mut linear),
            (Interpolation::Full, &mut full),
        ] {
            let query = prepared(interpolation);
            query.radiance(&conditions, direction, out).unwrap();
        }
        assert_eq!(linear, full);
    }
}

/// Either side of a node and of the middle of an interval, where other neighbours may count.
#[test]
fn nothing_jumps_between_intervals() {
    let model = Model::default_model().unwrap();
    let [altitudes, visibilities] = [&model.head().altitudes, &model.head().visibilities];
    let middles = |nodes: &[f64]| {
        nodes
            .windows(2)
            .map(|n| (n[0] + n[1]) / 2.0)
            .collect::<Vec<_>>()
    };
    let places = [altitudes, visibilities].map(|nodes| {
        let inner = &nodes[1..nodes.len() - 1];
        [inner.to_vec(), middles(nodes)].concat()
    });
    for interpolation in [Interpolation::Linear, Interpolation::Full] {
        let query = PointQuery::new(welkin::DEFAULT_MODEL)
            .unwrap()
            .with_interpolation(interpolation);
        for (&altitude, &visibility) in places[0]
            .iter()
            .flat_map(|a| places[1].iter().map(move |v| (a, v)))
        {
            let [mut below, mut above] = [(); 2].map(|()| vec![0.0; model.wavelengths().len()]);
            for (nudge, out) in [(-1e-9, &mut below), (1e-9, &mut above)] {
                let conditions = Conditions {
                    altitude: altitude * (1.0 + nudge),
                    visibility: visibility * (1.0 + nudge),
                    ..Conditions::default()
                };
                query.radiance(&conditions, [0.3, 0.4, 0.2], out).unwrap();
            }
            for (below, above) in below.into_iter().zip(above) {
                assert!(
                    (below / above - 1.0).abs() < 1e-5 * common::darkness(above),
                    "{altitude} {visibility} {below} {above}"
                );
            }
        }
    }
}

fn bits_of(error: &Error) -> String {
    error.to_string()
}

proptest! {
    #![proptest_config(common::cases(256))]

    #[test]
    fn queries_agree_with_skies(
        altitude in prop_oneof![Just(0.0), Just(120.0), Just(2000.0), 0.0..2000.0f64],
        visibility in prop_oneof![Just(59.4e3), Just(20e3), Just(131.8e3), 20e3..131.8e3f64],
        albedo in prop_oneof![Just(0.0), Just(1.0), 0.0..1.0f64],
        elevation in -4.2..90.0f64,
        solar_azimuth in -7.0..7.0f64,
        direction in prop::array::uniform3(-1.0..1.0f32),
        bytes in prop::sample::select(vec![common::model_bytes(), common::wide_bytes(), common::long_bytes()]),
    ) {
        let query = PointQuery::new(&bytes).unwrap().with_interpolation(Interpolation::Full);
        query.verify(&bytes).unwrap();
        let model = Model::from_bytes(bytes.clone()).unwrap();
        let solar_elevation = elevation.to_radians();
        let conditions = Conditions { solar_elevation, solar_azimuth, visibility, albedo, altitude };
        let sky = model.sky(&conditions).unwrap();
        let n = query.wavelengths().len();
        let (mut got, mut expected, mut zenith) = (vec![f32::NAN; n], vec![f32::NAN; n], vec![f32::NAN; n]);
        query.radiance(&conditions, direction, &mut got).unwrap();
        sky.radiance(direction, &mut expected).unwrap();
        sky.radiance([0.0, 0.0, 1.0], &mut zenith).unwrap();
        for i in 0..n {
            let allowed = (3e-5 * expected[i]).max(1e-7 * zenith[i]);
            prop_assert!((got[i] - expected[i]).abs() <= allowed, "{} {}", got[i], expected[i]);
        }
    }

    #[test]
    fn any_conditions_and_directions_give_numbers_or_the_errors_of_skies(
        [solar_elevation, solar_azimuth, visibility, albedo, altitude] in prop::array::uniform5(prop_oneof![any::<f64>(), -1.0..2e5f64]),
        direction in prop::array::uniform3(any::<f32>()),
    ) {
        let bytes = common::model_bytes();
        let query = PointQuery::new(&bytes).unwrap();
        let model = Model::from_bytes(bytes.clone()).unwrap();
        let conditions = Conditions { solar_elevation, solar_azimuth, visibility, albedo, altitude };
        let mut out = vec![f32::NAN; query.wavelengths().len()];
        let got = query.radiance(&conditions, direction, &mut out);
        let expected = model.sky(&conditions).and_then(|sky| sky.radiance(direction, &mut out.clone()));
        match (&got, &expected) {
            (Ok(()), Ok(())) => prop_assert!(out.iter().all(|l| l.is_finite() && *l >= 0.0)),
            (Err(got), Err(expected)) => prop_assert_eq!(bits_of(got), bits_of(expected)),
            _ => prop_assert!(false, "{got:?} {expected:?}"),
        }
    }

    #[test]
    fn damaged_files_never_panic(place in any::<prop::sample::Index>(), bit in 0..8u32, refresh in any::<bool>()) {
        let original = common::model_bytes();
        let mut bytes = original.clone();
        let place = place.index(bytes.len());
        bytes[place] ^= 1 << bit;
        if refresh {
            common::seal(&mut bytes, &original);
        }
        if let Ok(query) = PointQuery::new(&bytes) {
            let mut out = vec![f32::NAN; query.wavelengths().len()];
            for z in [-0.5, 0.1, 1.0] {
                for altitude in [0.0, 500.0] {
                    let conditions = Conditions { altitude, ..Conditions::default() };
                    if query.radiance(&conditions, [0.3, 0.2, z], &mut out).is_ok() {
                        prop_assert!(out.iter().all(|l| l.is_finite()), "{out:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn missing_chunks_and_wrong_lengths_are_typed_errors() {
    let head = common::head(&[0.0, 120.0, 1000.0], &[20e3, 59.4e3]);
    let mut chunks = common::chunks(&head);
    chunks.retain(|c| c.altitude != Some(1));
    let bytes = welkin::format::encode(&head, &chunks).unwrap();
    let query = PointQuery::new(&bytes).unwrap();
    let mut out = vec![0.0; query.wavelengths().len()];
    let conditions = Conditions::default();
    query
        .radiance(&conditions, [0.0, 0.0, 1.0], &mut out)
        .unwrap();
    let wrong = query.radiance(&conditions, [0.0, 0.0, 1.0], &mut out[1..]);
    assert!(matches!(wrong, Err(Error::Length { .. })));
    let above = Conditions {
        altitude: 60.0,
        ..conditions
    };
    let missing = query.radiance(&above, [0.0, 0.0, 1.0], &mut out);
    assert!(matches!(
        missing,
        Err(Error::MissingChunk {
            altitude: Some(120.0),
            ..
        })
    ));
    assert!(matches!(PointQuery::new(b""), Err(Error::NotWelkin)));
    assert!(matches!(
        PointQuery::new(&bytes[..bytes.len() - 1]),
        Err(Error::Length { .. })
    ));
    let mut damaged = bytes.clone();
    *damaged.last_mut().unwrap() ^= 1;
    let query = PointQuery::new(&damaged).unwrap();
    assert!(matches!(
        query.verify(&damaged),
        Err(Error::Checksum { .. })
    ));
}

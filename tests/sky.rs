//! What holds for every sky and every query, whatever the floats.

mod common;

use std::sync::LazyLock;

use common::{direction, radiance};
use proptest::prelude::*;
use welkin::{Conditions, Error, Model, Sky};

static MODEL: LazyLock<Model> = LazyLock::new(|| Model::from_bytes(common::model_bytes()).unwrap());

fn conditions() -> impl Strategy<Value = Conditions> {
    (
        -4.2..90.0f64,
        -9.0..9.0f64,
        20e3..131.8e3f64,
        0.0..1.0f64,
        0.0..2e3f64,
    )
        .prop_map(
            |(elevation, solar_azimuth, visibility, albedo, altitude)| Conditions {
                solar_elevation: elevation.to_radians(),
                solar_azimuth,
                visibility,
                albedo,
                altitude,
            },
        )
}

/// Ordinary numbers and all the odd ones.
fn any_f64() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<f64>(),
        -2.0..2.0f64,
        0.0..2e5f64,
        prop::sample::select(vec![
            0.0,
            -0.0,
            f64::NAN,
            f64::INFINITY,
            f64::MIN,
            f64::MAX,
            5e-324
        ]),
    ]
}

fn any_f32() -> impl Strategy<Value = f32> {
    prop_oneof![
        any::<f32>(),
        -1.0..1.0f32,
        prop::sample::select(vec![0.0, -0.0, f32::NAN, f32::INFINITY, f32::MAX, 1e-45]),
    ]
}

proptest! {
    #![proptest_config(common::cases(256))]

    #[test]
    fn radiance_is_finite_and_not_negative(conditions in conditions(), direction in prop::array::uniform3(any_f32())) {
        let sky = MODEL.sky(&conditions).unwrap();
        let mut out = vec![f32::NAN; sky.wavelengths().len()];
        let sound = direction.iter().all(|v| v.is_finite()) && direction.iter().any(|&v| v != 0.0);
        match sky.radiance(direction, &mut out) {
            Ok(()) => {
                prop_assert!(sound);
                prop_assert!(out.iter().all(|l| l.is_finite() && *l >= 0.0), "{out:?}");
                prop_assert!(sky.linear_srgb(direction).unwrap().iter().all(|v| v.is_finite()));
            }
            Err(Error::Direction { .. }) => prop_assert!(!sound),
            Err(other) => prop_assert!(false, "{other}"),
        }
    }

    #[test]
    fn conditions_of_any_floats_get_a_sky_or_a_typed_error(
        [solar_elevation, solar_azimuth, visibility, albedo, altitude] in prop::array::uniform5(any_f64()),
        wavelength in any_f64(),
    ) {
        let conditions = Conditions { solar_elevation, solar_azimuth, visibility, albedo, altitude };
        let finite = [solar_elevation, solar_azimuth, visibility, albedo, altitude].iter().all(|v| v.is_finite());
        let clamped = conditions.clamped(&MODEL);
        prop_assert_eq!(clamped.is_ok(), finite);
        let sky = match MODEL.sky(&conditions) {
            Ok(sky) => sky,
            Err(Error::OutOfRange { .. }) => match clamped {
                Ok(clamped) => MODEL.sky(&clamped).unwrap(),
                Err(_) => return Ok(()),
            },
            Err(other) => return Err(TestCaseError::fail(other.to_string())),
        };
        match sky.radiance_at([0.1, 0.2, 0.3], wavelength) {
            Ok(l) => prop_assert!(l.is_finite() && l >= 0.0),
            Err(Error::OutOfRange { parameter: "wavelength", .. }) => {}
            Err(other) => prop_assert!(false, "{other}"),
        }
    }

    #[test]
    fn left_and_right_of_the_sun_mirror(conditions in conditions(), elevation in -1.5..1.5f64, azimuth in 0.0..3.1f64) {
        let straight = MODEL.sky(&Conditions { solar_azimuth: 0.0, ..conditions }).unwrap();
        let [x, y, z] = direction(elevation, azimuth);
        prop_assert_eq!(radiance(&straight, [x, y, z]), radiance(&straight, [x, -y, z]));
        let turned = MODEL.sky(&conditions).unwrap();
        let sun = conditions.solar_azimuth;
        let left = radiance(&turned, direction(elevation, sun + azimuth));
        let right = radiance(&turned, direction(elevation, sun - azimuth));
        for (a, b) in left.iter().zip(&right) {
            prop_assert!((a - b).abs() <= 2e-4 * a.max(*b), "{a} {b}");
        }
    }

    #[test]
    fn length_of_the_direction_does_not_matter(conditions in conditions(), direction in prop::array::uniform3(-1.0..1.0f32), exponent in -100i32..100) {
        let sky = MODEL.sky(&conditions).unwrap();
        let scaled = direction.map(|v| v * 2f32.powi(exponent));
        prop_assert_eq!(radiance(&sky, direction), radiance(&sky, scaled));
    }

    #[test]
    fn small_turns_change_little(conditions in conditions(), elevation in -1.5..1.5f64, azimuth in -3.1..3.1f64, turn in 0.0..6.3f64) {
        let dip = (6_378_000.0 / (6_378_000.0 + conditions.altitude)).acos();
        prop_assume!((elevation + dip).abs() > 0.03);
        let sky = MODEL.sky(&conditions).unwrap();
        let step = 1e-4;
        let a = radiance(&sky, direction(elevation, azimuth));
        let b = radiance(&sky, direction(elevation + step * turn.sin(), azimuth + step * turn.cos()));
        for (a, b) in a.iter().zip(&b) {
            prop_assert!((a - b).abs() <= 0.02 * a.max(*b) + 1e-9, "{a} {b}");
        }
    }
}

#[test]
fn special_directions_have_values() {
    let sky = MODEL
        .sky(&Conditions {
            altitude: 300.0,
            ..Conditions::default()
        })
        .unwrap();
    let sun = sky.sun_direction();
    let [x, y, z] = sun;
    for direction in [
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
        [1.0, 0.0, 0.0],
        [0.0, 1e-45, 0.0],
        [f32::MAX; 3],
        sun,
        [-x, -y, -z],
    ] {
        assert!(
            radiance(&sky, direction).iter().all(|l| l.is_finite()),
            "{direction:?}"
        );
    }
}

#[test]
fn on_the_ground_no_air_is_below() {
    let sky = MODEL.sky(&Conditions::default()).unwrap();
    assert!(radiance(&sky, [0.3, 0.1, -0.2]).iter().all(|&l| l == 0.0));
}

#[test]
fn brighter_ground_makes_a_brighter_sky() {
    let sky = |albedo| {
        MODEL
            .sky(&Conditions {
                albedo,
                ..Conditions::default()
            })
            .unwrap()
    };
    let dark = radiance(&sky(0.0), [0.0, 0.0, 1.0]);
    let bright = radiance(&sky(1.0), [0.0, 0.0, 1.0]);
    assert!(dark.iter().zip(&bright).all(|(d, b)| d < b));
}

#[test]
fn batches_agree_with_single_queries() {
    let sky = MODEL.sky(&Conditions::default()).unwrap();
    let directions: Vec<[f32; 3]> = (0..50)
        .map(|i| direction(0.03 * f64::from(i), f64::from(i)))
        .collect();
    let n = sky.wavelengths().len();
    let mut batch = vec![0.0; 50 * n];
    let mut xyz = vec![[0.0; 3]; 50];
    sky.radiance_batch(&directions, &mut batch).unwrap();
    sky.xyz_batch(&directions, &mut xyz).unwrap();
    for (i, &direction) in directions.iter().enumerate() {
        assert_eq!(radiance(&sky, direction), batch[i * n..(i + 1) * n]);
        assert_eq!(sky.xyz(direction).unwrap(), xyz[i]);
    }
    assert!(matches!(
        sky.radiance_batch(&directions, &mut batch[1..]),
        Err(Error::Length { what: "output", .. })
    ));
    assert!(matches!(
        sky.radiance(directions[0], &mut []),
        Err(Error::Length { .. })
    ));
}

#[test]
fn wavelengths_of_the_model_are_met_exactly() {
    let sky = MODEL.sky(&Conditions::default()).unwrap();
    let direction = [0.2, 0.3, 0.4];
    for (&wavelength, &expected) in sky.wavelengths().iter().zip(&radiance(&sky, direction)) {
        let got = sky.radiance_at(direction, wavelength).unwrap();
        assert!((got / expected - 1.0).abs() < 1e-6);
    }
}

#[test]
fn the_azimuth_can_be_changed_afterwards() {
    let mut sky = MODEL.sky(&Conditions::default()).unwrap();
    let expected = MODEL
        .sky(&Conditions {
            solar_azimuth: 1.0,
            ..Conditions::default()
        })
        .unwrap();
    sky.set_solar_azimuth(1.0).unwrap();
    let direction = [0.2, 0.3, 0.4];
    assert_eq!(radiance(&sky, direction), radiance(&expected, direction));
    assert!(sky.set_solar_azimuth(f64::NAN).is_err());
}

#[test]
fn models_and_skies_cross_threads() {
    fn check<T: Send + Sync>() {}
    check::<Model>();
    check::<Sky>();
    let sums: Vec<u32> = std::thread::scope(|scope| {
        let run =
            || radiance(&MODEL.sky(&Conditions::default()).unwrap(), [0.0, 0.1, 1.0])[0].to_bits();
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(run)).collect();
        threads.into_iter().map(|t| t.join().unwrap()).collect()
    });
    assert!(sums.windows(2).all(|w| w[0] == w[1]));
}

#[test]
fn a_sky_at_nodes_touches_the_basis_and_two_chunks() {
    let model = Model::from_bytes(common::model_bytes()).unwrap();
    assert_eq!(model.touched_bytes(), model.head_bytes());
    model.sky(&Conditions::default()).unwrap();
    let three: usize = model.directory().iter().take(3).map(|e| e.length).sum();
    assert_eq!(model.touched_bytes(), model.head_bytes() + three);
    model.verify().unwrap();
}

#[test]
fn an_absent_chunk_is_a_typed_error() {
    let head = common::head(&[0.0, 120.0, 1000.0], &[20e3, 59.4e3]);
    let mut chunks = common::chunks(&head);
    chunks.retain(|c| c.altitude != Some(1));
    let model = Model::from_bytes(welkin::format::encode(&head, &chunks).unwrap()).unwrap();
    assert!(model.sky(&Conditions::default()).is_ok());
    let error = model
        .sky(&Conditions {
            altitude: 60.0,
            ..Conditions::default()
        })
        .unwrap_err();
    assert!(
        matches!(
            error,
            Error::MissingChunk {
                altitude: Some(120.0),
                ..
            }
        ),
        "{error}"
    );
}

#[cfg(feature = "mmap")]
#[test]
fn mapped_and_read_files_agree() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.welkin");
    std::fs::write(&path, common::model_bytes()).unwrap();
    let sky = |model: Model| model.sky(&Conditions::default()).unwrap();
    let direction = [0.1, 0.2, 0.3];
    let mapped = radiance(&sky(Model::open(&path).unwrap()), direction);
    assert_eq!(
        mapped,
        radiance(&sky(Model::read(&path).unwrap()), direction)
    );
    assert!(matches!(Model::open(folder.path()), Err(Error::Io { .. })));
    assert!(matches!(
        Model::open(folder.path().join("none")),
        Err(Error::Io { .. })
    ));
    std::fs::write(&path, b"").unwrap();
    assert!(matches!(Model::open(&path), Err(Error::NotWelkin)));
}

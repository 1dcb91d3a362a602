//! The evaluator against a slow f64 reading of the specification.

mod common;

use common::oracle::{Oracle, Query};
use proptest::prelude::*;
use welkin::{Conditions, Model};

fn close(got: f32, expected: f64, zenith: f64) -> bool {
    (f64::from(got) - expected).abs() <= (1e-4 * expected.abs()).max(1e-7 * zenith)
}

proptest! {
    #![proptest_config(common::cases(256))]

    #[test]
    fn sky_follows_the_specification(
        altitude in prop_oneof![Just(0.0), Just(120.0), 0.0..2000.0f64],
        visibility in prop_oneof![Just(59.4e3), 20e3..131.8e3f64],
        albedo in prop_oneof![Just(0.0), Just(1.0), 0.0..1.0f64],
        solar_elevation in prop_oneof![3 => -4.2..90.0f64, 1 => 86.0..90.0f64, 1 => 89.99..90.0f64],
        solar_azimuth in -7.0..7.0f64,
        direction in prop_oneof![9 => proptest::array::uniform3(-1.0..1.0f32), 1 => Just([0.0, 0.0, 1.0])],
        wavelength in 320.0..760.0f64,
        bytes in prop::sample::select(vec![
            common::model_bytes(), common::wide_bytes(), common::long_bytes(),
            common::estimated_bytes(), common::estimated_bytes(),
        ]),
    ) {
        let oracle = Oracle::new(&bytes);
        let model = Model::from_bytes(bytes.clone()).unwrap();
        let solar_elevation = solar_elevation.to_radians();
        let conditions = Conditions { solar_elevation, solar_azimuth, visibility, albedo, altitude };
        let query = |direction: [f32; 3]| Query {
            altitude, visibility, albedo, solar_elevation, solar_azimuth,
            direction: direction.map(f64::from),
        };
        let sky = model.sky(&conditions).unwrap();
        let mut got = vec![0.0; sky.wavelengths().len()];
        sky.relative_radiance(direction, &mut got).unwrap();
        let zenith = oracle.radiance(&query([0.0, 0.0, 1.0]));
        let expected = oracle.radiance(&query(direction));
        for ((got, expected), zenith) in got.iter().zip(&expected).zip(&zenith) {
            prop_assert!(close(*got, *expected, *zenith), "{got} {expected}");
        }
        let xyz = oracle.xyz(&query([0.1, 0.2, 0.9]));
        for (got, expected) in sky.xyz([0.1, 0.2, 0.9]).unwrap().into_iter().zip(xyz) {
            prop_assert!(close(got, expected, 0.0), "{got} {expected}");
        }
        let (relative, solar) = oracle.radiance_at(&query([0.1, 0.2, 0.9]), wavelength);
        let got = sky.relative_radiance_at([0.1, 0.2, 0.9], wavelength).unwrap();
        prop_assert!(close(got, relative, 0.0), "{got} {relative}");
        let got = sky.radiance_at([0.1, 0.2, 0.9], wavelength).unwrap();
        prop_assert!(close(got, relative * solar, 0.0), "{got}");
    }
}

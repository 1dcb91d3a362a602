//! Segments that share no conditions are answered as by an aerial perspective of their own.

use welkin::{Conditions, Error, Model, PolarisationFrame};

/// Conditions and segments all over the model, some of which follow each other under the same sun.
fn cases() -> impl Iterator<Item = (Conditions, [f64; 3], [f64; 3])> {
    (0..60u32).map(|i| {
        let share =
            |k: u32| f64::from((i / 2).wrapping_mul(2_654_435_761 + 2 * k) >> 8) / 16_777_216.0;
        let own =
            |k: u32| f64::from((i + 1).wrapping_mul(2_246_822_519 + 2 * k) >> 8) / 16_777_216.0;
        let altitude = 15e3 * own(3).powi(2);
        let conditions = Conditions {
            solar_elevation: (-4.2 + 94.2 * share(0).powi(2)).to_radians(),
            solar_azimuth: 6.0 * own(1),
            visibility: 20e3 + 111.8e3 * share(1),
            albedo: share(2),
            altitude,
        };
        let distance = 10f64.powf(1.0 + 4.4 * own(5));
        let (z, azimuth) = (2.0 * own(6) - 1.0, 6.3 * own(7));
        let r = (1.0 - z * z).sqrt();
        let way = [r * azimuth.cos(), r * azimuth.sin(), z];
        let from = [0.0, 0.0, altitude];
        let to = std::array::from_fn(|k| from[k] + distance * way[k]);
        (conditions, from, to)
    })
}

fn close(got: &[f32], expected: &[f32], tolerance: f32, of: &str) {
    for (got, expected) in got.iter().zip(expected) {
        let error = (got - expected).abs();
        assert!(
            error <= tolerance * expected.abs().max(1e-20),
            "{of}: {got} {expected}"
        );
    }
}

#[test]
fn queries_answer_as_prepared_aerial_perspectives() {
    let model = Model::default_model().unwrap();
    let mut query = model.aerial_perspective_query().unwrap();
    let n = query.wavelengths().len();
    let [mut a, mut b, mut c, mut d] = [0; 4].map(|_| vec![0.0; n]);
    for (conditions, from, to) in cases() {
        let of = format!("{conditions:?} {to:?}");
        let aerial = model.aerial_perspective(&conditions).unwrap();
        aerial.in_scattering(from, to, &mut a, &mut b).unwrap();
        query
            .in_scattering(&conditions, from, to, &mut c, &mut d)
            .unwrap();
        close(&c, &a, 1e-5, &of);
        assert_eq!(b, d, "{of}");
        let way = std::array::from_fn(|k| to[k] - from[k]);
        aerial.to_end(from, way, &mut a, &mut b).unwrap();
        query
            .to_end(&conditions, from, way, &mut c, &mut d)
            .unwrap();
        close(&c, &a, 1e-5, &of);
        assert_eq!(b, d, "{of}");
        let frame = PolarisationFrame::SunAligned;
        let light = aerial.relative_stokes_at(from, to, frame, 555.0).unwrap();
        let other = query
            .relative_stokes_at(&conditions, from, to, frame, 555.0)
            .unwrap();
        for (got, expected) in [(other.i, light.i), (other.q, light.q), (other.u, light.u)] {
            assert!((got - expected).abs() <= 1e-5 * light.i, "{of}");
        }
    }
}

#[test]
fn a_clone_goes_its_own_way_and_errors_leave_no_trace() {
    let model = Model::default_model().unwrap();
    let mut query = model.aerial_perspective_query().unwrap();
    let n = query.wavelengths().len();
    let [mut light, mut through, mut again] = [0; 3].map(|_| vec![0.0; n]);
    let (from, to) = ([0.0, 0.0, 10.0], [2e4, 3e3, 1e3]);
    let noon = Conditions::default();
    let dusk = Conditions {
        solar_elevation: -0.03,
        ..noon
    };
    query
        .in_scattering(&noon, from, to, &mut light, &mut through)
        .unwrap();
    let mut other = query.clone();
    other
        .in_scattering(&dusk, from, to, &mut again, &mut through)
        .unwrap();
    assert!(again[4] < 0.1 * light[4]);
    let outside = Conditions {
        visibility: 1e3,
        ..noon
    };
    let refused = query.in_scattering(&outside, from, to, &mut again, &mut through);
    assert!(matches!(
        refused,
        Err(Error::OutOfRange {
            parameter: "visibility",
            ..
        })
    ));
    let endless = [f64::INFINITY, 0.0, 0.0];
    let refused = query.in_scattering(&dusk, from, endless, &mut again, &mut through);
    assert!(matches!(refused, Err(Error::Point { .. })));
    query
        .in_scattering(&noon, from, to, &mut again, &mut through)
        .unwrap();
    assert_eq!(light, again);
}

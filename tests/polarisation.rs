//! Polarised skies: the specification in slow f64, axes, limits, absent and forged chunks.

mod common;

use common::oracle::{Oracle, Query, dot, vertical_frame};
use proptest::prelude::*;
use welkin::format::{Payload, encode};
use welkin::{Conditions, Error, Model, PolarisationFrame, PolarisedSky, Stokes};

fn sky(bytes: Vec<u8>, conditions: &Conditions) -> PolarisedSky {
    let model = Model::from_bytes(bytes).unwrap();
    model.polarised_sky(conditions).unwrap()
}

fn stokes(sky: &PolarisedSky, direction: [f32; 3], frame: PolarisationFrame) -> Vec<Stokes> {
    let mut out = vec![Stokes::default(); sky.sky().wavelengths().len()];
    sky.relative_stokes(direction, frame, &mut out).unwrap();
    out
}

proptest! {
    #![proptest_config(common::cases(256))]

    #[test]
    fn polarisation_follows_the_specification(
        altitude in prop_oneof![Just(0.0), Just(120.0), 0.0..2000.0f64],
        visibility in prop_oneof![Just(59.4e3), 20e3..131.8e3f64],
        albedo in 0.0..1.0f64,
        solar_elevation in -4.2..90.0f64,
        solar_azimuth in -7.0..7.0f64,
        direction in prop_oneof![
            proptest::array::uniform3(-1.0..1.0f32),
            Just([0.0, 0.0, 1.0]),
        ],
        axis in proptest::array::uniform3(-1.0..1.0f32),
        bytes in prop::sample::select(vec![
            common::polarised_bytes(0.02), common::polarised_bytes(1.0), common::wide_polarised_bytes(),
        ]),
    ) {
        let solar_elevation = solar_elevation.to_radians();
        let conditions = Conditions { solar_elevation, solar_azimuth, visibility, albedo, altitude };
        let oracle = Oracle::new(&bytes);
        let wide = direction.map(f64::from);
        let expected = oracle.stokes(&Query {
            altitude, visibility, albedo, solar_elevation, solar_azimuth, direction: wide,
        });
        let length = dot(wide, wide).sqrt();
        prop_assume!(length > 0.01);
        let [e1, e2] = vertical_frame(wide.map(|v| v / length), solar_azimuth);
        let axis64 = axis.map(f64::from);
        let (along, across) = (dot(axis64, e1), dot(axis64, e2));
        prop_assume!(along.hypot(across) > 0.01);
        let psi = across.atan2(along);
        let sky = sky(bytes.clone(), &conditions);
        let vertical = stokes(&sky, direction, PolarisationFrame::Vertical);
        let turned = stokes(&sky, direction, PolarisationFrame::Axis(axis));
        for ((got, turned), [l, q, u]) in vertical.iter().zip(&turned).zip(expected) {
            let close = |got: f32, expected: f64| (f64::from(got) - expected).abs() <= 2e-4 * l + 1e-12;
            prop_assert!(close(got.i, l) && close(got.q, q) && close(got.u, u), "{got:?} {l} {q} {u}");
            let (c, s) = ((2.0 * psi).cos(), (2.0 * psi).sin());
            prop_assert!(close(turned.q, c * q + s * u) && close(turned.u, c * u - s * q));
            prop_assert!(got.q.hypot(got.u) <= got.i);
        }
    }
}

#[test]
fn singly_scattered_light_is_polarised_across_the_scattering_plane() {
    let conditions = Conditions {
        altitude: 500.0,
        ..Conditions::default()
    };
    let sky = sky(common::polarised_bytes(0.0), &conditions);
    let sun = sky.sky().sun_direction();
    for direction in [[0.1, 0.8, 0.6], [-0.6, -0.2, 0.1], [0.5, 0.1, -0.7]] {
        for light in stokes(&sky, direction, PolarisationFrame::SunAligned) {
            assert!(light.q > 0.0 && light.u.abs() < 1e-6 * light.i, "{light:?}");
        }
    }
    for direction in [sun, sun.map(|v| -v)] {
        for light in stokes(&sky, direction, PolarisationFrame::SunAligned) {
            assert!(light.i > 0.0 && light.degree() < 1e-6);
        }
    }
}

/// Nearby directions have nearby Stokes vectors in a fixed frame, where axes of their own are undefined.
#[test]
fn nothing_jumps_at_the_zenith_or_around_the_sun() {
    for solar_elevation in [20f64.to_radians(), 90f64.to_radians()] {
        let conditions = Conditions {
            solar_elevation,
            ..Conditions::default()
        };
        let sky = sky(common::polarised_bytes(0.02), &conditions);
        let axis = PolarisationFrame::Axis([0.3, 0.9, 0.05]);
        let [x, y, z] = sky.sky().sun_direction();
        let at_sun = stokes(&sky, [x, y, z], axis);
        for (dx, dy) in [(1e-5, 0.0), (-1e-5, 0.0), (0.0, 1e-5), (0.0, -1e-5)] {
            let near = stokes(&sky, [x + dx, y + dy, z], axis);
            for (a, b) in at_sun.iter().zip(&near) {
                assert!((a.degree() - b.degree()).abs() < 1e-3, "{a:?} {b:?}");
                if solar_elevation < 1.5 {
                    let jump = (a.q - b.q).hypot(a.u - b.u);
                    assert!(jump < 1e-3 * a.i, "{a:?} {b:?}");
                }
            }
        }
    }
}

#[test]
fn the_whole_light_is_never_less_than_its_polarised_part() {
    let sky = sky(common::polarised_bytes(50.0), &Conditions::default());
    let mut full = 0;
    for k in 0..500 {
        let z = 1.0 - k as f32 / 250.0;
        let direction = [(2.4 * k as f32).cos(), (2.4 * k as f32).sin(), z];
        for light in stokes(&sky, direction, PolarisationFrame::SunAligned) {
            assert!(light.q.hypot(light.u) <= light.i);
            full += usize::from(light.degree() > 0.999);
        }
        for light in sky.xyz(direction, PolarisationFrame::Vertical).unwrap() {
            assert!(light.i.is_finite() && light.q.is_finite() && light.u.is_finite());
        }
        for wavelength in [320.0, 333.0, 517.2, 760.0] {
            let light = sky
                .stokes_at(direction, PolarisationFrame::Vertical, wavelength)
                .unwrap();
            assert!(light.q.hypot(light.u) <= light.i);
        }
    }
    assert!(full > 1000, "the limit counts: {full}");
}

#[test]
fn wavelengths_between_nodes_continue_the_nodes() {
    let sky = sky(common::polarised_bytes(0.02), &Conditions::default());
    let direction = [0.2, 0.5, 0.6];
    let mut nodes = vec![Stokes::default(); sky.sky().wavelengths().len()];
    sky.stokes(direction, PolarisationFrame::Vertical, &mut nodes)
        .unwrap();
    for (node, &wavelength) in nodes.iter().zip(sky.sky().wavelengths()) {
        let light = sky
            .stokes_at(direction, PolarisationFrame::Vertical, wavelength)
            .unwrap();
        let close = |a: f32, b: f32| (a - b).abs() <= 1e-5 * node.i;
        assert!(close(light.i, node.i) && close(light.q, node.q) && close(light.u, node.u));
    }
    let outside = sky.stokes_at(direction, PolarisationFrame::Vertical, 800.0);
    assert!(matches!(outside, Err(Error::OutOfRange { .. })));
}

#[test]
fn files_without_polarisation_say_so() {
    let model = Model::from_bytes(common::model_bytes()).unwrap();
    assert!(!model.is_polarised());
    let error = model.polarised_sky(&Conditions::default()).unwrap_err();
    assert!(
        matches!(
            error,
            Error::MissingChunk {
                kind: "polarisation basis",
                ..
            }
        ),
        "{error}"
    );

    let head = common::head(&[0.0, 120.0, 1000.0, 2000.0], &[20e3, 59.4e3, 131.8e3]);
    let mut chunks = common::polarised_chunks(&head, 0.02);
    chunks.retain(|c| !matches!(c.payload, Payload::Polarisation(_)) || c.altitude != Some(0));
    let model = Model::from_bytes(encode(&head, &chunks).unwrap()).unwrap();
    assert!(model.is_polarised() && model.sky(&Conditions::default()).is_ok());
    let error = model.polarised_sky(&Conditions::default()).unwrap_err();
    assert!(
        matches!(
            error,
            Error::MissingChunk {
                kind: "polarisation",
                ..
            }
        ),
        "{error}"
    );
}

#[test]
fn bad_directions_axes_and_ranks_are_refused() {
    let sky = sky(common::polarised_bytes(0.02), &Conditions::default());
    let mut out = vec![Stokes::default(); sky.sky().wavelengths().len()];
    let refused = |result: welkin::Result<()>| matches!(result, Err(Error::Direction { .. }));
    assert!(refused(sky.stokes(
        [0.0; 3],
        PolarisationFrame::Vertical,
        &mut out
    )));
    assert!(refused(sky.stokes(
        [0.0, 0.0, 1.0],
        PolarisationFrame::Axis([0.0; 3]),
        &mut out
    )));
    let short = sky.stokes([0.0, 0.0, 1.0], PolarisationFrame::Vertical, &mut out[1..]);
    assert!(matches!(short, Err(Error::Length { .. })));

    let head = common::head(&[0.0], &[59.4e3]);
    let mut chunks = common::polarised_chunks(&head, 0.02);
    for chunk in &mut chunks {
        if let Payload::PolarisationBasis(basis) = &mut chunk.payload {
            let rank = basis.rank - 1;
            *basis = welkin::format::PolarisationBasis {
                rank,
                phi: vec![0.5; head.shape().phi * rank],
                channel: vec![0.5; rank * 4 * head.wavelengths.len()],
            };
        }
    }
    let error = encode(&head, &chunks).unwrap_err();
    assert!(error.to_string().contains("rank"), "{error}");
}

#[test]
fn a_cropped_file_has_the_same_polarisation() {
    use welkin::format::{Selection, crop, unpack};
    let (mut head, mut chunks) = unpack(&common::polarised_bytes(0.02)).unwrap();
    let selection = Selection {
        altitudes: vec![0, 2],
        visibilities: vec![1],
        wavelengths: vec![1, 3, 4],
    };
    crop(&mut head, &mut chunks, &selection).unwrap();
    let conditions = Conditions {
        altitude: 1000.0,
        ..Conditions::default()
    };
    let whole = sky(common::polarised_bytes(0.02), &conditions);
    let part = sky(encode(&head, &chunks).unwrap(), &conditions);
    let direction = [0.4, -0.3, 0.2];
    let whole = stokes(&whole, direction, PolarisationFrame::SunAligned);
    let part = stokes(&part, direction, PolarisationFrame::SunAligned);
    assert_eq!(part, [1, 3, 4].map(|w| whole[w]));
}

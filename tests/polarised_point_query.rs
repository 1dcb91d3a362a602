//! Stokes vectors of point queries are those of prepared skies.

mod common;

use welkin::{
    Budget, Channels, Conditions, Error, Model, PolarisationFrame, PolarisedPointQuery, Stokes,
};

fn whole(model: &Model, channels: Channels) -> welkin::Plan {
    let budget = Budget {
        altitude: model.altitude_range(),
        visibility: model.visibility_range(),
        solar_elevation: model.solar_elevation_range(),
        tolerance: 1e-2,
        channels,
    };
    model.plan(&budget).unwrap()
}

fn prepared(model: &Model) -> PolarisedPointQuery<'_> {
    let plan = whole(model, Channels::Stokes);
    model.polarised_point_query(&plan).unwrap()
}

#[test]
fn stokes_vectors_are_those_of_prepared_skies() {
    let model = Model::default_model().unwrap();
    let query = prepared(&model);
    let n = query.wavelengths().len();
    let mut prepared = vec![Stokes::default(); n];
    let mut got = prepared.clone();
    let [shortest, longest] = model.wavelength_range().unwrap();
    for i in 0..300u32 {
        let share =
            |k: u32| f64::from((i + 1).wrapping_mul(2_246_822_519 + 2 * k) >> 8) / 16_777_216.0;
        let conditions = Conditions {
            solar_elevation: (-4.2 + 94.2 * share(0)).to_radians(),
            solar_azimuth: 6.0 * share(1),
            visibility: 20e3 + 111.8e3 * share(2),
            albedo: share(3),
            altitude: 15e3 * share(4).powi(3),
        };
        let z = 2.0 * share(5) - 1.0;
        let (r, azimuth) = ((1.0 - z * z).sqrt(), 6.3 * share(6));
        let direction = [r * azimuth.cos(), r * azimuth.sin(), z].map(|v| v as f32);
        let frame = match i % 3 {
            0 => PolarisationFrame::Vertical,
            1 => PolarisationFrame::SunAligned,
            _ => PolarisationFrame::Axis([0.3, -0.2, 0.9]),
        };
        let sky = model.polarised_sky(&conditions).unwrap();
        sky.stokes(direction, frame, &mut prepared).unwrap();
        query
            .stokes(&conditions, direction, frame, &mut got)
            .unwrap();
        let nm = shortest + (longest - shortest) * share(7);
        let at = sky.stokes_at(direction, frame, nm).unwrap();
        let other = query.stokes_at(&conditions, direction, frame, nm).unwrap();
        let mut relative = vec![0.0; got.len()];
        sky.sky()
            .relative_radiance(direction, &mut relative)
            .unwrap();
        let grown = common::growth(&model, &relative, nm).max(1.0) as f32;
        let pairs = got.iter().zip(&prepared).map(|pair| (pair, 1.0));
        for ((got, expected), grown) in pairs.chain([((&other, &at), grown)]) {
            let errors = [got.i - expected.i, got.q - expected.q, got.u - expected.u];
            let largest = errors.into_iter().fold(0.0, |m: f32, e| m.max(e.abs()));
            assert!(
                largest <= 1e-5 * grown * common::darkness(expected.i) * expected.i,
                "{conditions:?} {direction:?} {got:?} {expected:?}"
            );
            assert!(got.q.hypot(got.u) <= got.i * (1.0 + 1e-6));
        }
    }
}

#[test]
fn what_is_refused() {
    let model = Model::default_model().unwrap();
    let query = prepared(&model);
    let (noon, up) = (Conditions::default(), [0.0, 0.0, 1.0]);
    let mut out = vec![Stokes::default(); query.wavelengths().len()];
    let mut ask = |conditions: &Conditions, direction, frame, n: usize| {
        query.stokes(conditions, direction, frame, &mut out[..n])
    };
    let far = Conditions {
        visibility: 1e6,
        ..noon
    };
    let n = query.wavelengths().len();
    let refused = ask(&far, up, PolarisationFrame::Vertical, n);
    assert!(matches!(
        refused,
        Err(Error::OutOfRange {
            parameter: "visibility",
            ..
        })
    ));
    let refused = ask(&noon, [0.0; 3], PolarisationFrame::Vertical, n);
    assert!(matches!(refused, Err(Error::Direction { .. })));
    let refused = ask(&noon, up, PolarisationFrame::Axis([0.0; 3]), n);
    assert!(matches!(refused, Err(Error::Direction { .. })));
    let refused = ask(&noon, up, PolarisationFrame::Vertical, n - 1);
    assert!(matches!(refused, Err(Error::Length { .. })));
    let refused = query.stokes_at(&noon, up, PolarisationFrame::Vertical, 2000.0);
    assert!(matches!(
        refused,
        Err(Error::OutOfRange {
            parameter: "wavelength",
            ..
        })
    ));
    // A plan without polarisation is not enough.
    let plan = whole(&model, Channels::Spectral);
    let refused = model.polarised_point_query(&plan);
    assert!(matches!(refused, Err(Error::MissingChunk { .. })));
}

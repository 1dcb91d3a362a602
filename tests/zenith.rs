//! The sun at the zenith, where it has no azimuth: skies and segments pass through that without a jump.
#![cfg(feature = "default-model")]

mod common;

use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

use common::oracle::{Oracle, Query};
use common::unit;
use proptest::prelude::*;
use welkin::{
    AerialPerspective, Budget, Channels, Conditions, DEFAULT_MODEL, Interpolation, Model, Plan,
    PointQuery, PolarisationFrame, Stokes, StokesSpectra,
};

static MODEL: LazyLock<Model> = LazyLock::new(|| Model::default_model().unwrap());
static PLAN: LazyLock<Plan> = LazyLock::new(|| {
    let budget = Budget {
        altitude: MODEL.altitude_range(),
        visibility: MODEL.visibility_range(),
        solar_elevation: MODEL.solar_elevation_range(),
        tolerance: 1e-2,
        channels: Channels::Stokes,
    };
    MODEL.plan(&budget).unwrap()
});
/// What may be left of stored differences over the azimuth.
const LEFT: f64 = 1e-3;
/// How much phase functions change light per radian that the sun moves, 20° or more away from it.
const SLOPE: f64 = 12.0;

fn conditions(zenith: f64, azimuth: f64, [altitude, visibility]: [f64; 2]) -> Conditions {
    Conditions {
        solar_elevation: FRAC_PI_2 - zenith,
        solar_azimuth: azimuth,
        visibility,
        albedo: 0.3,
        altitude,
    }
}

fn farthest(a: &[f32], b: &[f32]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs
        .map(|(a, b)| f64::from((a / b - 1.0).abs()))
        .fold(0.0, f64::max)
}

/// Zenith angles from far too small to far enough to see.
fn near() -> impl Strategy<Value = f64> {
    (-6.0..-3.0f64).prop_map(|x| 10f64.powf(x))
}

fn in_scattering(aerial: &AerialPerspective, from: [f64; 3], to: [f64; 3]) -> Vec<f32> {
    let n = aerial.wavelengths().len();
    let (mut light, mut through) = (vec![0.0; n], vec![0.0; n]);
    aerial
        .in_scattering(from, to, &mut light, &mut through)
        .unwrap();
    light
}

proptest! {
    #![proptest_config(common::cases(48))]

    /// Sun and direction at right angles: the angle between them stays what it is, so only what has to fade could
    /// change.
    #[test]
    fn skies_do_not_know_the_azimuth_of_a_vertical_sun(
        zenith in near(),
        azimuth in -3.0..3.0f64,
        elevation in -1.5..1.2f64,
        place in (0.0..15e3f64, 20e3..130e3f64),
    ) {
        let place = [place.0, place.1];
        let vertical = MODEL.polarised_sky(&conditions(0.0, 0.0, place)).unwrap();
        let sky = MODEL.polarised_sky(&conditions(zenith, azimuth, place)).unwrap();
        let n = MODEL.wavelengths().len();
        let direction = |turn: f64| unit(elevation, azimuth + turn).map(|v| v as f32);
        let general = PointQuery::new(DEFAULT_MODEL).unwrap().with_interpolation(Interpolation::Full);
        let polarised = MODEL.polarised_point_query(&PLAN).unwrap();
        let [mut a, mut b] = [(); 2].map(|()| vec![Stokes::default(); n]);
        for turn in [FRAC_PI_2, -FRAC_PI_2, 0.3, 2.0] {
            let bound = match turn.abs() == FRAC_PI_2 {
                true => LEFT,
                false => LEFT + SLOPE * zenith,
            };
            vertical.relative_stokes(direction(turn), PolarisationFrame::Vertical, &mut a).unwrap();
            sky.relative_stokes(direction(turn), PolarisationFrame::Vertical, &mut b).unwrap();
            for (a, b) in a.iter().zip(&b) {
                prop_assert!(f64::from((b.i / a.i - 1.0).abs()) < bound, "{a:?} {b:?}");
                let moved = f64::from((b.q - a.q).hypot(b.u - a.u));
                prop_assert!(moved < bound * f64::from(a.i), "{a:?} {b:?}");
            }
            let mut at_once = vec![0.0; n];
            general
                .relative_radiance(&conditions(zenith, azimuth, place), direction(turn), &mut at_once)
                .unwrap();
            let lights: Vec<f32> = b.iter().map(|s| s.i).collect();
            prop_assert!(farthest(&at_once, &lights) < 1e-4);
            let asked = conditions(zenith, azimuth, place);
            let at = polarised.stokes_at(&asked, direction(turn), PolarisationFrame::Vertical, 520.0).unwrap();
            let prepared = sky.stokes_at(direction(turn), PolarisationFrame::Vertical, 520.0).unwrap();
            for (a, b) in [(at.i, prepared.i), (at.q, prepared.q), (at.u, prepared.u)] {
                prop_assert!((a - b).abs() < 1e-4 * prepared.i, "{at:?} {prepared:?}");
            }
        }
    }

    /// Points some way off, so that the sun passes their zenith and not that of the origin.
    #[test]
    fn segments_do_not_know_the_azimuth_of_a_locally_vertical_sun(
        zenith in near(),
        azimuth in -3.0..3.0f64,
        elevation in -1.2..1.2f64,
        away in 0.0..0.1f64,
        height in 0.0..9e3f64,
        length in prop_oneof![Just(100.0), 10.0..30e3f64],
    ) {
        let sun = conditions(away, 0.7, [0.0, 30e3]);
        let here = unit(FRAC_PI_2 - away, 0.7);
        let radius = MODEL.head().planet.radius;
        let from: [f64; 3] = std::array::from_fn(|k| (radius + height) * here[k] - if k == 2 { radius } else { 0.0 });
        // The sun stands exactly above `from`; now the point moves, and the sun goes round its zenith.
        let aerial = MODEL.aerial_perspective(&sun).unwrap();
        let east = [-0.7f64.sin(), 0.7f64.cos(), 0.0];
        let north = [
            here[1] * east[2] - here[2] * east[1],
            here[2] * east[0] - here[0] * east[2],
            here[0] * east[1] - here[1] * east[0],
        ];
        let local = |[x, y, z]: [f64; 3]| -> [f64; 3] {
            std::array::from_fn(|k| x * east[k] + y * north[k] + z * here[k])
        };
        let direction = local(unit(elevation, 0.2));
        let light = |from: [f64; 3]| {
            in_scattering(&aerial, from, std::array::from_fn(|k| from[k] + length * direction[k]))
        };
        let step = local(unit(0.0, azimuth));
        let moved = std::array::from_fn(|k| from[k] + zenith * radius * step[k]);
        let [at, beside] = [light(from), light(moved)];
        let change = farthest(&at, &beside);
        // Along the ground nothing but the sun changes.
        prop_assert!(change < LEFT + 2.0 * zenith, "{change}: {at:?} {beside:?}");
    }

    /// With sources that are not at all symmetric there.
    #[test]
    fn short_segments_follow_the_specification(
        zenith in (-6.5..-0.7f64).prop_map(|x| 10f64.powf(x)),
        solar_azimuth in -3.0..3.0f64,
        elevation in -1.5..1.5f64,
        altitude in 0.0..3e3f64,
    ) {
        let head = common::head(&[0.0], &[20e3]);
        let chunks = common::aerial::polarised_chunks(&head);
        let bytes = welkin::format::encode(&head, &chunks).unwrap();
        let model = Model::from_bytes(bytes.as_slice()).unwrap();
        let conditions = conditions(zenith, solar_azimuth, [0.0, 20e3]);
        let aerial = model.aerial_perspective(&conditions).unwrap();
        let direction = unit(elevation, 0.0);
        let n = aerial.wavelengths().len();
        let from = [0.0, 0.0, altitude];
        let to = std::array::from_fn(|k| from[k] + 100.0 * direction[k]);
        let [mut i, mut q, mut u, mut through] = [(); 4].map(|()| vec![0.0; n]);
        let out = StokesSpectra { i: &mut i, q: &mut q, u: &mut u };
        aerial.in_scattering_stokes(from, to, PolarisationFrame::Vertical, out, &mut through).unwrap();
        let query = Query {
            altitude,
            visibility: conditions.visibility,
            albedo: conditions.albedo,
            solar_elevation: conditions.solar_elevation,
            solar_azimuth,
            direction,
        };
        let expected = Oracle::new(&bytes).in_scattering(&query, 100.0, 100.0);
        let head = model.head();
        for (w, [l, eq, eu]) in expected.into_iter().enumerate() {
            let sun = head.solar_irradiance_at(head.wavelengths[w]);
            let got = [i[w], q[w], u[w]].map(|v| f64::from(v) / sun);
            for (got, expected) in got.into_iter().zip([l, eq, eu]) {
                prop_assert!((got - expected).abs() < 0.01 * l, "{w}: {got} {expected} of {l}");
            }
        }
    }
}

//! Baked skies do not pop: small steps of the sun, the observer or the air change no pixel beyond the sky's own change.
#![cfg(feature = "default-model")]

mod common;
#[allow(dead_code)]
#[path = "../tools/src/bin/motion/steps.rs"]
mod steps;

use std::sync::LazyLock;

use proptest::prelude::*;
use steps::{Axis, Jump, KINDS, Kind, View, bisect, jump};
use welkin::{BakedSky, Conditions, Error, Model};

static MODEL: LazyLock<Model> = LazyLock::new(|| Model::default_model().unwrap());

/// The largest change of a pixel beyond the sky's own. The horizon and the sky with it go with the root of the
/// altitude, so that the first metres of a climb are long: 0.1 m from the ground is as far as 11 m from 3 km. In
/// twilight, and where the disc of the sun sets, errors change fastest, and where the fit of a sky falls through zero no table follows it well.
fn largest(conditions: &Conditions, jump: &Jump) -> f64 {
    match (jump.held, conditions.altitude < 20.0) {
        (false, _) => 5e-2,
        (_, true) => 1e-2,
        _ if conditions.solar_elevation < 0.05 => 5e-3,
        _ => 1e-3,
    }
}

fn view(kind: Kind, conditions: &Conditions) -> Result<View, Error> {
    View::new(&MODEL, kind, conditions, BakedSky::TOLERANCE)
}

/// A refused sky has no pixels.
fn jumps(kind: Kind, from: &Conditions, to: &Conditions) -> Jump {
    let views = view(kind, from).and_then(|from| Ok((from, view(kind, to)?)));
    match views {
        Err(Error::Tolerance { .. }) => Jump::default(),
        other => {
            let (from, to) = other.unwrap();
            jump(&from, &to).unwrap()
        }
    }
}

fn axis() -> impl Strategy<Value = (Axis, f64, f64)> {
    prop_oneof![
        (Just(Axis::Climb), 0.0..15e3f64, 0.0..400f64),
        (Just(Axis::Climb), 0.0..100f64, 0.0..20f64),
        (Just(Axis::Sun), -12.0..89.0f64, 0.0..1f64),
        (Just(Axis::Sun), -12.0..5.0f64, 0.0..0.5f64),
        (Just(Axis::Visibility), 20e3..131e3f64, 0.0..5e3f64),
    ]
}

proptest! {
    #![proptest_config(common::cases(60))]

    /// From anywhere, and where the size of the tables changes on a short way from there.
    #[test]
    fn small_steps_make_no_jumps(
        (axis, start, way) in axis(),
        kind in prop::sample::select(&KINDS[..]),
        altitude in prop_oneof![Just(0.0), 0.0..3e3f64, 0.0..15e3f64],
        elevation in prop_oneof![-12.0..5.0f64, -12.0..90.0f64],
        visibility in 20e3..131.8e3f64,
        albedo in 0.0..1.0f64,
    ) {
        let base = Conditions { solar_elevation: elevation.to_radians(), solar_azimuth: 0.0, visibility, albedo, altitude };
        let at = |value: f64| axis.at(&base, value).clamped(&MODEL).unwrap();
        let step = jumps(kind, &at(start), &at(start + axis.step()));
        prop_assert!(step.largest <= largest(&at(start), &step), "{kind:?} {:?}: {step:?}", at(start));
        let [near, far] = [start, start + way].map(|value| view(kind, &at(value)).map(|view| view.bytes()));
        if let (Ok(near), Ok(far)) = (near, far) && near != far {
            let switch = bisect(|value| view(kind, &at(value)), [start, start + way], axis.step());
            // A refused sky on the way has no size.
            if let Ok([low, high]) = switch {
                let step = jumps(kind, &at(low), &at(high));
                prop_assert!(step.largest <= largest(&at(low), &step), "{kind:?} {:?}..{high}: {step:?}", at(low));
            }
        }
    }
}

/// Where tables of fixed sizes took turns: 8 and 12 % of the light of a pixel.
#[test]
fn known_pops_are_gone() {
    let conditions = |elevation: f64, altitude: f64, visibility: f64| Conditions {
        solar_elevation: elevation.to_radians(),
        altitude,
        visibility,
        ..Conditions::default()
    };
    for (from, to) in [
        (
            conditions(20.0, 2450.78186, 59.4e3),
            conditions(20.0, 2450.78194, 59.4e3),
        ),
        (
            conditions(1.52525, 3e3, 90e3),
            conditions(1.52531, 3e3, 90e3),
        ),
    ] {
        for kind in KINDS {
            let step = jumps(kind, &from, &to);
            assert!(step.largest <= 1e-4, "{kind:?} {from:?}: {step:?}");
        }
    }
}

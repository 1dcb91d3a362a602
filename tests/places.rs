//! Places anywhere on the planet: their skies and segments are those of the origin under a sun that is turned with
//! them.
#![cfg(feature = "default-model")]

mod common;

use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

use common::unit;
use proptest::prelude::*;
use welkin::{
    AerialPerspective, Conditions, DEFAULT_MODEL, Error, Interpolation, Model, Place, PointQuery,
    PolarisationFrame, Stokes,
};

static MODEL: LazyLock<Model> = LazyLock::new(|| Model::default_model().unwrap());

/// A turn of the world, from a quaternion of any length.
fn turned([a, b, c, d]: [f64; 4], v: [f64; 3]) -> [f64; 3] {
    let n = a * a + b * b + c * c + d * d;
    let rows = [
        [
            a * a + b * b - c * c - d * d,
            2.0 * (b * c - a * d),
            2.0 * (b * d + a * c),
        ],
        [
            2.0 * (b * c + a * d),
            a * a - b * b + c * c - d * d,
            2.0 * (c * d - a * b),
        ],
        [
            2.0 * (b * d - a * c),
            2.0 * (c * d + a * b),
            a * a - b * b - c * c + d * d,
        ],
    ];
    rows.map(|row| row.iter().zip(v).map(|(r, v)| r * v).sum::<f64>() / n)
}

fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] + b[k])
}

fn in_scattering(
    aerial: &AerialPerspective,
    from: [f64; 3],
    to: [f64; 3],
) -> welkin::Result<Vec<f32>> {
    let n = aerial.wavelengths().len();
    let (mut light, mut through) = (vec![0.0; n], vec![0.0; n]);
    aerial.in_scattering(from, to, &mut light, &mut through)?;
    light.extend(through);
    Ok(light)
}

proptest! {
    #![proptest_config(common::cases(64))]

    #[test]
    fn a_place_anywhere_is_the_origin_under_a_turned_sun(
        turn in proptest::array::uniform4(-1.0..1.0f64).prop_filter("a turn", |q| {
            q.iter().map(|v| v * v).sum::<f64>() > 0.01
        }),
        centre in proptest::array::uniform3(-1e7..1e7f64),
        altitude in 0.0..15e3f64,
        sun in (-0.07..1.5f64, -3.0..3.0f64),
        view in (-1.5..1.5f64, -3.0..3.0f64),
        axis in proptest::array::uniform3(-1.0..1.0f64),
    ) {
        let planet = MODEL.head().planet;
        let home = Conditions {
            altitude,
            solar_elevation: sun.0,
            solar_azimuth: sun.1,
            ..Conditions::default()
        };
        let world = |v| turned(turn, v);
        let position = add(centre, world([0.0, 0.0, planet.radius + altitude]));
        let place = Place::new(&planet, centre, position).unwrap();
        let (sun, view, axis) = (world(unit(sun.0, sun.1)), unit(view.0, view.1), axis);
        let there = place.conditions(sun, &home).unwrap();
        prop_assert!((there.altitude - altitude).abs() < 1e-6);
        prop_assert!((there.solar_elevation - home.solar_elevation).abs() < 1e-12);

        // Not where a view along the horizon would be one beside it.
        let dip = planet.dip(altitude);
        prop_assume!((view[2].asin() + dip).abs() > 1e-3);
        let n = MODEL.wavelengths().len();
        let [mut here, mut away] = [(); 2].map(|()| vec![Stokes::default(); n]);
        let frame = PolarisationFrame::Axis(axis.map(|v| v as f32));
        let sky = MODEL.polarised_sky(&home).unwrap();
        sky.relative_stokes(view.map(|v| v as f32), frame, &mut here).unwrap();
        let sky = MODEL.polarised_sky(&there).unwrap();
        let direction = place.direction(world(view));
        sky.relative_stokes(direction, place.frame(world(axis)), &mut away).unwrap();
        // Rounded directions: near the horizon and the sun light changes fast.
        for (a, b) in here.iter().zip(&away) {
            prop_assert!((a.i - b.i).abs() < 2e-4 * a.i, "{a:?} {b:?}");
            prop_assert!((a.q - b.q).hypot(a.u - b.u) < 4e-4 * a.i, "{a:?} {b:?}");
        }
        let query = PointQuery::new(DEFAULT_MODEL).unwrap();
        let query = query.with_interpolation(Interpolation::Full);
        let mut at_once = vec![0.0; n];
        query.relative_radiance(&there, direction, &mut at_once).unwrap();
        for (a, b) in here.iter().zip(&at_once) {
            prop_assert!((a.i - b).abs() < 3e-4 * a.i, "{a:?} {b}");
        }

        let from = [0.0, 0.0, altitude];
        let to = add(from, view.map(|v| 8e3 * v));
        let beneath = add(centre, world([0.0, 0.0, planet.radius]));
        let aerial = MODEL.aerial_perspective(&home).unwrap();
        let here = in_scattering(&aerial, from, to).unwrap();
        let local = |p| place.point_to_local(add(beneath, world(p)));
        let aerial = MODEL.aerial_perspective(&there).unwrap();
        let away = in_scattering(&aerial, local(from), local(to)).unwrap();
        for (a, b) in here.iter().zip(&away) {
            prop_assert!((a / b - 1.0).abs() < 1e-3, "{a} {b}");
        }
    }

    /// Within its reach an aerial perspective agrees with one that is prepared where the segment is.
    #[test]
    fn aerial_perspectives_agree_as_far_as_they_reach(
        away in 0.05..0.33f64,
        around in -3.1..3.1f64,
        sun in 0.2..1.2f64,
        view in (-0.1..1.5f64, -3.1..3.1f64),
        height in 100.0..9e3f64,
    ) {
        let planet = MODEL.head().planet;
        let home = Conditions { solar_elevation: sun, ..Conditions::default() };
        let aerial = MODEL.aerial_perspective(&home).unwrap();
        let centre = [0.0, 0.0, -planet.radius];
        let from = add(centre, unit(FRAC_PI_2 - away, around).map(|v| (planet.radius + height) * v));
        let place = Place::new(&planet, centre, from).unwrap();
        let there = place.conditions(aerial.sun_direction(), &home).unwrap();
        prop_assume!(there.solar_elevation > 0.0);
        let to = add(from, place.to_world(unit(view.0, view.1).map(|v| 900.0 * v)));
        let far = in_scattering(&aerial, from, to).unwrap();
        let near = MODEL.aerial_perspective(&there).unwrap();
        let near = in_scattering(&near, place.point_to_local(from), place.point_to_local(to)).unwrap();
        for (a, b) in far.iter().zip(&near) {
            prop_assert!((a / b - 1.0).abs() < 0.03, "{a} {b}, sun {}", there.solar_elevation);
        }
    }
}

/// Spectrum of the zenith from the ground at a place, away from the sun from where the aerial perspective was prepared,
/// in this many pieces.
fn zenith(aerial: &AerialPerspective, away: f64, pieces: u32) -> Vec<f64> {
    let radius = aerial.transmittance().planet().radius;
    let up = unit(FRAC_PI_2 - away, std::f64::consts::PI);
    let n = aerial.wavelengths().len();
    let (mut sum, mut through) = (vec![0.0; n], vec![1.0; n]);
    let at = |i: u32| {
        let height = 1e5 * f64::from(i) / f64::from(pieces);
        add([0.0, 0.0, -radius], up.map(|v| (radius + height) * v))
    };
    for i in 0..pieces {
        let piece = in_scattering(aerial, at(i), at(i + 1)).unwrap();
        for w in 0..n {
            sum[w] += through[w] * f64::from(piece[w]);
            through[w] *= f64::from(piece[n + w]);
        }
    }
    sum
}

/// Where the sun stands locally lower than any that skies are made for, light goes on to fall as its source does.
#[test]
fn twilight_fades_beyond_the_lowest_sun_of_skies() {
    const LOWEST: f64 = -4.2;
    let green = common::nearest(MODEL.wavelengths(), 550.0);
    let mut errors = vec![];
    for visibility in [25e3, 59.4e3, 120e3] {
        let dusk = Conditions {
            solar_elevation: LOWEST.to_radians(),
            visibility,
            ..Conditions::default()
        };
        let aerial = MODEL.aerial_perspective(&dusk).unwrap();
        let mut before = f64::INFINITY;
        for step in 0..=12 {
            let away = (0.5 * f64::from(step)).to_radians();
            let light = zenith(&aerial, away, 1)[green];
            assert!(light < before, "{visibility} {step}: {before} {light}");
            before = light;
            // Where little changes in a piece, it is what the specification says.
            let exact = zenith(&aerial, away, 1000)[green];
            errors.push((light / exact).ln().abs());
        }
    }
    errors.sort_by(f64::total_cmp);
    let [median, max] =
        [0.5, 1.0].map(|share| errors[(share * (errors.len() - 1) as f64) as usize]);
    println!("zenith in one piece and in many: {median:.3}, {max:.3}");
    assert!(median < 0.15 && max < 0.8, "{median} {max}");
}

#[test]
fn all_that_is_seen_from_the_air_above_the_origin_is_within_reach() {
    let aerial = MODEL.aerial_perspective(&Conditions::default()).unwrap();
    let n = aerial.wavelengths().len();
    let (mut light, mut through) = (vec![0.0; n], vec![0.0; n]);
    let top = MODEL.head().planet.top;
    for height in [0.0, 100.0, 15e3, 40e3, top] {
        for i in 0..=200 {
            let direction = unit(-0.3 + 0.003 * f64::from(i), 0.7);
            aerial
                .to_end([0.0, 0.0, height], direction, &mut light, &mut through)
                .unwrap();
        }
    }
    assert!((0.34..0.36).contains(&aerial.reach()), "{}", aerial.reach());
}

#[test]
fn air_beyond_the_reach_is_refused_and_space_is_not() {
    let aerial = MODEL.aerial_perspective(&Conditions::default()).unwrap();
    let planet = aerial.transmittance().planet();
    let at = |away: f64, height: f64| {
        let up = unit(FRAC_PI_2 - away, 1.0);
        add(
            [0.0, 0.0, -planet.radius],
            up.map(|v| (planet.radius + height) * v),
        )
    };
    let reach = aerial.reach();
    for side in [0.5, 0.999] {
        in_scattering(&aerial, at(side * reach, 10.0), at(side * reach, 2000.0)).unwrap();
    }
    for side in [1.001, 1.5, 5.0] {
        for segment in [
            [at(side * reach, 10.0), at(side * reach, 2000.0)],
            [at(0.9 * reach, 2000.0), at(side * reach, 2000.0)],
            [at(side * reach, 2000.0), at(0.0, 2000.0)],
        ] {
            let refused = in_scattering(&aerial, segment[0], segment[1]).unwrap_err();
            assert!(matches!(refused, Error::Reach { .. }), "{refused}");
            assert_eq!(refused.class(), "point");
        }
        // Above the air nothing scatters, wherever it is.
        let high = [200e3, 300e3].map(|height| at(side * reach, height));
        let light = in_scattering(&aerial, high[0], high[1]).unwrap();
        assert!(
            light
                .iter()
                .take(MODEL.wavelengths().len())
                .all(|&l| l == 0.0)
        );
    }
    // From space down to the origin.
    let light = in_scattering(&aerial, at(0.0, 5e8), at(0.0, 0.0)).unwrap();
    assert!(light.iter().all(|l| *l > 0.0));
}

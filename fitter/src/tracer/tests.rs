//! Properties that hold for any correct tracer.

use super::test_atmosphere::{clear, conservative};
use super::*;
use crate::atmosphere::{Particles, real_with};
use std::f64::consts::PI;

fn query(altitude: f64, zenith: f64, azimuth: f64, sun: f64) -> Query {
    Query {
        altitude,
        view_zenith: zenith.to_radians(),
        view_azimuth: azimuth.to_radians(),
        sun_elevation: sun.to_radians(),
        distance: None,
    }
}

fn tracer(wavelengths: usize, options: Options) -> Tracer {
    Tracer::new(&conservative(wavelengths), options).unwrap()
}

/// |a − b| in standard errors.
fn apart(a: (f64, f64), b: (f64, f64)) -> f64 {
    (a.0 - b.0).abs() / a.1.hypot(b.1).max(1e-12)
}

fn component(r: &Radiance, c: usize) -> (f64, f64) {
    (r.stokes[c], r.error[c])
}

#[test]
fn result_does_not_depend_on_threads() {
    let tracer = tracer(3, Options::default());
    let queries = [
        query(0.0, 40.0, 30.0, 10.0),
        query(9000.0, 93.0, 120.0, -2.0),
    ];
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap()
            .install(|| tracer.estimate_all(&queries, 20, 5).unwrap())
    };
    assert_eq!(run(1), run(3));
    assert_ne!(run(1), tracer.estimate_all(&queries, 20, 6).unwrap());
}

#[test]
fn mirror_images_have_the_same_q_and_opposite_u() {
    let tracer = tracer(1, Options::default());
    let left = tracer.estimate(&query(1000.0, 70.0, 60.0, 15.0), 400, 1);
    let right = tracer.estimate(&query(1000.0, 70.0, -60.0, 15.0), 400, 2);
    let (left, right) = (
        left.unwrap().radiance(0.3, 0),
        right.unwrap().radiance(0.3, 0),
    );
    assert!(apart(component(&left, 0), component(&right, 0)) < 4.0);
    assert!(apart(component(&left, 1), component(&right, 1)) < 4.0);
    let mirrored = (-right.stokes[2], right.error[2]);
    assert!(apart(component(&left, 2), mirrored) < 4.0);
    assert!(left.stokes[2].abs() > 8.0 * left.error[2]);
}

/// At the zenith the azimuth only turns the frame: Q + iU turns by twice the angle.
#[test]
fn polarisation_turns_with_the_frame() {
    let tracer = tracer(1, Options::default());
    let at = |azimuth: f64, seed| {
        let r = tracer.estimate(&query(0.0, 0.0, azimuth, 20.0), 400, seed);
        r.unwrap().radiance(0.0, 0)
    };
    let (zero, turned) = (at(0.0, 1), at(35.0, 2));
    let (sin, cos) = 70.0_f64.to_radians().sin_cos();
    let q = turned.stokes[1] * cos - turned.stokes[2] * sin;
    let u = turned.stokes[1] * sin + turned.stokes[2] * cos;
    assert!(
        apart((q, turned.error[1]), component(&zero, 1)) < 4.0,
        "{q}"
    );
    assert!(
        apart((u.abs(), turned.error[2]), (0.0, zero.error[2])) < 4.0,
        "{u}"
    );
    assert!(
        zero.stokes[1] < 0.0,
        "the zenith is polarised across the sun's plane"
    );
}

#[test]
fn both_ways_of_gathering_sunlight_agree() {
    let flights = tracer(3, Options::default());
    let collisions = tracer(
        3,
        Options {
            gather: Gather::Collisions,
            ..Options::default()
        },
    );
    for (i, q) in [
        query(0.0, 60.0, 45.0, 30.0),
        query(0.0, 88.0, 20.0, 3.0),
        query(5000.0, 120.0, 10.0, 50.0),
    ]
    .iter()
    .enumerate()
    {
        let a = flights.estimate(q, 500, 10 + i as u64).unwrap();
        let b = collisions.estimate(q, 1500, 20 + i as u64).unwrap();
        for w in 0..3 {
            for c in 0..3 {
                let (a, b) = (a.radiance(0.5, w), b.radiance(0.5, w));
                let z = apart(component(&a, c), component(&b, c));
                assert!(z < 4.5, "query {i} lane {w} component {c}: {a:?} {b:?}");
            }
        }
    }
}

/// One walk for several wavelengths gives what a walk for each gives.
#[test]
fn wavelengths_agree_with_themselves_alone() {
    let all = conservative(3);
    let together = Tracer::new(&all, Options::default()).unwrap();
    let q = query(0.0, 75.0, 50.0, 8.0);
    let spectrum = together.estimate(&q, 1000, 3).unwrap();
    for w in 0..3 {
        let one = Tracer {
            groups: vec![engine(&all, &[w], Options::default()).unwrap()],
            options: Options::default(),
            top: all.top(),
        };
        let alone = one.estimate(&q, 500, 4).unwrap().radiance(0.8, 0);
        for c in 0..3 {
            let z = apart(
                component(&alone, c),
                component(&spectrum.radiance(0.8, w), c),
            );
            assert!(z < 4.0, "lane {w} component {c}: z = {z}");
        }
    }
}

/// The zenith under the sun at elevation e, seen through little air: I and Q of the single-scattering formula.
#[test]
fn thin_air_scatters_by_the_closed_form() {
    let mut air = clear();
    for c in &mut air.constituents {
        c.extinction[0] *= 1e-6;
        c.scatterers[0].scattering[0] *= 1e-6;
    }
    let tau: f64 = air.vertical_optical_depth(0, 0);
    let albedo =
        air.constituents[0].scatterers[0].scattering[0] / air.constituents[0].extinction[0];
    let tracer = Tracer::new(&air, Options::default()).unwrap();
    for elevation in [10.0_f64, 45.0, 80.0] {
        let r = tracer.estimate(&query(0.0, 0.0, 0.0, elevation), 20, 1);
        let r = r.unwrap().radiance(0.0, 0);
        let c = elevation.to_radians().sin();
        let i = tau * albedo * 0.75 * (1.0 + c * c) / (4.0 * PI);
        let q = -tau * albedo * 0.75 * (1.0 - c * c) / (4.0 * PI);
        assert!((r.stokes[0] / i - 1.0).abs() < 1e-4, "{} {i}", r.stokes[0]);
        assert!((r.stokes[1] / q - 1.0).abs() < 1e-4, "{} {q}", r.stokes[1]);
    }
}

/// Babinet's and Arago's points: on the sun's vertical Q is positive near the sun and opposite to it, negative between.
#[test]
fn neutral_points_exist() {
    let mut air = conservative(1);
    air.constituents.truncate(1);
    let tracer = Tracer::new(&air, Options::default()).unwrap();
    let q = |zenith, azimuth| {
        let r = tracer.estimate(&query(0.0, zenith, azimuth, 10.0), 1500, 9);
        let r = r.unwrap().radiance(0.0, 0);
        (r.stokes[1], r.error[1])
    };
    for (zenith, azimuth, sign) in [
        (78.0, 0.0, 1.0),
        (40.0, 0.0, -1.0),
        (0.0, 0.0, -1.0),
        (40.0, 180.0, -1.0),
        (84.0, 180.0, 1.0),
    ] {
        let (value, error) = q(zenith, azimuth);
        assert!(
            sign * value > 3.0 * error,
            "{zenith} {azimuth}: {value} ± {error}"
        );
    }
}

#[test]
fn a_cut_line_of_sight_adds_up() {
    let options = Options {
        orders: Orders::Single,
        ..Options::default()
    };
    let tracer = tracer(1, options);
    let whole = query(0.0, 80.0, 20.0, 30.0);
    let near = Query {
        distance: Some(20_000.0),
        ..whole
    };
    let none = Query {
        distance: Some(0.0),
        ..whole
    };
    let i = |q: &Query| tracer.estimate(q, 0, 1).unwrap().radiance(0.0, 0).stokes[0];
    assert!(i(&near) > 0.1 * i(&whole) && i(&near) < i(&whole));
    assert_eq!(i(&none), 0.0);
    assert_eq!(tracer.optical_depth(&none).unwrap()[0], 0.0);
}

#[test]
fn impossible_queries_are_refused() {
    let tracer = tracer(1, Options::default());
    for (q, field) in [
        (query(-1.0, 0.0, 0.0, 0.0), "altitude"),
        (query(90_000.0, 0.0, 0.0, 0.0), "altitude"),
        (query(0.0, 181.0, 0.0, 0.0), "view zenith"),
        (query(0.0, f64::NAN, 0.0, 0.0), "view zenith"),
        (query(0.0, 0.0, 0.0, 91.0), "sun elevation"),
    ] {
        let message = tracer.estimate(&q, 1, 1).unwrap_err().to_string();
        assert!(message.contains(field), "{message}");
    }
}

/// Under a high sun the disc changes nothing. At night light scattered once comes from above the shadow, where the air
/// thins by e over 8 km; the shadow's edges for the upper and lower rim of the sun are 7 km apart, so the disc
/// brightens by about (7/2/8)² / 8 = 2.5 %.
#[test]
fn the_suns_disc_matters_at_the_shadows_edge_only() {
    let radius = 0.2667_f64.to_radians();
    let at = |sun_radius, orders, q: &Query| {
        let options = Options {
            sun_radius,
            orders,
            ..Options::default()
        };
        let r = tracer(1, options).estimate(q, 300, 4);
        r.unwrap().radiance(0.3, 0)
    };
    let day = query(0.0, 50.0, 90.0, 40.0);
    let (point, disc) = (at(0.0, Orders::All, &day), at(radius, Orders::All, &day));
    assert!(apart(component(&point, 0), component(&disc, 0)) < 4.0);
    let night = query(0.0, 0.0, 0.0, -7.0);
    let (point, disc) = (
        at(0.0, Orders::Single, &night),
        at(radius, Orders::Single, &night),
    );
    let ratio = disc.stokes[0] / point.stokes[0];
    assert!((1.01..1.06).contains(&ratio), "{ratio}");
}

/// Thin air with one species of spheres: Q/I at each scattering angle is the table's P12/P11 (550 nm).
#[test]
fn spheres_polarise_as_their_table_says() {
    let mut air = real_with(59_400.0, &[550.0], Particles::Mie).unwrap();
    air.constituents.swap_remove(0);
    for c in &mut air.constituents {
        c.scatterers.retain(|s| s.name == "inso");
        c.extinction[0] = 1e-12;
    }
    let options = Options {
        orders: Orders::Single,
        ..Options::default()
    };
    let tracer = Tracer::new(&air, options).unwrap();
    for (angle, ratio) in [(60.0, 0.0424), (90.0, 0.0705), (150.0, 0.2121)] {
        let r = tracer.estimate(&query(3000.0, angle - 10.0, 180.0, 80.0), 0, 1);
        let r = r.unwrap().radiance(0.0, 0);
        let ours = r.stokes[1] / r.stokes[0];
        assert!((ours - ratio).abs() < 1e-4, "{angle}°: {ours}");
    }
}

#[test]
fn both_ways_of_gathering_sunlight_agree_for_mie_particles() {
    let air = real_with(20_000.0, &[450.0, 650.0], Particles::Mie).unwrap();
    let with = |gather| {
        let options = Options {
            gather,
            ..Options::default()
        };
        Tracer::new(&air, options).unwrap()
    };
    let q = query(0.0, 60.0, 45.0, 30.0);
    let a = with(Gather::Flights).estimate(&q, 500, 1).unwrap();
    let b = with(Gather::Collisions).estimate(&q, 1500, 2).unwrap();
    for w in 0..2 {
        let (a, b) = (a.radiance(0.5, w), b.radiance(0.5, w));
        for c in 0..3 {
            assert!(
                apart(component(&a, c), component(&b, c)) < 4.5,
                "{a:?} {b:?}"
            );
        }
        assert!(a.error[0] < 0.02 * a.stokes[0], "{a:?}");
    }
}

#[test]
fn there_is_no_air_under_the_ground_or_over_the_top() {
    let tracer = tracer(1, Options::default());
    for q in [
        query(0.0, 180.0, 0.0, 30.0),
        query(0.0, 91.0, 20.0, 30.0),
        query(80_000.0, 0.0, 0.0, 30.0),
        query(80_000.0, 80.0, 0.0, 30.0),
    ] {
        let estimate = tracer.estimate(&q, 4, 1).unwrap();
        assert_eq!(estimate.radiance(0.5, 0).stokes, [0.0; 3], "{q:?}");
        assert_eq!(estimate.transmittance(0), 1.0);
    }
}

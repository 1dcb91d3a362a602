//! Helmholtz reciprocity: swapping the sun and the observer leaves the reflection function of a slab unchanged.
//!
//! For light scattered back by a plane-parallel slab, I(view zenith v, sun zenith s) / cos s = I(s, v) / cos v. The
//! walks of the two sides have nothing in common, so that an error in phase functions, path lengths or densities breaks
//! it.

use welkin_fitter::atmosphere::{Atmosphere, Constituent, Phase, Scatterer};
use welkin_fitter::tracer::{Options, Query, Radiance, Tracer, VisibleGround};

/// A slab of Rayleigh and Henyey-Greenstein scatterers as a thin shell of a very large planet.
fn slab() -> Atmosphere {
    let thickness = 100.0;
    let constituent = |name: &str, tau: f64, albedo: f64, phase: Phase| Constituent {
        name: name.into(),
        profile: vec![1.0, 1.0],
        extinction: vec![tau / thickness],
        scatterers: vec![Scatterer {
            name: name.into(),
            phase,
            extinction: vec![tau / thickness],
            scattering: vec![albedo * tau / thickness],
        }],
    };
    Atmosphere {
        planet_radius: 1e11,
        altitudes: vec![0.0, thickness],
        wavelengths: vec![550.0],
        constituents: vec![
            constituent(
                "air",
                0.3,
                1.0,
                Phase::Rayleigh {
                    depolarisation: vec![0.03],
                },
            ),
            constituent(
                "aerosol",
                0.4,
                0.9,
                Phase::HenyeyGreenstein { g: vec![0.7] },
            ),
        ],
    }
}

fn reflected(tracer: &Tracer, view: f64, sun: f64, azimuth: f64, seed: u64) -> (f64, f64) {
    let query = Query {
        altitude: 100.0,
        view_zenith: (180.0 - view).to_radians(),
        view_azimuth: azimuth.to_radians(),
        sun_elevation: (90.0 - sun).to_radians(),
        distance: None,
    };
    let estimate = tracer.estimate(&query, 1500, seed).unwrap();
    let Radiance { stokes, error } = estimate.radiance(0.5, 0);
    let cosine = sun.to_radians().cos();
    (stokes[0] / cosine, error[0] / cosine)
}

#[test]
fn sun_and_observer_may_change_places() {
    // The ground must be lit: swapping turns "ground, then air" into "air, then ground".
    let options = Options {
        visible_ground: VisibleGround::Lit,
        ..Options::default()
    };
    let tracer = Tracer::new(&slab(), options).unwrap();
    let mut square = 0.0;
    let cases = [
        (20.0, 70.0, 0.0),
        (40.0, 60.0, 90.0),
        (10.0, 80.0, 180.0),
        (65.0, 30.0, 45.0),
    ];
    for (i, (a, b, azimuth)) in cases.into_iter().enumerate() {
        let there = reflected(&tracer, a, b, azimuth, 2 * i as u64);
        let back = reflected(&tracer, b, a, azimuth, 2 * i as u64 + 1);
        let z = (there.0 - back.0) / there.1.hypot(back.1);
        println!(
            "{a}° / {b}°: {:.5} ± {:.5}, {:.5} ± {:.5}, z {z:.2}",
            there.0, there.1, back.0, back.1
        );
        assert!(there.1 / there.0 < 0.01, "too noisy to tell");
        assert!(z.abs() < 4.0, "{z}");
        square += z * z;
    }
    assert!(square < 16.0, "{square}");
}

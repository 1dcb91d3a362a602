//! Polarisation from the tracer to the file: a small model, built and judged; neutral points where the air has them.

use std::sync::OnceLock;
use welkin::axis::Ends;
use welkin::{Conditions, Frame, Model, PolarisedSky};
use welkin_fitter::assess::Quantiles;
use welkin_fitter::build::{Fitting, build};
use welkin_fitter::dataset::{Axis, Grid};
use welkin_fitter::decompose::Options;
use welkin_fitter::orders::Settings;
use welkin_fitter::polarimetry;
use welkin_fitter::units::{HeldOut, Plan};

const CLEAR: f64 = 131_800.0;
const HAZY: f64 = 20_000.0;

fn plan() -> Plan {
    let free = |intervals| Axis {
        intervals,
        ends: Ends::Free,
    };
    let grid = Grid::default();
    Plan {
        grid: Grid {
            altitudes: vec![0.0],
            visibilities: vec![HAZY, CLEAR],
            up: (free(20), 3.0),
            down: (free(4), 3.0),
            phi: Axis {
                intervals: 10,
                ends: Ends::Mirrored,
            },
            elevation: welkin::axis::ElevationAxis {
                intervals: 22,
                ..grid.elevation
            },
        },
        settings: Settings {
            up: 10,
            down: 7,
            azimuths: 8,
            first: 2,
            orders: 5,
            fineness: 4.0,
        },
        held_out: HeldOut {
            views: 60,
            suns: 12,
        },
    }
}

struct Built {
    model: Model,
    work: tempfile::TempDir,
}

fn built() -> &'static Built {
    static BUILT: OnceLock<Built> = OnceLock::new();
    BUILT.get_or_init(|| {
        let work = tempfile::tempdir().unwrap();
        let out = work.path().join("small.welkin");
        let options = |rank, sweeps| Options {
            rank,
            sweeps,
            seed: 1,
        };
        let fitting = Fitting {
            options: options(48, 150),
            refinements: 0,
            polarisation: options(24, 150),
        };
        println!("{}", build(&plan(), fitting, work.path(), &out).unwrap());
        let model = Model::open(&out).unwrap();
        Built { model, work }
    })
}

fn sky(visibility: f64, degrees: f64) -> PolarisedSky {
    let conditions = Conditions {
        solar_elevation: degrees.to_radians(),
        visibility,
        ..Conditions::default()
    };
    built().model.polarised_sky(&conditions).unwrap()
}

#[test]
fn a_small_model_follows_the_traced_polarisation() {
    let Built { model, work } = built();
    let plan = plan();
    let store = plan.store(work.path()).unwrap();
    for visibility in [HAZY, CLEAR] {
        let solved = plan.solve(work.path(), visibility, &|_| {}).unwrap();
        let samples = plan.held_out(&store, &solved, 0.0).unwrap();
        let errors = polarimetry::errors(model, visibility, &samples).unwrap();
        println!("{}", polarimetry::table(&errors));
        let degree = Quantiles::of(errors.iter().map(|e| e.degree)).unwrap();
        let angle = Quantiles::of(errors.iter().filter_map(|e| e.angle)).unwrap();
        assert!(
            degree.count > 2000 && degree.median < 0.003 && degree.p99 < 0.03,
            "{degree:?}"
        );
        assert!(angle.count > 1000 && angle.p95 < 1.5, "{angle:?}");
        // What the paper drops matters at this precision.
        let dropped = polarimetry::without_u(model, visibility, &samples);
        let dropped = Quantiles::of(dropped.iter().map(|e| e.degree)).unwrap();
        assert!(dropped.p99 > 2.0 * degree.p99, "{dropped:?}");
    }
}

/// Angles from the sun (degrees, upwards over the zenith) in the sun's vertical plane where the polarisation changes its sign.
fn neutral_points(sky: &PolarisedSky, wavelength: f64) -> Vec<f64> {
    let sun = sky.sky().conditions().solar_elevation.to_degrees();
    let signed = |from_sun: f64| {
        let (z, x) = (sun + from_sun).to_radians().sin_cos();
        let direction = [x as f32, 0.0, z as f32];
        let light = sky
            .stokes_at(direction, Frame::SunAligned, wavelength)
            .unwrap();
        light.signed_degree()
    };
    let steps: Vec<f64> = (0..)
        .map(|k| 0.25 * f64::from(k) - sun + 0.5)
        .take_while(|a| sun + a < 179.5)
        .filter(|a| a.abs() > 1.0)
        .collect();
    let changes = steps
        .windows(2)
        .filter(|w| signed(w[0]) * signed(w[1]) < 0.0);
    changes.map(|w| 0.5 * (w[0] + w[1])).collect()
}

/// Babinet's point above the sun, Brewster's below it, Arago's above the point opposite to the sun: each some 10..35° away.
#[test]
fn neutral_points_stand_where_the_air_has_them() {
    let babinet = |points: &[f64]| points.iter().copied().find(|a| (1.0..60.0).contains(a));
    let brewster = |points: &[f64]| points.iter().copied().find(|a| (-60.0..-1.0).contains(a));
    let arago = |points: &[f64]| points.iter().copied().find(|a| (120.0..180.0).contains(a));

    let low = neutral_points(&sky(CLEAR, 5.0), 440.0);
    println!("sun at 5°: {low:?}");
    let from_antisun = 180.0 - arago(&low).expect("Arago's point");
    assert!((12.0..35.0).contains(&from_antisun), "{from_antisun}");
    let above = babinet(&low).expect("Babinet's point");
    assert!((8.0..30.0).contains(&above), "{above}");
    assert_eq!(brewster(&low), None, "below the horizon");

    let high = neutral_points(&sky(CLEAR, 45.0), 440.0);
    println!("sun at 45°: {high:?}");
    assert_eq!(arago(&high), None, "set");
    let (babinet_high, brewster_high) = (babinet(&high).unwrap(), brewster(&high).unwrap());
    assert!(babinet_high > 2.0 && brewster_high < -2.0);
    // Both approach the sun as it rises.
    let higher = neutral_points(&sky(CLEAR, 70.0), 440.0);
    println!("sun at 70°: {higher:?}");
    assert!(babinet(&higher).unwrap() < babinet_high);
    assert!(brewster(&higher).unwrap() > brewster_high);

    // Haze scatters more often: the points move away from the sun and from the point opposite to it.
    let hazy = neutral_points(&sky(HAZY, 5.0), 440.0);
    println!("haze, sun at 5°: {hazy:?}");
    let from_antisun_hazy = 180.0 - arago(&hazy).expect("Arago's point");
    assert!(
        from_antisun_hazy > from_antisun + 1.0,
        "{from_antisun_hazy}"
    );
}

//! Polarisation from the tracer to the file: a small model, built and judged; neutral points where the air has them.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::OnceLock;
use welkin::axis::Ends;
use welkin::geometry::Side;
use welkin::output::Target;
use welkin::{Conditions, Model, PolarisationFrame, PolarisedSky, Stokes};
use welkin_fitter::assess::Quantiles;
use welkin_fitter::build::build;
use welkin_fitter::dataset::{Axis, Grid};
use welkin_fitter::decompose::Options;
use welkin_fitter::fitting::Fitting;
use welkin_fitter::polarimetry;
use welkin_fitter::successive_orders::scattered_source::Sun;
use welkin_fitter::successive_orders::{NW, Settings};
use welkin_fitter::units::{Between, HeldOut, Plan};

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
                intervals: 28,
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
        between: Between::Nothing,
        ..Plan::default()
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
            options: options(64, 150),
            refinements: 0,
            polarisation: options(48, 300),
            ..Fitting::default()
        };
        println!(
            "{}",
            build(&plan(), fitting, work.path(), &Target::new(&out)).unwrap()
        );
        let model = Model::open(&out).unwrap();
        Built { model, work }
    })
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
    }
}

/// Signed degree of polarisation in the vertical plane of the sun at an angle (degrees) from it, upwards over the
/// zenith: of the model and as traced.
struct Plane {
    sky: PolarisedSky,
    visibility: f64,
    sun: f64,
}

/// The node at 430 nm.
const WAVELENGTH: usize = 9;

impl Plane {
    fn new(visibility: f64, sun: f64) -> Self {
        let conditions = Conditions {
            solar_elevation: sun.to_radians(),
            visibility,
            ..Conditions::default()
        };
        Self {
            sky: built().model.polarised_sky(&conditions).unwrap(),
            visibility,
            sun,
        }
    }

    /// Signed degree at an angle from the horizon (rad), over the zenith.
    fn modelled(&self, elevation: f64) -> f64 {
        let (z, x) = elevation.sin_cos();
        let mut light = [Stokes::default(); NW];
        let direction = [x as f32, 0.0, z as f32];
        self.sky
            .relative_stokes(direction, PolarisationFrame::SunAligned, &mut light)
            .unwrap();
        f64::from(light[WAVELENGTH].signed_degree())
    }

    fn traced(&self) -> impl Fn(f64) -> f64 {
        let Built { work, .. } = built();
        let solved = plan().solve(work.path(), self.visibility, &|_| {}).unwrap();
        let (se, ce) = self.sun.to_radians().sin_cos();
        move |elevation| {
            let gatherer = solved.gatherer();
            let above = elevation.min(PI - elevation);
            let side = if elevation < FRAC_PI_2 { 1.0 } else { -1.0 };
            let sun = Sun {
                elevation: (ce, se),
                azimuth: (side, 0.0),
            };
            let path = gatherer.path(0.0, above, Side::Up);
            let albedo = Conditions::default().albedo as f32;
            let [i, q, _] = gatherer.stokes(&path, above.sin(), &sun, albedo);
            // e1 is vertical, the plane of view and sun too.
            f64::from(-q[WAVELENGTH] / i[WAVELENGTH])
        }
    }

    /// Where the sign changes, degrees from the sun.
    fn neutral_points(&self, signed: &dyn Fn(f64) -> f64) -> Vec<f64> {
        let angles = (1..180)
            .map(|k| f64::from(k) - self.sun)
            .filter(|a| a.abs() > 1.5);
        let values: Vec<(f64, f64)> = angles
            .map(|a| (a, signed((self.sun + a).to_radians())))
            .collect();
        let crossing = |w: &[(f64, f64)]| {
            let ((a, p), (b, q)) = (w[0], w[1]);
            (p * q < 0.0 && b - a < 1.5).then(|| a + (b - a) * p / (p - q))
        };
        values.windows(2).filter_map(crossing).collect()
    }
}

/// Babinet's point above the sun, Brewster's below it, Arago's above the point opposite to the sun.
#[test]
fn neutral_points_stand_where_the_air_has_them() {
    let within = |points: &[f64], low: f64, high: f64| {
        points.iter().copied().find(|a| (low..high).contains(a))
    };
    let mut babinet = vec![];
    for (visibility, sun) in [(CLEAR, 5.0), (HAZY, 5.0), (CLEAR, 45.0), (CLEAR, 70.0)] {
        let plane = Plane::new(visibility, sun);
        let modelled = plane.neutral_points(&|elevation| plane.modelled(elevation));
        let truth = plane.traced();
        let traced = plane.neutral_points(&truth);
        println!("visibility {visibility} m, sun at {sun}°: {modelled:.1?}, traced {traced:.1?}");
        for (low, high) in [(1.5, 60.0), (-60.0, -1.5), (120.0, 170.0)] {
            let (got, want) = (within(&modelled, low, high), within(&traced, low, high));
            // One that the other does not have is where the other comes next to zero.
            let alone = match (got, want) {
                (Some(at), None) => truth((sun + at).to_radians()),
                (None, Some(at)) => plane.modelled((sun + at).to_radians()),
                _ => 0.0,
            };
            assert!(
                alone.abs() < 0.004,
                "{low}..{high}: {got:?} {want:?} {alone}"
            );
            if let (Some(got), Some(want)) = (got, want) {
                // Near a high sun the degree crosses zero so slowly that a small error of it moves the point.
                let most = if sun > 60.0 { 4.0 } else { 1.0 };
                let there = plane.modelled((sun + want).to_radians());
                println!("{got:.2}°, traced {want:.2}°, where the model has {there:.5}");
                assert!((got - want).abs() < most, "{got} {want}");
                assert!(there.abs() < 0.004, "{there}");
            }
        }
        let arago = within(&modelled, 120.0, 170.0);
        let brewster = within(&modelled, -60.0, -1.5);
        if sun < 10.0 {
            let from_antisun = 180.0 - arago.expect("Arago's point");
            assert!((15.0..30.0).contains(&from_antisun), "{from_antisun}");
            // Haze lifts one over the horizon, in the model and as traced.
            let lifted = visibility == HAZY && brewster.is_some_and(|b| sun + b < 3.0);
            assert!(brewster.is_none() || lifted, "below the horizon");
        } else {
            assert_eq!(arago, None, "below the horizon");
            assert!(brewster.is_some());
        }
        babinet.push(within(&modelled, 1.5, 60.0).expect("Babinet's point"));
    }
    // It approaches the sun as the sun rises.
    assert!(
        (15.0..30.0).contains(&babinet[0]) && babinet[0] > babinet[2] && babinet[2] > babinet[3]
    );
}

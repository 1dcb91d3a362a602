//! Scattering matrices of spheres: the solver by orders against the unbiased tracer, and a model of such air.

use std::f64::consts::FRAC_PI_2;
use std::sync::OnceLock;
use welkin::format::PhaseFunction;
use welkin::output::Target;
use welkin::{Conditions, Model, PolarisationFrame, Stokes};
use welkin_fitter::aureole::lines::{Line, Place, all};
use welkin_fitter::dataset::VISIBLE;
use welkin_fitter::make::{Bands, Quality, Request, Scene};
use welkin_fitter::recipe::Recipe;
use welkin_fitter::successive_orders::scattered_source::Sun;
use welkin_fitter::successive_orders::{
    Gatherer, LightField, Medium, NW, SOLAR_ANGULAR_RADIUS, Settings, solve,
};
use welkin_fitter::tracer::{Options, Query, Radiance, Tracer};

const ALBEDO: f64 = 0.2;
const COARSE: Settings = Settings {
    up: 10,
    down: 7,
    azimuths: 8,
    first: 2,
    orders: 5,
    fineness: 4.0,
};

/// Haze over the sea of OPAC's continental average particles at 50 % humidity.
fn recipe() -> Recipe {
    let text =
        "[layers.haze]\ntop_km = 2\nscale_height_km = 8\nmixture = \"continental_average\"\n";
    Recipe::parse(text, None).unwrap().with_mie().unwrap()
}

fn solved() -> &'static (Medium, LightField) {
    static SOLVED: OnceLock<(Medium, LightField)> = OnceLock::new();
    SOLVED.get_or_init(|| {
        let air = recipe().air(&VISIBLE.nodes).unwrap();
        let medium = Medium::new(air, SOLAR_ANGULAR_RADIUS).unwrap();
        let light = solve(&medium, COARSE, &|_| ());
        (medium, light)
    })
}

fn lines() -> Vec<Line> {
    let every = |place: Place, stride: usize| {
        let lines = all(&[0.4]);
        let own: Vec<Line> = lines.into_iter().filter(|l| l.place == place).collect();
        own.into_iter().step_by(stride).collect::<Vec<_>>()
    };
    [every(Place::Aureole, 3), every(Place::Sky, 4)].concat()
}

/// I, Q and U by wavelength, with the light that was scattered before in `light`.
fn gathered(line: &Line, light: &LightField, albedo: f32) -> [[f32; NW]; 3] {
    let gatherer = Gatherer::new(&solved().0, light, 1.5);
    let mu = line.view[0].sin();
    let side = gatherer.planet().ray(0.0, line.view[0]).side;
    let path = gatherer.path(0.0, line.view[0], side);
    let sun = Sun {
        elevation: (line.sun.cos(), line.sun.sin()),
        azimuth: (line.view[1].cos(), line.view[1].sin()),
    };
    gatherer.stokes(&path, mu, &sun, albedo)
}

fn query(line: &Line) -> Query {
    Query {
        altitude: 0.0,
        view_zenith: FRAC_PI_2 - line.view[0],
        view_azimuth: line.view[1],
        sun_elevation: line.sun,
        distance: None,
    }
}

fn traced() -> &'static Vec<(Line, Vec<Radiance>)> {
    static TRACED: OnceLock<Vec<(Line, Vec<Radiance>)>> = OnceLock::new();
    TRACED.get_or_init(|| {
        let air = recipe().air(&VISIBLE.nodes).unwrap();
        let tracer = Tracer::new(&air, Options::default()).unwrap();
        let one = |(i, line): (usize, Line)| {
            let estimate = tracer.estimate(&query(&line), 400, i as u64).unwrap();
            let light = (0..NW).map(|w| estimate.radiance(ALBEDO, w)).collect();
            (line, light)
        };
        lines().into_iter().enumerate().map(one).collect()
    })
}

#[test]
fn the_unbiased_tracer_confirms_the_radiance() {
    let mut errors = vec![];
    for (line, light) in traced() {
        let ours = gathered(line, &solved().1, ALBEDO as f32);
        for (w, truth) in light.iter().enumerate() {
            let [i, noise] = [truth.stokes[0], truth.error[0]];
            if i > 1e-7 {
                let error = f64::from(ours[0][w]) / i - 1.0;
                assert!(
                    error.abs() < 0.04 + 4.0 * noise / i,
                    "{line:?} {w}: {error}"
                );
                errors.push(error);
            }
        }
    }
    let bias = errors.iter().sum::<f64>() / errors.len() as f64;
    println!("{} values, bias {bias:+.4}", errors.len());
    assert!(bias.abs() < 0.01, "{bias}");
}

/// Light that particles polarise, and light that stays polarised when they scatter it again.
#[test]
fn the_unbiased_tracer_confirms_the_polarisation() {
    let (mut errors, mut strongest) = (vec![], 0.0f64);
    for (line, light) in traced() {
        let ours = gathered(line, &solved().1, ALBEDO as f32);
        for (w, truth) in light.iter().enumerate() {
            let [i, noise] = [truth.stokes[0], truth.error[1].max(truth.error[2])];
            if line.place != Place::Sky || i < 1e-7 || noise > 0.004 * i {
                continue;
            }
            for s in [1, 2] {
                let degree = truth.stokes[s] / i;
                errors.push((f64::from(ours[s][w]) / f64::from(ours[0][w]) - degree).abs());
                strongest = strongest.max(degree.abs());
            }
        }
    }
    errors.sort_by(f64::total_cmp);
    let at = |share: f64| errors[(share * (errors.len() - 1) as f64) as usize];
    let (median, p95, max) = (at(0.5), at(0.95), at(1.0));
    println!(
        "{} values, {median:.4} {p95:.4} {max:.4}, {strongest:.2}",
        errors.len()
    );
    assert!(errors.len() > 200 && strongest > 0.3);
    assert!(median < 0.01 && p95 < 0.08, "{median} {p95} {max}");
}

struct Made {
    model: Model,
    bytes: usize,
}

fn made() -> &'static Made {
    static MADE: OnceLock<Made> = OnceLock::new();
    MADE.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("mie.welkin");
        let request = Request {
            recipe: recipe(),
            scene: Scene {
                altitudes: [0.0, 0.0],
                elevations: [5.0, 40.0].map(f64::to_radians),
                bands: Bands::All,
            },
            axis: None,
            quality: Quality::Draft,
        };
        request
            .make(&folder.path().join("work"), &Target::new(&out))
            .unwrap();
        let bytes = std::fs::read(&out).unwrap();
        Made {
            bytes: bytes.len(),
            model: Model::from_bytes(bytes).unwrap(),
        }
    })
}

#[test]
fn a_kind_of_particles_is_several_fields_of_the_file() {
    let head = made().model.head();
    let lobes = head
        .fields
        .iter()
        .filter(|f| f.phase == PhaseFunction::HenyeyGreenstein);
    assert!(lobes.count() > 4);
    assert!(head.fields.len() <= 16 && made().bytes > 0);
}

/// A draft is coarse; a Henyey-Greenstein model is off by half the light at 0.5° from the sun.
#[test]
fn the_model_has_the_aureole() {
    let mut errors = vec![];
    for (line, light) in traced() {
        let sky = made().model.polarised_sky(&Conditions {
            solar_elevation: line.sun,
            visibility: made().model.head().visibilities[0],
            albedo: ALBEDO,
            ..Conditions::default()
        });
        let mut ours = vec![Stokes::default(); NW];
        sky.unwrap()
            .relative_stokes(line.direction(), PolarisationFrame::Vertical, &mut ours)
            .unwrap();
        if line.place == Place::Aureole {
            errors.push((f64::from(ours[12].i) / light[12].stokes[0] - 1.0).abs());
        }
    }
    errors.sort_by(f64::total_cmp);
    println!("aureole at 550 nm: {errors:.3?}");
    assert!(errors[errors.len() / 2] < 0.05, "{errors:?}");
    assert!(errors[errors.len() - 1] < 0.15, "{errors:?}");
}

#[test]
fn the_recipe_says_it_too() {
    let text = "[aerosol]\nphase = \"mie\"\n[layers.haze]\ntop_km = 2\nmixture = \"urban\"\n";
    let said = Recipe::parse(text, None).unwrap();
    let asked = Recipe::parse(&text.replace("phase = \"mie\"\n", ""), None).unwrap();
    assert_ne!(said.key(), asked.key());
    assert_eq!(said, asked.with_mie().unwrap());
    let wrong = Recipe::parse(&text.replace("mie", "mei"), None).unwrap_err();
    assert!(wrong.to_string().contains("mei"), "{wrong:#}");
}

//! From a recipe to a model: a coarse one, judged where it was fitted to nothing.

use std::path::Path;
use std::process::Command;
use std::sync::OnceLock;
use welkin::output::Target;
use welkin::{Conditions, Model};
use welkin_fitter::make::{Bands, Quality, Request, Scene, judge::judge};
use welkin_fitter::recipe::Recipe;

/// The model's own air of 59.4 km.
fn recipe() -> Recipe {
    let text = include_str!("reference/own_air.toml");
    Recipe::parse(&format!("name = \"Own air\"\n{text}"), None).unwrap()
}

fn request(bands: Bands) -> Request {
    Request {
        recipe: recipe(),
        axis: None,
        scene: Scene {
            altitudes: [0.0, 0.0],
            elevations: [5.0, 40.0].map(f64::to_radians),
            bands,
        },
        quality: Quality::Draft,
    }
}

struct Made {
    folder: tempfile::TempDir,
    model: Model,
    report: String,
}

fn open(path: &Path) -> Model {
    Model::from_bytes(std::fs::read(path).unwrap()).unwrap()
}

fn made() -> &'static Made {
    static MADE: OnceLock<Made> = OnceLock::new();
    MADE.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("clean.welkin");
        let report = request(Bands::All)
            .make(&folder.path().join("work"), &Target::new(&out))
            .unwrap();
        println!("{report}");
        Made {
            model: open(&out),
            folder,
            report,
        }
    })
}

fn conditions() -> Conditions {
    Conditions {
        solar_elevation: 20f64.to_radians(),
        visibility: made().model.head().visibilities[0],
        ..Conditions::default()
    }
}

#[test]
fn the_model_has_the_air_and_the_ranges_of_the_request() {
    let head = made().model.head();
    assert_eq!(head.visibilities, [recipe().visibility().unwrap().round()]);
    assert_eq!(head.altitudes, [0.0]);
    let [low, high] = made().model.solar_elevation_range().map(f64::to_degrees);
    assert!((low - 5.0).abs() < 1e-9 && (high - 40.0).abs() < 1e-9);
    assert!(head.metadata.contains("Own air"), "{}", head.metadata);
    assert!(made().report.contains("against the unbiased tracer"));
}

/// As near as a draft is to the truth.
#[test]
fn a_recipe_of_the_default_air_makes_the_default_model() {
    let default = Model::default_model().unwrap();
    let mut errors = vec![];
    for elevation in [7.0, 13.0, 22.0, 37.0f64] {
        let [ours, theirs] = [&made().model, &default].map(|model| {
            let own = Conditions {
                solar_elevation: elevation.to_radians(),
                visibility: made().model.head().visibilities[0],
                ..Conditions::default()
            };
            model.sky(&own).unwrap()
        });
        for (i, height) in [0.02, 0.1, 0.3, 0.6, 0.9f64].into_iter().enumerate() {
            let (cosine, azimuth) = ((1.0 - height * height).sqrt(), 0.3 + 1.1 * i as f64);
            let direction = [cosine * azimuth.cos(), cosine * azimuth.sin(), height];
            let direction = direction.map(|x| x as f32);
            for nm in default.wavelengths() {
                let light = |sky: &welkin::Sky| sky.radiance_at(direction, *nm).unwrap();
                errors.push((f64::from(light(&ours) / light(&theirs)) - 1.0).abs());
            }
        }
    }
    errors.sort_by(f64::total_cmp);
    let at = |share: f64| errors[(share * (errors.len() - 1) as f64) as usize];
    println!(
        "median {:.4}, p95 {:.4}, largest {:.4}",
        at(0.5),
        at(0.95),
        at(1.0)
    );
    assert!(at(0.5) < 0.01 && at(0.95) < 0.05 && at(1.0) < 0.15);
}

#[test]
fn the_unbiased_tracer_confirms_a_draft() {
    let (plan, _) = request(Bands::All).plan().unwrap();
    let judgement = judge(&made().model, &plan, None, Quality::Draft.judged()).unwrap();
    println!("{judgement}");
    let errors = judgement.quantiles().unwrap();
    assert!(errors.count > 200);
    assert!(errors.median < 0.02, "{}", errors.median);
    // A wrong air, or a wrong ground, would be off everywhere.
    assert!(errors.p95 < 0.08, "{}", errors.p95);
}

/// The second time nothing is traced; only what is written differs.
#[test]
fn a_second_run_goes_on_from_the_units_of_the_first() {
    let work = made().folder.path().join("work");
    let light = || {
        let entries = std::fs::read_dir(&work).unwrap().map(Result::unwrap);
        let mut units = entries.filter(|e| e.path().extension().is_some_and(|e| e == "unit"));
        let light = units.find(|e| e.file_name().to_string_lossy().starts_with("light-"));
        light.unwrap().metadata().unwrap().modified().unwrap()
    };
    let (before, whole) = (light(), std::fs::read(work.join("whole.welkin")).unwrap());
    let out = made().folder.path().join("small.welkin");
    request(Bands::Rgb).make(&work, &Target::new(&out)).unwrap();
    assert_eq!(light(), before);
    assert_eq!(std::fs::read(work.join("whole.welkin")).unwrap(), whole);

    let small = open(&out);
    assert!(small.file_bytes() < made().model.file_bytes());
    let sky = |model: &Model| {
        let sky = model.sky(&conditions()).unwrap();
        sky.xyz([0.6, 0.0, 0.8]).unwrap()
    };
    for (a, b) in sky(&small).into_iter().zip(sky(&made().model)) {
        assert!((a / b - 1.0).abs() < 2e-3, "{a} {b}");
    }
}

/// So that many machines can share them.
#[test]
fn units_of_a_recipe_have_names() {
    let list = |more: &[&str]| {
        let folder = tempfile::tempdir().unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_welkin-fit"))
            .args([
                "units",
                "list",
                "--recipe",
                "desert",
                "--altitudes",
                "0,3000",
            ])
            .args(more)
            .current_dir(folder.path())
            .output()
            .unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        (text(output.stdout), text(output.stderr))
    };
    let (units, _) = list(&[]);
    let visibility = Recipe::named("desert")
        .unwrap()
        .visibility()
        .unwrap()
        .round();
    for unit in [
        format!("light-{visibility}"),
        format!("tensor-{visibility}-3000"),
    ] {
        assert!(units.contains(&format!("{unit}\tmissing")), "{units}");
    }
    let (_, error) = list(&["--visibilities", "40"]);
    assert!(error.contains("cannot be used with"), "{error}");
}

#[test]
fn what_cannot_be_made_is_refused_before_anything_is_traced() {
    let folder = tempfile::tempdir().unwrap();
    let mut wrong = request(Bands::All);
    wrong.scene.elevations = [-30.0, 40.0].map(f64::to_radians);
    let out = folder.path().join("x.welkin");
    let error = wrong.make(folder.path(), &Target::new(&out)).unwrap_err();
    assert!(error.to_string().contains("solar elevations"), "{error}");
    assert!(!out.exists());
}

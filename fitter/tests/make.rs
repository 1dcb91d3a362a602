//! From a recipe to a model: a coarse one, judged where it was fitted to nothing.

use std::path::Path;
use std::process::Command;
use std::sync::OnceLock;
use welkin::output::Target;
use welkin::{Conditions, Model};
use welkin_fitter::make::{Bands, Quality, Request, Scene, judge::judge};
use welkin_fitter::recipe::Recipe;

fn request(bands: Bands) -> Request {
    Request {
        recipe: Recipe::named("continental-clean").unwrap(),
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
    let visibility = Recipe::named("continental-clean")
        .unwrap()
        .visibility()
        .unwrap()
        .round();
    assert_eq!(head.visibilities, [visibility]);
    assert_eq!(head.altitudes, [0.0]);
    let [low, high] = made().model.solar_elevation_range().map(f64::to_degrees);
    assert!((low - 5.0).abs() < 1e-9 && (high - 40.0).abs() < 1e-9);
    assert!(
        head.metadata.contains("Continental clean"),
        "{}",
        head.metadata
    );
    assert!(made().report.contains("against the unbiased tracer"));
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

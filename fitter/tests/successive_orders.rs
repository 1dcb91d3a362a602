//! The noise-free successive-orders solver against the unbiased tracer, and the embedded model against both.
//!
//! The solver runs at a resolution that fits a test; `welkin-fit cross-check` and `welkin-fit assess` do the same at
//! production resolution.

use std::sync::OnceLock;
use welkin::{Conditions, Model};
use welkin_fitter::assess::{Quantiles, errors, table};
use welkin_fitter::atmosphere::json::Case;
use welkin_fitter::atmosphere::{Particles, real_at};
use welkin_fitter::cross_check::cross_check;
use welkin_fitter::dataset::{Sample, VISIBLE, truth};
use welkin_fitter::reference::{sky, successive_orders};
use welkin_fitter::spectrum::training::SUNS;
use welkin_fitter::successive_orders::{
    Gatherer, LightField, Medium, SOLAR_ANGULAR_RADIUS, Settings, solve,
};

const VISIBILITY: f64 = 59_400.0;
const COARSE: Settings = Settings {
    up: 10,
    down: 7,
    azimuths: 8,
    first: 2,
    orders: 5,
    fineness: 4.0,
};

fn solved() -> &'static (Medium, LightField) {
    static SOLVED: OnceLock<(Medium, LightField)> = OnceLock::new();
    SOLVED.get_or_init(|| {
        let air = real_at(VISIBILITY, &VISIBLE.nodes, Particles::HenyeyGreenstein).unwrap();
        let medium = Medium::new(air, SOLAR_ANGULAR_RADIUS).unwrap();
        let light = solve(&medium, COARSE, &|_| ());
        (medium, light)
    })
}

fn samples(altitude: f64, counts: [usize; 2], seed: u64) -> Vec<Sample> {
    let (medium, light) = solved();
    truth(
        &Gatherer::new(medium, light, 1.5),
        light,
        (altitude, SUNS),
        counts,
        seed,
    )
}

#[test]
fn the_unbiased_tracer_confirms_the_data() {
    let air = real_at(VISIBILITY, &VISIBLE.nodes, Particles::HenyeyGreenstein).unwrap();
    let samples: Vec<Sample> = [0.0, 2000.0, 8000.0]
        .into_iter()
        .flat_map(|h| samples(h, [3, 2], h as u64 + 5))
        .filter(|s| s.solar_elevation > (-3f64).to_radians())
        .collect();
    let differences = cross_check(&air, &samples, 0.01, &|| ()).unwrap();
    println!("{}", welkin_fitter::cross_check::table(&differences));
    let n = differences.len() as f64;
    let bias = differences.iter().map(|d| d.relative).sum::<f64>() / n;
    assert!(n > 60.0 && bias.abs() < 0.006, "{bias}");
    for d in &differences {
        assert!(d.relative.abs() < 0.015 + 4.0 * d.standard_error, "{d:?}");
    }
}

/// A defect of 3 % in the data must not pass the reference tracer.
#[test]
fn the_judge_can_say_no() {
    let air = real_at(VISIBILITY, &VISIBLE.nodes, Particles::HenyeyGreenstein).unwrap();
    let mut wrong = samples(2000.0, [3, 2], 11);
    for sample in &mut wrong {
        sample.radiance.iter_mut().for_each(|l| *l *= 1.03);
    }
    let differences = cross_check(&air, &wrong, 0.01, &|| ()).unwrap();
    let bias = differences.iter().map(|d| d.relative).sum::<f64>() / differences.len() as f64;
    assert!(bias > 0.02, "{bias}");
}

#[test]
fn the_embedded_model_follows_the_traced_sky() {
    let model = Model::default_model().unwrap();
    assert_eq!(model.wavelengths(), VISIBLE.wavelengths());
    let mut all = vec![];
    for altitude in [0.0, 120.0, 2000.0] {
        let samples = samples(altitude, [24, 12], 70 + altitude as u64);
        all.extend(errors(&model, VISIBILITY, &samples).unwrap());
    }
    println!("{}", table(&all));
    let of = |day: bool| {
        let chosen = all.iter().filter(|e| (e.solar_elevation > 0.0) == day);
        Quantiles::of(chosen.map(|e| e.relative)).unwrap()
    };
    let (day, twilight) = (of(true), of(false));
    // The truth of this test is itself good to a few tenths of a percent. Its twilight goes down to −12°.
    assert!(
        day.count > 1000 && day.median < 0.006 && day.p99 < 0.04,
        "{day:?}"
    );
    assert!(
        twilight.count > 500 && twilight.median < 0.012 && twilight.p95 < 0.06,
        "{twilight:?}"
    );
}

/// The published model is wrong by 3..10 % between its elevation nodes; here no elevation may stand out. Half a per cent
/// is what a stop of the estimates makes where it passes a level, with the sun at 2°.
#[test]
fn no_solar_elevation_stands_out() {
    let model = Model::default_model().unwrap();
    let direction = [0.6, 0.3, 0.7];
    let values: Vec<f64> = (0..=1880)
        .map(|k| {
            let solar_elevation = (-4.2 + 0.05 * f64::from(k)).to_radians();
            let conditions = Conditions {
                solar_elevation,
                ..Conditions::default()
            };
            let sky = model.sky(&conditions).unwrap();
            f64::from(sky.relative_radiance_at(direction, 550.0).unwrap()).ln()
        })
        .collect();
    for (k, v) in values.windows(3).enumerate() {
        let (before, after) = (v[1] - v[0], v[2] - v[1]);
        let degrees = -4.15 + 0.05 * k as f64;
        assert!(
            (after - before).abs() < 0.006 + 0.05 * before.abs(),
            "kink at {degrees}°: {before} {after}"
        );
    }
}

/// The successive-orders solver before an outside code: I, Q and U of reference case O2 (Rayleigh, ozone and three
/// aerosols, sun at 20°). `welkin-fit validate --successive-orders` runs all cases at production resolution.
#[test]
fn outside_references_confirm_the_data_maker() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/reference/sky_O2.json");
    let case = Case::read(path.as_ref()).unwrap();
    let results = successive_orders::gather(&case, COARSE).unwrap();
    for verdict in sky::judge(&case, &results, sky::Columns::Path).unwrap() {
        println!("{verdict}");
        let (bias, _) = verdict.bias();
        assert!(bias.abs() < 0.0025 && verdict.relative(1.0) < 0.012);
    }
}

/// Narrow peaks of phase functions are beyond the degrees of the light field; what is missing of twice scattered light
/// is added. Without that the first case is up to 12 % off. `welkin-fit validate --successive-orders
/// fitter/tests/reference/forward-peaked` judges all of them at production resolution.
#[test]
fn forward_peaked_aerosols_are_followed() {
    let settings = Settings {
        fineness: 3.0,
        ..Settings::default()
    };
    let folder = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/reference/forward-peaked"
    );
    let case = Case::read(format!("{folder}/sky_W1.json").as_ref()).unwrap();
    let results = successive_orders::gather(&case, settings).unwrap();
    for verdict in sky::judge(&case, &results, sky::Columns::Path).unwrap() {
        println!("{verdict}");
        let (bias, _) = verdict.bias();
        assert!(bias.abs() < 0.002 && verdict.relative(0.95) < 0.03);
    }
}

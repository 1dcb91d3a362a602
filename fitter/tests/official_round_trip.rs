//! From welkin to the official form and back: what is exported says what the model says, and what is imported says what
//! the file says.

use std::path::PathBuf;
use tempfile::TempDir;
use welkin::{Conditions, Model, PolarisationFrame, Response, Stokes};
use welkin_fitter::official::export::{Plan, export};
use welkin_fitter::official::import::{Settings, import, left_out};
use welkin_fitter::official::layout::{Axes, Channels, Node};
use welkin_fitter::official::{Observer, OfficialData, Selection};

fn plan() -> Plan {
    Plan {
        axes: Axes {
            visibilities: vec![40.0, 59.4],
            albedos: vec![0.0, 0.4, 1.0],
            altitudes: vec![0.0, 2000.0],
            elevations: vec![-2.0, 3.0, 12.0, 40.0],
        },
        channels: Channels {
            count: 2,
            start: 440.0,
            width: 80.0,
        },
        polarisation_rank: 5,
        transmittance_altitudes: vec![0.0, 1000.0, 6000.0],
        ..Plan::default()
    }
}

struct Files {
    model: Model,
    data: OfficialData,
    path: PathBuf,
    _folder: TempDir,
}

fn exported(plan: &Plan) -> Files {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("sky.dat");
    let model = Model::default_model().unwrap();
    let report = export(&model, plan, &path).unwrap();
    println!("{report}");
    Files {
        model,
        data: OfficialData::open(&path).unwrap(),
        path,
        _folder: folder,
    }
}

/// Directions all over the sky, from 5° above the horizon.
fn directions() -> Vec<[f64; 3]> {
    let turn = |i: usize| (i as f64 * 2.399_963).sin_cos();
    let direction = |i: usize| {
        let z: f64 = 0.09 + 0.9 * (i as f64 + 0.5) / 60.0;
        let (s, c) = turn(i);
        let across = (1.0 - z * z).sqrt();
        [across * c, across * s, z]
    };
    (0..60).map(direction).collect()
}

fn quantiles(mut errors: Vec<f64>) -> [f64; 2] {
    errors.sort_by(f64::total_cmp);
    [0.5, 0.95].map(|q| errors[(q * (errors.len() - 1) as f64) as usize])
}

fn responses(channels: Channels) -> Vec<Response> {
    let bin = |c: usize| {
        let start = channels.start + c as f64 * channels.width;
        let bin = Response::table(&[start, start + channels.width], &[1.0, 1.0]);
        bin.unwrap().normalised()
    };
    (0..channels.count).map(bin).collect()
}

fn conditions(axes: &Axes, node: Node) -> Conditions {
    Conditions {
        altitude: axes.altitudes[node.altitude],
        visibility: 1e3 * axes.visibilities[node.visibility],
        albedo: axes.albedos[node.albedo],
        solar_elevation: axes.elevations[node.elevation].to_radians(),
        solar_azimuth: 0.0,
    }
}

#[test]
fn an_export_is_the_model_and_an_import_of_it_the_file() {
    let plan = plan();
    let files = exported(&plan);
    export_is_the_model(&plan, &files);
    import_is_the_file(&files);
}

fn export_is_the_model(plan: &Plan, files: &Files) {
    let (data, model) = (&files.data, &files.model);
    assert_eq!(data.notes(), &[]);
    assert_eq!(data.header().axes, plan.axes);
    let bands = model.bands(&responses(plan.channels)).unwrap();
    let (mut light, mut degrees) = (vec![], vec![]);
    for node in data.header().nodes() {
        let conditions = conditions(&plan.axes, node);
        let sky = model.polarised_band_sky(&conditions, &bands).unwrap();
        let (theirs, degree) = (
            data.stored_sky(node).unwrap(),
            data.stored_polarisation(node).unwrap(),
        );
        let mut want = [Stokes::default(); 2];
        for direction in directions() {
            let single = direction.map(|v| v as f32);
            sky.stokes(single, PolarisationFrame::SunAligned, &mut want)
                .unwrap();
            let got = theirs.radiance(direction).unwrap();
            let polarised = degree.degree(direction).unwrap();
            for c in 0..2 {
                light.push((got[c] / f64::from(want[c].i) - 1.0).abs());
                degrees.push((polarised[c] - f64::from(want[c].signed_degree())).abs());
            }
        }
    }
    let [median, p95] = quantiles(light);
    assert!(median < 0.01 && p95 < 0.05, "radiance {median} {p95}");
    let [median, p95] = quantiles(degrees);
    assert!(median < 0.01 && p95 < 0.04, "polarisation {median} {p95}");
    let table = data.transmittance().unwrap();
    let air = model.band_transmittance(59.4e3, &bands).unwrap();
    let mut errors = vec![];
    for (i, h) in [0.0, 1000.0, 6000.0].into_iter().enumerate() {
        for k in 0..40 {
            let elevation = 0.02 + 1.5 * (k as f64 / 39.0);
            let distance = 10f64.powf(3.0 + 2.0 * ((k * 7 + i) % 11) as f64 / 10.0);
            let (sine, cosine) = elevation.sin_cos();
            let to = [cosine * distance, 0.0, h + sine * distance];
            let mut want = [0.0; 2];
            air.transmittance([0.0, 0.0, h], to, &mut want).unwrap();
            let theta = std::f64::consts::FRAC_PI_2 - elevation;
            let got = table.at(h, theta, distance, 59.4e3).unwrap();
            errors.extend(got.iter().zip(want).map(|(g, w)| (g - f64::from(w)).abs()));
        }
    }
    let [median, p95] = quantiles(errors);
    assert!(median < 0.003 && p95 < 0.01, "transmittance {median} {p95}");
}

fn import_is_the_file(files: &Files) {
    let mut settings = Settings::default();
    settings.options.rank = 48;
    settings.options.sweeps = 60;
    settings.refinements = 15;
    settings.polarisation.rank = 24;
    settings.directions = 30;
    let imported = import(&files.data, &settings).unwrap();
    println!("{}", imported.report);
    let model = Model::from_bytes(imported.bytes).unwrap();
    model.verify().unwrap();
    let data = OfficialData::open(&files.path).unwrap();
    let axes = &data.header().axes;
    let (mut light, mut degrees) = (vec![], vec![]);
    for node in data.header().nodes() {
        let sky = model.polarised_sky(&conditions(axes, node)).unwrap();
        let theirs = data.stored_sky(node).unwrap();
        let degree = data.stored_polarisation(node).unwrap();
        let mut got = [Stokes::default(); 2];
        for direction in directions() {
            let single = direction.map(|v| v as f32);
            sky.stokes(single, PolarisationFrame::SunAligned, &mut got)
                .unwrap();
            let want = theirs.radiance(direction).unwrap();
            let polarised = degree.degree(direction).unwrap();
            for c in 0..2 {
                light.push((f64::from(got[c].i) / want[c] - 1.0).abs());
                degrees.push((polarised[c] - f64::from(got[c].signed_degree())).abs());
            }
        }
    }
    let [median, p95] = quantiles(light);
    assert!(median < 0.01 && p95 < 0.04, "radiance {median} {p95}");
    let [median, p95] = quantiles(degrees);
    assert!(median < 0.01 && p95 < 0.04, "polarisation {median} {p95}");
    // The air is the one that was exported.
    let bands = files
        .model
        .bands(&responses(data.header().channels))
        .unwrap();
    let original = files.model.band_transmittance(59.4e3, &bands).unwrap();
    let again = model.transmittance(59.4e3).unwrap();
    let mut through = [[0.0; 2]; 2];
    for (from, to) in [(500.0, 1000.0), (0.0, 3000.0), (3000.0, 500.0)] {
        let (from, to) = ([0.0, 0.0, from], [20e3, 0.0, to]);
        original.transmittance(from, to, &mut through[0]).unwrap();
        again.transmittance(from, to, &mut through[1]).unwrap();
        let pairs = through[0].iter().zip(through[1]);
        for (want, got) in pairs {
            assert!((want - got).abs() < 0.01, "transmittance {want} {got}");
        }
    }
}

/// Of a file with suns between those that are imported: the model follows the sky where the official interpolation cuts
/// corners.
#[test]
fn an_import_holds_between_its_suns() {
    let plan = Plan {
        axes: Axes {
            visibilities: vec![59.4],
            albedos: vec![0.3],
            altitudes: vec![0.0],
            elevations: vec![
                -4.0, -3.0, -2.0, -1.0, 0.5, 3.0, 5.0, 8.0, 12.0, 17.0, 24.0, 32.0, 40.0,
            ],
        },
        polarisation_rank: 0,
        ..plan()
    };
    let files = exported(&plan);
    let again = OfficialData::open(&files.path).unwrap();
    let part = Selection::all(again.header()).every_second_elevation();
    let part = again.select(part).unwrap();
    assert_eq!(part.header().axes.elevations.len(), 7);
    let mut settings = Settings::default();
    settings.options.rank = 96;
    settings.refinements = 15;
    let imported = import(&part, &settings).unwrap();
    let model = Model::from_bytes(imported.bytes).unwrap();
    let found = left_out::compare(&files.data, &part, &model, 100).unwrap();
    println!("{}{}", imported.report, found.report);
    assert!(found.imported.median < 0.5 * found.interpolated.median);
    assert!(found.imported.p95 < found.interpolated.p95);
    // Nothing was left out.
    assert!(left_out::compare(&files.data, &files.data, &model, 100).is_err());
}

/// What the reader raises observers by is taken off again: the tables hold what it will then look up.
#[test]
fn an_export_for_raised_observers_is_the_model_at_their_own_altitude() {
    let plan = Plan {
        axes: Axes {
            visibilities: vec![59.4],
            albedos: vec![0.3],
            altitudes: vec![50.0, 1050.0],
            elevations: vec![20.0],
        },
        transmittance_altitudes: vec![0.0, 1000.0],
        polarisation_rank: 0,
        raised: 50.0,
        ..plan()
    };
    let files = exported(&plan);
    let bands = files.model.bands(&responses(plan.channels)).unwrap();
    for altitude in [0.0, 1000.0] {
        let observer = Observer {
            viewpoint: [0.0, 0.0, altitude],
            raised: 50.0,
            solar_elevation: 20f64.to_radians(),
            solar_azimuth: 0.0,
        };
        let theirs = files.data.sky(&observer, 59.4e3, 0.3).unwrap();
        let conditions = Conditions {
            altitude,
            visibility: 59.4e3,
            albedo: 0.3,
            solar_elevation: 20f64.to_radians(),
            solar_azimuth: 0.0,
        };
        let sky = files.model.band_sky(&conditions, &bands).unwrap();
        let mut errors = vec![];
        for elevation in [0.3f64, 0.6, 1.0, 2.0, 5.0, 20.0] {
            let (sine, cosine) = elevation.to_radians().sin_cos();
            let direction = [0.0, cosine, sine];
            let mut want = [0.0; 2];
            sky.radiance(direction.map(|v| v as f32), &mut want)
                .unwrap();
            let got = theirs.radiance(direction).unwrap();
            errors.extend(
                got.iter()
                    .zip(want)
                    .map(|(g, w)| (g / f64::from(w) - 1.0).abs()),
            );
        }
        let [median, p95] = quantiles(errors);
        assert!(median < 0.02 && p95 < 0.06, "{altitude} m: {median} {p95}");
    }
}

#[test]
fn nothing_stays_of_an_export_that_fails() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("sky.dat");
    std::fs::write(&path, "what was there").unwrap();
    let model = Model::default_model().unwrap();
    let fog = Plan {
        axes: Axes {
            visibilities: vec![1.0],
            ..plan().axes
        },
        ..plan()
    };
    assert!(export(&model, &fog, &path).is_err());
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "what was there");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

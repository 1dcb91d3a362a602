//! Any bytes as the table of `welkin query`: one line of error, or as many rows as there were.
#![no_main]

#[path = "../../src/bin/welkin/albedo.rs"]
#[allow(dead_code)]
mod albedo;
#[path = "../../src/bin/welkin/cells.rs"]
#[allow(dead_code)]
mod cells;
#[path = "../../src/bin/welkin/failure.rs"]
#[allow(dead_code)]
mod failure;
#[path = "../../src/bin/welkin/parameter.rs"]
#[allow(dead_code)]
mod parameter;
#[path = "../../src/bin/welkin/query/mod.rs"]
#[allow(dead_code)]
mod query;
#[path = "../../src/bin/welkin/sensor.rs"]
#[allow(dead_code)]
mod sensor;

use std::path::PathBuf;
use std::sync::OnceLock;

use libfuzzer_sys::fuzz_target;
use query::shared::Shared;
use sensor::Sensor;
use welkin::{Model, Response};

/// What the command's own `Source` is to `query`.
#[derive(clap::Args)]
struct Source {
    #[arg(long)]
    model: Option<PathBuf>,
}

impl Source {
    fn open(&self) -> failure::Result<Model> {
        Err(failure::Failure::message(format!("{:?}", self.model)))
    }
}

static THREADS: OnceLock<rayon::ThreadPool> = OnceLock::new();

static MODEL: OnceLock<(Model, Sensor)> = OnceLock::new();

fuzz_target!(|table: &[u8]| {
    let (model, sensor) = MODEL.get_or_init(|| {
        let file = include_bytes!("../../format-spec/conformance/files/raw.welkin");
        let model = Model::from_static(file).expect("a valid model");
        let [first, last] = model.wavelength_range().expect("a range");
        let lines = [first, 0.3 * first + 0.7 * last].map(Response::wavelength);
        let sensor = Sensor {
            names: vec!["first".to_owned(), "second".to_owned()],
            bands: model.bands(&lines).expect("within the range"),
            wavelengths: None,
        };
        (model, sensor)
    });
    let threads = THREADS.get_or_init(|| {
        let one = rayon::ThreadPoolBuilder::new().num_threads(1);
        one.build().expect("a thread")
    });
    for (clamp, sensor) in [(false, None), (true, None), (false, Some(sensor))] {
        let mut answers = Vec::new();
        let shared = Shared::new(model, clamp, sensor.map(|s| s.bands.clone()));
        if let Ok(summary) = query::answer(&shared, sensor, threads, table, &mut answers) {
            assert!(summary.failures <= summary.rows);
            let mut reader = csv::Reader::from_reader(answers.as_slice());
            let read = reader.byte_records().filter(|row| row.is_ok()).count();
            assert_eq!(read as u64, summary.rows);
        }
    }
});

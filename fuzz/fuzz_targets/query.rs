//! Any bytes as the table of `welkin query`: one line of error, or as many rows as there were.
#![no_main]

#[path = "../../src/bin/welkin/failure.rs"]
#[allow(dead_code)]
mod failure;
#[path = "../../src/bin/welkin/query/mod.rs"]
#[allow(dead_code)]
mod query;

use std::path::PathBuf;
use std::sync::OnceLock;

use libfuzzer_sys::fuzz_target;
use welkin::Model;

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

static MODEL: OnceLock<Model> = OnceLock::new();

fuzz_target!(|table: &[u8]| {
    let model = MODEL.get_or_init(|| {
        let file = include_bytes!("../../format-spec/conformance/files/raw.welkin");
        Model::from_static(file).expect("a valid model")
    });
    let threads = THREADS.get_or_init(|| {
        let one = rayon::ThreadPoolBuilder::new().num_threads(1);
        one.build().expect("a thread")
    });
    for clamp in [false, true] {
        let mut answers = Vec::new();
        if let Ok(summary) = query::answer(model, clamp, threads, table, &mut answers) {
            assert!(summary.failures <= summary.rows);
            let mut reader = csv::Reader::from_reader(answers.as_slice());
            let read = reader.byte_records().filter(|row| row.is_ok()).count();
            assert_eq!(read as u64, summary.rows);
        }
    }
});

//! All readers about the same file: they accept and refuse the same, for the same reasons, and give the same values.
//!
//! The input is a list of choices: a file of the conformance suite, changes of its parts, and questions. Lengths and
//! checksums are made right, so that what is behind them is reached.
#![no_main]

#[path = "../../../tests/common/answer.rs"]
mod answer;
mod bytes;
mod compare;
mod mutation;
mod parts;
mod question;
mod readers;
mod spectrum;
mod sunlight;

use std::path::Path;
use std::sync::{Mutex, OnceLock};

use bytes::Bytes;
use compare::{Case, disagreement};
use libfuzzer_sys::fuzz_target;
use parts::Parts;
use question::{Ranges, questions};
use readers::{Python, Report};
use welkin::Model;
use welkin::format::Kind;
// What the build script compiles is linked to the library of this package.
use welkin_fuzz as _;

/// One in so many inputs is asked of the Python reader, which is slow; the first of a run, too.
const PYTHON_EVERY: u64 = 16;

struct Fixture {
    bases: Vec<(String, Parts)>,
    /// The Python reader, and how many inputs there were.
    python: Mutex<(Python, u64)>,
}

fn fixture() -> &'static Fixture {
    static FIXTURE: OnceLock<Fixture> = OnceLock::new();
    FIXTURE.get_or_init(|| Fixture {
        bases: bases(),
        python: Mutex::new((Python::start(), 0)),
    })
}

/// The files of the conformance suite that readers accept, in order.
fn bases() -> Vec<(String, Parts)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../format-spec/conformance/files");
    let mut paths: Vec<_> = std::fs::read_dir(folder)
        .expect("the conformance suite")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    let names = paths
        .iter()
        .map(|path| path.file_stem().unwrap_or_default().to_string_lossy());
    let valid = paths
        .iter()
        .zip(names)
        .filter(|(_, name)| !name.starts_with("x-"));
    let read = |path: &Path| Parts::of(&std::fs::read(path).expect("a file"));
    valid
        .map(|(path, name)| (name.into_owned(), read(path)))
        .collect()
}

fuzz_target!(|data: &[u8]| {
    let fixture = fixture();
    let mut bytes = Bytes::new(data);
    let (name, parts) = &fixture.bases[bytes.below(fixture.bases.len())];
    let (file, changes) = mutation::mutated(&mut bytes, parts);
    let model = Model::from_bytes(file.as_slice());
    let ranges = Ranges::of(model.as_ref().ok());
    let questions = questions(&mut bytes, &ranges);
    let library = readers::library(&model, &questions);
    let case = Case {
        base: name,
        questions: &questions,
        ranges,
        changes: &changes,
        early: spectrum_damage(&model).or_else(|| estimate_damage(&model, &file)),
    };
    let check = |reader: &str, report: Report| {
        if let Some(wrong) = disagreement(&case, &library, &report) {
            complain(&format!("{reader}: {name}, {:?}: {wrong}", changes.told));
        }
    };
    check("C", readers::c(&file, &questions));
    // Who streams does not know how long the file is.
    if !library.as_ref().is_err_and(|class| class == "length") {
        let streamed = Model::stream(file.clone());
        check("stream", readers::library(&streamed, &questions));
    }
    check_general(&check, &library, readers::general(&file, &questions));
    check_verifier(&file, &model, &library);
    let mut python = fixture.python.lock().expect("no panic before");
    let (python, inputs) = &mut *python;
    if inputs.is_multiple_of(PYTHON_EVERY) {
        check("Python", python.ask(&file, &questions));
    }
    *inputs += 1;
});

/// The class of what is wrong with the spectrum of a file that can be opened.
fn spectrum_damage(model: &Result<Model, welkin::Error>) -> Option<&'static str> {
    let range = model.as_ref().ok()?.wavelength_range();
    range.err().map(|error| error.class())
}

/// The same of the estimates.
fn estimate_damage(model: &Result<Model, welkin::Error>, file: &[u8]) -> Option<&'static str> {
    let mut directory = model.as_ref().ok()?.directory().iter();
    let place = directory.position(|entry| entry.kind == Kind::Estimate)?;
    let problems = welkin::format::verify(file);
    let found = problems.iter().find(|problem| problem.chunk == Some(place));
    found.map(|problem| problem.error.class())
}

/// Ends the run; with DIFFERENTIAL_LIST in the environment it goes on, to list what there is.
fn complain(complaint: &str) {
    match std::env::var_os("DIFFERENTIAL_LIST") {
        None => panic!("{complaint}"),
        Some(_) => eprintln!("{complaint}"),
    }
}

/// A point query does not look at checksums and numbers of chunks: where others refuse them it may say
/// anything.
fn check_general(check: &dyn Fn(&str, Report), library: &Report, mut general: Report) {
    if let (Ok(library), Ok(general)) = (library, &mut general) {
        for (expected, got) in library.iter().zip(general) {
            let unchecked = |class: &String| ["checksum", "value"].contains(&class.as_str());
            if expected.as_ref().is_err_and(unchecked) {
                *got = Err(readers::ABSTAINS.to_owned());
            }
        }
    }
    check("general", general);
}

/// A verifier finds what a reader finds, and where it finds nothing, a reader does not either.
fn check_verifier(file: &[u8], model: &Result<Model, welkin::Error>, library: &Report) {
    let problems = welkin::format::verify(file);
    match model {
        Err(error) => assert_eq!(problems[0].error.class(), error.class()),
        Ok(model) if problems.is_empty() => {
            model.verify().expect("no problem");
            let answers = library
                .iter()
                .flatten()
                .filter_map(|answer| answer.as_ref().err());
            let found = |class: &&String| ["checksum", "encoding"].contains(&class.as_str());
            assert_eq!(answers.filter(found).next(), None);
        }
        Ok(_) => {}
    }
}

//! Models that are read in pieces: the same skies from the head and the chunks of the scene, and nothing else.

mod common;
#[path = "../tools/src/http_file.rs"]
mod http_file;

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use common::server::Server;
use http_file::HttpFile;
use welkin::format::{Entry, Kind};
use welkin::{Conditions, Error, Model, ReadAt};

/// What a model says about a scene, as bits.
fn answers(model: &Model, conditions: &Conditions) -> Vec<u32> {
    let sky = model.sky(conditions).unwrap();
    let mut out = vec![0.0; sky.wavelengths().len()];
    sky.radiance([0.3, 0.2, 0.1], &mut out).unwrap();
    out.into_iter().map(f32::to_bits).collect()
}

fn at(altitude: f64, visibility: f64) -> Conditions {
    Conditions {
        altitude,
        visibility,
        ..Conditions::default()
    }
}

#[test]
fn a_server_gives_the_same_skies_as_memory() {
    let bytes = common::model_bytes();
    let whole = Model::from_bytes(bytes.clone()).unwrap();
    let server = Server::start(bytes);
    let file = HttpFile::new(server.url(), Duration::from_secs(60));
    let streamed = Model::stream(file).unwrap();
    for conditions in [at(0.0, 20e3), at(500.0, 50e3), at(500.0, 50e3)] {
        assert_eq!(
            answers(&streamed, &conditions),
            answers(&whole, &conditions)
        );
    }
    let traffic = streamed.traffic();
    assert_eq!(traffic.requests, server.requests.load(Ordering::Relaxed));
    assert_eq!(traffic.bytes, server.bytes.load(Ordering::Relaxed));
}

/// A model that is longer than the first request, with room for its scenes to be told apart.
fn long_model() -> Vec<u8> {
    let altitudes: Vec<f64> = (0..24).map(|i| 100.0 * f64::from(i)).collect();
    let head = common::head_with(&altitudes, &[20e3, 40e3, 60e3, 80e3, 130e3], 20);
    welkin::format::encode(&head, &common::chunks(&head)).unwrap()
}

#[test]
fn scenes_cost_their_chunks_and_repeated_scenes_nothing() {
    let bytes = long_model();
    let model = Model::stream(bytes.clone()).unwrap();
    let opening = model.traffic();
    let head = model.head_bytes();
    assert_eq!(opening.requests, if head > 48 << 10 { 2 } else { 1 });
    assert_eq!(opening.bytes as usize, head.max(48 << 10));
    // The basis that all scenes share came with the head.
    answers(&model, &at(0.0, 20e3));
    let mut before = model.traffic();
    assert_eq!(before.requests, opening.requests);
    // Nodes far behind the first request: the column, the radiance, and at most what stands between them.
    for (altitude, requests) in [(2000.0, 2), (2200.0, 2), (2200.0, 0)] {
        let touched = model.touched_bytes();
        answers(&model, &at(altitude, 60e3));
        let after = model.traffic();
        assert_eq!(after.requests - before.requests, requests);
        let needed = (model.touched_bytes() - touched) as u64;
        assert_eq!(after.bytes - before.bytes, needed);
        before = after;
    }
    // Between nodes four altitudes are needed, each a row of neighbours in the file.
    answers(&model, &at(1500.0, 50e3));
    let after = model.traffic();
    assert!(after.requests - before.requests <= 8);
    assert!(after.bytes < bytes.len() as u64 / 2);
}

#[test]
fn another_visibility_or_altitude_costs_its_new_chunks_only() {
    let model = Model::stream(long_model()).unwrap();
    let length = |kind: Kind, altitude: usize, visibility: Option<usize>| {
        let mut entries = model.directory().iter();
        let place = (kind, Some(altitude), visibility);
        let entry = entries.find(|e| (e.kind, e.altitude, e.visibility) == place);
        entry.unwrap().length as u64
    };
    let radiance = |altitude, visibility| length(Kind::Radiance, altitude, Some(visibility));
    let column = |altitude| length(Kind::Column, altitude, None);
    let cost = |conditions: &Conditions| {
        let before = model.traffic();
        answers(&model, conditions);
        let after = model.traffic();
        (after.requests - before.requests, after.bytes - before.bytes)
    };
    assert_eq!(
        cost(&at(2000.0, 60e3)),
        (2, column(20) + radiance(20, 2)),
        "one altitude, one visibility"
    );
    assert_eq!(cost(&at(2000.0, 80e3)), (1, radiance(20, 3)));
    let outer = radiance(20, 1) + radiance(20, 4);
    assert_eq!(cost(&at(2000.0, 70e3)), (2, outer), "between them");
    assert_eq!(cost(&at(2100.0, 60e3)), (2, column(21) + radiance(21, 2)));
    let outer = column(19) + radiance(19, 2) + column(22) + radiance(22, 2);
    assert_eq!(cost(&at(2050.0, 60e3)), (4, outer));
    assert_eq!(cost(&at(2050.0, 60e3)), (0, 0));
}

#[test]
fn aerial_perspective_costs_the_air_and_the_sources_of_its_visibilities() {
    let altitudes: Vec<f64> = (0..9).map(|i| 100.0 * f64::from(i)).collect();
    let head = common::head_with(&altitudes, &[20e3, 40e3, 60e3, 80e3, 130e3], 20);
    let mut chunks = common::chunks(&head);
    chunks.extend(common::aerial::chunks(&head, 0.2));
    let bytes = welkin::format::encode(&head, &chunks).unwrap();
    let model = Model::stream(bytes).unwrap();
    let opening = model.traffic();
    model.aerial_perspective(&at(0.0, 60e3)).unwrap();
    let after = model.traffic();
    // Air and basis are neighbours, the third source stands behind two others.
    assert_eq!(after.requests - opening.requests, 2);
    let needed = |e: &&Entry| match e.kind {
        Kind::Transmittance | Kind::SourceBasis => true,
        Kind::Source => e.visibility == Some(2),
        _ => false,
    };
    let lengths = model
        .directory()
        .iter()
        .filter(needed)
        .map(|e| e.length as u64);
    let needed: u64 = lengths.sum();
    let got = after.bytes - opening.bytes;
    assert!((needed..needed + 64).contains(&got), "{got} for {needed}");
}

#[test]
fn a_file_on_disk_can_be_streamed() {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), common::model_bytes()).unwrap();
    let model = Model::stream(std::fs::File::open(file.path()).unwrap()).unwrap();
    let whole = Model::open(file.path()).unwrap();
    assert_eq!(
        answers(&model, &at(70.0, 33e3)),
        answers(&whole, &at(70.0, 33e3))
    );
    assert_eq!(whole.traffic().requests, 0);
    model.verify().unwrap();
}

#[test]
fn threads_may_fetch_the_same_chunk() {
    let model = Model::stream(common::model_bytes()).unwrap();
    let expected = answers(&model, &at(0.0, 20e3));
    let other = Model::stream(common::model_bytes()).unwrap();
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| assert_eq!(answers(&other, &at(0.0, 20e3)), expected));
        }
    });
}

/// Fails after some requests, or ends early.
struct Faulty {
    bytes: Vec<u8>,
    requests: AtomicUsize,
    allowed: usize,
}

impl ReadAt for Faulty {
    fn read_at(&self, offset: u64, buffer: &mut [u8]) -> io::Result<usize> {
        if self.requests.fetch_add(1, Ordering::Relaxed) >= self.allowed {
            return Err(io::Error::other("the line is dead"));
        }
        self.bytes.read_at(offset, buffer)
    }
}

#[test]
fn a_source_that_fails_or_ends_early_is_an_error_and_can_recover() {
    let source = |bytes: &[u8], allowed| {
        Arc::new(Faulty {
            bytes: bytes.to_vec(),
            requests: AtomicUsize::new(0),
            allowed,
        })
    };
    let bytes = long_model();
    assert!(matches!(
        Model::stream(source(&bytes, 0)),
        Err(Error::Read { offset: 0, .. })
    ));
    let faulty = source(&bytes, 2);
    let model = Model::stream(faulty.clone()).unwrap();
    let conditions = at(2300.0, 130e3);
    faulty.requests.store(2, Ordering::Relaxed);
    assert!(matches!(model.sky(&conditions), Err(Error::Read { .. })));
    faulty.requests.store(0, Ordering::Relaxed);
    assert!(model.sky(&conditions).is_ok());
    for length in (0..bytes.len()).step_by(997) {
        let outcome = Model::stream(bytes[..length].to_vec()).and_then(|m| m.sky(&conditions));
        match outcome {
            Err(Error::Length { .. } | Error::NotWelkin) => {}
            Ok(_) => panic!("{length} bytes are enough"),
            Err(other) => panic!("{length} bytes: {other}"),
        }
    }
}

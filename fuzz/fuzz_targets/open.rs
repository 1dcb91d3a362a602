//! Any bytes: an error or a model whose skies are finite.
#![no_main]

use libfuzzer_sys::fuzz_target;
use welkin::Model;
use welkin_fuzz::{forged, interrogate};

fuzz_target!(|data: &[u8]| {
    let _ = Model::from_bytes(data);
    if let Ok(model) = Model::from_bytes(forged(data)) {
        interrogate(&model);
    }
});

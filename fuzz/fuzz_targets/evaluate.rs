//! Any conditions and directions against the default model: an error or a finite, non-negative radiance.
#![no_main]

use libfuzzer_sys::fuzz_target;
use std::sync::OnceLock;
use welkin::{Conditions, Model};

static MODEL: OnceLock<Model> = OnceLock::new();

fuzz_target!(|input: ([f64; 5], [f32; 3], f64)| {
    let ([solar_elevation, solar_azimuth, visibility, albedo, altitude], direction, wavelength) = input;
    let model = MODEL.get_or_init(|| {
        Model::from_static(include_bytes!("../../models/default.welkin")).expect("a valid model")
    });
    let conditions = Conditions { solar_elevation, solar_azimuth, visibility, albedo, altitude };
    let conditions = conditions.clamped(model).unwrap_or_default();
    let sky = model.sky(&conditions).expect("clamped conditions");
    if let Ok(l) = sky.radiance_at(direction, wavelength) {
        assert!(l.is_finite() && l >= 0.0);
    }
    if let Ok(xyz) = sky.xyz(direction) {
        assert!(xyz.iter().all(|v| v.is_finite()));
    }
});

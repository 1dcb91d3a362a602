//! Any conditions, directions and points against the default model: errors, or finite numbers in their ranges.
#![no_main]

use libfuzzer_sys::fuzz_target;
use std::sync::OnceLock;
use welkin::{Conditions, Model};
use welkin_fuzz::{look_polarised, scatter};

static MODEL: OnceLock<Model> = OnceLock::new();

type Scene = ([f64; 5], [f32; 3], f64, [[f64; 3]; 2]);

fuzz_target!(|input: Scene| {
    let ([solar_elevation, solar_azimuth, visibility, albedo, altitude], direction, wavelength, points) = input;
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
    look_polarised(&model.polarised_sky(&conditions).expect("a polarised model"), direction);
    scatter(&model.haze(&conditions).expect("a model with haze"), points[0], points[1]);
});

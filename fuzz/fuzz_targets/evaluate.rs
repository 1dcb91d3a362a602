//! Any conditions, directions and points against the default model: errors, or finite numbers in their ranges.
#![no_main]

use libfuzzer_sys::fuzz_target;
use std::sync::OnceLock;
use welkin::{AerialPerspective, Conditions, Model, PolarisedSky};
use welkin_fuzz::{look_polarised, scatter};

/// What takes long to prepare, for a few scenes.
struct Prepared {
    model: Model,
    scenes: Vec<(AerialPerspective, PolarisedSky)>,
}

impl Prepared {
    fn new() -> Self {
        let file = include_bytes!("../../models/default.welkin");
        let model = Model::from_static(file).expect("a valid model");
        let scenes = [(-0.03, 30e3), (0.4, 80e3)];
        let scenes = scenes.map(|(solar_elevation, visibility)| {
            let conditions = Conditions {
                solar_elevation,
                visibility,
                altitude: 1500.0,
                ..Conditions::default()
            };
            let aerial = model
                .aerial_perspective(&conditions)
                .expect("a model with aerial perspective");
            let sky = model.polarised_sky(&conditions).expect("a polarised model");
            (aerial, sky)
        });
        Self {
            model,
            scenes: scenes.into(),
        }
    }
}

static PREPARED: OnceLock<Prepared> = OnceLock::new();

type Scene = ([f64; 5], [f32; 3], f64, [[i32; 3]; 2]);

fuzz_target!(|input: Scene| {
    let (
        [solar_elevation, solar_azimuth, visibility, albedo, altitude],
        direction,
        wavelength,
        points,
    ) = input;
    let prepared = PREPARED.get_or_init(Prepared::new);
    let conditions = Conditions {
        solar_elevation,
        solar_azimuth,
        visibility,
        albedo,
        altitude,
    };
    let conditions = conditions.clamped(&prepared.model).unwrap_or_default();
    let sky = prepared.model.sky(&conditions).expect("clamped conditions");
    if let Ok(l) = sky.radiance_at(direction, wavelength) {
        assert!(l.is_finite() && l >= 0.0);
    }
    if let Ok(xyz) = sky.xyz(direction) {
        assert!(xyz.iter().all(|v| v.is_finite()));
    }
    // Metres: far too far for some.
    let [from, to] = points.map(|point| point.map(f64::from));
    for (aerial, sky) in &prepared.scenes {
        scatter(aerial, from, to);
        look_polarised(sky, direction);
    }
});

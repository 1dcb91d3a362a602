//! What a model costs: bytes of its file, and time.

use super::ALBEDO;
use anyhow::Result;
use std::fmt;
use std::time::Instant;
use welkin::{Conditions, Model};

/// Directions that are timed, and how often.
const DIRECTIONS: usize = 512;
const REPEATS: usize = 20;

/// Bytes and nanoseconds.
#[derive(Clone, Copy, Debug)]
pub struct Cost {
    /// Of the file.
    pub bytes: u64,
    /// Fields of the file.
    pub fields: usize,
    /// For all wavelengths in a direction of a prepared sky, the fastest of some runs.
    pub nanoseconds: f64,
}

impl Cost {
    /// Measures it.
    pub fn of(model: &Model) -> Result<Self> {
        let sky = model.sky(&Conditions {
            solar_elevation: 0.5,
            visibility: model.head().visibilities[0],
            albedo: ALBEDO,
            altitude: model.head().altitudes[0],
            ..Conditions::default()
        })?;
        let mut light = vec![0.0; model.wavelengths().len()];
        let mut fastest = f64::INFINITY;
        for _ in 0..REPEATS {
            let started = Instant::now();
            for i in 0..DIRECTIONS {
                // A spiral over the upper half of the sphere.
                let (z, turn) = ((i as f32 + 0.5) / DIRECTIONS as f32, 2.4 * i as f32);
                let r = (1.0 - z * z).sqrt();
                sky.relative_radiance([r * turn.cos(), r * turn.sin(), z], &mut light)?;
                std::hint::black_box(&light);
            }
            let each = started.elapsed().as_nanos() as f64 / DIRECTIONS as f64;
            fastest = fastest.min(each);
        }
        Ok(Self {
            bytes: model.file_bytes() as u64,
            fields: model.head().fields.len(),
            nanoseconds: fastest,
        })
    }
}

impl fmt::Display for Cost {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self {
            bytes,
            fields,
            nanoseconds,
        } = self;
        write!(
            f,
            "{bytes} bytes, {fields} fields, {nanoseconds:.0} ns per direction"
        )
    }
}

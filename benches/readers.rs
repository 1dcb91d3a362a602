//! The C reader next to this library: all wavelengths of one direction in a prepared sky of the default model.
//!
//! `cargo bench --bench readers` compiles the C reader with gcc. Times are the least of some rounds, in turns.

use std::hint::black_box;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use welkin::{BakedSky, Conditions, Model, Result};

const ROUNDS: usize = 3;
const DIRECTIONS: usize = 4096;
/// What the lines of `bench.c` start with.
const MODES: [&str; 2] = ["radiance,", "radiance "];

fn main() -> Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = tempfile::tempdir().expect("a temporary folder");
    let program = folder.path().join("bench");
    if !compile(&root.join("format-spec/readers/c/bench.c"), &program) {
        println!("the C reader does not compile here");
        return Ok(());
    }
    let model = Model::default_model()?;
    let sky = model.sky(&conditions(&model))?;
    let baked = sky.bake(BakedSky::TOLERANCE)?;
    let directions: Vec<[f32; 3]> = (0..DIRECTIONS).map(sphere).collect();
    let mut out = vec![0.0; sky.wavelengths().len()];
    let mut least = [f64::INFINITY; 4];
    for _ in 0..ROUNDS {
        let c = c_times(&program, &root.join("models/default.welkin"));
        let prepared = time(&directions, |d| sky.radiance(d, &mut out))?;
        let table = time(&directions, |d| baked.radiance(d, &mut out))?;
        for (least, new) in least.iter_mut().zip([c[0], c[1], prepared, table]) {
            *least = least.min(new);
        }
    }
    let names = ["C, dense", "C", "library, Sky", "library, BakedSky"];
    for (name, ns) in names.into_iter().zip(least) {
        println!(
            "{name:20} {ns:8.0} ns  {:6.2} of the library's Sky",
            ns / least[2]
        );
    }
    Ok(())
}

fn compile(source: &Path, program: &Path) -> bool {
    let flags = [
        "-std=c99",
        "-O3",
        "-march=native",
        "-fno-math-errno",
        "-fno-trapping-math",
        "-o",
    ];
    let status = Command::new("gcc")
        .args(flags)
        .args([program, source])
        .arg("-lm")
        .status();
    status.is_ok_and(|status| status.success())
}

/// Nanoseconds per direction in each of [`MODES`].
fn c_times(program: &Path, model: &Path) -> [f64; 2] {
    let output = Command::new(program)
        .arg(model)
        .output()
        .expect("the C bench runs");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    MODES.map(|mode| {
        let line = text.lines().find(|line| line.starts_with(mode));
        let words: Vec<&str> = line.unwrap_or_default().split_whitespace().collect();
        let ns = words
            .iter()
            .position(|word| *word == "ns")
            .and_then(|i| words[i - 1].parse().ok());
        ns.expect("nanoseconds")
    })
}

/// Those of the C bench.
fn conditions(model: &Model) -> Conditions {
    let head = model.head();
    Conditions {
        altitude: 0.3 * head.altitudes[0] + 0.7 * head.altitudes[1],
        visibility: 0.5 * (head.visibilities[0] + head.visibilities[1]),
        albedo: 0.2,
        solar_elevation: 30f64.to_radians(),
        solar_azimuth: 1.0,
    }
}

/// Nanoseconds per direction in the shortest of many passes. A pass is short against the time slices of the system: the
/// C bench counts time of the processor, which an interrupted pass would not be.
fn time(directions: &[[f32; 3]], mut ask: impl FnMut([f32; 3]) -> Result<()>) -> Result<f64> {
    const PASSES: usize = 100;
    let mut least = f64::INFINITY;
    for _ in 0..PASSES {
        let start = Instant::now();
        for &direction in directions {
            ask(black_box(direction))?;
        }
        least = least.min(start.elapsed().as_nanos() as f64);
    }
    Ok(least / directions.len() as f64)
}

/// Spread over the sphere, in no order.
fn sphere(i: usize) -> [f32; 3] {
    let step = |ratio: f64| ((i + 1) as f64 * ratio).fract();
    let z = 2.0 * step(0.754_877_67) - 1.0;
    let (sine, cosine) = (std::f64::consts::TAU * step(0.569_840_29)).sin_cos();
    let level = (1.0 - z * z).sqrt();
    [level * cosine, level * sine, z].map(|v| v as f32)
}

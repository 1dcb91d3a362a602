//! Speed against accuracy against bytes for every setting of a baked sky: `cargo run --release --example chart` writes
//! `docs/settings.csv` and `docs/settings.svg`.
//!
//! Errors are 95th percentiles against [`welkin::Sky`] over a few skies; times are the least of many repetitions.

use std::fmt::Write as _;
use std::hint::black_box;
use std::time::Instant;

use welkin::{BakedSky, Conditions, Directions, Model, Result, Sky};

const TOLERANCES: [f64; 6] = [0.02, 0.005, 0.0025, 0.0018, 0.0012, 0.0008];
const QUERIES: usize = 1024;

/// One point of the chart.
struct Point {
    channels: &'static str,
    tolerance: f64,
    p95: f64,
    bytes: usize,
    ns: f64,
}

fn main() -> Result<()> {
    let model = Model::default_model()?;
    let skies = skies(&model)?;
    let mut points = Vec::new();
    for tolerance in TOLERANCES {
        points.extend(spectral(&skies, tolerance));
        points.extend(colour(&skies, tolerance));
    }
    points.push(exact(&skies[0]));
    let mut csv = String::from("channels,tolerance,p95_error,bytes,ns\n");
    for p in &points {
        let _ = writeln!(
            csv,
            "{},{},{:.6},{},{:.1}",
            p.channels, p.tolerance, p.p95, p.bytes, p.ns
        );
    }
    print!("{csv}");
    let write = |path: &str, text: &str| welkin::format::replace_file(path, text.as_bytes());
    write("docs/settings.csv", &csv)?;
    write("docs/settings.svg", &svg(&points))
}

/// Noon, low sun and twilight, near the ground and high up.
fn skies(model: &Model) -> Result<Vec<Sky>> {
    let places = [(50.0f64, 30.0), (8.0, 0.0), (-2.0, 700.0), (20.0, 1300.0)];
    let sky = |(elevation, altitude): (f64, f64)| {
        model.sky(&Conditions {
            solar_elevation: elevation.to_radians(),
            altitude,
            ..Conditions::default()
        })
    };
    places.into_iter().map(sky).collect()
}

fn spectral(skies: &[Sky], tolerance: f64) -> Option<Point> {
    let baked: Vec<_> = skies
        .iter()
        .map(|sky| sky.bake(tolerance))
        .collect::<Result<_>>()
        .ok()?;
    let mut out = vec![0.0; QUERIES * baked[0].wavelengths().len()];
    Some(Point {
        channels: "spectral",
        tolerance,
        p95: baked.iter().map(|b| b.bake_error().p95).fold(0.0, f64::max),
        bytes: baked.iter().map(BakedSky::bytes).max()?,
        ns: fastest(|d| baked[0].radiance_batch(d, &mut out)),
    })
}

fn colour(skies: &[Sky], tolerance: f64) -> Option<Point> {
    let baked: Vec<_> = skies
        .iter()
        .map(|sky| sky.bake_colour(tolerance))
        .collect::<Result<_>>()
        .ok()?;
    let mut out = vec![[0.0; 3]; QUERIES];
    Some(Point {
        channels: "RGB",
        tolerance,
        p95: baked.iter().map(|b| b.bake_error().p95).fold(0.0, f64::max),
        bytes: baked.iter().map(|b| b.bytes()).max()?,
        ns: fastest(|d| baked[0].linear_srgb_batch(d, &mut out)),
    })
}

/// The sky that is not baked.
fn exact(sky: &Sky) -> Point {
    let mut out = vec![0.0; QUERIES * sky.wavelengths().len()];
    Point {
        channels: "not baked",
        tolerance: 0.0,
        p95: 0.0,
        bytes: sky.bytes(),
        ns: fastest(|d| {
            let all: Vec<_> = (0..QUERIES).map(|i| [d.x[i], d.y[i], d.z[i]]).collect();
            sky.radiance_batch(&all, &mut out)
        }),
    }
}

/// Least time per direction, ns.
fn fastest(mut ask: impl FnMut(&Directions) -> Result<()>) -> f64 {
    let golden = |i: usize| (i as f32 * 0.618_034).fract();
    let z: Vec<f32> = (0..QUERIES).map(|i| 1.0 - 2.0 * golden(i)).collect();
    let around = |f: fn(f32) -> f32| -> Vec<f32> {
        let point = |i: usize| (1.0 - z[i] * z[i]).sqrt() * f(2.399_963 * i as f32);
        (0..QUERIES).map(point).collect()
    };
    let (x, y) = (around(f32::cos), around(f32::sin));
    let directions = Directions {
        x: &x,
        y: &y,
        z: &z,
    };
    let once = |_| {
        let start = Instant::now();
        ask(black_box(&directions)).expect("directions");
        start.elapsed().as_secs_f64()
    };
    (0..200).map(once).fold(f64::INFINITY, f64::min) * 1e9 / QUERIES as f64
}

/// Time over error, both logarithmic; the area of a mark is its bytes.
fn svg(points: &[Point]) -> String {
    let mut out = String::from(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 640 400" font-family="sans-serif" font-size="12">
<rect width="640" height="400" fill="#fff"/>
<text x="320" y="390" text-anchor="middle">error that baking adds, p95 (%)</text>
<text x="16" y="190" text-anchor="middle" transform="rotate(-90 16 190)">time per direction (ns)</text>
"##,
    );
    let x = |error: f64| 70.0 + 500.0 * ((100.0 * error).log10() + 1.5) / 2.0;
    let y = |ns: f64| 350.0 - 310.0 * (ns.log10() - 1.0) / 0.7;
    for percent in [0.05, 0.1, 0.2, 0.5, 1.0, 2.0] {
        let x = x(percent / 100.0);
        let _ = writeln!(
            out,
            r##"<path d="M{x:.1} 40V350" stroke="#ddd"/><text x="{x:.1}" y="366" text-anchor="middle">{percent}</text>"##
        );
    }
    for ns in [10.0, 15.0, 20.0, 30.0, 40.0] {
        let y = y(ns);
        let _ = writeln!(
            out,
            r##"<path d="M70 {y:.1}H590" stroke="#ddd"/><text x="64" y="{:.1}" text-anchor="end">{ns}</text>"##,
            y + 4.0
        );
    }
    for p in points.iter().filter(|p| p.p95 > 0.0) {
        let fill = if p.channels == "RGB" {
            "#d95f02"
        } else {
            "#1b6ca8"
        };
        let (x, y, r) = (x(p.p95), y(p.ns), (p.bytes as f64).sqrt() / 30.0);
        let chosen = if p.tolerance == BakedSky::TOLERANCE {
            " (default)"
        } else {
            ""
        };
        let _ = writeln!(
            out,
            r##"<circle cx="{x:.1}" cy="{y:.1}" r="{r:.1}" fill="{fill}" fill-opacity="0.6"/><text x="{x:.1}" y="{:.1}" text-anchor="middle">{} {:.0} kB{chosen}</text>"##,
            y - r - 4.0,
            p.channels,
            p.bytes as f64 / 1e3
        );
    }
    out + "</svg>\n"
}

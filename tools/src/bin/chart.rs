//! Speed against accuracy against bytes for every setting of the evaluators: `cargo run --release -p welkin-tools --bin
//! chart` writes `docs/figures/settings.csv` and `.svg`.
//!
//! Errors are 95th percentiles against [`welkin::Sky`], of baked skies over a few conditions, of point queries over
//! the whole model; times are the least of many repetitions.

use std::fmt::Write as _;
use std::hint::black_box;
use std::time::Instant;

use welkin::{BakedSky, Conditions, Directions, Interpolation, Model, PointQuery, Result, Sky};
use welkin_tools::WAVELENGTHS;
use welkin_tools::random::{self, Sequence, p95, sphere};

const TOLERANCES: [f64; 6] = [0.02, 0.005, 0.0025, 0.0018, 0.0012, 0.0008];
const QUERIES: usize = 1024;
/// What the marks of the chart are, and their colours.
const KINDS: [(&str, &str); 3] = [
    ("baked, RGB (outlined: default)", "#d95f02"),
    ("baked, all wavelengths", "#1b6ca8"),
    ("all wavelengths", "#4d9221"),
];

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
    for (name, interpolation) in [
        ("point query of 4 chunks", Interpolation::Linear),
        ("point query of 16 chunks", Interpolation::Full),
    ] {
        points.push(general(&model, name, interpolation)?);
    }
    let mut csv = String::from(
        "# cargo run --release -p welkin-tools --bin chart\nchannels,tolerance,p95_error,bytes,ns\n",
    );
    for p in &points {
        let _ = writeln!(
            csv,
            "{},{},{:.6},{},{:.1}",
            p.channels, p.tolerance, p.p95, p.bytes, p.ns
        );
    }
    print!("{csv}");
    welkin::output::replace_files(&[
        ("docs/figures/settings.csv".as_ref(), csv.as_bytes()),
        (
            "docs/figures/settings.svg".as_ref(),
            svg(&points).as_bytes(),
        ),
    ])
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

/// Queries anywhere in the model without preparation.
fn general(model: &Model, name: &'static str, interpolation: Interpolation) -> Result<Point> {
    let general = PointQuery::new(welkin::DEFAULT_MODEL)?.with_interpolation(interpolation);
    let (mut places, mut views) = (Sequence::<4>::default(), Sequence::<2>::default());
    let queries: Vec<_> = (0..QUERIES)
        .map(|_| {
            (
                random::conditions(model, places.draw()),
                sphere(views.draw()),
            )
        })
        .collect();
    let mut pairs = Vec::new();
    for (conditions, direction) in queries.iter().step_by(4) {
        let [mut got, mut truth] = [[0.0; WAVELENGTHS]; 2];
        general.radiance(conditions, *direction, &mut got)?;
        model.sky(conditions)?.radiance(*direction, &mut truth)?;
        pairs.extend(got.into_iter().zip(truth));
    }
    let mut out = [0.0; WAVELENGTHS];
    let ask = |_: &Directions| {
        queries.iter().try_for_each(|(conditions, direction)| {
            general.radiance(black_box(conditions), *direction, &mut out)
        })
    };
    Ok(Point {
        channels: name,
        tolerance: 0.0,
        p95: p95(pairs.into_iter()),
        bytes: welkin::DEFAULT_MODEL.len(),
        ns: fastest(ask),
    })
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

/// Time over error, both logarithmic; larger marks take more bytes.
fn svg(points: &[Point]) -> String {
    let mut out = String::from(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 640 400" font-family="sans-serif" font-size="12">
<rect width="640" height="400" fill="#fff"/>
<text x="320" y="390" text-anchor="middle">error against the prepared sky, p95 (%); at the left edge none</text>
<text x="16" y="190" text-anchor="middle" transform="rotate(-90 16 190)">time per query (ns)</text>
"##,
    );
    let x = |error: f64| 80.0 + 490.0 * ((100.0 * error).max(0.0316).log10() + 1.5) / 2.0;
    let y = |ns: f64| 350.0 - 310.0 * (ns.log10() - 1.0) / 2.7;
    for percent in [0.05, 0.1, 0.2, 0.5, 1.0, 2.0] {
        let x = x(percent / 100.0);
        let _ = writeln!(
            out,
            r##"<path d="M{x:.1} 40V350" stroke="#ddd"/><text x="{x:.1}" y="366" text-anchor="middle">{percent}</text>"##
        );
    }
    for ns in [
        10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0,
    ] {
        let y = y(ns);
        let _ = writeln!(
            out,
            r##"<path d="M70 {y:.1}H590" stroke="#ddd"/><text x="64" y="{:.1}" text-anchor="end">{ns}</text>"##,
            y + 4.0
        );
    }
    for (i, (name, fill)) in KINDS.iter().enumerate() {
        let y = 24.0 + 18.0 * i as f64;
        let _ = writeln!(
            out,
            r##"<circle cx="430" cy="{:.1}" r="6" fill="{fill}" fill-opacity="0.6"/><text x="442" y="{y:.1}">{name}</text>"##,
            y - 4.0
        );
    }
    for p in points {
        let fill = match p.channels {
            "RGB" => KINDS[0].1,
            "spectral" => KINDS[1].1,
            _ => KINDS[2].1,
        };
        let (x, y, r) = (x(p.p95), y(p.ns), (p.bytes as f64).powf(0.25) / 4.0);
        let kilobytes = format!("{:.0}", p.bytes as f64 / 1e3);
        // Point queries are close together, so their names stand above and below.
        let (label, above) = match p.channels {
            "spectral" => (kilobytes, true),
            "RGB" => (kilobytes, false),
            name => (name.to_owned(), name != "point query of 4 chunks"),
        };
        let known = points.iter().take_while(|other| !std::ptr::eq(*other, p));
        let repeated = p.tolerance > 0.0
            && known
                .into_iter()
                .any(|other| (other.channels, other.bytes) == (p.channels, p.bytes));
        let stroke = if p.tolerance == BakedSky::TOLERANCE {
            "#000"
        } else {
            "none"
        };
        let _ = write!(
            out,
            r##"<circle cx="{x:.1}" cy="{y:.1}" r="{r:.1}" fill="{fill}" fill-opacity="0.6" stroke="{stroke}"/>"##
        );
        if !repeated {
            let y = if above { y - r - 4.0 } else { y + r + 14.0 };
            let (x, anchor) = match p.tolerance > 0.0 {
                true => (x, "middle"),
                false => (x - r, "start"),
            };
            let _ = write!(
                out,
                r##"<text x="{x:.1}" y="{y:.1}" text-anchor="{anchor}">{label}</text>"##
            );
        }
        out.push('\n');
    }
    out + "</svg>\n"
}

//! `welkin-fit trace-bench`: how fast the tracer is, on the calling thread alone.

use anyhow::Result;
use clap::Args as ClapArgs;
use std::time::Instant;
use welkin_fitter::atmosphere::real;
use welkin_fitter::tracer::{BATCHES, Options, Query, Tracer};

/// Arguments of `trace-bench`.
#[derive(ClapArgs)]
pub struct Args {
    /// Visibility of the atmosphere, m.
    #[arg(long, default_value_t = 59_400.0)]
    visibility: f64,
    /// Walks per batch.
    #[arg(long, default_value_t = 400)]
    samples: usize,
}

const ALBEDO: f64 = 0.3;

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    println!(
        "{:<44} {:>11} {:>10} {:>9} {:>12}",
        "query", "wavelengths", "walks/s", "se %", "s to 1 % se"
    );
    let visible: Vec<f64> = (0..12).map(|i| 320.0 + 40.0 * f64::from(i)).collect();
    for wavelengths in [vec![550.0], visible] {
        let atmosphere = real(args.visibility, &wavelengths)?;
        let tracer = Tracer::new(&atmosphere, Options::default())?;
        let middle = wavelengths.iter().position(|&w| w >= 550.0).unwrap_or(0);
        for (name, query) in queries() {
            let start = Instant::now();
            let estimate = pool.install(|| tracer.estimate(&query, args.samples, 1))?;
            let seconds = start.elapsed().as_secs_f64();
            let r = estimate.radiance(ALBEDO, middle);
            let error = r.error[0] / r.stokes[0];
            println!(
                "{name:<44} {:>11} {:>10.0} {:>9.3} {:>12.3}",
                wavelengths.len(),
                (BATCHES * args.samples) as f64 / seconds,
                100.0 * error,
                seconds * (error / 0.01).powi(2),
            );
        }
    }
    Ok(())
}

fn queries() -> [(&'static str, Query); 6] {
    let query = |zenith: f64, sun: f64| Query {
        altitude: 0.0,
        view_zenith: zenith.to_radians(),
        view_azimuth: 0.0,
        sun_elevation: sun.to_radians(),
        distance: None,
    };
    let shadow_edge = Query {
        altitude: 12e3,
        view_azimuth: std::f64::consts::PI,
        ..query(86.5, -3.5)
    };
    [
        ("(a) zenith, sun at 30°", query(0.0, 30.0)),
        ("(b) 2° above the horizon, sun at 2°", query(88.0, 2.0)),
        ("(c) zenith, sun at -4.2°", query(0.0, -4.2)),
        ("(d) edge of the shadow, 12 km, sun at -3.5°", shadow_edge),
        ("(e) zenith, sun at -8°", query(0.0, -8.0)),
        ("(f) zenith, sun at -12°", query(0.0, -12.0)),
    ]
}

//! Rows per second of `welkin query`, one core, every row with conditions of its own, as CSV: `cargo bench --features
//! cli --bench rows`. Where the system says so, by processor time, so that other programs do not count. Paths of other
//! `welkin` commands after `--` are timed beside it, table by table.

use std::process::{Command, Stdio};
use std::time::Instant;

const HEADER: &str = "quantity,visibility_km,albedo,altitude_m,solar_elevation_deg,view_zenith_deg,view_azimuth_deg,distance_m,wavelength_nm\n";
/// How long a table should keep a command busy, s.
const BUSY: f64 = 1.0;

/// Numbers that are as good as random (SplitMix64).
struct Random(u64);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        low + (high - low) * ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn table(quantity: &str, segments: bool, rows: usize) -> String {
    let mut random = Random(1);
    let mut table = HEADER.to_owned();
    for _ in 0..rows {
        let visibility = 1.0 / random.between(1.0 / 131.8, 1.0 / 20.0);
        let altitude = 15e3 * random.between(0.0, 1.0).powi(3);
        let elevation = random.between(-4.2, 90.0);
        let (mut zenith, mut azimuth) = (
            random.between(-1.0, 1.0).acos().to_degrees(),
            random.between(-180.0, 180.0),
        );
        if quantity == "sun_radiance" {
            (zenith, azimuth) = (90.0 - elevation, 0.1);
        }
        let distance = match segments {
            true => format!("{:.1}", 10f64.powf(random.between(0.0, 5.5))),
            false => String::new(),
        };
        let albedo = random.between(0.0, 1.0);
        let wavelength = random.between(320.0, 760.0);
        table += &format!(
            "{quantity},{visibility:.4},{albedo:.3},{altitude:.2},{elevation:.4},{zenith:.4},{azimuth:.4},{distance},{wavelength:.2}\n"
        );
    }
    table
}

/// Seconds of a processor that children took so far, where the system says so: other programs do not count.
fn busy() -> Option<f64> {
    /// Of which Linux counts a hundred to a second on every machine.
    const TICK: f64 = 0.01;
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    // After the name in parentheses; user and system time of children are fields 16 and 17 of all.
    let fields: Vec<&str> = text.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |i: usize| fields.get(i)?.parse::<f64>().ok();
    Some(TICK * (ticks(13)? + ticks(14)?))
}

/// Seconds for a table.
fn time(command: &str, file: &std::path::Path) -> f64 {
    let (start, before) = (Instant::now(), busy());
    let status = Command::new(command)
        .args(["query", "--strict"])
        .arg(file)
        .env("RAYON_NUM_THREADS", "1")
        .stdout(Stdio::null())
        .status()
        .unwrap();
    assert!(status.success());
    let spent = busy().zip(before).map(|(now, before)| now - before);
    spent.unwrap_or_else(|| start.elapsed().as_secs_f64())
}

fn main() {
    let others = std::env::args().skip(1).filter(|a| !a.starts_with("--"));
    let own = env!("CARGO_BIN_EXE_welkin").to_owned();
    let commands: Vec<String> = std::iter::once(own).chain(others).collect();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("rows.csv");
    println!("rows per second,{}", commands.join(","));
    for (quantity, segments) in [
        ("radiance", false),
        ("relative_radiance", false),
        ("polarisation", false),
        ("stokes_q", false),
        ("polarisation", true),
        ("stokes_q", true),
        ("transmittance", true),
        ("in_scattering", false),
        ("in_scattering", true),
        ("sun_radiance", false),
    ] {
        let rates = commands.iter().map(|command| {
            let mut rows = 100;
            // As many rows as keep it busy, without the time to start.
            loop {
                std::fs::write(&file, table(quantity, segments, rows)).unwrap();
                let seconds = time(command, &file);
                if seconds >= 0.3 * BUSY || rows >= 1_000_000 {
                    break;
                }
                rows *= 4;
            }
            let fastest = (0..3)
                .map(|_| time(command, &file))
                .fold(f64::MAX, f64::min);
            format!(",{:.0}", rows as f64 / fastest)
        });
        let rates: String = rates.collect();
        let of = if segments { "segments" } else { "rays" };
        println!("{quantity} of {of}{rates}");
    }
}

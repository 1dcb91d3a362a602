//! Memory that a process holds, as CSV: `cargo run --release -p welkin-tools --bin resident -- MODEL [LOW HIGH]`
//! evaluates one sky on the ground, or skies at altitudes between two (m), and prints what that added to an empty
//! process (Linux).

use std::hint::black_box;
use std::io::Error as IoError;

use welkin::{BakedSky, Conditions, Model};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let file = arguments
        .first()
        .ok_or("usage: resident MODEL [LOW HIGH]")?;
    let altitudes = match arguments.get(1..3) {
        Some([low, high]) => [low.parse::<f64>()?, high.parse::<f64>()?],
        _ => [0.0, 0.0],
    };
    let before = resident()?;
    let model = Model::open(file)?;
    let steps = if altitudes[0] < altitudes[1] { 64 } else { 1 };
    let mut colour = None;
    for i in 0..steps {
        let altitude =
            altitudes[0] + (altitudes[1] - altitudes[0]) * f64::from(i) / f64::from(steps);
        let sky = model.colour_sky(&Conditions {
            altitude,
            ..Conditions::default()
        })?;
        colour = Some(sky.bake(BakedSky::TOLERANCE)?);
    }
    let luminance = colour.map(|sky| sky.xyz([0.0, 0.0, 1.0])).transpose()?;
    black_box(luminance);
    let after = resident()?;
    let kilobytes = |part: usize| after[part].saturating_sub(before[part]);
    println!("what,bytes");
    println!("anonymous,{}", 1024 * kilobytes(0));
    println!("file-backed,{}", 1024 * kilobytes(1));
    println!("both,{}", 1024 * (kilobytes(0) + kilobytes(1)));
    println!("read from the model,{}", model.touched_bytes());
    println!("the model,{}", model.file_bytes());
    Ok(())
}

/// Resident anonymous and file-backed memory, kB.
fn resident() -> Result<[usize; 2], IoError> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let field = |name: &str| {
        let line = status.lines().find_map(|line| line.strip_prefix(name));
        let number = line.and_then(|rest| rest.split_whitespace().next());
        number.and_then(|number| number.parse().ok()).unwrap_or(0)
    };
    Ok(["RssAnon:", "RssFile:"].map(field))
}

//! Strips of frames: each frame is a column of pixels, from 10° below the horizon up to 30° above it under the sun. A
//! pop would be a vertical edge. The lower half shows the error of the baked sky, ±1 % from black to white.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use welkin::{BakedSky, Conditions, Model};

use crate::steps::{Axis, unit};

const FRAMES: usize = 600;
const HEIGHT: usize = 200;

type Result = std::result::Result<(), Box<dyn std::error::Error>>;

pub fn write(model: &Model, folder: &Path) -> Result {
    let climb = Conditions {
        solar_elevation: 20f64.to_radians(),
        ..Conditions::default()
    };
    let sunset = Conditions {
        altitude: 3e3,
        visibility: 90e3,
        ..Conditions::default()
    };
    for (name, axis, base, range) in [
        ("climb", Axis::Climb, climb, [0.0, 15e3]),
        ("sunset", Axis::Sun, sunset, [8.0, -4.2]),
    ] {
        let path = folder.join(format!("{name}.png"));
        picture(model, axis, &base, range, &path)?;
        println!("{}", path.display());
    }
    Ok(())
}

fn picture(model: &Model, axis: Axis, base: &Conditions, range: [f64; 2], path: &Path) -> Result {
    let mut pixels = vec![0u8; FRAMES * HEIGHT * 2 * 3];
    let mut before: Option<Vec<[f64; 3]>> = None;
    let mut jumps = Vec::new();
    for frame in 0..FRAMES {
        let share = frame as f64 / (FRAMES - 1) as f64;
        let conditions = axis.at(base, range[0] + share * (range[1] - range[0]));
        let sky = model.sky(&conditions)?;
        let baked = sky.bake_colour(BakedSky::TOLERANCE)?;
        let dip = (6_378e3 / (6_378e3 + conditions.altitude))
            .acos()
            .to_degrees();
        let mut errors = Vec::new();
        let exposure = 0.4 / f64::from(baked.xyz(unit(30.0, 0.0))?[1]);
        for y in 0..HEIGHT {
            let direction = unit(30.0 - 40.0 * (y as f64 + 0.5) / HEIGHT as f64 - dip, 0.0);
            let rgb = baked.linear_srgb(direction)?;
            let (truth, got) = (sky.xyz(direction)?, baked.xyz(direction)?);
            let error = std::array::from_fn(|c| match truth[c] == got[c] {
                true => 0.0,
                false => f64::from(got[c]) / f64::from(truth[c]) - 1.0,
            });
            let colour = rgb.map(|v| encoded(1.0 - (-exposure * f64::from(v)).exp()));
            let grey = [((0.5 + 50.0 * error[1]) * 255.0).clamp(0.0, 255.0) as u8; 3];
            for (row, colour) in [(y, colour), (HEIGHT + y, grey)] {
                pixels[(row * FRAMES + frame) * 3..][..3].copy_from_slice(&colour);
            }
            errors.push(error);
        }
        if let Some(before) = &before {
            let pairs = before.as_flattened().iter().zip(errors.as_flattened());
            jumps.push(pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max));
        }
        before = Some(errors);
    }
    jumps.sort_by(f64::total_cmp);
    let step = (range[1] - range[0]).abs() / (FRAMES - 1) as f64;
    println!(
        "{FRAMES} frames, {step:.3} apart: largest change of an error {:.3} %, p95 {:.3} %, median {:.3} %",
        100.0 * jumps[jumps.len() - 1],
        100.0 * jumps[jumps.len() * 95 / 100],
        100.0 * jumps[jumps.len() / 2]
    );
    save(path, &pixels)
}

fn encoded(linear: f64) -> u8 {
    (linear.max(0.0).powf(1.0 / 2.2) * 255.0).min(255.0) as u8
}

fn save(path: &Path, pixels: &[u8]) -> Result {
    let file = BufWriter::new(File::create(path)?);
    let mut encoder = png::Encoder::new(file, FRAMES as u32, 2 * HEIGHT as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(pixels)?;
    Ok(())
}

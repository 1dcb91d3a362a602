//! An equirectangular environment map in linear sRGB, as a PFM file: `environment.pfm`.
//!
//! The top row is the zenith, the middle column looks along +x, columns run clockwise as seen from above: what
//! Blender and most renderers take. `welkin render --projection lat-long` writes the same as EXR.
//!
//! `cargo run --release --example 02_environment_map`

use std::f32::consts::{PI, TAU};
use std::fs::File;
use std::io::{BufWriter, Write};

use welkin::{BakedSky, Conditions, Model};

const WIDTH: usize = 1024;
const HEIGHT: usize = WIDTH / 2;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = Model::default_model()?;
    let sky = model.colour_sky(&Conditions {
        solar_elevation: 12f64.to_radians(),
        ..Conditions::default()
    })?;
    // Many directions under the same conditions: bake first.
    let baked = sky.bake(BakedSky::TOLERANCE)?;

    let mut file = BufWriter::new(File::create("environment.pfm")?);
    // A negative scale means little-endian; rows of a PFM run from the bottom up.
    write!(file, "PF\n{WIDTH} {HEIGHT}\n-1.0\n")?;
    for row in (0..HEIGHT).rev() {
        let zenith_angle = PI * (row as f32 + 0.5) / HEIGHT as f32;
        for column in 0..WIDTH {
            let azimuth = PI - TAU * (column as f32 + 0.5) / WIDTH as f32;
            let (sine, cosine) = zenith_angle.sin_cos();
            let direction = [sine * azimuth.cos(), sine * azimuth.sin(), cosine];
            for value in baked.linear_srgb(direction)? {
                file.write_all(&value.to_le_bytes())?;
            }
        }
    }
    file.flush()?;
    println!("environment.pfm: {WIDTH} × {HEIGHT}, linear sRGB in cd/m²");
    Ok(())
}

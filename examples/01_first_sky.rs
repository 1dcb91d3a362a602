//! The first sky: open the model, prepare a sky, ask directions.
//!
//! `cargo run --release --example 01_first_sky`

use welkin::{Conditions, Model, Result};

fn main() -> Result<()> {
    // A file would be `Model::open("clear-sky.welkin")`: mapped, only its head is read.
    let model = Model::default_model()?;
    let sky = model.sky(&Conditions {
        solar_elevation: 30f64.to_radians(),
        visibility: 60e3,
        ..Conditions::default()
    })?;

    // +z is the zenith, azimuths run counter-clockwise from +x, where the sun stands by default.
    println!("elevation  luminance  linear sRGB (cd/m²)");
    for elevation in [5f32, 20.0, 45.0, 90.0] {
        let (z, x) = elevation.to_radians().sin_cos();
        let direction = [-x, 0.0, z]; // away from the sun
        let [_, luminance, _] = sky.xyz(direction)?;
        let [r, g, b] = sky.linear_srgb(direction)?;
        println!("{elevation:8}°  {luminance:9.0}  {r:.0} {g:.0} {b:.0}");
    }

    println!("spectral radiance of the zenith, W m⁻² sr⁻¹ nm⁻¹");
    let mut radiance = vec![0.0; sky.wavelengths().len()];
    sky.radiance([0.0, 0.0, 1.0], &mut radiance)?;
    for (wavelength, l) in sky.wavelengths().iter().zip(&radiance) {
        println!("{wavelength:6} nm  {l:.4}");
    }
    let between = sky.radiance_at([0.0, 0.0, 1.0], 555.0)?;
    println!("   555 nm  {between:.4} (between the nodes of the model)");
    Ok(())
}

//! A camera with a polarising filter: the sky darkens as the filter turns.
//!
//! `cargo run --release --example 07_polarised_view`

use welkin::{Conditions, Model, PolarisationFrame, Result};

fn main() -> Result<()> {
    let model = Model::default_model()?;
    let sky = model.polarised_sky(&Conditions {
        solar_elevation: 10f64.to_radians(),
        ..Conditions::default()
    })?;

    // Looking north at 30° elevation, the sun in the east (+x); the camera is upright.
    let direction = [0.0, 0.87, 0.5];
    let frame = PolarisationFrame::Axis([0.0, 0.0, 1.0]);
    let light = sky.stokes_at(direction, frame, 550.0)?;
    println!(
        "550 nm: degree of linear polarisation {:.2}, angle {:.1}° from the camera's up towards its right",
        light.degree(),
        light.angle().to_degrees()
    );

    println!("filter   luminance (cd/m²)");
    let [_, luminance, _] = sky.xyz(direction, frame)?;
    for degrees in (0..180).step_by(30) {
        let passed = luminance.through_polariser((degrees as f32).to_radians());
        println!("{degrees:5}°   {passed:.0}");
    }
    Ok(())
}

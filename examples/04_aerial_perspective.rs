//! Aerial perspective: what the air does to things at a distance.
//!
//! `cargo run --release --example 04_aerial_perspective`

use welkin::{Conditions, Model, Result};

fn main() -> Result<()> {
    let model = Model::default_model()?;
    let conditions = Conditions {
        solar_elevation: 10f64.to_radians(),
        visibility: 40e3,
        altitude: 300.0,
        ..Conditions::default()
    };
    // One for all cameras of a scene. Joined to the sky, what is far away vanishes in that sky without a seam.
    let air = model.aerial_perspective(&conditions)?;
    let sky = model.sky(&conditions)?;
    let joined = air.joined_to(&sky)?;

    // A dark green mountain side, lit as the eye would see it from nearby, in cd/m².
    let mountain = [250.0, 420.0, 180.0];
    println!("distance   in-scattering (r g b)   factors (r g b)   what the camera sees");
    for kilometres in [0.1, 1.0, 5.0, 20.0, 60.0, 150.0] {
        // Points are metres in the frame of the ground below the observer, +z up.
        let point = [0.0, -1e3 * kilometres, 400.0];
        let (light, factors) = joined.linear_srgb(point)?;
        let seen: [f32; 3] = core::array::from_fn(|c| light[c] + factors[c] * mountain[c]);
        println!("{kilometres:6} km   {light:8.1?}   {factors:.3?}   {seen:8.1?}");
    }

    let (from, to) = ([0.0, 0.0, 300.0], [0.0, -20e3, 1500.0]);
    let mut transmittance = vec![0.0; air.wavelengths().len()];
    air.transmittance()
        .transmittance(from, to, &mut transmittance)?;
    println!("transmittance over 20 km: {transmittance:.3?}");
    Ok(())
}

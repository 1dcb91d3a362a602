//! A camera that flies around the planet, in a world whose origin is the planet's centre.
//!
//! Models speak of the place where the observer stands; [`Place`] turns the world into that frame.
//!
//! `cargo run --release --example 08_observer_on_a_sphere`

use welkin::{Conditions, Model, Place};

fn main() -> welkin::Result<()> {
    let model = Model::default_model()?;
    let planet = model.head().planet;
    let (centre, towards_sun) = ([0.0; 3], [1.0, 0.0, 0.0]);

    println!(
        "longitude  sun's elevation  luminance: zenith  5° above the west  in-scattering over 10 km, 520 nm"
    );
    for longitude in (0..=90).step_by(15) {
        // 3 km above the equator.
        let (y, x) = f64::from(longitude).to_radians().sin_cos();
        let (up, west) = ([x, y, 0.0], [y, -x, 0.0]);
        let camera = up.map(|v| v * (planet.radius + 3000.0));

        // Altitude of the observer, elevation and azimuth of the sun follow from position and world.
        let place = Place::new(&planet, centre, camera)?;
        let conditions = place.conditions(towards_sun, &Conditions::default())?;
        let sky = model.sky(&conditions)?;

        // Directions of the world.
        let low: [f64; 3] = std::array::from_fn(|i| west[i] + 5f64.to_radians().tan() * up[i]);
        let [zenith, low] = [up, low].map(|direction| sky.xyz(place.direction(direction)));

        // Points of the world.
        let air = model.aerial_perspective(&conditions)?;
        let tower = std::array::from_fn(|i| camera[i] + 10e3 * west[i]);
        let [from, to] = [camera, tower].map(|point| place.point_to_local(point));
        let light = air.in_scattering_at(from, to, 520.0)?;

        let elevation = conditions.solar_elevation.to_degrees();
        let ([_, zenith, _], [_, low, _]) = (zenith?, low?);
        println!("{longitude:8}°  {elevation:14.1}°  {zenith:17.0}  {low:17.0}  {light:32.2e}");
    }
    Ok(())
}

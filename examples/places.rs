//! A flight over the planet: at each position of the world, the local conditions, the sky above and the aerial perspective of a kilometre ahead.
//!
//! `cargo run --release --example places`

use welkin::{Conditions, Model, Place};

fn main() -> welkin::Result<()> {
    let model = Model::default_model()?;
    let planet = model.head().planet;
    // The world: the planet's centre in the origin, the axis towards +z, the sun above the equator.
    let (centre, sun) = ([0.0; 3], [1.0, 0.0, 0.0]);
    let air = Conditions::default();
    let n = model.wavelengths().len();
    let [mut light, mut through] = [(); 2].map(|()| vec![0.0; n]);
    println!("longitude  sun's elevation   zenith  5° above the sun's horizon  1 km east");
    for longitude in (0..=90).step_by(15) {
        let (y, x) = f64::from(longitude).to_radians().sin_cos();
        let distance = planet.radius + 3000.0;
        let camera = [distance * x, distance * y, 0.0];
        let (up, east) = ([x, y, 0.0], [-y, x, 0.0]);
        let place = Place::new(&planet, centre, camera)?;
        let conditions = place.conditions(sun, &air)?;
        let sky = model.sky(&conditions)?;
        let zenith = sky.xyz(place.direction(up))?[1];
        // Directions of the world: here towards the west, where the sun sets.
        let low = core::array::from_fn(|i| 5f64.to_radians().sin() * up[i] - east[i]);
        let towards_sun = sky.xyz(place.direction(low))?[1];
        // Points of the world, for an aerial perspective that is prepared at this place; it serves for `reach` around it.
        let aerial = model.aerial_perspective(&conditions)?;
        let [from, to] = [0.0, 1e3].map(|d| core::array::from_fn(|i| camera[i] + d * east[i]));
        let [from, to] = [from, to].map(|point| place.point_to_local(point));
        aerial.in_scattering(from, to, &mut light, &mut through)?;
        let elevation = conditions.solar_elevation.to_degrees();
        println!(
            "{longitude:8}°  {elevation:14.2}°  {zenith:7.0}  {towards_sun:26.0}  {:.3e}",
            light[5]
        );
    }
    Ok(())
}

//! A sun that moves every frame: what a frame costs.
//!
//! `cargo run --release --example 03_time_of_day`

use std::time::Instant;

use welkin::{BakedSky, Conditions, Model, Result};

const FRAMES: u32 = 120;

fn main() -> Result<()> {
    let model = Model::default_model()?;
    let [lowest, _] = model.solar_elevation_range();
    let mut milliseconds = Vec::new();
    for frame in 0..FRAMES {
        // From the lowest sun of the model to 40°.
        let share = f64::from(frame) / f64::from(FRAMES - 1);
        let conditions = Conditions {
            solar_elevation: lowest + share * (40f64.to_radians() - lowest),
            solar_azimuth: share,
            ..Conditions::default()
        };
        let start = Instant::now();
        let baked = model.colour_sky(&conditions)?.bake(BakedSky::TOLERANCE)?;
        milliseconds.push(start.elapsed().as_secs_f64() * 1e3);
        if frame % 20 == 0 {
            let [r, g, b] = baked.linear_srgb([-0.8, 0.0, 0.6])?;
            let degrees = conditions.solar_elevation.to_degrees();
            println!("sun {degrees:6.2}°: {r:8.1} {g:8.1} {b:8.1} cd/m² opposite the sun");
        }
    }
    milliseconds.sort_by(f64::total_cmp);
    let [median, worst] = [milliseconds.len() / 2, milliseconds.len() - 1].map(|i| milliseconds[i]);
    println!("sky and baking per frame: median {median:.2} ms, longest {worst:.2} ms");

    // All skies of an afternoon beforehand: then a frame is a blend of four.
    let elevations = [5.0, 40.0].map(f64::to_radians);
    let start = Instant::now();
    let course = model.sun_course(&Conditions::default(), elevations, BakedSky::TOLERANCE)?;
    let (skies, kilobytes) = (course.skies(), course.bytes() / 1000);
    let prepared = start.elapsed().as_secs_f64() * 1e3;
    println!("a course of {skies} skies, 5 to 40°: {prepared:.0} ms, {kilobytes} kB");
    let mut sky = course.at(elevations[0], 0.0)?;
    let start = Instant::now();
    for frame in 0..FRAMES {
        let share = f64::from(frame) / f64::from(FRAMES - 1);
        let elevation = elevations[0] + share * (elevations[1] - elevations[0]);
        course.write(elevation, share, &mut sky)?;
    }
    let microseconds = start.elapsed().as_secs_f64() * 1e6 / f64::from(FRAMES);
    println!("per frame: {microseconds:.0} µs");
    Ok(())
}

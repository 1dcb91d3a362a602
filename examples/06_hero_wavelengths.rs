//! Four wavelengths for each path, as spectral renderers with hero wavelengths ask for.
//!
//! `cargo run --release --example 06_hero_wavelengths`

use welkin::{BakedSky, Conditions, Directions, Model, Result};

const PATHS: usize = 4096;

fn main() -> Result<()> {
    let model = Model::default_model()?;
    let baked = model
        .sky(&Conditions::default())?
        .bake(BakedSky::TOLERANCE)?;

    let one = baked.hero([0.2, 0.3, 0.9], [420.0, 500.0, 580.0, 660.0])?;
    println!("one path: {one:.4?} W m⁻² sr⁻¹ nm⁻¹");

    // Batches take structures of arrays and give the same bits.
    let turn = |i: usize, step: f32| (i as f32 * step).fract();
    let (mut x, mut y, mut z, mut wavelengths) = (vec![], vec![], vec![], vec![]);
    for i in 0..PATHS {
        let azimuth = std::f32::consts::TAU * turn(i, 0.618_034);
        let height = turn(i, 0.754_878);
        let radius = (1.0 - height * height).sqrt();
        x.push(radius * azimuth.cos());
        y.push(radius * azimuth.sin());
        z.push(height);
        let hero = 380.0 + 90.0 * turn(i, 0.569_84);
        wavelengths.push([hero, hero + 90.0, hero + 180.0, hero + 270.0]);
    }
    let directions = Directions {
        x: &x,
        y: &y,
        z: &z,
    };
    let mut radiance = vec![[0.0; 4]; PATHS];
    baked.hero_batch(&directions, &wavelengths, &mut radiance)?;
    let mean: f32 = radiance.as_flattened().iter().sum::<f32>() / (4 * PATHS) as f32;
    println!("mean over {PATHS} paths: {mean:.4}");
    Ok(())
}

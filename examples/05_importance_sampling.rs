//! Light from sky and sun by importance sampling.
//!
//! `welkin light --sun-elevation 35` gets the same by quadrature: see its `global_horizontal`.
//!
//! `cargo run --release --example 05_importance_sampling`

use welkin::{BakedSky, Conditions, Model, Result};

fn main() -> Result<()> {
    let model = Model::default_model()?;
    let conditions = Conditions {
        solar_elevation: 35f64.to_radians(),
        ..Conditions::default()
    };
    let baked = model.colour_sky(&conditions)?.bake(BakedSky::TOLERANCE)?;
    let disc = model.solar_disc(&conditions)?;
    let sampler = baked.sampler().with_sun(&disc);

    println!("samples  illuminance of level ground  deviation of one sample");
    for samples in [64, 1024, 16_384, 262_144] {
        let (mut sum, mut squares) = (0.0, 0.0);
        for i in 0..samples {
            // Samples below the horizon light nothing, but they count.
            let sample = sampler.sample(sobol(i));
            let [_, luminance, _] = sample.xyz;
            let cosine = sample.direction[2].max(0.0);
            let weight = match sample.pdf > 0.0 {
                true => f64::from(luminance * cosine / sample.pdf),
                false => 0.0,
            };
            sum += weight;
            squares += weight * weight;
        }
        let mean = sum / f64::from(samples);
        let deviation = (squares / f64::from(samples) - mean * mean).max(0.0).sqrt();
        println!(
            "{samples:7}  {mean:24.0} lx  {:21.0} %",
            100.0 * deviation / mean
        );
    }

    // The density of any direction, to combine it with other strategies by multiple importance sampling.
    println!(
        "density at the zenith: {:.3} / sr",
        sampler.pdf([0.0, 0.0, 1.0])?
    );
    println!("and in the sun: {:.0} / sr", sampler.pdf(disc.direction())?);
    Ok(())
}

/// The first two dimensions of Sobol's sequence: better than random numbers, and the same in every run.
fn sobol(i: u32) -> [f32; 2] {
    let (mut y, mut direction) = (0, 1u32 << 31);
    for bit in 0..u32::BITS {
        y ^= direction * (i >> bit & 1);
        direction ^= direction >> 1;
    }
    [i.reverse_bits(), y].map(|v| (v >> 8) as f32 / (1 << 24) as f32)
}

//! Model no more than a scene needs: what a budget reads, holds and errs.
//!
//! `cargo run --release --example 10_scene_budget`

use welkin::{BakedSky, Budget, Channels, Conditions, Model, Result};

fn main() -> Result<()> {
    let model = Model::default_model()?;
    let budget = Budget {
        altitude: [0.0, 200.0],
        visibility: [40e3, 80e3],
        solar_elevation: [0.0, 60f64.to_radians()],
        tolerance: BakedSky::TOLERANCE,
        channels: Channels::Colour,
    };
    let plan = model.plan(&budget)?;
    println!(
        "{} chunks, {} of {} bytes of the file are read; a baked sky holds at most {} bytes",
        plan.chunk_count,
        plan.file_bytes,
        model.file_bytes(),
        plan.sky_bytes
    );
    println!(
        "error of the chunks against traced data: median {:.2} %, p99 {:.2} %; baking adds at most {:.2} % (p95)",
        100.0 * plan.error_median,
        100.0 * plan.error_p99,
        100.0 * plan.bake_p95
    );

    // After this no sky of the scene reads anything.
    model.load(&plan)?;
    let baked = model
        .sky(&Conditions::default())?
        .bake_colour(budget.tolerance)?;
    println!("this sky holds {} bytes", baked.bytes());

    // Nothing prepared: any conditions of the scene, query by query.
    let query = model.point_query(&plan)?;
    let mut radiance = vec![0.0; query.wavelengths().len()];
    query.radiance(&Conditions::default(), [0.0, 0.0, 1.0], &mut radiance)?;
    println!("zenith {radiance:.4?} W m⁻² sr⁻¹ nm⁻¹");
    Ok(())
}

use std::time::Instant;
use welkin_fitter::{atmosphere::*, dataset::*, decompose::*, orders::*};
fn main() {
    let grid = Grid::default();
    let plan = welkin_fitter::build::Plan::default();
    let store = Store::open("work", plan.key()).unwrap();
    let v: f64 = 131800.0;
    let a = 6;
    let medium = Medium::new(real(v, &WAVELENGTHS).unwrap(), SUN_RADIUS).unwrap();
    let light =
        LightField::from_values(&store.unit(&format!("light-{v}"), || panic!()).unwrap()).unwrap();
    let gatherer = Gatherer::new(&medium, &light, 1.0);
    let values = store
        .unit(&format!("tensor-{v}-{}", grid.altitudes[a]), || panic!())
        .unwrap();
    let tensor = Tensor {
        shape: [
            grid.up.0.len() + grid.down.0.len(),
            grid.phi.len(),
            grid.elevation_axis().len(),
            60,
        ],
        values,
    };
    let geometry = chunk_geometry(&medium, gatherer.planet(), &grid, a);
    let scale = ElevationScale::new(&tensor, &geometry, &medium);
    let weights = channel_weights(&tensor, &gatherer, &grid, a);
    for rank in [64, 96, 160] {
        for sweeps in [200, 600, 2000] {
            let t = Instant::now();
            let f = fit(
                &tensor,
                &geometry,
                &medium,
                &grid,
                &scale,
                &weights,
                Options {
                    rank,
                    sweeps,
                    seed: 1,
                },
            );
            println!(
                "rank {rank} sweeps {sweeps} error {:.5} condition {:.1} {:.1?}",
                f.error,
                f.condition,
                t.elapsed()
            );
        }
    }
}

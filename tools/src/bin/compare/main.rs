//! Times and errors next to those of others, on the same directions in the same run.
//!
//! `cargo run --release -p welkin-tools --bin compare` prints a table, `-- --json` the same as JSON. Times are medians
//! per query on one core; errors are 95th percentiles of relative differences from [`welkin::Sky`] (peers: from what
//! they stand for). Only ratios mean something on another machine.

mod baked;
mod bands;
mod clock;
mod finite;
mod point_query;
mod polarised;
mod preparation;
mod report;
mod scene;
mod types;

use scene::Scene;

fn main() -> welkin::Result<()> {
    let json = std::env::args().any(|argument| argument == "--json");
    let scene = Scene::new()?;
    let mut rows = baked::rows(&scene)?;
    rows.extend(bands::rows(&scene)?);
    rows.extend(polarised::rows(&scene)?);
    rows.extend(finite::rows(&scene)?);
    rows.extend(point_query::rows(&scene)?);
    rows.extend(preparation::rows(&scene)?);
    rows.extend(types::rows(&scene)?);
    match json {
        true => println!("{}", report::json(&rows)),
        false => report::table(&rows),
    }
    Ok(())
}

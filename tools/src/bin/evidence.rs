//! Every model of the sky on the same sky: `cargo run --release -p welkin-tools --bin evidence` writes
//! `docs/evidence` from what `bash docs/evidence/trace` has traced.
//!
//! `-- skies` compares pictures, profiles, errors and abilities, `-- times` times and memory, `-- page` fills the page;
//! `-- air AIR.json FOLDER` sums up what `welkin-fit atmosphere` wrote and puts what is to be traced into a folder.

use std::fs;
use std::path::Path;

use welkin::output::replace_file;
use welkin_tools::evidence::{
    Result, abilities, air::Air, directions, errors, haze, models, pictures, profiles, table,
    timing, truth::Traced,
};
use welkin_tools::figures;

const USAGE: &str = "usage: evidence [skies | times | page | air AIR.json FOLDER]";

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        [] => {
            skies()?;
            timing::write()?;
            page()
        }
        ["skies"] => skies(),
        ["times"] => timing::write(),
        ["page"] => page(),
        ["air", air, folder] => sum_up(air.as_ref(), folder.as_ref()),
        _ => Err(USAGE.into()),
    }
}

fn skies() -> Result<()> {
    let folder = table::folder();
    let air = Air::read(&folder.join("air.csv"))?;
    let real = Traced::read(&folder.join("real.csv"))?;
    let exponential = Traced::read(&folder.join("exponential.csv"))?;
    let models = models::all(&air)?;
    models::write(&models)?;
    errors::write(&models, &real, &exponential)?;
    haze::write()?;
    abilities::write()?;
    profiles::write(&models)?;
    pictures::write(&models)
}

fn page() -> Result<()> {
    let path = table::folder().join("README.md");
    let page = fs::read_to_string(&path)?;
    let filled = figures::filled(&page, &table::folder())?;
    Ok(replace_file(&path, filled.as_bytes())?)
}

/// What is traced: the same air with exponential profiles, and the lines of sight.
fn sum_up(air: &Path, folder: &Path) -> Result<()> {
    let text = fs::read_to_string(air).map_err(|e| format!("{}: {e}", air.display()))?;
    let air = Air::from_json(&text)?;
    let exponential = air.exponential()?.to_string();
    replace_file(folder.join("exponential.json"), exponential.as_bytes())?;
    replace_file(folder.join("queries.csv"), directions::queries().as_bytes())?;
    table::write("air.csv", air.csv().as_bytes())
}

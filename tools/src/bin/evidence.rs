//! Every model of the sky on the same sky: `cargo run --release -p welkin-tools --bin evidence` writes
//! `docs/evidence` from what `bash docs/evidence/trace` has traced.
//!
//! `-- skies` compares pictures, profiles, errors and abilities, `-- times` times and memory, `-- page` fills the page;
//! `-- air CASE AIR.json FOLDER` sums up what `welkin-fit atmosphere` wrote and puts what is to be traced into a folder.
//! `--official FILE.dat`, or the variable `WELKIN_OFFICIAL_DATA`, names the data of the official model, without which its
//! rows say that it was not run.

use std::fs;
use std::path::{Path, PathBuf};

use welkin::output::replace_file;
use welkin_tools::evidence::{
    Result, abilities,
    air::Air,
    cases::{Case, FIRST, OTHERS},
    directions, errors, haze, models, official, pictures, profiles, table, timing,
    truth::Traced,
};
use welkin_tools::figures;

const USAGE: &str =
    "usage: evidence [skies | times | page | air CASE AIR.json FOLDER] [--official FILE.dat]";

fn main() -> Result<()> {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let official = official_file(&mut arguments)?;
    if let Some(file) = &official {
        // Before minutes are spent.
        fs::metadata(file).map_err(|e| format!("{}: {e}", file.display()))?;
    }
    let official = official.as_deref();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        [] => {
            skies(official)?;
            timing::write(official)?;
            page()
        }
        ["skies"] => skies(official),
        ["times"] => timing::write(official),
        ["page"] => page(),
        ["air", case, air, folder] => sum_up(case, air.as_ref(), folder.as_ref()),
        _ => Err(USAGE.into()),
    }
}

/// Takes `--official FILE.dat` out of the arguments, or else the file from the environment.
fn official_file(arguments: &mut Vec<String>) -> Result<Option<PathBuf>> {
    let Some(at) = arguments.iter().position(|a| a == "--official") else {
        return Ok(std::env::var_os(official::VARIABLE).map(PathBuf::from));
    };
    if at + 1 >= arguments.len() {
        return Err(USAGE.into());
    }
    let mut pair = arguments.drain(at..at + 2);
    Ok(pair.nth(1).map(PathBuf::from))
}

fn skies(file: Option<&Path>) -> Result<()> {
    let folder = table::folder();
    let air = Air::read(&folder.join("air.csv"))?;
    let real = Traced::read(&folder.join(FIRST.traced()), &FIRST)?;
    let exponential = Traced::read(&folder.join("exponential.csv"), &FIRST)?;
    let models = models::all(&FIRST, &air, file)?;
    models::write(&models)?;
    errors::write(&models, &real, &exponential)?;
    haze::write()?;
    abilities::write(file)?;
    profiles::write(&models)?;
    pictures::write(&models)?;
    let others = OTHERS.iter().map(|case| other(case, file));
    let others = others.collect::<Result<Vec<_>>>()?;
    errors::write_noise([&real, &exponential], &others)
}

/// The table of a case beside the first.
fn other(case: &Case, file: Option<&Path>) -> Result<Traced> {
    let folder = table::folder();
    let air = Air::read(&folder.join(case.air()))?;
    let traced = Traced::read(&folder.join(case.traced()), case)?;
    errors::write_case(case, &models::all(case, &air, file)?, &traced)?;
    Ok(traced)
}

fn page() -> Result<()> {
    let path = table::folder().join("README.md");
    let page = fs::read_to_string(&path)?;
    let filled = figures::filled(&page, &table::folder())?;
    Ok(replace_file(&path, filled.as_bytes())?)
}

/// What is traced of a case: the same air with exponential profiles, and the lines of sight.
fn sum_up(case: &str, air: &Path, folder: &Path) -> Result<()> {
    let case = Case::named(case)?;
    let text = fs::read_to_string(air).map_err(|e| format!("{}: {e}", air.display()))?;
    let air = Air::from_json(&text)?;
    let exponential = air.exponential(case.albedo)?.to_string();
    replace_file(folder.join("exponential.json"), exponential.as_bytes())?;
    replace_file(
        folder.join("queries.csv"),
        directions::queries(&case).as_bytes(),
    )?;
    table::write(&case.air(), air.csv().as_bytes())
}

//! The ground: its albedo by wavelength.

use super::columns::Functions;
use super::error::field;
use super::file::Ground;
use crate::atmosphere::table::{Curve, Table};
use anyhow::Result;

/// Names of the surfaces of `src/bin/welkin/surfaces.csv`, which the command knows as well.
pub const NAMES: [&str; 5] = ["grass", "snow", "sand", "sea", "urban"];

/// Albedo of the ground, if the recipe says something about it.
pub fn surface(ground: &Ground) -> Result<Option<Curve>> {
    if let Some(name) = &ground.surface {
        return Ok(Some(named(name)?));
    }
    if let Some(albedo) = ground.albedo {
        return Ok(Some(Curve::new(vec![300.0, 2500.0], vec![albedo; 2])?));
    }
    let Some(columns) = &ground.table else {
        return Ok(None);
    };
    let table = Functions::new("ground.table", columns, "wavelength_nm")?;
    table.only(|name| name == "albedo")?;
    Ok(Some(table.curve("albedo", 0.0, 1.0)?))
}

fn named(name: &str) -> Result<Curve> {
    if !NAMES.contains(&name) {
        let what = format!("there is no {name:?}, only {}", NAMES.join(", "));
        return Err(field("ground.surface", what).into());
    }
    let text = include_str!("../../../src/bin/welkin/surfaces.csv");
    Table::parse("surfaces.csv", text)?.curve("wavelength_nm", name)
}

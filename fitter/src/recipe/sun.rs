//! Sunlight above the atmosphere.

use super::columns::Functions;
use super::error::{RecipeError, field};
use super::file::Sun;
use crate::atmosphere::table::{Curve, Table};
use anyhow::Result;

/// What a spectrum covers at least, nm: what models are made of.
const COVERED: [f64; 2] = [300.0, 1100.0];

/// W m⁻² nm⁻¹ by wavelength, nm, at the planet's distance.
pub fn irradiance(sun: &Sun) -> Result<Curve> {
    let at_1_au = match &sun.spectrum {
        Some(columns) => {
            let table = Functions::new("sun.spectrum", columns, "wavelength_nm")?;
            table.only(|name| name == "irradiance_w_m2_nm")?;
            covers(table.range())?;
            table.curve("irradiance_w_m2_nm", f64::MIN_POSITIVE, 1e9)?
        }
        None => earths()?,
    };
    let dilution = sun.distance_au.powi(-2);
    let nodes = at_1_au.nodes();
    let values = nodes.iter().map(|&nm| at_1_au.at(nm) * dilution);
    Curve::new(nodes.to_vec(), values.collect())
}

fn covers([from, to]: [f64; 2]) -> Result<(), RecipeError> {
    let [least, most] = COVERED;
    if from > least || to < most {
        let what =
            format!("wavelength_nm runs from {from} to {to}, not from {least} to {most} or beyond");
        return Err(field("sun.spectrum", what));
    }
    Ok(())
}

fn earths() -> Result<Curve> {
    let text = include_str!("../../data/solar_irradiance_1nm.csv");
    Table::parse("solar_irradiance_1nm.csv", text)?.curve("wavelength_nm", "g173")
}

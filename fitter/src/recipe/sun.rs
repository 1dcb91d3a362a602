//! Sunlight above the atmosphere.

use super::columns::Functions;
use super::file::Sun;
use crate::atmosphere::table::{Curve, Table};
use anyhow::Result;

/// W m⁻² nm⁻¹ by wavelength, nm, at the planet's distance.
pub fn irradiance(sun: &Sun) -> Result<Curve> {
    let at_1_au = match &sun.spectrum {
        Some(columns) => {
            let table = Functions::new("sun.spectrum", columns, "wavelength_nm")?;
            table.only(|name| name == "irradiance_w_m2_nm")?;
            table.curve("irradiance_w_m2_nm", 0.0, 1e9)?
        }
        None => earths()?,
    };
    let dilution = sun.distance_au.powi(-2);
    let nodes = at_1_au.nodes();
    let values = nodes.iter().map(|&nm| at_1_au.at(nm) * dilution);
    Curve::new(nodes.to_vec(), values.collect())
}

fn earths() -> Result<Curve> {
    let text = include_str!("../../data/solar_irradiance_1nm.csv");
    Table::parse("solar_irradiance_1nm.csv", text)?.curve("wavelength_nm", "g173")
}

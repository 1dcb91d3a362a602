//! The fields of a recipe, as they stand in the file.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The whole file.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct File {
    pub name: String,
    pub description: String,
    pub planet: Planet,
    pub gases: Gases,
    pub aerosol: Aerosol,
    pub layers: BTreeMap<String, Layer>,
    pub ground: Ground,
    pub sun: Sun,
}

/// `[planet]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Planet {
    pub radius_km: f64,
    pub gravity_m_s2: f64,
}

impl Default for Planet {
    fn default() -> Self {
        Self {
            radius_km: 6378.0,
            gravity_m_s2: 9.806_65,
        }
    }
}

/// `[gases]`: one of `standard`, `table` and `isothermal`.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Gases {
    pub standard: Option<String>,
    pub table: Option<Columns>,
    pub isothermal: Option<Isothermal>,
    pub molecules: Molecules,
    pub surface_pressure_hpa: Option<f64>,
    pub ozone_du: Option<f64>,
    pub water_cm: Option<f64>,
}

/// Gas of one temperature in hydrostatic balance.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Isothermal {
    pub temperature_k: f64,
}

/// What the gas is.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Molecules {
    #[default]
    Air,
    CarbonDioxide,
}

/// `[aerosol]`: what holds for the particles of all layers.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Aerosol {
    pub humidity_percent: Option<f64>,
    pub optical_depth_550: Option<f64>,
    pub visibility_km: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub phase: Option<PhaseFunctions>,
}

/// How OPAC's particles scatter.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PhaseFunctions {
    /// By Henyey-Greenstein functions.
    #[default]
    HenyeyGreenstein,
    /// As the spheres that they are in OPAC.
    Mie,
}

/// `[layers.NAME]`
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Layer {
    pub bottom_km: Option<f64>,
    pub top_km: Option<f64>,
    pub scale_height_km: Option<f64>,
    pub bottom_edge_km: Option<f64>,
    pub top_edge_km: Option<f64>,
    pub profile: Option<Columns>,

    pub mixture: Option<String>,
    pub particles_per_cm3: Option<BTreeMap<String, f64>>,
    pub optics: Option<Columns>,
    pub phase: Option<Columns>,

    pub humidity_percent: Option<f64>,
    pub optical_depth_550: Option<f64>,
    pub extinction_550_per_km: Option<f64>,
    pub visibility_km: Option<f64>,
}

/// `[ground]`: one of the three, or none.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Ground {
    pub surface: Option<String>,
    pub albedo: Option<f64>,
    pub table: Option<Columns>,
}

/// `[sun]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Sun {
    pub distance_au: f64,
    pub spectrum: Option<Columns>,
}

impl Default for Sun {
    fn default() -> Self {
        Self {
            distance_au: 1.0,
            spectrum: None,
        }
    }
}

/// Columns of numbers, named; or the CSV file that has them, until it is read.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(
    untagged,
    expecting = "expected the name of a CSV file, or columns of numbers such as { altitude_km = [0, 2], relative = [1, 0] }"
)]
pub enum Columns {
    File(PathBuf),
    Inline(BTreeMap<String, Vec<f64>>),
}

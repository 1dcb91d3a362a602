//! The air of a model: an atmosphere for every node of its visibility axis.

use crate::atmosphere::table::Table;
use crate::atmosphere::{Atmosphere, Monochromatic, Particles, real_at};
use crate::recipe::Recipe;
use anyhow::{Context, Result};
use serde_json::{Value, json};

/// What a model is made of.
#[derive(Clone, Debug, Default)]
pub enum Air {
    /// The continental air of the default model, at any visibility.
    #[default]
    Continental,
    /// Recipes at the nodes of the axis, m; only there.
    Recipes(Vec<(f64, Recipe)>),
}

impl Air {
    /// The air of a recipe alone, at its own visibility, to the metre.
    pub fn of(recipe: Recipe) -> Result<Self> {
        Ok(Self::Recipes(vec![(recipe.visibility()?.round(), recipe)]))
    }

    /// The visibilities that alone there are, m; none if there is any.
    pub fn visibilities(&self) -> Vec<f64> {
        match self {
            Self::Continental => vec![],
            Self::Recipes(nodes) => nodes.iter().map(|(v, _)| *v).collect(),
        }
    }

    /// The atmosphere of a visibility (m) for some lights.
    pub fn at(&self, visibility: f64, lights: &[Monochromatic]) -> Result<Atmosphere> {
        match self {
            Self::Continental => real_at(visibility, lights, Particles::HenyeyGreenstein),
            Self::Recipes(nodes) => {
                let found = nodes.iter().find(|(v, _)| *v == visibility);
                let (_, recipe) = found
                    .with_context(|| format!("no recipe for a visibility of {visibility} m"))?;
                recipe.air(lights)
            }
        }
    }

    /// What the names of work units have to tell apart.
    pub fn key(&self) -> String {
        match self {
            Self::Continental => String::new(),
            Self::Recipes(nodes) => {
                let key = |(v, recipe): &(f64, Recipe)| format!(" {v} {}", recipe.key());
                nodes.iter().map(key).collect()
            }
        }
    }

    /// Solar irradiance outside the air, W m⁻² nm⁻¹, means over 1 nm about `first`, `first + 1`, …, `last` (nm).
    pub fn solar_irradiance(&self, [first, last]: [f64; 2]) -> Result<Vec<f32>> {
        let sun = match self {
            Self::Recipes(nodes) => nodes[0].1.solar_irradiance()?,
            Self::Continental => Table::parse(
                "solar_irradiance_1nm.csv",
                include_str!("../data/solar_irradiance_1nm.csv"),
            )?
            .curve("wavelength_nm", "g173")?,
        };
        let samples = (last - first) as usize + 1;
        Ok((0..samples)
            .map(|i| sun.at(first + i as f64) as f32)
            .collect())
    }

    /// What the file says of it.
    pub fn provenance(&self) -> (String, Value) {
        match self {
            Self::Continental => (
                "Clear sky of the US standard atmosphere with OPAC continental aerosol".into(),
                json!({
                    "air": "AFGL US standard 1986; Rayleigh scattering: Bodhaine et al. 1999; ozone: Gorshelev et al. 2014, 223 to 293 K; absorption bands: Bird & Riordan 1984",
                    "aerosol": "OPAC water-soluble (50 % humidity), insoluble, soot (Hess et al. 1998), Henyey-Greenstein",
                    "precipitable_water_cm": 1.42,
                    "sun": "ASTM G173-03 extraterrestrial",
                }),
            ),
            Self::Recipes(nodes) => {
                let recipe = &nodes[0].1;
                let mut what = json!({ "description": recipe.description() });
                if recipe.has_spheres() {
                    what["phase_functions"] = "OPAC's particles as spheres (Lorenz-Mie), by sums of Henyey-Greenstein functions".into();
                }
                (recipe.name().into(), what)
            }
        }
    }
}

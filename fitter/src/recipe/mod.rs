//! Atmospheres that a person can write: TOML in, [`Atmosphere`] out.
//!
//! `docs/recipes.md` describes the fields.

mod carbon_dioxide;
mod change;
mod check;
mod columns;
mod error;
mod file;
mod gas;
mod key;
mod merge;
mod nodes;
mod opac;
mod optics;
mod particles;
mod risk;
mod shape;
mod shipped;
mod sun;
mod surface;
mod syntax;
mod tables;

pub use error::RecipeError;
pub use shipped::{OPAC, OPAC_HUMIDITY, Published};

use crate::atmosphere::table::Curve;
use crate::atmosphere::{Atmosphere, Constituent, Monochromatic};
use crate::column::MAX_CONSTITUENTS;
use anyhow::Result;
use file::{File, PhaseFunctions};
use gas::Gas;
use particles::{GREEN, KOSCHMIEDER, Particles};
use shape::Shape;
use std::path::Path;

/// Wavelengths for which all data are known, nm.
const WAVELENGTHS: [f64; 2] = [300.0, 2500.0];

/// An atmosphere with its sun and ground, as a file describes it.
///
/// ```
/// use welkin_fitter::atmosphere::Monochromatic;
/// use welkin_fitter::recipe::Recipe;
///
/// let urban = Recipe::named("urban").unwrap();
/// let murky = urban.with("visibility", 5.0)?;
/// assert!((murky.visibility()? - 5000.0).abs() < 1.0);
/// let air = murky.air(&[Monochromatic::beside_lines(550.0)])?;
/// assert!(air.constituents.len() <= 8);
/// # Ok::<(), anyhow::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Recipe {
    file: File,
}

/// A layer of particles as one line of a summary.
///
/// ```
/// let clean = welkin_fitter::recipe::Recipe::named("maritime-clean").unwrap();
/// let layers = clean.layers(&[550.0])?;
/// assert!(layers.iter().any(|layer| layer.name == "mixing" && layer.optical_depth[0] > 0.05));
/// # Ok::<(), anyhow::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LayerDepth {
    /// Its name in the recipe.
    pub name: String,
    /// By wavelength.
    pub optical_depth: Vec<f64>,
}

impl Recipe {
    /// Reads a TOML file; tables that it names are relative to it.
    pub fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path).map_err(|why| RecipeError::Unreadable {
            path: path.to_owned(),
            why,
        })?;
        let folder = path.parent();
        Self::parse(&text, folder).map_err(|e| e.context(path.display().to_string()))
    }

    /// Reads TOML; tables that it names are relative to `folder`, or to where the program runs.
    ///
    /// All that is wrong is a [`RecipeError`], which says where.
    pub fn parse(text: &str, folder: Option<&Path>) -> Result<Self> {
        let parsed = toml::from_str(text);
        let mut file: File = parsed.map_err(|e| syntax::error(text, &e))?;
        syntax::no_empty_ground(text)?;
        tables::read_all(&mut file, folder)?;
        Self::checked(file)
    }

    /// One that comes with the program.
    pub fn named(name: &str) -> Option<Self> {
        let (_, text) = shipped::RECIPES.iter().find(|(known, _)| *known == name)?;
        Some(Self::parse(text, None).expect("a test reads all recipes that come with the program"))
    }

    /// The names of those.
    pub fn names() -> impl Iterator<Item = &'static str> {
        shipped::RECIPES.iter().map(|(name, _)| *name)
    }

    /// The text of one of those, to start one's own from.
    pub fn text(name: &str) -> Option<&'static str> {
        let found = shipped::RECIPES.iter().find(|(known, _)| *known == name)?;
        Some(found.1)
    }

    fn checked(file: File) -> Result<Self> {
        check::check(&file)?;
        let recipe = Self { file };
        // All else that can be wrong shows where the air is made.
        recipe.air(&[Monochromatic::beside_lines(GREEN)])?;
        recipe.solar_irradiance()?;
        recipe.surface()?;
        Ok(recipe)
    }

    /// What it is called.
    pub fn name(&self) -> &str {
        &self.file.name
    }

    /// What it is, in a sentence or two.
    pub fn description(&self) -> &str {
        &self.file.description
    }

    /// The air for lights of 300..2500 nm, in any order: the gases, then the particles, at most eight constituents.
    pub fn air(&self, lights: &[Monochromatic]) -> Result<Atmosphere> {
        let wavelengths: Vec<f64> = lights.iter().map(|l| l.wavelength).collect();
        let [from, to] = WAVELENGTHS;
        if let Some(w) = wavelengths.iter().find(|w| !(from..=to).contains(*w)) {
            anyhow::bail!("wavelength {w:?} nm is outside {from}..{to} nm");
        }
        let parts = self.parts()?;
        let altitudes = &parts.altitudes;
        let mut layers = vec![];
        for layer in &parts.particles {
            layers.push(layer.constituent(altitudes, &wavelengths)?);
        }
        let particles = merge::merged(layers);
        let mut constituents = vec![parts.gas.air(altitudes, lights)?];
        let ozone = ozone_parts(&parts.gas, particles.len())?;
        constituents.extend(parts.gas.absorbers(altitudes, lights, ozone)?);
        constituents.extend(particles);
        Ok(Atmosphere {
            planet_radius: self.planet_radius(),
            altitudes: parts.altitudes,
            wavelengths,
            constituents,
        })
    }

    /// Refuses wavelengths (nm) that a table of the recipe's own optics does not have.
    pub fn reaches(&self, wavelengths: &[f64]) -> Result<()> {
        let parts = self.parts()?;
        for layer in &parts.particles {
            layer.reaches(wavelengths)?;
        }
        Ok(())
    }

    /// Radius of the planet, m.
    pub fn planet_radius(&self) -> f64 {
        self.file.planet.radius_km * 1000.0
    }

    /// Koschmieder's visibility at the ground, m: where a contrast of 1 has become 0.02 at 550 nm. What gases absorb
    /// does not count.
    pub fn visibility(&self) -> Result<f64> {
        let parts = self.parts()?;
        let mut extinction = parts.clear;
        for layer in &parts.particles {
            let green = layer.constituent(&parts.altitudes, &[GREEN])?;
            extinction += green.profile[0] * green.extinction[0];
        }
        Ok(KOSCHMIEDER / extinction)
    }

    /// Optical depth of every layer of particles at wavelengths in nm.
    pub fn layers(&self, wavelengths: &[f64]) -> Result<Vec<LayerDepth>> {
        let parts = self.parts()?;
        let depth = |layer: &Particles| {
            let constituent = layer.constituent(&parts.altitudes, wavelengths)?;
            let column = crate::atmosphere::column(&parts.altitudes, &constituent.profile);
            Ok(LayerDepth {
                name: layer.name().to_owned(),
                optical_depth: constituent.extinction.iter().map(|e| e * column).collect(),
            })
        };
        parts.particles.iter().map(depth).collect()
    }

    /// The layers of particles as they are, before those that can be one become one; and the nodes of their profiles.
    pub fn particles(&self, wavelengths: &[f64]) -> Result<(Vec<f64>, Vec<Constituent>)> {
        let parts = self.parts()?;
        let layers = parts.particles.iter();
        let layers = layers.map(|layer| layer.constituent(&parts.altitudes, wavelengths));
        let layers = layers.collect::<Result<_>>()?;
        Ok((parts.altitudes, layers))
    }

    /// Column of ozone, Dobson units.
    pub fn ozone(&self) -> Result<f64> {
        let parts = self.parts()?;
        Ok(parts.gas.dobson(&parts.altitudes))
    }

    /// Precipitable water, cm.
    pub fn water(&self) -> Result<f64> {
        let parts = self.parts()?;
        Ok(parts.gas.water(&parts.altitudes))
    }

    /// Sunlight above the air, W m⁻² nm⁻¹ by wavelength in nm.
    pub fn solar_irradiance(&self) -> Result<Curve> {
        sun::irradiance(&self.file.sun)
    }

    /// Distance of the sun, astronomical units.
    pub fn sun_distance(&self) -> f64 {
        self.file.sun.distance_au
    }

    /// Albedo of the ground by wavelength in nm, if the recipe says it.
    pub fn surface(&self) -> Result<Option<Curve>> {
        surface::surface(&self.file.ground)
    }

    /// A name for the air: the same 32 digits for the same air, others for any other. Name, description, sun and ground
    /// do not count, tables do.
    pub fn key(&self) -> String {
        key::key(&self.file)
    }

    /// The recipe with one number changed: `ozone` (DU), `water` (cm), `pressure` (hPa), `humidity` (%),
    /// `optical_depth` (all particles, 550 nm), `visibility` (km), `sun_distance` (AU), and in layers such as
    /// `layers.dust.optical_depth`.
    pub fn with(&self, parameter: &str, value: f64) -> Result<Self> {
        let mut file = self.file.clone();
        change::change(&mut file, parameter, value)?;
        Self::checked(file)
    }

    /// The recipe with OPAC's particles as spheres, by Lorenz-Mie theory, but for those whose sizes OPAC does not say.
    pub fn with_mie(&self) -> Result<Self> {
        let mut file = self.file.clone();
        file.aerosol.phase = Some(PhaseFunctions::Mie);
        Self::checked(file)
    }

    /// Whether OPAC's particles are spheres.
    pub fn has_spheres(&self) -> bool {
        self.file.aerosol.phase == Some(PhaseFunctions::Mie)
    }

    /// What may trace less exactly than usual.
    pub fn cautions(&self) -> Result<Vec<String>> {
        let (_, layers) = self.particles(&[GREEN])?;
        let pairs = layers.iter().zip(self.shapes()?);
        let say = |(layer, shape): (&Constituent, Shape)| {
            risk::cautions(&layer.name, &shape, layer.extinction[0])
        };
        Ok(pairs.flat_map(say).collect())
    }

    fn shapes(&self) -> Result<Vec<Shape>, RecipeError> {
        let layers = self.file.layers.iter();
        layers
            .map(|(name, layer)| Shape::new(&format!("layers.{name}"), layer))
            .collect()
    }

    fn parts(&self) -> Result<Parts<'_>> {
        let shapes = self.shapes()?;
        let bends = Gas::bends(&self.file)?;
        let altitudes = nodes::altitudes(shapes.iter(), &bends);
        let gas = Gas::new(&self.file, &altitudes)?;
        let air = gas.air(&altitudes, &[Monochromatic::beside_lines(GREEN)])?;
        let clear = air.profile[0] * air.extinction[0];
        Ok(Parts {
            particles: Particles::all(&self.file, shapes, &altitudes, clear)?,
            altitudes,
            gas,
            clear,
        })
    }
}

/// A recipe that has been worked out.
struct Parts<'a> {
    altitudes: Vec<f64>,
    gas: Gas<'a>,
    particles: Vec<Particles>,
    /// Extinction of the gas without absorption at the ground, 550 nm, m⁻¹.
    clear: f64,
}

/// In how many temperatures ozone absorbs beside so many profiles of particles.
fn ozone_parts(gas: &Gas, particles: usize) -> Result<usize, RecipeError> {
    let (ozone, others) = gas.counts();
    let least = others + usize::from(ozone);
    let left = MAX_CONSTITUENTS.checked_sub(least + particles);
    let too_many = || RecipeError::TooManyProfiles {
        particles,
        most: MAX_CONSTITUENTS - least,
    };
    let left = left.ok_or_else(too_many)?;
    Ok(if ozone { (left + 1).min(3) } else { 0 })
}

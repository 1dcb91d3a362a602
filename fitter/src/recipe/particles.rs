//! The layers of particles with their amounts: as much as the recipe says at 550 nm.

use super::error::{RecipeError, field};
use super::file::{File, Layer};
use super::optics::Optics;
use super::shape::Shape;
use crate::atmosphere::{Constituent, Scatterer, column};
use anyhow::Result;

/// Wavelength of optical depths and visibilities, nm.
pub const GREEN: f64 = 550.0;
/// Contrast that is just seen, as its negative logarithm: Koschmieder's visibility times the extinction.
pub const KOSCHMIEDER: f64 = 3.912;
/// Humidity where the recipe says nothing, percent: that of the model's own air.
const HUMIDITY: f64 = 50.0;

/// Why a layer has no visibility.
const NOT_AT_GROUND: &str = "there are no particles at the ground to have it";

/// A layer of the recipe.
pub struct Particles {
    name: String,
    shape: Shape,
    optics: Optics,
    /// Of what the optics say, where the profile is 1.
    amount: f64,
}

/// A layer while its amount is not known.
struct Unscaled<'a> {
    layer: &'a Layer,
    on_ground: bool,
    /// Extinction at the ground, m⁻¹, and the largest.
    ground: f64,
    largest: f64,
    depth: f64,
}

impl Particles {
    /// All layers; `air` is the extinction of the gas without absorption at the ground, m⁻¹.
    pub fn all(file: &File, shapes: Vec<Shape>, altitudes: &[f64], air: f64) -> Result<Vec<Self>> {
        let humidity = file.aerosol.humidity_percent.unwrap_or(HUMIDITY);
        let phase = file.aerosol.phase.unwrap_or_default();
        let mut layers = vec![];
        for ((name, layer), shape) in file.layers.iter().zip(shapes) {
            let optics = Optics::new(&format!("layers.{name}"), layer, (humidity, phase))?;
            layers.push(Self {
                name: name.clone(),
                shape,
                optics,
                amount: 1.0,
            });
        }
        let amounts = amounts(file, &layers, altitudes, air)?;
        for (layer, amount) in layers.iter_mut().zip(amounts) {
            layer.amount = amount;
        }
        Ok(layers)
    }

    /// The name of the layer.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Refuses wavelengths (nm) that a table of the recipe's own does not have.
    pub fn reaches(&self, wavelengths: &[f64]) -> Result<(), RecipeError> {
        self.optics.reaches(wavelengths)
    }

    /// The layer at wavelengths in nm.
    pub fn constituent(&self, altitudes: &[f64], wavelengths: &[f64]) -> Result<Constituent> {
        let mut scatterers = self.optics.scatterers(wavelengths)?;
        for scatterer in &mut scatterers {
            let Scatterer {
                extinction,
                scattering,
                ..
            } = scatterer;
            extinction
                .iter_mut()
                .chain(scattering)
                .for_each(|v| *v *= self.amount);
        }
        // The sum of nothing is −0.
        let total = |w: usize| 0.0 + scatterers.iter().map(|s| s.extinction[w]).sum::<f64>();
        Ok(Constituent {
            name: self.name.clone(),
            profile: altitudes.iter().map(|&z| self.shape.at(z)).collect(),
            extinction: (0..wavelengths.len()).map(total).collect(),
            scatterers,
        })
    }
}

fn amounts(file: &File, layers: &[Particles], altitudes: &[f64], air: f64) -> Result<Vec<f64>> {
    let mut unscaled = vec![];
    for (particles, layer) in layers.iter().zip(file.layers.values()) {
        let green = particles.constituent(altitudes, &[GREEN])?;
        let (profile, extinction) = (&green.profile, green.extinction[0]);
        unscaled.push(Unscaled {
            layer,
            on_ground: particles.shape.on_ground(),
            ground: profile[0] * extinction,
            largest: profile.iter().fold(0.0, |a: f64, &b| a.max(b)) * extinction,
            depth: column(altitudes, profile) * extinction,
        });
    }
    let mut out = vec![];
    for (unscaled, particles) in unscaled.iter().zip(layers) {
        out.push(unscaled.own_amount(&particles.name)?);
    }
    fill_in_visibility(&unscaled, layers, &mut out, air)?;
    scale_all(file, &unscaled, &mut out, air)?;
    Ok(out)
}

impl Unscaled<'_> {
    /// From the layer's own fields, but for its visibility.
    fn own_amount(&self, name: &str) -> Result<f64, RecipeError> {
        let per = |wanted: f64, is: f64, what: &str| match () {
            () if wanted == 0.0 => Ok(0.0),
            () if is > 0.0 => Ok(wanted / is),
            () => Err(field(
                format!("layers.{name}.{what}"),
                "nothing in the layer to have it",
            )),
        };
        let layer = self.layer;
        match (layer.optical_depth_550, layer.extinction_550_per_km) {
            (Some(depth), _) => per(depth, self.depth, "optical_depth_550"),
            (_, Some(per_km)) => per(per_km * 1e-3, self.largest, "extinction_550_per_km"),
            _ if layer.visibility_km.is_some() => Ok(0.0),
            _ => Ok(1.0),
        }
    }
}

/// As much of the one layer with a visibility as makes it that of all the air.
fn fill_in_visibility(
    unscaled: &[Unscaled],
    layers: &[Particles],
    amounts: &mut [f64],
    air: f64,
) -> Result<(), RecipeError> {
    let Some(i) = unscaled
        .iter()
        .position(|u| u.layer.visibility_km.is_some())
    else {
        return Ok(());
    };
    let place = format!("layers.{}.visibility_km", layers[i].name);
    if !unscaled[i].on_ground {
        return Err(field(place, NOT_AT_GROUND));
    }
    let km = unscaled[i].layer.visibility_km.unwrap_or_default();
    let others: f64 = unscaled
        .iter()
        .zip(&*amounts)
        .map(|(u, a)| u.ground * a)
        .sum();
    amounts[i] = missing(&place, km, air + others, unscaled[i].ground)?;
    Ok(())
}

/// How much of `ground` (m⁻¹) is missing beside `rest` for a visibility.
fn missing(place: &str, km: f64, rest: f64, ground: f64) -> Result<f64, RecipeError> {
    let wanted = KOSCHMIEDER / (1000.0 * km) - rest;
    if wanted < 0.0 {
        let clearest = KOSCHMIEDER / rest / 1000.0;
        return Err(field(
            place,
            format!("{km:?} km, but it is {clearest:.1} km without the particles"),
        ));
    }
    if ground <= 0.0 {
        return Err(field(place, NOT_AT_GROUND));
    }
    Ok(wanted / ground)
}

/// As `[aerosol]` says: the optical depth scales all layers, the visibility those at the ground.
fn scale_all(
    file: &File,
    unscaled: &[Unscaled],
    amounts: &mut [f64],
    air: f64,
) -> Result<(), RecipeError> {
    let sum = |amounts: &[f64], of: &dyn Fn(&Unscaled) -> f64| -> f64 {
        unscaled.iter().zip(amounts).map(|(u, a)| a * of(u)).sum()
    };
    if let Some(wanted) = file.aerosol.optical_depth_550 {
        let depth = sum(amounts, &|u| u.depth);
        if depth <= 0.0 && wanted > 0.0 {
            return Err(field(
                "aerosol.optical_depth_550",
                "there are no particles to have it",
            ));
        }
        let factor = if wanted > 0.0 { wanted / depth } else { 0.0 };
        amounts.iter_mut().for_each(|a| *a *= factor);
    }
    if let Some(km) = file.aerosol.visibility_km {
        let low = sum(amounts, &|u| if u.on_ground { u.ground } else { 0.0 });
        let high = sum(amounts, &|u| if u.on_ground { 0.0 } else { u.ground });
        let factor = missing("aerosol.visibility_km", km, air + high, low)?;
        let at_ground = unscaled.iter().zip(amounts).filter(|(u, _)| u.on_ground);
        at_ground.for_each(|(_, a)| *a *= factor);
    }
    Ok(())
}

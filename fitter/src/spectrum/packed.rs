//! A spectrum as it goes into a model file, and the lines of its terms.

use crate::air::Air;
use crate::atmosphere::Monochromatic;
use anyhow::Result;
use welkin::format::Spectrum;

/// The spectrum and the colour weights of a model.
pub struct Packed {
    /// The payload of its chunk.
    pub spectrum: Spectrum,
    /// XYZ per unit of relative radiance at each node.
    pub xyz: Vec<[f64; 3]>,
    /// The light of each term.
    pub(super) lights: Vec<Monochromatic>,
}

/// What lines add to the extinction of each constituent, m⁻¹.
pub(super) fn lines(air: &Air, visibility: f64, light: Monochromatic) -> Result<Vec<f64>> {
    let pair = [light, Monochromatic::beside_lines(light.wavelength)];
    let air = air.at(visibility, &pair)?;
    let added = air
        .constituents
        .iter()
        .map(|c| (c.extinction[0] - c.extinction[1]).max(0.0));
    Ok(added.collect())
}

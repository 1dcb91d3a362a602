//! The particles: OPAC water-soluble, insoluble and soot, and how they are spread over the altitude.

use super::composition::{Constituent, Phase, Scatterer, column};
use super::mie;
use super::table::Table;
use super::variation::AerosolProfile;
use anyhow::Result;
use std::sync::Arc;

const SPECIES: [&str; 3] = ["waso", "inso", "soot"];
/// Altitudes at which density falls to 1/e within each layer, km.
const SCALE_HEIGHT: f64 = 8.0;
/// Wavelength of optical depths and visibilities, nm.
const GREEN: f64 = 550.0;

macro_rules! table {
    ($name:literal) => {
        Table::parse($name, include_str!(concat!("../../data/", $name)))
    };
}

/// How the aerosol scatters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Particles {
    /// By Henyey-Greenstein functions, as the paper has it.
    #[default]
    HenyeyGreenstein,
    /// By the Mie matrices of its spheres (320..760 nm).
    Mie,
}

/// The two layers, or the only one.
pub fn aerosols(
    visibility: f64,
    altitudes: &[f64],
    wavelengths: &[f64],
    particles: Particles,
    profile: AerosolProfile,
) -> Result<Vec<Constituent>> {
    let [boundary, free] = concentrations(visibility)?;
    let phases = SPECIES
        .iter()
        .map(|species| phase(species, wavelengths, particles))
        .collect::<Result<Vec<_>>>()?;
    let part = |name: &str, shape, per_cm3| aerosol(name, shape, per_cm3, wavelengths, &phases);
    if profile == AerosolProfile::Exponential {
        let shape = exponential(altitudes, [boundary, free])?;
        return Ok(vec![part("exponential aerosol", shape, boundary)?]);
    }
    let [below, above] = layers(altitudes, profile);
    Ok(vec![
        part("boundary layer aerosol", below, boundary)?,
        part("free troposphere aerosol", above, free)?,
    ])
}

/// Profiles of the layers below and above the inversion at 2 km: `exp(-z/8)` cut off there and at 12 km.
fn layers(altitudes: &[f64], profile: AerosolProfile) -> [Vec<f64>; 2] {
    let [inversion, end] = AerosolProfile::EDGES.map(|z| z / 1000.0);
    let beyond = |z: f64, edge: f64, width: f64| match profile {
        AerosolProfile::Sharp => f64::from(u8::from(z > edge)),
        _ => 1.0 / (1.0 + (-(z - edge) / width).exp()),
    };
    let shape = |z: &f64, below: bool| {
        let z = z / 1000.0;
        let above = beyond(z, inversion, 0.15);
        let gone = beyond(z, end, 0.5);
        (-z / SCALE_HEIGHT).exp() * (1.0 - gone) * if below { 1.0 - above } else { above }
    };
    [true, false].map(|below| altitudes.iter().map(|z| shape(z, below)).collect())
}

/// The profile of boundary layer aerosol that has the vertical optical depth of both layers.
fn exponential(altitudes: &[f64], [boundary, free]: [[f64; 3]; 2]) -> Result<Vec<f64>> {
    let [below, above] = layers(altitudes, AerosolProfile::Smooth).map(|p| column(altitudes, &p));
    let [ground, higher] = [green(boundary)?, green(free)?];
    let scale_height = below + above * higher / ground;
    Ok(altitudes
        .iter()
        .map(|z| (-z / scale_height).exp())
        .collect())
}

/// Extinction coefficient at 550 nm, up to a factor.
fn green(per_cm3: [f64; 3]) -> Result<f64> {
    let optics = table!("opac_channels.csv")?;
    let mut sum = 0.0;
    for (species, n) in SPECIES.into_iter().zip(per_cm3) {
        let cross_section = optics.curve("wavelength_nm", &format!("{species}_ext_m2"))?;
        sum += n * cross_section.log_at(GREEN);
    }
    Ok(sum)
}

/// Number densities (cm⁻³) of the species in the boundary layer and above, extrapolated to z = 0.
///
/// Between the tabulated visibilities the mixtures are mixed linearly in concentration, so that the extinction matches.
fn concentrations(visibility: f64) -> Result<[[f64; 3]; 2]> {
    let table = table!("aerosol_profiles.csv")?;
    let rows = table.column("visibility_km")?;
    let v = visibility / 1000.0;
    let i = rows
        .partition_point(|&row| row <= v)
        .clamp(1, rows.len() - 1);
    let t = ((1.0 / v - 1.0 / rows[i - 1]) / (1.0 / rows[i] - 1.0 / rows[i - 1])).clamp(0.0, 1.0);
    let mix = |prefix: &str| -> Result<[f64; 3]> {
        let mut out = [0.0; 3];
        for (value, species) in out.iter_mut().zip(SPECIES) {
            let column = table.column(&format!("{prefix}_{species}"))?;
            *value = column[i - 1] + t * (column[i] - column[i - 1]);
        }
        Ok(out)
    };
    Ok([mix("A")?, mix("F")?])
}

fn phase(species: &str, wavelengths: &[f64], particles: Particles) -> Result<Phase> {
    Ok(match particles {
        Particles::HenyeyGreenstein => {
            let optics = table!("opac_channels.csv")?;
            let g = optics.curve("wavelength_nm", &format!("{species}_g_use"))?;
            Phase::HenyeyGreenstein {
                g: wavelengths.iter().map(|&w| g.at(w)).collect(),
            }
        }
        Particles::Mie => Phase::Tabulated(Arc::new(mie::matrix(species, wavelengths)?)),
    })
}

fn aerosol(
    name: &str,
    profile: Vec<f64>,
    per_cm3: [f64; 3],
    wavelengths: &[f64],
    phases: &[Phase],
) -> Result<Constituent> {
    let optics = table!("opac_channels.csv")?;
    let mut extinction = vec![0.0; wavelengths.len()];
    let mut scatterers = vec![];
    for ((species, n), phase) in SPECIES.into_iter().zip(per_cm3).zip(phases) {
        let curve = |column: &str| optics.curve("wavelength_nm", &format!("{species}_{column}"));
        let (cross_section, albedo) = (curve("ext_m2")?, curve("ssa")?);
        let ext: Vec<f64> = wavelengths
            .iter()
            .map(|&w| n * 1e6 * cross_section.log_at(w))
            .collect();
        for (sum, e) in extinction.iter_mut().zip(&ext) {
            *sum += e;
        }
        scatterers.push(Scatterer {
            name: species.into(),
            phase: phase.clone(),
            scattering: ext
                .iter()
                .zip(wavelengths)
                .map(|(e, &w)| e * albedo.at(w))
                .collect(),
            extinction: ext,
        });
    }
    Ok(Constituent {
        name: name.into(),
        profile,
        extinction,
        scatterers,
    })
}

#[cfg(test)]
mod tests {
    use super::super::variation::Variation;
    use super::super::{Atmosphere, real_varied};
    use super::*;

    const VISIBILITY: f64 = 59_400.0;

    fn air(aerosol: AerosolProfile) -> Atmosphere {
        let variation = Variation {
            aerosol,
            ..Variation::default()
        };
        let particles = Particles::HenyeyGreenstein;
        real_varied(VISIBILITY, &[GREEN], particles, variation).unwrap()
    }

    /// Of the particles alone, which come after air, three ozones and water.
    fn extinction(air: &Atmosphere, altitude: f64) -> f64 {
        let particles = 5..air.constituents.len();
        let part = |k: usize| air.profile(k, altitude) * air.constituents[k].extinction[0];
        particles.map(part).sum()
    }

    fn depth(air: &Atmosphere) -> f64 {
        let particles = 5..air.constituents.len();
        particles.map(|k| air.vertical_optical_depth(k, 0)).sum()
    }

    #[test]
    fn all_profiles_have_the_same_haze_on_the_ground() {
        let smooth = extinction(&air(AerosolProfile::Smooth), 0.0);
        for profile in [AerosolProfile::Sharp, AerosolProfile::Exponential] {
            let other = extinction(&air(profile), 0.0);
            assert!((other / smooth - 1.0).abs() < 1e-5, "{profile:?}");
        }
    }

    #[test]
    fn the_sharp_profile_jumps_where_the_smooth_one_bends() {
        let jump = |profile| {
            let air = air(profile);
            extinction(&air, 1999.0) / extinction(&air, 2001.0)
        };
        assert!(jump(AerosolProfile::Sharp) > 10.0);
        assert!(jump(AerosolProfile::Smooth) < 1.02);
        assert_eq!(extinction(&air(AerosolProfile::Sharp), 12_001.0), 0.0);
    }

    #[test]
    fn the_exponential_has_the_optical_depth_of_the_layers() {
        let [layered, one] = [AerosolProfile::Smooth, AerosolProfile::Exponential].map(air);
        let (layered, exponential) = (depth(&layered), depth(&one));
        assert!((exponential / layered - 1.0).abs() < 2e-3, "{exponential}");
        let fold = extinction(&one, 1000.0) / extinction(&one, 3000.0);
        let again = extinction(&one, 3000.0) / extinction(&one, 5000.0);
        assert!((fold / again - 1.0).abs() < 1e-9, "{fold} {again}");
    }
}

//! Sunlight and colour at the channels of a file.

use crate::atmosphere::table::Table;
use crate::official::layout::Channels;
use anyhow::{Result, ensure};

/// Luminous efficacy in the definition of XYZ, lm/W.
const EFFICACY: f64 = 683.0;

/// Solar irradiance and colour of each channel.
pub struct Light {
    /// Mean solar irradiance of the bins, W m⁻² nm⁻¹.
    pub irradiance: Vec<f64>,
    /// XYZ per unit of radiance relative to it.
    pub xyz: Vec<[f64; 3]>,
}

impl Light {
    /// From the tables in `fitter/data`.
    pub fn new(channels: Channels) -> Result<Self> {
        let solar = include_str!("../../../data/solar_irradiance_1nm.csv");
        let solar = Table::parse("solar_irradiance_1nm.csv", solar)?;
        let wavelengths = solar.column("wavelength_nm")?;
        let known = [wavelengths[0], wavelengths[wavelengths.len() - 1]];
        let ends = [
            channels.start,
            channels.start + channels.count as f64 * channels.width,
        ];
        // Half a bin more or less changes little.
        let slack = 0.5 * channels.width;
        ensure!(
            ends[0] >= known[0] - slack && ends[1] <= known[1] + slack,
            "channels from {} to {} nm are beyond the solar spectrum of {} to {} nm",
            ends[0],
            ends[1],
            known[0],
            known[1]
        );
        let sun = solar.curve("wavelength_nm", "g173")?;
        let matching = include_str!("../../../data/cie1931_2deg_1nm.csv");
        let matching = Table::parse("cie1931_2deg_1nm.csv", matching)?;
        let curve = |name: &str| matching.curve("wavelength_nm", name);
        let curves = [curve("xbar")?, curve("ybar")?, curve("zbar")?];
        let reach = matching.column("wavelength_nm")?;
        let reach = reach[0]..=reach[reach.len() - 1];
        let mut light = Self {
            irradiance: vec![],
            xyz: vec![],
        };
        for channel in 0..channels.count {
            let steps = (channels.width.ceil() as usize).max(1);
            let step = channels.width / steps as f64;
            let (mut irradiance, mut colour) = (0.0, [0.0; 3]);
            for i in 0..steps {
                let nm = channels.start + channel as f64 * channels.width + (i as f64 + 0.5) * step;
                irradiance += sun.at(nm) / steps as f64;
                // The radiance of a bin is the same all over it.
                if reach.contains(&nm) {
                    for (sum, curve) in colour.iter_mut().zip(&curves) {
                        *sum += EFFICACY * step * curve.at(nm);
                    }
                }
            }
            light.irradiance.push(irradiance);
            light.xyz.push(colour.map(|c| c * irradiance));
        }
        Ok(light)
    }
}

//! The skies of a file at one altitude and visibility, at the sites of welkin's axes.

use super::sites::Sites;
use crate::official::error::Result;
use crate::official::layout::Node;
use crate::official::{OfficialData, OfficialError};
use rayon::prelude::*;
use welkin::geometry::Side;

/// Radiance, W m⁻² sr⁻¹ nm⁻¹, `[site][albedo][channel]`.
pub struct Samples {
    /// The numbers.
    pub values: Vec<f32>,
    /// How many albedos.
    pub albedos: usize,
    /// How many channels.
    pub channels: usize,
}

impl Samples {
    /// Samples the skies at a stored altitude and visibility.
    pub fn new(
        data: &OfficialData,
        sites: &Sites,
        [altitude, visibility]: [usize; 2],
    ) -> Result<Self> {
        let header = data.header();
        let (albedos, channels) = (header.axes.albedos.len(), header.channels.count);
        let [views, azimuths, suns] = sites.shape();
        let h = header.axes.altitudes[altitude];
        let under = |sun: usize, albedo: usize| -> Result<Vec<f32>> {
            let sky = data.stored_sky(Node {
                visibility,
                albedo,
                altitude,
                elevation: sun,
            })?;
            let mut out = Vec::with_capacity(views * azimuths * channels);
            for v in 0..views {
                let side = sites.views[v].0;
                for p in 0..azimuths {
                    if side == Side::Down && !Sites::sees_down(h) {
                        out.extend(std::iter::repeat_n(0.0, channels));
                        continue;
                    }
                    let radiance = sky.beside_horizon(sites.direction(v, p), side)?;
                    out.extend(radiance.iter().map(|l| *l as f32));
                }
            }
            Ok(out)
        };
        let skies: Vec<Vec<f32>> = (0..suns * albedos)
            .into_par_iter()
            .map(|i| under(i / albedos, i % albedos))
            .collect::<Result<_>>()?;
        let mut values = vec![0.0; views * azimuths * suns * albedos * channels];
        for (place, cell) in values.chunks_exact_mut(channels).enumerate() {
            let (site, albedo) = (place / albedos, place % albedos);
            let (view, sun) = (site / suns, site % suns);
            cell.copy_from_slice(&skies[sun * albedos + albedo][view * channels..][..channels]);
        }
        if let Some(bad) = values.iter().find(|v| !v.is_finite()) {
            return Err(OfficialError::value(
                crate::official::Section::Radiance,
                "a radiance",
                format!("got {bad}"),
            ));
        }
        Ok(Self {
            values,
            albedos,
            channels,
        })
    }

    /// The same relative to the irradiance of each channel.
    pub fn relative_to(mut self, irradiance: &[f64]) -> Self {
        for cell in self.values.chunks_exact_mut(self.channels) {
            for (value, irradiance) in cell.iter_mut().zip(irradiance) {
                *value = (f64::from(*value) / irradiance) as f32;
            }
        }
        self
    }

    /// The radiance at a site.
    pub fn at(&self, site: usize, albedo: usize, channel: usize) -> f32 {
        self.values[(site * self.albedos + albedo) * self.channels + channel]
    }
}

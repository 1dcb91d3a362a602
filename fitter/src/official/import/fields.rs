//! What is fitted: the fields of the skies at one altitude and visibility, relative to a level.

use super::albedo::AlbedoLaw;
use super::sample::Samples;
use super::sites::Sites;
use super::split::{AIR_FIELDS, LOBES, Splitter, henyey_greenstein};
use super::suns::SunSplines;
use faer::Mat;
use half::f16;

/// Sites of a sky darker than this share of its mean count as that dark in its level.
const DARK: f64 = 1e-4;

/// The skies at one altitude and visibility as the fit sees them.
pub struct Fields {
    /// Where they are sampled.
    pub sites: Sites,
    /// Fields per channel.
    pub fields: usize,
    /// Channels.
    pub channels: usize,
    /// Fields relative to the level, `[site][field][channel]`.
    pub values: Vec<f32>,
    /// Radiance of the file relative to the level, `[site][albedo][channel]`.
    pub radiance: Vec<f32>,
    /// Albedos.
    pub albedos: usize,
    /// A/(1 − A s), `[albedo][channel]`.
    pub ground_share: Vec<f32>,
    /// Phase functions, `[site][field]`.
    pub phase: Vec<f32>,
    /// Spline coefficients of the logarithm of the level, `[coefficient][channel]`, as half precision has them.
    pub level: Vec<f32>,
    /// What the exponential of the level is to be multiplied with.
    pub offset: f64,
}

impl Fields {
    /// From sampled skies relative to the solar irradiance.
    pub fn new(
        (sites, samples): (Sites, Samples),
        law: &AlbedoLaw,
        splitter: &Splitter,
        suns: &SunSplines,
    ) -> Self {
        let channels = samples.channels;
        let fields = AIR_FIELDS + usize::from(law.tells_ground());
        let [_, _, count] = sites.shape();
        let (level, offset) = level(&samples, count, suns);
        let at_suns = suns.at_suns(&level);
        let scale = |sun: usize, c: usize| (at_suns[(sun, c)] + offset).exp();
        let whole = sites.shape().iter().product::<usize>();
        let (black, ground) = split_albedo(&samples, law, whole, |site, c| scale(site % count, c));
        let parts = splitter.split_all(&black);
        let mut values = Vec::with_capacity(whole * fields * channels);
        for site in 0..whole {
            for f in 0..AIR_FIELDS {
                values.extend(parts.iter().map(|p| p[f][site]));
            }
            if law.tells_ground() {
                values.extend(ground.iter().map(|g| g[site] as f32));
            }
        }
        let relative = samples.values.iter().enumerate().map(|(i, value)| {
            let site = i / (samples.albedos * channels);
            (f64::from(*value) / scale(site % count, i % channels)) as f32
        });
        let share = |i: usize| law.ground_share(i / channels, i % channels) as f32;
        Self {
            radiance: relative.collect(),
            albedos: samples.albedos,
            ground_share: (0..samples.albedos * channels).map(share).collect(),
            phase: phases(&sites, fields),
            level: crate::decompose::row_major(&level),
            sites,
            fields,
            channels,
            values,
            offset: offset.exp(),
        }
    }

    /// Number of channels of all fields.
    pub fn width(&self) -> usize {
        self.fields * self.channels
    }

    /// What each field counts in the radiance of a channel, `out[field]`.
    pub fn shares(&self, site: usize, albedo: usize, channel: usize, out: &mut [f32]) {
        out.copy_from_slice(&self.phase[site * self.fields..][..self.fields]);
        if self.fields > AIR_FIELDS {
            out[AIR_FIELDS] *= self.ground_share[albedo * self.channels + channel];
        }
    }

    /// Radiance relative to the level.
    pub fn radiance(&self, site: usize, albedo: usize, channel: usize) -> f32 {
        self.radiance[(site * self.albedos + albedo) * self.channels + channel]
    }

    /// Mean over albedos and channels of the radiance relative to the level.
    pub fn brightness(&self, site: usize) -> f64 {
        let cell = &self.radiance[site * self.albedos * self.channels..];
        let cell = &cell[..self.albedos * self.channels];
        cell.iter().map(|l| f64::from(*l)).sum::<f64>() / cell.len() as f64
    }
}

/// Spline coefficients of the mean logarithm of the radiance, `[coefficient][channel]`, rounded to half precision, and
/// what was taken from all of them, so that they are small.
fn level(samples: &Samples, suns: usize, splines: &SunSplines) -> (Mat<f64>, f64) {
    let channels = samples.channels;
    let cell = samples.albedos * channels;
    let mut mean = Mat::<f64>::zeros(suns, channels);
    let mut seen = vec![0.0; suns];
    for sky in samples.values.chunks_exact(suns * cell) {
        // Directions in which there is nothing.
        if sky.iter().all(|l| *l == 0.0) {
            continue;
        }
        for (sun, site) in sky.chunks_exact(cell).enumerate() {
            seen[sun] += samples.albedos as f64;
            for (i, l) in site.iter().enumerate() {
                mean[(sun, i % channels)] += f64::from(*l);
            }
        }
    }
    let dark = Mat::from_fn(suns, channels, |e, c| {
        (DARK * mean[(e, c)] / f64::max(seen[e], 1.0)).max(1e-30)
    });
    let mut logarithm = Mat::<f64>::zeros(suns, channels);
    for sky in samples.values.chunks_exact(suns * cell) {
        if sky.iter().all(|l| *l == 0.0) {
            continue;
        }
        for (sun, site) in sky.chunks_exact(cell).enumerate() {
            for (i, l) in site.iter().enumerate() {
                let c = i % channels;
                logarithm[(sun, c)] +=
                    f64::from(*l).max(dark[(sun, c)]).ln() / f64::max(seen[sun], 1.0);
            }
        }
    }
    let largest = (0..suns * channels)
        .map(|i| logarithm[(i / channels, i % channels)])
        .fold(f64::NEG_INFINITY, f64::max);
    let offset = if largest.is_finite() { largest } else { 0.0 };
    let shifted = Mat::from_fn(suns, channels, |e, c| logarithm[(e, c)] - offset);
    let coefficients = splines.coefficients(&shifted);
    let rounded = Mat::from_fn(coefficients.nrows(), channels, |i, c| {
        f16::from_f64(coefficients[(i, c)]).to_f64()
    });
    (rounded, offset)
}

/// Light over black ground and from the ground, relative to a scale, `[channel][site]`.
fn split_albedo(
    samples: &Samples,
    law: &AlbedoLaw,
    sites: usize,
    scale: impl Fn(usize, usize) -> f64,
) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
    let channel = |c: usize| -> (Vec<f64>, Vec<f64>) {
        let parts = (0..sites).map(|site| {
            let values = (0..samples.albedos).map(|a| f64::from(samples.at(site, a, c)));
            let values: Vec<f64> = values.map(|l| l / scale(site, c)).collect();
            let [black, ground] = law.split(&values, c);
            (black, ground)
        });
        parts.unzip()
    };
    (0..samples.channels).map(channel).unzip()
}

fn phases(sites: &Sites, fields: usize) -> Vec<f32> {
    let cosines = sites.cosines();
    let row = |cosine: &f32| {
        let lobes = LOBES.map(|g| henyey_greenstein(g, f64::from(*cosine)) as f32);
        let all = [1.0].into_iter().chain(lobes).chain([1.0]);
        all.take(fields).collect::<Vec<f32>>()
    };
    cosines.iter().flat_map(row).collect()
}

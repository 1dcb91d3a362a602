//! The equations that a fit should fulfil, and what the factors say of them.

use super::factors::{Basis, row};
use super::normal::Normal;
use crate::decompose::Chunk;
use crate::successive_orders::{FIELDS, NW};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;

/// Albedos at which the radiance is compared.
pub const ALBEDOS: [f32; 3] = [0.0, 0.3, 1.0];
/// Weight of the relative error of a single field against that of the radiance.
const FIELD_WEIGHT: f32 = 0.4;
/// Fields of single scattering by particles, and the share of the radiance that they have at least around the sun.
const PARTICLES: [usize; 2] = [1, 2];
const LEAST_SHARE: f32 = 0.3;

/// Relative errors above this count linearly and not squared: at the edge of the Earth's shadow they are large whatever
/// the fit does, and must not cost what the rest could have.
const OUTLIER: f32 = 0.03;
/// Radiance below this share of its level counts less: nobody sees it, and it would cost what all see.
const DARK: f32 = 1e-4;
/// A linear equation: the radiance (or one field) at a site, a wavelength and an albedo, relative to what was traced.
pub struct Equation {
    /// Index of the wavelength.
    pub wavelength: usize,
    /// Factor of each field.
    pub share: [f32; FIELDS],
    /// What Σ share · field should be.
    pub target: f32,
    /// Square root of its weight.
    pub weight: f32,
}

impl Equation {
    /// All fields together are the radiance.
    pub fn radiance(chunk: &Chunk, site: usize, wavelength: usize, albedo: f32) -> Self {
        let (wavelength, share) = chunk.radiance_equation(site, wavelength, albedo);
        let brightness = chunk.brightness(site, wavelength, albedo);
        Self {
            wavelength,
            share,
            target: 1.0,
            weight: chunk.weight(site)
                * chunk.importance(wavelength)
                * (brightness / DARK).min(1.0),
        }
    }

    /// One of the fields is what was traced. Particles count at least a little around the sun: nearer to it, where there
    /// is no site, they may be all there is.
    pub fn field(&self, chunk: &Chunk, site: usize, field: usize) -> Self {
        let value = chunk.value(site, field, self.wavelength);
        let mut share = [0.0; FIELDS];
        share[field] = self.share[field];
        if PARTICLES.contains(&field) && chunk.is_near_sun(site) {
            // Relative to its estimate such a field is about 1.
            share[field] = share[field].max(LEAST_SHARE);
        }
        Self {
            wavelength: self.wavelength,
            share,
            target: share[field] * value,
            weight: self.weight * FIELD_WEIGHT,
        }
    }

    /// Σ_f share_f · channel_(f, w, r) for every r.
    pub fn mix(&self, basis: &Basis, out: &mut [f32]) {
        out.fill(0.0);
        for (f, share) in self.share.iter().enumerate() {
            if *share != 0.0 {
                let channel = row(&basis.channel, f * NW + self.wavelength, basis.rank);
                for (o, c) in out.iter_mut().zip(channel) {
                    *o += share * c;
                }
            }
        }
    }

    /// Root of the weight where the factors say `value`.
    pub fn robust_weight(&self, value: f32) -> f32 {
        let outlier = (self.target - value) / OUTLIER;
        self.weight * (1.0 + outlier * outlier).sqrt().sqrt().recip()
    }

    /// Adds itself, linear in `x` with the coefficients `coefficient`, to the normal equations of a step of `x`.
    #[inline(always)]
    pub fn push(&self, normal: &mut Normal, x: &[f32], coefficient: impl Fn(usize) -> f32) {
        normal.push(|column| {
            let mut value = 0.0;
            for (r, (x, entry)) in x.iter().zip(column.iter_mut()).enumerate() {
                let c = coefficient(r);
                value += c * x;
                *entry = c;
            }
            let weight = self.robust_weight(value);
            column.iter_mut().for_each(|entry| *entry *= weight);
            (self.target - value) * weight
        });
    }
}

/// The equations that are asked at a site: the radiance at three of the `nodes`, one of each third of them, and a random
/// albedo each, one field at one of them.
pub fn equations(chunk: &Chunk, nodes: &[usize], site: usize, rng: &mut Pcg64Mcg) -> [Equation; 4] {
    let draw = rng.next_u64() as usize;
    let radiance = |k: usize| {
        let albedo = ALBEDOS[(draw >> (8 + 8 * k)) % 3];
        let third = k * nodes.len() / 3..((k + 1) * nodes.len()).div_ceil(3);
        Equation::radiance(chunk, site, nodes[third.start + draw % third.len()], albedo)
    };
    let field = radiance(draw % 3).field(chunk, site, (draw >> 40) % FIELDS);
    [radiance(0), radiance(1), radiance(2), field]
}

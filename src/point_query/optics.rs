//! What all queries of a model share besides the chunks: phase functions, extinction and spherical albedo, with the
//! wavelengths in vectors.
#![allow(clippy::needless_range_loop)] // As in `contract`.

use super::chunk_table::limit;
use super::contraction::{MOST_CHANNELS, Spectrum, WIDTH};
use super::head_view::HeadView;
use super::query_coordinates::QueryCoordinates;
use crate::error::{Error, Result};
use crate::estimate::{Blocks, Estimator, MOST_BLOCKS};
use crate::format::{EstimateView, FIELD_ESTIMATE_SHIFT, FIELD_GROUND, MAX_ESTIMATE_CONSTITUENTS};
use crate::geometry::Planet;
use crate::kernel::axis::Stencil;
use crate::kernel::lanes::Lanes;
use crate::kernel::math::exp;
use crate::kernel::simd::Instructions;
use crate::phase_function::{henyey_greenstein, rayleigh};

/// Most fields and constituents.
const MOST: usize = 16;
const MOST_PHASES: usize = 64;
const MOST_EXTINCTION: usize = 512;
const MOST_ALBEDO: usize = 128;

type Block = Lanes<WIDTH>;

/// `blocks` vectors per row of each table.
pub(super) struct Light {
    wavelengths: usize,
    blocks: usize,
    constituents: usize,
    absorbers: u16,
    fields: usize,
    planet: Planet,
    /// Whether a field is Henyey-Greenstein, whether the ground reflected it, and the estimate that it is relative to.
    kind: [(bool, bool, u8); MOST],
    /// Coefficients of the phase functions, `[field][block]`.
    phase: [[Block; 3]; MOST_PHASES],
    /// `[visibility][constituent][block]`.
    extinction: [Block; MOST_EXTINCTION],
    /// `[visibility][block]`.
    spherical_albedo: [Block; MOST_ALBEDO],
}

impl Light {
    pub fn new(head: &HeadView) -> Result<Self> {
        let n = head.shape.wavelengths;
        let blocks = n.div_ceil(WIDTH);
        let rows = head.visibilities.len() * head.shape.constituents;
        limit("fields", head.fields.len(), MOST)?;
        limit("constituents", head.shape.constituents, MOST)?;
        limit(
            "blocks of phase functions",
            head.fields.len() * blocks,
            MOST_PHASES,
        )?;
        limit("blocks of extinction", rows * blocks, MOST_EXTINCTION)?;
        limit(
            "blocks of spherical albedo",
            head.visibilities.len() * blocks,
            MOST_ALBEDO,
        )?;
        let zero = Lanes::splat(0.0);
        let mut light = Self {
            wavelengths: n,
            blocks,
            constituents: head.shape.constituents,
            absorbers: head.absorbers,
            fields: head.fields.len(),
            planet: head.planet,
            kind: [(false, false, 0); MOST],
            phase: [[Lanes::splat(1.0); 3]; MOST_PHASES],
            extinction: [zero; MOST_EXTINCTION],
            spherical_albedo: [zero; MOST_ALBEDO],
        };
        for (i, value) in head.extinction.iter().enumerate() {
            light.extinction[i / n * blocks + i % n / WIDTH].0[i % n % WIDTH] = value.get() as f32;
        }
        for (i, value) in head.spherical_albedo.iter().enumerate() {
            let block = &mut light.spherical_albedo[i / n * blocks + i % n / WIDTH];
            block.0[i % n % WIDTH] = value.get() as f32;
        }
        for f in 0..light.fields {
            light.read_field(head, f)?;
        }
        Ok(light)
    }

    fn read_field(&mut self, head: &HeadView, f: usize) -> Result<()> {
        let code = head.fields[f].get();
        let ground = code & FIELD_GROUND != 0;
        let phase = code & !FIELD_GROUND & ((1 << FIELD_ESTIMATE_SHIFT) - 1);
        self.kind[f] = (phase == 2, ground, (code >> FIELD_ESTIMATE_SHIFT) as u8);
        let parameters = &head.phase_parameter[f * self.wavelengths..][..self.wavelengths];
        for (w, parameter) in parameters.iter().enumerate() {
            let coefficients = match phase {
                0 => [1.0, 0.0, 0.0],
                1 => {
                    let [a, b] = rayleigh(parameter.get());
                    [a, b, 0.0]
                }
                2 => henyey_greenstein(parameter.get()),
                _ => return Err(Error::invalid("field", "has an unknown code")),
            };
            let block = &mut self.phase[f * self.blocks + w / WIDTH];
            for (row, c) in block.iter_mut().zip(coefficients) {
                row.0[w % WIDTH] = c as f32;
            }
        }
        Ok(())
    }

    /// (1 − T) · ω · S · max(0, Σ fields · phase functions), block by block.
    #[inline(always)]
    pub fn mix(
        &self,
        place: &QueryCoordinates,
        channels: &[f32; MOST_CHANNELS],
        level: &Spectrum,
        (columns, estimates): (&[f32; MOST], Option<&Blocks>),
        out: &mut [f32],
    ) {
        let mut densities = *columns;
        for density in &mut densities {
            *density = exp(*density);
        }
        let albedo = Lanes::splat(place.albedo as f32);
        let one = Lanes::splat(1.0);
        for b in 0..self.blocks {
            let spherical = self.at(&self.spherical_albedo, 1, &place.visibilities.line, 0, b);
            let ground = albedo / (one - albedo * spherical);
            let mut sum = Lanes::splat(0.0);
            for f in 0..self.fields {
                let value = load(channels, f * self.wavelengths + b * WIDTH);
                let phase = self.phase_at(place, f, b);
                let light = if self.kind[f].1 { ground } else { one };
                sum = sum + self.whole(f, estimates, b, value * phase * light);
            }
            if estimates.is_some() {
                store(sum, b, out);
                continue;
            }
            let [mut extinction, mut scattering] = [Lanes::splat(0.0); 2];
            for k in 0..self.constituents {
                let n = self.constituents;
                let row = self.at(&self.extinction, n, &place.visibilities.line, k, b);
                let part = row * densities[k];
                extinction = extinction + part;
                if self.absorbers >> k & 1 == 0 {
                    scattering = scattering + part;
                }
            }
            let mut opacity = (extinction * place.ray.length as f32).one_minus_exp_neg();
            if self.absorbers != 0 {
                opacity = opacity * scattering / extinction.max(Lanes::splat(f32::MIN_POSITIVE));
            }
            let value = opacity * level[b].exp() * sum.max(Lanes::splat(0.0));
            store(value, b, out);
        }
    }

    /// A field, of which `value` is relative to its estimate.
    #[inline(always)]
    fn whole(&self, f: usize, estimates: Option<&Blocks>, b: usize, value: Block) -> Block {
        match estimates {
            None => value,
            Some(estimates) => value * estimates[b][usize::from(self.kind[f].2)],
        }
    }

    /// What the fields are relative to.
    #[inline(always)]
    pub fn estimates<I: Instructions>(
        &self,
        instructions: I,
        tables: &EstimateView,
        place: &QueryCoordinates,
    ) -> Blocks {
        let mut extinction = [[0.0; WIDTH]; MAX_ESTIMATE_CONSTITUENTS * MOST_BLOCKS];
        let n = self.constituents;
        for k in 0..n {
            for b in 0..self.blocks {
                let row = self.at(&self.extinction, n, &place.visibilities.line, k, b);
                extinction[k * self.blocks + b] = row.0;
            }
        }
        let estimator = Estimator {
            planet: self.planet,
            tables: *tables,
            extinction: &extinction,
        };
        estimator.along(instructions, instructions, &place.line)
    }

    /// Σ fields · phase functions, what Rayleigh scattering polarises of it, and A / (1 − A s), wavelength by
    /// wavelength.
    #[cfg(feature = "std")]
    #[inline(always)]
    pub fn fields<const N: usize>(
        &self,
        place: &QueryCoordinates,
        channels: &[f32; MOST_CHANNELS],
        estimates: Option<&Blocks>,
        [sums, dipoles, grounds]: [&mut [f32; N]; 3],
    ) {
        let albedo = Lanes::splat(place.albedo as f32);
        for b in 0..self.blocks {
            let spherical = self.at(&self.spherical_albedo, 1, &place.visibilities.line, 0, b);
            let ground = albedo / (Lanes::splat(1.0) - albedo * spherical);
            let [mut sum, mut dipole] = [Lanes::splat(0.0); 2];
            for f in 0..self.fields {
                let (particles, reflected, _) = self.kind[f];
                let mut value = load(channels, f * self.wavelengths + b * WIDTH);
                if reflected {
                    value = value * ground;
                }
                value = self.whole(f, estimates, b, value);
                sum = sum + value * self.phase_at(place, f, b);
                if !particles {
                    dipole = dipole + value * self.phase[f * self.blocks + b][1];
                }
            }
            let rows = [
                (&mut *sums, sum),
                (&mut *dipoles, dipole),
                (&mut *grounds, ground),
            ];
            for (row, lanes) in rows {
                row[b * WIDTH..][..WIDTH].copy_from_slice(&lanes.0);
            }
        }
    }

    #[inline(always)]
    fn phase_at(&self, place: &QueryCoordinates, f: usize, b: usize) -> Block {
        let [p, q, r] = self.phase[f * self.blocks + b];
        if self.kind[f].0 {
            let x = q + r * place.angle.versine;
            let x = x.max(Lanes::splat(f32::MIN_POSITIVE));
            return p / (x * x.sqrt());
        }
        p + q * place.angle.cosine_squared
    }

    /// Row `k` of `n` per visibility, at the visibility of the query.
    #[inline(always)]
    fn at(&self, table: &[Block], n: usize, stencil: &Stencil, k: usize, b: usize) -> Block {
        let weight = stencil.weight;
        let place = (stencil.first * n + k) * self.blocks + b;
        let low = table[place] * weight[0] as f32;
        if stencil.len == 1 {
            return low;
        }
        low + table[place + n * self.blocks] * weight[1] as f32
    }
}

/// Writes a block that is finite and not negative.
#[inline(always)]
fn store(value: Block, block: usize, out: &mut [f32]) {
    let value = value.max(Lanes::splat(0.0)).min(Lanes::splat(f32::MAX));
    let out = &mut out[block * WIDTH..];
    let n = out.len().min(WIDTH);
    out[..n].copy_from_slice(&value.0[..n]);
}

/// Eight channels from one on; beyond the last they are zero.
#[inline(always)]
fn load(channels: &[f32; MOST_CHANNELS], first: usize) -> Block {
    match channels[first..].first_chunk() {
        Some(whole) => Lanes(*whole),
        None => {
            let mut lanes = Lanes::splat(0.0);
            lanes
                .0
                .iter_mut()
                .zip(&channels[first..])
                .for_each(|(lane, c)| *lane = *c);
            lanes
        }
    }
}

//! What polarisation needs of a point query. Format specification, section 7.5.

use super::capacity::WAVELENGTH_BLOCKS;
use super::chunk_table::limit;
use super::contraction::{self, MOST_CHANNELS, MOST_RANK, WIDTH};
use super::evaluate::Query;
use super::opened::PointQuery;
use super::query_coordinates::{QueryCoordinates, Question};
use crate::conditions::Conditions;
use crate::error::{Error, Result};
use crate::format::{BasisView, FactorsView, ceil16};
use crate::geometry::Side;
use crate::kernel::lanes::Lanes;
use crate::kernel::simd::{Instructions, Kernel, dispatch};

const MOST_WAVELENGTHS: usize = WAVELENGTH_BLOCKS * WIDTH;

/// Factor matrices of the polarisation.
pub(crate) struct Factors<'a> {
    basis: BasisView<'a>,
    visibilities: usize,
    /// `[altitude][visibility]`.
    chunks: Vec<Option<FactorsView<'a>>>,
}

impl<'a> Factors<'a> {
    /// `chunks` are `[altitude][visibility]`, with this many of the latter.
    pub fn new(
        basis: BasisView<'a>,
        chunks: Vec<Option<FactorsView<'a>>>,
        visibilities: usize,
    ) -> Result<Self> {
        limit("components", basis.stride, MOST_RANK)?;
        limit("channels", ceil16(basis.channels), MOST_CHANNELS)?;
        if let Some(chunk) = chunks.iter().flatten().find(|c| c.rank > basis.rank) {
            let detail = format!("at most {} as the basis, got {}", basis.rank, chunk.rank);
            return Err(Error::invalid("rank of a polarisation chunk", detail));
        }
        Ok(Self {
            basis,
            visibilities,
            chunks,
        })
    }
}

/// One number per wavelength.
pub(crate) type Row = [f32; MOST_WAVELENGTHS];

/// Light in one direction, at each wavelength.
pub(crate) struct Parts {
    /// Relative radiance, sr⁻¹, finite and not negative.
    pub radiance: Row,
    /// The sum of the fields, each times its phase function, and what Rayleigh scattering polarises of them.
    pub sum: Row,
    pub dipole: Row,
    /// What was scattered more often, of Q and of U over the sine of the azimuth.
    pub scattered: [Row; 2],
}

impl PointQuery<'_> {
    /// As [`PointQuery::relative_radiance`], with what polarisation needs.
    pub(crate) fn parts(
        &self,
        factors: &Factors,
        conditions: &Conditions,
        direction: [f32; 3],
    ) -> Result<Parts> {
        dispatch(Polarised {
            model: self,
            factors,
            conditions,
            direction,
        })
    }
}

struct Polarised<'a, 'b> {
    model: &'b PointQuery<'a>,
    factors: &'b Factors<'b>,
    conditions: &'b Conditions,
    direction: [f32; 3],
}

impl Kernel for Polarised<'_, '_> {
    type Output = Result<Parts>;

    #[inline(always)]
    fn run<I: Instructions>(self, instructions: I) -> Result<Parts> {
        let model = self.model;
        let n = model.head.shape.wavelengths;
        let question = Question::new(&model.head, self.conditions, self.direction)?;
        let place = model.coordinates(&question);
        let query = Query::around(model, &place)?;
        let mut channels = [0.0; MOST_CHANNELS];
        let level = query.sum(instructions, &mut channels)?;
        let zero = [0.0; MOST_WAVELENGTHS];
        let mut parts = Parts {
            radiance: zero,
            sum: zero,
            dipole: zero,
            scattered: [zero; 2],
        };
        let out = &mut parts.radiance[..n];
        let densities = query.densities();
        let estimates = query.estimates(instructions);
        let relative = (&densities, estimates.as_ref());
        model.light.mix(&place, &channels, &level, relative, out);
        let mut ground = zero;
        let fields = [&mut parts.sum, &mut parts.dipole, &mut ground];
        model
            .light
            .fields(&place, &channels, estimates.as_ref(), fields);
        let mut channels = [0.0; MOST_CHANNELS];
        self.scattered(instructions, &place, &mut channels)?;
        for (part, out) in parts.scattered.iter_mut().enumerate() {
            let (sky, reflected) = (&channels[part * n..], &channels[(part + 2) * n..]);
            // U is odd in the azimuth: nothing of it stays under a vertical sun.
            let share = if part == 1 { place.fade as f32 } else { 1.0 };
            for w in 0..n {
                out[w] = share * (sky[w] + ground[w] * reflected[w]);
            }
            if let (Some(blocks), Some(tables)) = (&estimates, &model.estimate) {
                let diffuse = tables.scatters.len() - 1;
                for (w, value) in out[..n].iter_mut().enumerate() {
                    *value *= blocks[w / WIDTH][diffuse].0[w % WIDTH];
                }
            }
        }
        Ok(parts)
    }
}

impl Polarised<'_, '_> {
    /// Sums the chunks in each channel.
    #[inline(always)]
    fn scattered<I: Instructions>(
        &self,
        instructions: I,
        place: &QueryCoordinates,
        channels: &mut contraction::Channels,
    ) -> Result<()> {
        let factors = self.factors;
        let mut components = [Lanes::splat(0.0); MOST_RANK / contraction::WIDTH];
        for (a, over_altitude) in place.altitudes.taps() {
            for (v, over_visibility) in place.visibilities.taps() {
                let chunk = factors.chunks[a * factors.visibilities + v].as_ref();
                let chunk =
                    chunk.ok_or_else(|| self.model.missing("polarisation", Some(a), Some(v)))?;
                let rows = match place.ray.side {
                    Side::Up => chunk.alpha_up,
                    Side::Down => chunk.alpha_down,
                };
                let weight = (over_altitude * over_visibility) as f32;
                let sum = &mut components;
                contraction::add_chunk(instructions, chunk, rows, &place.curve, weight, sum);
            }
        }
        place.turn(instructions, &factors.basis, &mut components);
        contraction::project(instructions, &factors.basis, &components, channels);
        Ok(())
    }
}

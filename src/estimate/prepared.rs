//! The estimates at one visibility.

use zerocopy::little_endian::{F32, U32};

use super::blocks::{Blocks, WIDTH};
use super::sightline::Sightline;
use super::sums::Estimator;
use crate::format::EstimateView;
use crate::geometry::Planet;
use crate::kernel::simd::{Instructions, Kernel, Portable, dispatch};

/// The estimates of a model at one visibility.
///
/// ```
/// use welkin::estimate::{Estimates, Sightline};
/// use welkin::format::EstimateView;
/// use welkin::geometry::Planet;
///
/// // Of the air of a file, where `view` is its estimate chunk and `extinction` its row at a visibility.
/// fn glow(planet: Planet, view: &EstimateView, extinction: &[f64], line: &Sightline) -> f32 {
///     let estimates = Estimates::new(planet, view, extinction);
///     let mut rows = vec![0.0; estimates.len()];
///     estimates.along(line, &mut rows);
///     rows[0] // sr⁻¹ per unit of solar irradiance
/// }
/// ```
#[derive(Clone, Debug)]
pub struct Estimates {
    planet: Planet,
    wavelengths: usize,
    constituents: usize,
    angles: usize,
    suns: usize,
    densities: usize,
    stride: usize,
    sun_axis: [f32; 2],
    level: Vec<F32>,
    ring: Vec<F32>,
    scatters: Vec<U32>,
    albedo: Vec<F32>,
    density: Vec<F32>,
    column: Vec<F32>,
    light: Vec<F32>,
    extinction: Vec<[f32; WIDTH]>,
}

impl Estimates {
    /// From the tables of a model and the extinction at a visibility, `[constituents][wavelengths]`, m⁻¹.
    ///
    /// # Panics
    /// Where `extinction` does not have one row for each constituent.
    pub fn new(planet: Planet, tables: &EstimateView, extinction: &[f64]) -> Self {
        let wavelengths = extinction.len() / tables.constituents;
        Self {
            planet,
            wavelengths,
            constituents: tables.constituents,
            angles: tables.angles,
            suns: tables.suns,
            densities: tables.densities,
            stride: tables.light_stride,
            sun_axis: [tables.sun_lowest, tables.sun_width],
            level: tables.level.to_vec(),
            ring: tables.ring.to_vec(),
            scatters: tables.scatters.to_vec(),
            albedo: tables.albedo.to_vec(),
            density: tables.density.to_vec(),
            column: tables.column.to_vec(),
            light: tables.light.to_vec(),
            extinction: blocks(extinction, wavelengths),
        }
    }

    /// The same with the tables at these of `stored` wavelengths, of which alone `extinction` is given.
    pub(crate) fn at_nodes(
        planet: Planet,
        tables: &EstimateView,
        extinction: &[f64],
        nodes: &[usize],
    ) -> Self {
        let stride = nodes.len().next_multiple_of(WIDTH);
        let pick = |table: &[F32]| -> Vec<F32> {
            let row = |row: &[F32]| {
                let kept = nodes.iter().map(|&n| row[n]);
                kept.chain(core::iter::repeat(F32::ZERO))
                    .take(stride)
                    .collect::<Vec<F32>>()
            };
            table
                .chunks_exact(tables.light_stride)
                .flat_map(row)
                .collect()
        };
        Self {
            albedo: pick(tables.albedo),
            light: pick(tables.light),
            stride,
            ..Self::new(planet, tables, extinction)
        }
    }

    /// How many numbers there are: estimates × wavelengths.
    pub fn len(&self) -> usize {
        self.scatters.len() * self.wavelengths
    }

    /// Never: there is at least one estimate.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// The estimates along a ray, sr⁻¹ per unit of solar irradiance, `[estimate][wavelength]`.
    ///
    /// # Panics
    /// Unless `out` has [`Estimates::len`] elements.
    pub fn along(&self, line: &Sightline, out: &mut [f32]) {
        assert_eq!(out.len(), self.len(), "room for all estimates");
        let blocks = self.blocks(line);
        for (q, row) in out.chunks_exact_mut(self.wavelengths).enumerate() {
            for (w, value) in row.iter_mut().enumerate() {
                *value = blocks[w / WIDTH][q].0[w % WIDTH];
            }
        }
    }

    /// All estimates along a ray.
    #[inline]
    pub(crate) fn blocks(&self, line: &Sightline) -> Blocks {
        let estimator = self.estimator();
        dispatch(Along { estimator, line })
    }

    /// How many blocks of wavelengths there are.
    pub(crate) fn block_count(&self) -> usize {
        self.stride / WIDTH
    }

    /// How many estimates there are; the last is of diffuse light.
    pub(crate) fn count(&self) -> usize {
        self.scatters.len()
    }

    #[inline(always)]
    pub(crate) fn estimator(&self) -> Estimator<'_> {
        Estimator {
            planet: self.planet,
            tables: EstimateView {
                constituents: self.constituents,
                angles: self.angles,
                suns: self.suns,
                densities: self.densities,
                light_stride: self.stride,
                sun_lowest: self.sun_axis[0],
                sun_width: self.sun_axis[1],
                level: &self.level,
                ring: &self.ring,
                scatters: &self.scatters,
                albedo: &self.albedo,
                density: &self.density,
                column: &self.column,
                light: &self.light,
            },
            extinction: &self.extinction,
        }
    }

    pub(crate) fn bytes(&self) -> usize {
        let tables = [
            &self.level,
            &self.ring,
            &self.albedo,
            &self.density,
            &self.column,
            &self.light,
        ];
        let tables: usize = tables.iter().map(|t| size_of_val(t.as_slice())).sum();
        tables + size_of_val(self.scatters.as_slice()) + size_of_val(self.extinction.as_slice())
    }
}

/// Rows over wavelengths in blocks, padded with zeros.
fn blocks(table: &[f64], wavelengths: usize) -> Vec<[f32; WIDTH]> {
    let block = |values: &[f64]| core::array::from_fn(|i| values.get(i).map_or(0.0, |&v| v as f32));
    let rows = table.chunks_exact(wavelengths);
    rows.flat_map(|row| row.chunks(WIDTH).map(block)).collect()
}

/// [`Estimator::along`] with the instructions of the processor, but not fused: the same bits on all of them.
struct Along<'a, 'b> {
    estimator: Estimator<'a>,
    line: &'b Sightline,
}

impl Kernel for Along<'_, '_> {
    type Output = Blocks;

    #[inline(always)]
    fn run<I: Instructions>(self, instructions: I) -> Blocks {
        self.estimator.along(instructions, Portable, self.line)
    }
}

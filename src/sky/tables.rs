//! The tables of one sky and the inner loops over them. Format specification, section 7.2.
//!
//! Radiance is a bicubic B-spline over (angle from the horizon, azimuth) on each side of the horizon, node-major with
//! all channels of a node contiguous, so that a query is sixteen short rows times sixteen weights.

use crate::estimate::{Around, Blocks, Estimates, NOTHING, Sightline, WIDTH};
use crate::format::{AlphaAxis, Shape};
use crate::geometry::{Ray, Side};
use crate::kernel::axis::{Ends, Taps, alpha_coordinate, spline};
use crate::kernel::math::{LANES, bound, exp, one_minus_exp_neg};
use crate::phase_function::{PhaseTable, SunAngle};

/// Most constituents and most groups of fields that a file can have.
const MOST: usize = 16;
/// Groups of fields that stand together in a row.
const QUAD: usize = 4;

/// One block of wavelengths of four groups. Aligned so that it stands in one cache line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Cell(pub [f32; QUAD * LANES]);

impl Cell {
    pub const ZERO: Self = Self([0.0; QUAD * LANES]);

    #[inline(always)]
    pub fn add(&mut self, weight: f32, other: &Cell) {
        // A new array instead of sums in place: nothing can alias, so this vectorises.
        self.0 = core::array::from_fn(|i| self.0[i] + weight * other.0[i]);
    }
}

/// Where the channels stand in a row: `[block of wavelengths][quad of groups][group][lane]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Layout {
    blocks: usize,
    quads: usize,
}

impl Layout {
    pub fn new(groups: usize, wavelengths: usize) -> Self {
        Self {
            blocks: wavelengths.div_ceil(LANES),
            quads: groups.div_ceil(QUAD),
        }
    }

    /// Cell of a channel in a row, and its place in the cell.
    pub fn position(&self, group: usize, wavelength: usize) -> (usize, usize) {
        let cell = wavelength / LANES * self.quads + group / QUAD;
        (cell, group % QUAD * LANES + wavelength % LANES)
    }

    /// Blocks of wavelengths.
    #[inline(always)]
    pub fn blocks(&self) -> usize {
        self.blocks
    }

    /// First cell of a block of wavelengths in a row.
    #[inline(always)]
    pub fn cell(&self, block: usize) -> usize {
        block * self.quads
    }

    /// Cells in a row.
    pub fn cells(&self) -> usize {
        self.blocks * self.quads
    }
}

/// Coefficients on one side of the horizon.
#[derive(Clone, Debug)]
pub(crate) struct SideTable {
    axis: AlphaAxis,
    phi_coefficients: usize,
    constituents: usize,
    cells: usize,
    /// `[alpha][phi][cell]`.
    pub radiance: Vec<Cell>,
    /// ln n̄, `[alpha][constituent]`.
    column: Vec<f32>,
}

impl SideTable {
    pub fn zeros(axis: AlphaAxis, coefficients: usize, shape: &Shape, layout: &Layout) -> Self {
        let cells = layout.cells();
        Self {
            axis,
            phi_coefficients: shape.phi,
            constituents: shape.constituents,
            cells,
            radiance: vec![Cell::ZERO; coefficients * shape.phi * cells],
            column: vec![0.0; coefficients * shape.constituents],
        }
    }

    pub fn add_columns(&mut self, values: &[zerocopy::little_endian::F32], weight: f64) {
        for (sum, value) in self.column.iter_mut().zip(values) {
            *sum += (weight * f64::from(value.get())) as f32;
        }
    }

    /// Optical path of each constituent per unit of extinction: length times mean density, m.
    #[inline(always)]
    fn depths(&self, taps: &Taps, length: f64) -> [f32; MOST] {
        let mut depths = [0.0; MOST];
        let n = self.constituents;
        for (k, depth) in depths[..n].iter_mut().enumerate() {
            let terms = taps.index.iter().zip(taps.weight);
            let logarithm: f32 = terms.map(|(&i, w)| w * self.column[i * n + k]).sum();
            *depth = length as f32 * exp(logarithm);
        }
        depths
    }

    fn is_finite(&self) -> bool {
        // Without leaving the loop early, so that it vectorises.
        let finite =
            |all: bool, cell: &Cell| all & cell.0.iter().fold(true, |all, v| all & v.is_finite());
        self.radiance.iter().fold(true, finite) && self.column.iter().all(|v| v.is_finite())
    }

    fn bytes(&self) -> usize {
        size_of_val(self.radiance.as_slice()) + size_of_val(self.column.as_slice())
    }
}

/// All that a sky needs for its queries.
#[derive(Clone, Debug)]
pub(crate) struct Tables {
    pub layout: Layout,
    pub up: SideTable,
    pub down: SideTable,
    pub phases: Vec<PhaseTable>,
    /// What the fields are relative to, if not to (1 − T) · ω · S.
    pub estimates: Option<SkyEstimates>,
    /// S, `[block]`; empty where there are estimates.
    pub scale: Vec<[f32; LANES]>,
    /// Solar irradiance at the wavelengths, `[block]`.
    pub irradiance: Vec<[f32; LANES]>,
    /// K, `[constituent][block]`.
    pub extinction: Vec<[f32; LANES]>,
    /// Bit k: constituent k absorbs and does not scatter.
    pub absorbers: u16,
    /// `[block][X, Y, Z]`.
    pub xyz: Vec<[[f32; LANES]; 3]>,
}

/// Estimates of a model at the visibility of a sky.
#[derive(Clone, Debug)]
pub(crate) struct SkyEstimates {
    pub estimates: Estimates,
    /// Which of them each group of fields is relative to.
    pub of_group: Vec<usize>,
}

/// One block of wavelengths in one direction. Format specification, section 7.5.
pub(crate) struct Polarisable {
    /// Relative radiance, sr⁻¹, finite and not negative.
    pub radiance: [f32; LANES],
    /// The sum of the fields, each times its phase function.
    pub sum: [f32; LANES],
    /// D: what Rayleigh scattering polarises of the fields.
    pub dipole: [f32; LANES],
    /// What multiply scattered Q and U are relative to.
    pub diffuse: [f32; LANES],
}

/// One angle from the horizon, with the azimuth left open.
pub(crate) struct Row {
    /// `[phi][cell]`.
    cells: Vec<Cell>,
    depth: [f32; MOST],
    /// With any azimuth.
    line: Sightline,
    /// The estimates at all azimuths, where the sun is high.
    around: Option<Around>,
}

/// The place of an azimuth from the sun, 0..=π.
#[inline(always)]
pub(crate) fn azimuth(phi: f64, intervals: usize) -> Taps {
    let u = intervals as f64 * phi / core::f64::consts::PI;
    spline(u, intervals, Ends::Mirrored)
}

/// One direction, looked up: what all wavelengths share.
pub(crate) struct Lookup<'a> {
    up: bool,
    side: &'a SideTable,
    /// First cell of each of the 16 rows.
    row: [usize; 16],
    weight: [f32; 16],
    depth: [f32; MOST],
    estimates: Blocks,
    angle: SunAngle,
}

impl Tables {
    /// Finds the coefficients for a ray with the azimuth `phi` (0..=π from the sun).
    #[inline(always)]
    pub fn lookup(
        &self,
        (ray, line): (&Ray, &Sightline),
        phi: f64,
        phi_intervals: usize,
        angle: SunAngle,
    ) -> Lookup<'_> {
        let (side, alpha) = self.alpha(ray);
        let phi = azimuth(phi, phi_intervals);
        let stride = side.phi_coefficients * side.cells;
        let rows: [usize; 4] = core::array::from_fn(|k| alpha.index[k] * stride);
        let columns: [usize; 4] = core::array::from_fn(|k| phi.index[k] * side.cells);
        Lookup {
            up: ray.side == Side::Up,
            side,
            row: core::array::from_fn(|t| rows[t / 4] + columns[t % 4]),
            weight: core::array::from_fn(|t| alpha.weight[t / 4] * phi.weight[t % 4]),
            depth: self.depths(side, &alpha, ray.length),
            estimates: self.estimate(line),
            angle,
        }
    }

    /// The side of a ray and its place there.
    #[inline(always)]
    fn alpha(&self, ray: &Ray) -> (&SideTable, Taps) {
        let side = match ray.side {
            Side::Up => &self.up,
            Side::Down => &self.down,
        };
        let AlphaAxis {
            intervals,
            exponent,
        } = side.axis;
        let u = alpha_coordinate(ray.angle, ray.range, intervals, exponent);
        (side, spline(u, intervals, Ends::Free))
    }

    /// All azimuths at the angle of `ray` from the horizon.
    pub fn row(&self, ray: &Ray, line: Sightline) -> Row {
        let (side, alpha) = self.alpha(ray);
        let stride = side.phi_coefficients * side.cells;
        let mut cells = vec![Cell::ZERO; stride];
        for (index, weight) in alpha.index.into_iter().zip(alpha.weight) {
            let row = &side.radiance[index * stride..(index + 1) * stride];
            cells
                .iter_mut()
                .zip(row)
                .for_each(|(sum, cell)| sum.add(weight, cell));
        }
        Row {
            cells,
            depth: self.depths(side, &alpha, ray.length),
            line,
            around: self
                .estimates
                .as_ref()
                .and_then(|own| Around::new(&own.estimates, line)),
        }
    }

    #[inline(always)]
    fn depths(&self, side: &SideTable, alpha: &Taps, length: f64) -> [f32; MOST] {
        match self.estimates {
            None => side.depths(alpha, length),
            Some(_) => [0.0; MOST],
        }
    }

    #[inline(always)]
    fn estimate(&self, line: &Sightline) -> Blocks {
        match &self.estimates {
            None => NOTHING,
            Some(own) => own.estimates.blocks(line),
        }
    }

    /// What the fields of a group are relative to, besides (1 − T) · ω · S.
    #[inline(always)]
    fn relative_to(&self, estimates: &Blocks, group: usize, block: usize) -> [f32; LANES] {
        let Some(own) = &self.estimates else {
            return [1.0; LANES];
        };
        self.part(estimates, own.of_group[group], block)
    }

    #[inline(always)]
    fn part(&self, estimates: &Blocks, estimate: usize, block: usize) -> [f32; LANES] {
        let lanes = estimates[block * LANES / WIDTH][estimate].0;
        let halves = lanes.as_chunks::<LANES>().0;
        halves[block % (WIDTH / LANES)]
    }

    /// As [`Tables::radiance`], for a direction in a row.
    #[inline(always)]
    pub fn radiance_in(
        &self,
        row: &Row,
        (phi, azimuth_cosine): (&Taps, f64),
        angle: SunAngle,
        mut emit: impl FnMut(usize, [f32; LANES]),
    ) {
        let estimates = match &row.around {
            Some(around) => around.at(azimuth_cosine),
            None => self.estimate(&Sightline {
                azimuth: azimuth_cosine,
                ..row.line
            }),
        };
        let cells = self.layout.cells();
        for block in 0..self.layout.blocks {
            let mut sum = [0.0; LANES];
            for quad in 0..self.layout.quads {
                let mut cell = Cell::ZERO;
                for (index, weight) in phi.index.into_iter().zip(phi.weight) {
                    let place = index * cells + block * self.layout.quads + quad;
                    cell.add(weight, &row.cells[place]);
                }
                let fields = self.fields((angle, &estimates), quad, block, &cell);
                sum = core::array::from_fn(|i| sum[i] + fields[i]);
            }
            emit(block, self.finish(&row.depth, block, sum));
        }
    }

    /// Relative radiance (sr⁻¹), finite and not negative, handed to `emit` block by block of wavelengths.
    #[inline(always)]
    pub fn radiance(&self, lookup: &Lookup, mut emit: impl FnMut(usize, [f32; LANES])) {
        let mut block = 0;
        if self.layout.quads == 1 {
            // The usual case: some cells at a time share the work on weights and rows.
            while block + 3 <= self.layout.blocks {
                self.blocks::<3>(lookup, block, &mut emit);
                block += 3;
            }
            if block + 2 == self.layout.blocks {
                self.blocks::<2>(lookup, block, &mut emit);
                block += 2;
            }
        }
        while block < self.layout.blocks {
            let mut sum = [0.0; LANES];
            for quad in 0..self.layout.quads {
                let [cell] = lookup.gather(self.layout.cell(block) + quad);
                let fields = self.fields(lookup.light(), quad, block, &cell);
                sum = core::array::from_fn(|i| sum[i] + fields[i]);
            }
            emit(block, self.finish(&lookup.depth, block, sum));
            block += 1;
        }
    }

    /// [`Tables::radiance`] of `N` blocks of wavelengths whose groups are a quad.
    #[inline(always)]
    fn blocks<const N: usize>(
        &self,
        lookup: &Lookup,
        first: usize,
        emit: &mut impl FnMut(usize, [f32; LANES]),
    ) {
        let cells = lookup.gather::<N>(first);
        for (i, cell) in cells.iter().enumerate() {
            let fields = self.fields(lookup.light(), 0, first + i, cell);
            emit(first + i, self.finish(&lookup.depth, first + i, fields));
        }
    }

    /// Sum of the fields of a quad, each times its phase function and what it is relative to.
    #[inline(always)]
    fn fields(
        &self,
        (angle, estimates): (SunAngle, &Blocks),
        quad: usize,
        block: usize,
        cell: &Cell,
    ) -> [f32; LANES] {
        let mut sum = [0.0; LANES];
        let phases = self.phases.iter().enumerate().skip(quad * QUAD).take(QUAD);
        for ((g, phase), field) in phases.zip(cell.0.as_chunks::<LANES>().0) {
            let phase = phase.evaluate(block, angle);
            let whole = self.relative_to(estimates, g, block);
            sum = core::array::from_fn(|i| sum[i] + phase[i] * field[i] * whole[i]);
        }
        sum
    }

    /// One block of wavelengths, with what polarisation needs.
    #[inline(always)]
    pub fn polarisable(&self, lookup: &Lookup, block: usize) -> Polarisable {
        let (mut sum, mut dipole) = ([0.0; LANES], [0.0; LANES]);
        for quad in 0..self.layout.quads {
            let [cell] = lookup.gather(self.layout.cell(block) + quad);
            let fields = self.fields(lookup.light(), quad, block, &cell);
            sum = core::array::from_fn(|i| sum[i] + fields[i]);
            let phases = self.phases.iter().enumerate().skip(quad * QUAD).take(QUAD);
            for ((g, phase), field) in phases.zip(cell.0.as_chunks::<LANES>().0) {
                if let Some(strength) = phase.polarising(block) {
                    let whole = self.relative_to(&lookup.estimates, g, block);
                    dipole =
                        core::array::from_fn(|i| dipole[i] + strength[i] * field[i] * whole[i]);
                }
            }
        }
        let diffuse = match &self.estimates {
            None => [1.0; LANES],
            Some(own) => self.part(&lookup.estimates, own.estimates.count() - 1, block),
        };
        Polarisable {
            diffuse,
            radiance: self.finish(&lookup.depth, block, sum),
            sum,
            dipole,
        }
    }

    #[inline(always)]
    fn finish(&self, depth: &[f32; MOST], block: usize, sum: [f32; LANES]) -> [f32; LANES] {
        if self.estimates.is_some() {
            return sum.map(|sum| bound(sum, 0.0, f32::MAX));
        }
        let opacity = self.opacity(depth, block);
        let scale = &self.scale[block];
        // Only absurd tables can make these bounds count.
        core::array::from_fn(|i| bound(opacity[i] * scale[i] * sum[i].max(0.0), 0.0, f32::MAX))
    }

    /// Optical depth of the constituents that are not among `without`.
    #[inline(always)]
    fn depth(&self, lengths: &[f32; MOST], block: usize, without: u16) -> [f32; LANES] {
        let mut depth = [0.0; LANES];
        let rows = self.extinction.chunks_exact(self.layout.blocks);
        for (k, (row, length)) in rows.zip(lengths).enumerate() {
            if without >> k & 1 == 0 {
                for i in 0..LANES {
                    depth[i] += row[block][i] * length;
                }
            }
        }
        depth
    }

    /// (1 − T) · ω.
    #[inline(always)]
    fn opacity(&self, lengths: &[f32; MOST], block: usize) -> [f32; LANES] {
        let depth = self.depth(lengths, block, 0);
        let mut opacity = depth;
        // A plain loop: `map` over an array is not always inlined, and then does not vectorise.
        for value in &mut opacity {
            *value = one_minus_exp_neg(*value);
        }
        if self.absorbers != 0 {
            let scattering = self.depth(lengths, block, self.absorbers);
            for i in 0..LANES {
                opacity[i] *= scattering[i] / depth[i].max(f32::MIN_POSITIVE);
            }
        }
        opacity
    }

    pub fn is_finite(&self) -> bool {
        let rows = [&self.scale, &self.irradiance, &self.extinction];
        let finite = |v: &f32| v.is_finite();
        rows.iter().all(|r| r.as_flattened().iter().all(finite))
            && self.xyz.as_flattened().as_flattened().iter().all(finite)
            && self.up.is_finite()
            && self.down.is_finite()
    }

    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        let rows = [&self.scale, &self.irradiance, &self.extinction];
        let rows: usize = rows.iter().map(|r| size_of_val(r.as_slice())).sum();
        let phases: usize = self.phases.iter().map(PhaseTable::bytes).sum();
        let estimates = self
            .estimates
            .as_ref()
            .map_or(0, |own| own.estimates.bytes());
        self.up.bytes()
            + self.down.bytes()
            + estimates
            + phases
            + rows
            + size_of_val(self.xyz.as_slice())
    }
}

impl Lookup<'_> {
    #[inline(always)]
    fn light(&self) -> (SunAngle, &Blocks) {
        (self.angle, &self.estimates)
    }

    /// Which table of a pair the direction is in: the one above the horizon or the one below.
    #[inline(always)]
    pub fn is_up(&self) -> bool {
        self.up
    }

    /// The weighted sum of the 16 cells that stand beside cell `cell` of the rows in another table.
    #[inline(always)]
    pub fn gather_beside<const N: usize, T: AsRef<[f32; N]>>(
        &self,
        table: &[T],
        cell: usize,
    ) -> [f32; N] {
        let mut sum = [0.0; N];
        for (row, weight) in self.row.iter().zip(self.weight) {
            let values = table[row + cell].as_ref();
            sum = core::array::from_fn(|i| sum[i] + weight * values[i]);
        }
        sum
    }

    /// The weighted sums of the 16 rows in `N` cells.
    #[inline(always)]
    fn gather<const N: usize>(&self, cell: usize) -> [Cell; N] {
        let mut sums = [Cell::ZERO; N];
        for (row, weight) in self.row.iter().zip(self.weight) {
            let values = &self.side.radiance[row + cell..][..N];
            for (sum, values) in sums.iter_mut().zip(values) {
                sum.add(weight, values);
            }
        }
        sums
    }
}

//! From chunks to the tables of one sky: every axis but direction and wavelength is contracted here.

use crate::azimuth_fade::{azimuthal, fade_rows};
use crate::conditions::Conditions;
use crate::error::{Error, Result};
use crate::format::{
    BasisView, FactorsView, Field, Head, Kind, Payload16, PhaseFunction, altitude_node,
    visibility_node,
};
use crate::ground::reflected;
use crate::kernel::axis::{Ends, Stencil, Taps, hermite, linear, spline};
use crate::kernel::half::widen;
use crate::kernel::lanes::Lanes;
use crate::kernel::math::LANES;
use crate::kernel::simd::{Instructions, Kernel, dispatch};
use crate::model::{Key, Model, Nodes};
use crate::phase_function::PhaseTable;
use crate::sky::Sky;
use crate::sky::tables::{Cell, Layout, SideTable, SkyEstimates, Tables};
use zerocopy::little_endian::F32;

impl Sky {
    /// At some of the wavelength nodes of the file, or at all: what costs time from here on goes with those. `albedos`
    /// are those of the ground at the nodes.
    pub(crate) fn prepare(
        model: &Model,
        nodes: Nodes,
        conditions: &Conditions,
        albedos: &[f64],
    ) -> Result<Self> {
        let conditions = conditions.checked(model)?;
        let head = nodes.head;
        let place = NodeWeights::new(head, &conditions);
        model.prefetch(place.keys().chain(nodes.spectrum()))?;
        let interpolation = nodes.interpolation(model)?;
        let groups = Groups::new(head);
        let baker = Baker {
            model,
            nodes,
            place: &place,
            groups: &groups,
            fold: place.fold(head, albedos),
            elevation: spline(place.elevation, head.elevation.intervals, Ends::Free),
        };
        let (scale, [up, down]) = baker.sides()?;
        let tables = Tables {
            estimates: groups.estimates(model, nodes, &place)?,
            scale: if head.estimated { vec![] } else { pad(&scale) },
            irradiance: pad(&solar(head)),
            extinction: place.extinction(head),
            absorbers: head.absorbers,
            xyz: xyz(head),
            phases: groups.phases,
            layout: groups.layout,
            up,
            down,
        };
        if !tables.is_finite() {
            let detail = "its values overflow at these conditions: the file is not a sensible sky";
            return Err(Error::invalid("model", detail));
        }
        Ok(Self::new(head, conditions, tables, interpolation))
    }
}

/// Weights of the nodes around the conditions.
pub(crate) struct NodeWeights {
    pub altitudes: Stencil,
    pub visibilities: Stencil,
    visibilities_linear: Stencil,
    /// Coordinate on the elevation axis.
    pub elevation: f64,
    /// What the azimuth counts.
    pub fade: f64,
}

impl NodeWeights {
    pub fn new(head: &Head, conditions: &Conditions) -> Self {
        let visibilities = head.visibility_nodes();
        let x = visibility_node(conditions.visibility);
        Self {
            altitudes: hermite(&head.altitude_nodes(), altitude_node(conditions.altitude)),
            visibilities: hermite(&visibilities, x),
            visibilities_linear: linear(&visibilities, x),
            elevation: head.elevation.coordinate(conditions.solar_elevation),
            fade: azimuthal(conditions.solar_elevation.cos()),
        }
    }

    /// The chunks that the baker asks for.
    pub fn keys(&self) -> impl Iterator<Item = Key> {
        let columns = self
            .altitudes
            .taps()
            .map(|(a, _)| (Kind::Column, Some(a), None));
        let basis = [Kind::RadianceBasis, Kind::Estimate].map(|kind| (kind, None, None));
        self.keys_of(Kind::Radiance).chain(columns).chain(basis)
    }

    /// The chunks of a kind that has one for every altitude and visibility.
    pub fn keys_of(&self, kind: Kind) -> impl Iterator<Item = Key> {
        let altitudes = self.altitudes.taps();
        altitudes.flat_map(move |(a, _)| {
            let visibilities = self.visibilities.taps();
            visibilities.map(move |(v, _)| (kind, Some(a), Some(v)))
        })
    }

    /// A table `[visibility][n]` at the visibility of the sky, linear in 1/V.
    fn at_visibility(&self, table: &[f64], n: usize) -> Vec<f64> {
        let mut row = vec![0.0; n];
        for (v, weight) in self.visibilities_linear.taps() {
            for (sum, value) in row.iter_mut().zip(&table[v * n..(v + 1) * n]) {
                *sum += weight * value;
            }
        }
        row
    }

    /// What each channel `[field][wavelength]` is multiplied with: the light between ground and sky for ground fields.
    fn fold(&self, head: &Head, albedos: &[f64]) -> Vec<f32> {
        let ground = self.ground(head, albedos);
        let factor = |f: &Field, g: f32| if f.ground { g } else { 1.0 };
        let fields = head.fields.iter();
        fields
            .flat_map(|f| ground.iter().map(move |&g| factor(f, g)))
            .collect()
    }

    /// What light from the ground is multiplied with at each wavelength, given the albedos there: A / (1 − A s).
    pub fn ground(&self, head: &Head, albedos: &[f64]) -> Vec<f32> {
        let spherical = self.spherical_albedo(head);
        let pairs = albedos.iter().zip(spherical);
        pairs.map(|(&a, s)| reflected(a, s) as f32).collect()
    }

    /// s at each wavelength.
    pub fn spherical_albedo(&self, head: &Head) -> Vec<f64> {
        self.at_visibility(&head.spherical_albedo, head.wavelengths.len())
    }

    /// K per constituent, `[constituent][block]`.
    fn extinction(&self, head: &Head) -> Vec<[f32; LANES]> {
        let nw = head.wavelengths.len();
        let table = self.at_visibility(&head.extinction, head.constituents * nw);
        let narrow = |row: &[f64]| pad(&row.iter().map(|&k| k as f32).collect::<Vec<_>>());
        table.chunks_exact(nw).flat_map(narrow).collect()
    }
}

/// Fields with the same phase function and parameters are one group in the tables.
struct Groups {
    phases: Vec<PhaseTable>,
    /// What they are relative to.
    estimates: Vec<usize>,
    layout: Layout,
    /// Position of each channel `[field][wavelength]` in a row of the tables.
    position: Vec<(usize, usize)>,
}

impl Groups {
    fn new(head: &Head) -> Self {
        let mut first: Vec<usize> = Vec::new();
        let mut group_of = Vec::new();
        for (f, field) in head.fields.iter().enumerate() {
            let same = |&g: &usize| same_phase(&head.fields[g], field);
            let group = first.iter().position(same).unwrap_or_else(|| {
                first.push(f);
                first.len() - 1
            });
            group_of.push(group);
        }
        let layout = Layout::new(first.len(), head.wavelengths.len());
        let wavelengths = 0..head.wavelengths.len();
        let place = |&g: &usize| wavelengths.clone().map(move |w| layout.position(g, w));
        Self {
            phases: first
                .iter()
                .map(|&f| PhaseTable::new(&head.fields[f]))
                .collect(),
            estimates: first.iter().map(|&f| head.fields[f].estimate).collect(),
            position: group_of.iter().flat_map(place).collect(),
            layout,
        }
    }
}

impl Groups {
    /// What the groups are relative to.
    fn estimates(
        &self,
        model: &Model,
        nodes: Nodes,
        place: &NodeWeights,
    ) -> Result<Option<SkyEstimates>> {
        let head = nodes.head;
        if !head.estimated {
            return Ok(None);
        }
        let width = head.constituents * head.wavelengths.len();
        let extinction = place.at_visibility(&head.extinction, width);
        Ok(Some(SkyEstimates {
            estimates: nodes.estimates(&model.estimate_chunk()?, &extinction),
            of_group: self.estimates.clone(),
        }))
    }
}

fn same_phase(a: &Field, b: &Field) -> bool {
    let none = a.phase == PhaseFunction::None;
    a.phase == b.phase && a.estimate == b.estimate && (none || a.parameter == b.parameter)
}

/// All that turns the chunks of a model into tables.
struct Baker<'a> {
    model: &'a Model,
    nodes: Nodes<'a>,
    place: &'a NodeWeights,
    groups: &'a Groups,
    /// Factor of each channel `[field][wavelength]`.
    fold: Vec<f32>,
    elevation: Taps,
}

impl Baker<'_> {
    /// S per wavelength and the tables above and below the horizon.
    fn sides(&self) -> Result<(Vec<f32>, [SideTable; 2])> {
        let head = self.nodes.head;
        let shape = head.shape();
        let basis = self.model.radiance_basis()?;
        let mut level = vec![0.0; shape.wavelengths];
        let mut alpha = [shape.up, shape.down].map(|n| vec![0.0; n * basis.rank]);
        let [mut up, mut down] = [(head.up, shape.up), (head.down, shape.down)]
            .map(|(axis, n)| SideTable::zeros(axis, n, &shape, &self.groups.layout));
        for (a, altitude_weight) in self.place.altitudes.taps() {
            if !head.estimated {
                let column = self.model.column_chunk(a)?.values;
                let (above, below) = column.split_at(shape.up * shape.constituents);
                up.add_columns(above, altitude_weight);
                down.add_columns(below, altitude_weight);
            }
            for (v, visibility_weight) in self.place.visibilities.taps() {
                let chunk = self.model.radiance_chunk(a, v)?;
                let weight = (altitude_weight * visibility_weight) as f32;
                if !head.estimated {
                    self.add_level(&chunk, weight, &mut level);
                }
                let own = OwnFactors {
                    rank: chunk.rank,
                    stride: chunk.stride,
                    scale: chunk.scale,
                    elevation: chunk.elevation,
                    alpha: [chunk.alpha_up, chunk.alpha_down],
                };
                own.add_to(&mut alpha, basis.rank, &self.elevation, weight);
            }
        }
        let patterns = self.patterns(&basis);
        for (alpha, side) in alpha.iter().zip([&mut up, &mut down]) {
            dispatch(Expand {
                patterns: &patterns,
                alpha,
                side,
            });
        }
        Ok((level.into_iter().map(f32::exp).collect(), [up, down]))
    }

    /// Adds the chunk's share of ln S.
    fn add_level(&self, chunk: &FactorsView, weight: f32, level: &mut [f32]) {
        let rows = self.elevation.index.iter().zip(self.elevation.weight);
        for (&i, tap) in rows {
            let row = self.nodes.row(chunk.level, i);
            for (sum, value) in level.iter_mut().zip(row) {
                *sum += weight * tap * value;
            }
        }
    }

    /// The shared factor matrices with the light between ground and sky folded in.
    fn patterns(&self, basis: &BasisView) -> Patterns {
        let rank = basis.rank;
        let cells = self.groups.layout.cells();
        let channels: Vec<usize> = self.nodes.channels(self.nodes.head.fields.len()).collect();
        let mut channel = vec![Cell::ZERO; cells * rank];
        for r in 0..rank {
            let values = &basis.channel[r * basis.channel_stride..][..basis.channels];
            let positions = self.groups.position.iter().zip(&self.fold);
            for (&stored, (&(cell, place), fold)) in channels.iter().zip(positions) {
                channel[r * cells + cell].0[place] += fold * widen(values[stored]);
            }
        }
        let mut phi = widen_rows(basis.phi, basis.stride, rank);
        fade_rows(&mut phi, rank, self.place.fade);
        Patterns { rank, phi, channel }
    }
}

/// The factor matrices of a chunk that belong to it alone.
pub(crate) struct OwnFactors<'a> {
    pub rank: usize,
    pub stride: usize,
    pub scale: &'a [F32],
    pub elevation: &'a Payload16,
    /// Above and below the horizon.
    pub alpha: [&'a Payload16; 2],
}

impl OwnFactors<'_> {
    /// Adds the rows over the angle from the horizon, each component times weight, scale and the factor of the solar
    /// elevation, to `sums`, which are as wide as the rank of the basis.
    pub fn add_to(&self, sums: &mut [Vec<f32>; 2], rank: usize, elevation: &Taps, weight: f32) {
        let at_sun = |r: usize| -> f32 {
            let taps = elevation.index.iter().zip(elevation.weight);
            taps.map(|(&i, w)| w * widen(self.elevation[i * self.stride + r]))
                .sum()
        };
        let mut factors = vec![0.0; self.stride];
        let scales = self.scale.iter().take(self.rank).enumerate();
        for (factor, (r, scale)) in factors.iter_mut().zip(scales) {
            *factor = weight * scale.get() * at_sun(r);
        }
        for (sums, matrix) in sums.iter_mut().zip(self.alpha) {
            dispatch(AddRows {
                factors: &factors,
                matrix,
                sums,
                rank,
            });
        }
    }
}

/// Adds rows that are as wide as there are factors, times those, to rows of width `rank`.
struct AddRows<'a> {
    factors: &'a [f32],
    matrix: &'a Payload16,
    sums: &'a mut [f32],
    rank: usize,
}

impl Kernel for AddRows<'_> {
    type Output = ();

    #[inline(always)]
    fn run<I: Instructions>(self, instructions: I) {
        let width = self.factors.len().min(self.rank);
        let (factors, last_factors) = self.factors[..width].as_chunks();
        let rows = self.matrix.chunks_exact(self.factors.len());
        for (sums, row) in self.sums.chunks_exact_mut(self.rank).zip(rows) {
            let (sums, last_sums) = sums[..width].as_chunks_mut();
            let (row, last) = row[..width].as_chunks();
            for ((sum, halves), &factor) in sums.iter_mut().zip(row).zip(factors) {
                *sum = (Lanes(*sum) + Lanes(factor) * instructions.widen(halves)).0;
            }
            for ((sum, &half), factor) in last_sums.iter_mut().zip(last).zip(last_factors) {
                *sum += factor * widen(half);
            }
        }
    }
}

/// What every component looks like over azimuth and channel.
struct Patterns {
    rank: usize,
    /// `[phi][rank]`.
    phi: Vec<f32>,
    /// `[rank][cell]`: the albedo is in it.
    channel: Vec<Cell>,
}

/// Fills the nodes of `side`, given the components' weights `[alpha][rank]`.
struct Expand<'a> {
    patterns: &'a Patterns,
    alpha: &'a [f32],
    side: &'a mut SideTable,
}

impl Kernel for Expand<'_> {
    type Output = ();

    #[inline(always)]
    fn run<I: Instructions>(self, _: I) {
        self.patterns.expand(self.alpha, self.side);
    }
}

/// Cells that are summed together: as many as stay in registers.
const TOGETHER: usize = 3;

impl Patterns {
    #[inline(always)]
    fn expand(&self, alpha: &[f32], side: &mut SideTable) {
        let cells = self.channel.len() / self.rank;
        let mut factors = vec![0.0; self.rank];
        let mut nodes = side.radiance.chunks_exact_mut(cells);
        for alpha in alpha.chunks_exact(self.rank) {
            // `zip` asks the azimuths first, so none of the nodes, which go on with the next row, is lost.
            for (phi, node) in self.phi.chunks_exact(self.rank).zip(&mut nodes) {
                for (factor, (a, p)) in factors.iter_mut().zip(alpha.iter().zip(phi)) {
                    *factor = a * p;
                }
                self.fill(&factors, node);
            }
        }
    }

    /// Sums all components in the cells of a node.
    #[inline(always)]
    fn fill(&self, factors: &[f32], node: &mut [Cell]) {
        let cells = node.len();
        let (groups, rest) = node.as_chunks_mut::<TOGETHER>();
        for (g, group) in groups.iter_mut().enumerate() {
            *group = self.sum(factors, cells, g * TOGETHER);
        }
        let first = groups.len() * TOGETHER;
        // Two at once take little longer than one.
        match rest.as_chunks_mut::<2>() {
            ([pair], _) => *pair = self.sum(factors, cells, first),
            (_, rest) => {
                for cell in rest {
                    [*cell] = self.sum(factors, cells, first);
                }
            }
        }
    }

    /// The sums stay in registers.
    #[inline(always)]
    fn sum<const N: usize>(&self, factors: &[f32], cells: usize, first: usize) -> [Cell; N] {
        let mut sums = [Cell::ZERO; N];
        for (&factor, row) in factors.iter().zip(self.channel.chunks_exact(cells)) {
            for (sum, cell) in sums.iter_mut().zip(&row[first..][..N]) {
                sum.add(factor, cell);
            }
        }
        sums
    }
}

/// Half-precision rows of width `stride` as single-precision rows of width `rank`.
pub(crate) fn widen_rows(table: &Payload16, stride: usize, rank: usize) -> Vec<f32> {
    let rows = table.chunks_exact(stride);
    rows.flat_map(|row| row[..rank].iter().map(|&h| widen(h)))
        .collect()
}

fn solar(head: &Head) -> Vec<f32> {
    let wavelengths = head.wavelengths.iter();
    wavelengths
        .map(|&l| head.solar_irradiance_at(l) as f32)
        .collect()
}

/// XYZ weights, `[block][X, Y, Z][lane]`.
fn xyz(head: &Head) -> Vec<[[f32; LANES]; 3]> {
    let component = |block: &[[f64; 3]], c: usize| {
        core::array::from_fn(|i| block.get(i).map_or(0.0, |xyz| xyz[c] as f32))
    };
    let blocks = head.xyz.chunks(LANES);
    blocks
        .map(|block| core::array::from_fn(|c| component(block, c)))
        .collect()
}

fn pad(values: &[f32]) -> Vec<[f32; LANES]> {
    let lane = |block: &[f32], i: usize| block.get(i).copied().unwrap_or(0.0);
    let blocks = values.chunks(LANES);
    blocks
        .map(|block| core::array::from_fn(|i| lane(block, i)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// However many cells there are, each is the sum over all components in their order, to the bit.
    #[test]
    fn all_cells_are_summed() {
        const RANK: usize = 7;
        for cells in 1..=13 {
            let value = |i: usize| (i as f32 * 0.37).sin();
            let cell = |c: usize| Cell(core::array::from_fn(|k| value(16 * c + k)));
            let patterns = Patterns {
                rank: RANK,
                phi: Vec::new(),
                channel: (0..RANK * cells).map(cell).collect(),
            };
            let factors: Vec<f32> = (0..RANK).map(|r| value(1000 + r)).collect();
            let mut node = vec![Cell::ZERO; cells];
            patterns.fill(&factors, &mut node);
            for (c, got) in node.iter().enumerate() {
                let mut sum = Cell::ZERO;
                for (r, &factor) in factors.iter().enumerate() {
                    sum.add(factor, &cell(r * cells + c));
                }
                assert_eq!(got.0, sum.0, "{c} of {cells}");
            }
        }
    }
}

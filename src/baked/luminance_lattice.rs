//! The luminance of a baked sky at all directions of a lattice: rows of one height share the most of a query.

use super::coordinates::LocalFrame;
use super::spline::{Taps, taps};
use super::spline_table::{ENVELOPE, SUN, Table};
use crate::kernel::lanes::Lanes;
use crate::kernel::simd::{Instructions, Kernel};

/// Azimuths that are looked up together.
const WIDTH: usize = 8;
/// Channel of the luminance.
const Y: usize = 1;

/// The lattice; the result is `[height][azimuth]`, cd m⁻².
pub(super) struct LuminanceLattice<'a> {
    pub table: &'a Table<4>,
    pub frame: &'a LocalFrame,
    /// z of unit vectors.
    pub heights: &'a [f32],
    /// From the sun's, rad.
    pub azimuths: &'a [f32],
}

/// Azimuths, looked up.
struct Columns {
    taps: Taps<WIDTH>,
    cosine: Lanes<WIDTH>,
    sine: Lanes<WIDTH>,
}

impl Columns {
    /// The last ones may be fewer.
    fn new(azimuths: &[f32], intervals: u32) -> Self {
        let mut phi = Lanes::splat(0.0);
        phi.0[..azimuths.len()].copy_from_slice(azimuths);
        let half_sine = phi.map(|phi| (0.5 * phi).sin());
        Self {
            taps: taps(half_sine, Lanes::splat(intervals as f32)),
            cosine: phi.map(f32::cos),
            sine: phi.map(f32::sin),
        }
    }
}

impl Kernel for LuminanceLattice<'_> {
    type Output = Vec<f32>;

    #[inline(always)]
    fn run<I: Instructions>(self, _: I) -> Vec<f32> {
        let intervals = self.table.grid.azimuth;
        let azimuths = self.azimuths.chunks(WIDTH);
        let columns: Vec<Columns> = azimuths.map(|a| Columns::new(a, intervals)).collect();
        let envelope: [f32; ENVELOPE] = core::array::from_fn(|i| self.table.envelope[i].0[Y]);
        let mut row = vec![0.0; self.table.grid.columns()];
        let mut out = Vec::with_capacity(self.heights.len() * self.azimuths.len());
        for &z in self.heights {
            let opacity = self.row(z, &mut row);
            let mut left = self.azimuths.len();
            for columns in &columns {
                let sun = taps(self.half_angle(z, columns), Lanes::splat(SUN as f32));
                let logarithm = weighted(&row, &columns.taps) + weighted(&envelope, &sun);
                let luminance = (logarithm.exp2() * opacity).max(Lanes::splat(0.0));
                out.extend_from_slice(&luminance.0[..left.min(WIDTH)]);
                left = left.saturating_sub(WIDTH);
            }
        }
        out
    }
}

impl LuminanceLattice<'_> {
    /// Coefficients over the azimuth at a height; returns the opacity there.
    #[inline(always)]
    fn row(&self, z: f32, row: &mut [f32]) -> f32 {
        let level = (1.0 - z * z).max(0.0).sqrt();
        let point = self.frame.locate([level, 0.0, z].map(|v| Lanes([v])));
        let grid = self.table.grid;
        let (intervals, skipped) = match point.side.0[0] >= 0.0 {
            true => (grid.up, 0),
            false => (grid.down, grid.up + 3),
        };
        let taps = taps(point.row, Lanes::splat(intervals as f32));
        let first = (skipped + taps.first[0]) as usize;
        row.fill(0.0);
        for (k, weight) in taps.weight.iter().enumerate() {
            let cells = &self.table.cells[(first + k) * row.len()..];
            for (sum, cell) in row.iter_mut().zip(cells) {
                *sum += weight.0[0] * cell.0[Y];
            }
        }
        point.opacity.0[0]
    }

    /// Half the chord to the sun.
    #[inline(always)]
    fn half_angle(&self, z: f32, columns: &Columns) -> Lanes<WIDTH> {
        let [cosine, sine] = self.frame.sun_elevation();
        let level = (1.0 - z * z).max(0.0).sqrt();
        let x = columns.cosine * level - cosine;
        let y = columns.sine * level;
        let z = z - sine;
        ((x * x + y * y + z * z).sqrt() * 0.5).min(Lanes::splat(1.0))
    }
}

#[inline(always)]
fn weighted(coefficients: &[f32], taps: &Taps<WIDTH>) -> Lanes<WIDTH> {
    let mut sum = Lanes::splat(0.0);
    for (k, weight) in taps.weight.iter().enumerate() {
        let gathered = taps.first.map(|first| coefficients[first as usize + k]);
        sum = sum + Lanes(gathered) * *weight;
    }
    sum
}

#[cfg(all(test, feature = "default-model"))]
mod tests {
    use super::*;
    use crate::kernel::simd::dispatch;
    use crate::{BakedSky, Conditions, Model};

    #[test]
    fn a_lattice_has_the_luminance_of_single_directions() {
        let model = Model::default_model().unwrap();
        for (elevation, altitude) in [(0.3, 0.0), (-0.1, 9e3), (1.2, 60e3)] {
            let conditions = Conditions {
                solar_elevation: elevation,
                altitude,
                ..Conditions::default()
            };
            let sky = model.colour_sky(&conditions).unwrap();
            let baked = sky.bake(BakedSky::TOLERANCE).unwrap();
            let heights: Vec<f32> = (0..41).map(|i| -1.0 + 0.05 * i as f32).collect();
            let azimuths: Vec<f32> = (0..21).map(|i| 0.157 * i as f32).collect();
            let lattice = dispatch(LuminanceLattice {
                table: baked.table(),
                frame: &baked.frame(),
                heights: &heights,
                azimuths: &azimuths,
            });
            assert_eq!(lattice.len(), heights.len() * azimuths.len());
            for (i, got) in lattice.into_iter().enumerate() {
                let (z, phi) = (heights[i / azimuths.len()], azimuths[i % azimuths.len()]);
                let level = (1.0 - z * z).max(0.0).sqrt();
                let [_, y, _] = baked
                    .xyz([level * phi.cos(), level * phi.sin(), z])
                    .unwrap();
                assert!((got - y).abs() <= 1e-4 * y, "{z} {phi}: {got} {y}");
            }
        }
    }
}

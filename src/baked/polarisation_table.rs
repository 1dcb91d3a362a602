//! How polarised a baked sky is: bicubic B-splines of Q/I and U/(I sin φ) in the vertical frame, on the grid of the
//! radiance.
//!
//! Both are smooth wherever the radiance is: at the neutral points, in the aureole and, as the azimuth is an axis of
//! its own, at the poles. U over the sine of the azimuth is even in it, as Q is.

use super::comparison_sites::{Site, WIDTH, sites};
use super::coordinates::LocalFrame;
use super::frame_rotation::FrameRotation;
use super::grid_choice::{BakeError, Errors, bake, largest};
use super::grid_nodes::{GridNodes, Known};
use super::hemisphere_spline::{self, joined};
use super::refinement::Half;
use super::spline_table::{Grid, Spots, regrouped};
use crate::bands::Projection;
use crate::error::Result;
use crate::geometry::{Ray, Side};
use crate::kernel::lanes::Lanes;
use crate::phase_function::SunAngle;
use crate::polarisation::{PolarisedSky, Stokes};
use crate::sky::MOST_WAVELENGTHS;

/// Wavelengths that are computed together: those of the usual model.
pub(super) const LANES: usize = 12;
/// Q of them, then U.
pub(super) const PAIR: usize = 2 * LANES;

/// Bound of U/(I sin φ) of bands, as that of single wavelengths.
const MOST_U: f32 = 2.0;

/// The tables.
#[derive(Clone, Debug)]
pub(super) struct PolarisationTable {
    grid: Grid,
    /// Blocks of `LANES`.
    pub blocks: usize,
    /// `[block][up rows, then down rows][azimuth]`.
    cells: Vec<Lanes<PAIR>>,
}

/// Most bytes that they take, for `n` wavelengths.
pub(super) fn largest_table(n: usize) -> usize {
    n.div_ceil(LANES) * largest().cells() * size_of::<Lanes<PAIR>>()
}

/// Q/I and U/(I sin φ) on one side of the horizon.
struct Ratios<'a> {
    sky: &'a PolarisedSky,
    /// Bands that are made of the wavelengths, if they are.
    bands: Option<&'a Projection>,
    lattice: GridNodes<'a>,
    sites: Vec<Site>,
    /// `[site][direction][block]`.
    truth: Vec<Lanes<PAIR>>,
    known: Known<PAIR>,
}

impl<'a> Ratios<'a> {
    fn new(
        sky: &'a PolarisedSky,
        bands: Option<&'a Projection>,
        side: Side,
        frame: &LocalFrame,
    ) -> Self {
        let lattice = GridNodes {
            sky: sky.sky(),
            side,
        };
        let mut half = Self {
            sky,
            bands,
            lattice,
            sites: sites(lattice, frame),
            truth: Vec::new(),
            known: Known::new(count(sky, bands).div_ceil(LANES)),
        };
        let rows = half.sites.iter();
        half.truth = rows
            .flat_map(|site| half.along(&site.ray, &site.azimuths))
            .collect();
        half
    }

    /// `[azimuth][block]`.
    fn along(&self, ray: &Ray, azimuths: &[f64]) -> Vec<Lanes<PAIR>> {
        let blocks = self.channels().div_ceil(LANES);
        let mut out = vec![Lanes::splat(0.0); blocks * azimuths.len()];
        let angles = self.lattice.angles(ray, azimuths);
        let places = azimuths.iter().zip(angles).zip(out.chunks_mut(blocks));
        for ((&phi, angle), out) in places {
            match self.bands {
                None => self.sky.ratios(ray, phi, angle, |narrow, _, parts| {
                    let first = narrow * parts[0].len();
                    let pair = &mut out[first / LANES].0;
                    for (part, values) in parts.iter().enumerate() {
                        pair[part * LANES + first % LANES..][..values.len()]
                            .copy_from_slice(values);
                    }
                }),
                Some(bands) => self.in_bands(bands, ray, phi, angle, out),
            }
        }
        out
    }

    /// The same of bands: their Q and U over their radiance.
    fn in_bands(
        &self,
        bands: &Projection,
        ray: &Ray,
        phi: f64,
        angle: SunAngle,
        out: &mut [Lanes<PAIR>],
    ) {
        let mut nodes = [Stokes::default(); MOST_WAVELENGTHS];
        self.sky.ratios(ray, phi, angle, |block, radiance, [q, u]| {
            for (lane, &i) in radiance.iter().enumerate() {
                nodes[block * radiance.len() + lane] = Stokes {
                    i,
                    q: i * q[lane],
                    u: i * u[lane],
                };
            }
        });
        let mut light = [Stokes::default(); MOST_WAVELENGTHS];
        let light = &mut light[..bands.bands()];
        bands.apply_stokes(&nodes[..self.lattice.sky.wavelengths().len()], light);
        for (band, light) in light.iter().enumerate() {
            let share = 1.0 / light.i.max(f32::MIN_POSITIVE);
            let pair = &mut out[band / LANES].0;
            pair[band % LANES] = (light.q * share).clamp(-1.0, 1.0);
            pair[LANES + band % LANES] = (light.u * share).clamp(-MOST_U, MOST_U);
        }
    }
}

impl Half<PAIR> for Ratios<'_> {
    const CHANNELS: usize = LANES;

    fn channels(&self) -> usize {
        count(self.sky, self.bands)
    }

    fn sites(&self) -> &[Site] {
        &self.sites
    }

    fn truth(&self) -> &[Lanes<PAIR>] {
        &self.truth
    }

    fn known(&mut self) -> &mut Known<PAIR> {
        &mut self.known
    }

    #[inline(always)]
    fn row(&self, height: f64, azimuths: &[f64]) -> Vec<Lanes<PAIR>> {
        self.along(&self.lattice.ray(height), azimuths)
    }

    #[inline(always)]
    fn base<const W: usize>(&self, _: &Spots<W>, _: usize, _: usize) -> Lanes<PAIR> {
        Lanes::splat(0.0)
    }

    #[inline(always)]
    fn compare(
        &self,
        (site, _, i, _): (&Site, &Spots<WIDTH>, usize, usize),
        sum: Lanes<PAIR>,
        truth: &Lanes<PAIR>,
        count: usize,
        errors: &mut Errors,
    ) {
        let sine = site.azimuths[i].sin() as f32;
        let off = sum - *truth;
        let distance = |k: usize| off.0[k].hypot(off.0[LANES + k] * sine);
        errors.add((0..count).map(distance), site.parts[i]);
    }
}

/// Channels: wavelengths, or bands that are made of them.
fn count(sky: &PolarisedSky, bands: Option<&Projection>) -> usize {
    bands.map_or(sky.sky().wavelengths().len(), Projection::bands)
}

impl PolarisationTable {
    /// On the grid of a sky, or on a larger one if they need that, to which the sky must be refined then.
    pub fn new(
        sky: &PolarisedSky,
        bands: Option<&Projection>,
        grid: Grid,
        frame: &LocalFrame,
        tolerance: f64,
    ) -> Result<(Self, BakeError)> {
        let half = |side| bake(&mut Ratios::new(sky, bands, side, frame), side, tolerance);
        let ((up, up_errors), (down, down_errors)) = (half(Side::Up)?, half(Side::Down)?);
        let grid = hemisphere_spline::grid(up.size, down.size).or_larger(grid);
        let degrees = Self {
            grid,
            blocks: count(sky, bands).div_ceil(LANES),
            cells: joined(up, down, grid),
        };
        Ok((degrees, up_errors.and(down_errors).summary()))
    }

    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// Q/I and U/(I sin φ) of a block in the vertical frame for direction `i`.
    #[inline(always)]
    pub fn at<const W: usize>(&self, spots: &Spots<W>, i: usize, block: usize) -> Lanes<PAIR> {
        spots.surface(Lanes::splat(0.0), &self.grid, &self.cells, i, block)
    }

    /// Q/I, or U/(I sin φ) of groups of four: `[group][up rows, then down rows][azimuth]`.
    pub fn regrouped(&self, groups: usize, part: usize) -> Vec<[f32; 4]> {
        regrouped(
            &self.cells,
            self.grid.cells(),
            groups,
            [part * LANES, LANES],
        )
    }

    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        size_of_val(self.cells.as_slice())
    }
}

/// Q/I and U/I of a block in the frame of the caller, for direction `i`. Where a spline overshoots, the light can be
/// more than wholly polarised.
#[inline(always)]
pub(super) fn turned<const W: usize>(
    values: &Lanes<PAIR>,
    turn: &FrameRotation<W>,
    i: usize,
) -> [Lanes<LANES>; 2] {
    let ([c, s], sine) = (turn.double.map(|d| d.0[i]), turn.sine.0[i]);
    let (mut q, mut u) = (Lanes::splat(0.0), Lanes::splat(0.0));
    q.0.copy_from_slice(&values.0[..LANES]);
    u.0.copy_from_slice(&values.0[LANES..]);
    [q * c + u * (s * sine), u * (c * sine) - q * s]
}

//! Makes the tables of a baked sky from a prepared one.

use super::comparison_sites::{Site, WIDTH, sites};
use super::coordinates::{LocalFrame, opaque_length};
use super::grid_choice::{BakeError, Errors, Refinable, bake, difference};
use super::grid_nodes::{GridNodes, Known};
use super::hemisphere_spline::{grid, joined};
use super::refinement::Half;
use super::spline::{Start, coefficients, taps};
use super::spline_size::Size;
use super::spline_table::{ENVELOPE, Grid, SUN, Spots, Table, envelope};
use crate::error::Result;
use crate::geometry::{Ray, Side};
use crate::kernel::lanes::Lanes;
use crate::kernel::simd::{Instructions, Kernel, dispatch};
use crate::phase_function::SunAngle;
use crate::sky::Sky;

/// What a table holds: positive linear functions of the spectrum of relative radiance.
pub(crate) trait Channels<const N: usize> {
    /// Blocks of `N` channels.
    fn blocks(&self) -> usize;
    /// Channels in all blocks that exist.
    fn count(&self) -> usize;
    /// Hands over the channels of each block; those that do not exist are 1.
    fn project(&self, radiance: &[f32], emit: impl FnMut(usize, Lanes<N>));
}

/// Differences count relative to the radiance, or to this share of the brightest direction where that is more: seen
/// from the stratosphere at dusk, skies fade by ten powers of ten.
pub(super) const DARK: f32 = 1e-5;
/// Radiance is not less than this share of the brightest: logarithms need an end where a fit has gone below zero.
const FLOOR: f32 = 1e-8;

/// Makes a table that keeps a tolerance.
pub(super) fn table<const N: usize>(
    sky: &Sky,
    channels: &impl Channels<N>,
    frame: &LocalFrame,
    tolerance: f64,
) -> Result<(Table<N>, BakeError)> {
    let envelope = dispatch(Envelope::<_, N> { sky, channels });
    let half = |side| {
        let mut half = Radiance::new(GridNodes { sky, side }, channels, frame, &envelope);
        bake(&mut half, side, tolerance)
    };
    let ((up, up_errors), (down, down_errors)) = (half(Side::Up)?, half(Side::Down)?);
    let grid = grid(up.size, down.size);
    let table = Table {
        grid,
        cells: joined(up, down, grid),
        envelope,
    };
    Ok((table, up_errors.and(down_errors).summary()))
}

/// Makes a table of a given size, without measuring its error.
pub(super) fn table_of<const N: usize>(
    sky: &Sky,
    channels: &impl Channels<N>,
    grid: Grid,
) -> Table<N> {
    let envelope = dispatch(Envelope::<_, N> { sky, channels });
    let half = |side, rows| {
        let nodes = GridNodes { sky, side };
        let columns = grid.azimuth;
        Radiance::unmeasured(nodes, channels, &envelope).surface(Size { rows, columns })
    };
    let (up, down) = (half(Side::Up, grid.up), half(Side::Down, grid.down));
    Table {
        grid,
        cells: joined(up, down, grid),
        envelope,
    }
}

/// What the phase functions make of the light that comes from beside the sun: smooth where the sky is not.
struct Envelope<'a, C, const N: usize> {
    sky: &'a Sky,
    channels: &'a C,
}

impl<const N: usize, C: Channels<N>> Kernel for Envelope<'_, C, N> {
    type Output = Vec<Lanes<N>>;

    #[inline(always)]
    fn run<I: Instructions>(self, _: I) -> Vec<Lanes<N>> {
        let beside_sun = self.sky.row(&self.beside_sun());
        let mut radiance = vec![0.0; self.sky.wavelengths().len()];
        let mut values = vec![Vec::new(); self.channels.blocks()];
        for i in 0..=SUN {
            let half_sine = f64::from(i) / f64::from(SUN);
            let angle = SunAngle::from_versine(2.0 * half_sine * half_sine);
            self.sky.relative_in(&beside_sun, 0.0, angle, &mut radiance);
            self.channels.project(&radiance, |block, value| {
                values[block].push(value.max(Lanes::splat(f32::MIN_POSITIVE)).log2());
            });
        }
        let blocks = values.iter();
        blocks
            .flat_map(|values| coefficients(values, Start::Mirrored))
            .collect()
    }
}

impl<C, const N: usize> Envelope<'_, C, N> {
    /// The ray towards the sun; above the horizon, where the sun is below it.
    fn beside_sun(&self) -> Ray {
        const LOWEST: f64 = 0.05;
        let altitude = self.sky.conditions().altitude;
        let above_horizon = self.sky.conditions().solar_elevation + self.sky.dip();
        let planet = self.sky.planet();
        planet.ray_beside_horizon(altitude, Side::Up, above_horizon.max(LOWEST))
    }
}

/// The radiance on one side of the horizon.
struct Radiance<'a, C, const N: usize> {
    lattice: GridNodes<'a>,
    channels: &'a C,
    envelope: &'a [Lanes<N>],
    /// In the brightest direction, `[block]`.
    brightest: Vec<Lanes<N>>,
    sites: Vec<Site>,
    /// `[site][direction][block]`.
    truth: Vec<Lanes<N>>,
    known: Known<N>,
}

impl<'a, const N: usize, C: Channels<N>> Radiance<'a, C, N> {
    fn new(
        lattice: GridNodes<'a>,
        channels: &'a C,
        frame: &LocalFrame,
        envelope: &'a [Lanes<N>],
    ) -> Self {
        let mut half = Self {
            sites: sites(lattice, frame),
            brightest: vec![Lanes::splat(f32::MIN_POSITIVE); channels.blocks()],
            ..Self::unmeasured(lattice, channels, envelope)
        };
        half.truth = dispatch(Truth(&half));
        for truth in half.truth.chunks(channels.blocks()) {
            let pairs = half.brightest.iter_mut().zip(truth);
            pairs.for_each(|(most, value)| *most = most.max(*value));
        }
        half
    }

    /// With nothing to compare surfaces with.
    fn unmeasured(lattice: GridNodes<'a>, channels: &'a C, envelope: &'a [Lanes<N>]) -> Self {
        // At the sun all light is brightest, or nearly so.
        let beside_sun = envelope.iter().step_by(ENVELOPE);
        Self {
            lattice,
            channels,
            envelope,
            brightest: beside_sun.map(|logarithm| logarithm.exp2()).collect(),
            sites: Vec::new(),
            truth: Vec::new(),
            known: Known::new(channels.blocks()),
        }
    }

    /// Channels along a ray, `[azimuth][block]`, with the angle from the sun.
    #[inline(always)]
    fn along(&self, ray: &Ray, azimuths: &[f64], mut emit: impl FnMut(SunAngle, usize, Lanes<N>)) {
        let sky = self.lattice.sky;
        let row = sky.row(ray);
        let mut radiance = [0.0; crate::sky::MOST_WAVELENGTHS];
        let radiance = &mut radiance[..sky.wavelengths().len()];
        let angles = self.lattice.angles(ray, azimuths);
        for (&phi, angle) in azimuths.iter().zip(angles) {
            sky.relative_in(&row, phi, angle, radiance);
            let hand_on = |block, value| emit(angle, block, value);
            self.channels.project(radiance, hand_on);
        }
    }

    /// As in [`super::coordinates`]; 1 where no air is, as nothing can be divided by 0.
    fn opacity(&self, ray: &Ray) -> f32 {
        let opaque = opaque_length(self.lattice.sky.conditions());
        match ray.side {
            Side::Down if ray.length > 0.0 => (ray.length / (ray.length + opaque)) as f32,
            _ => 1.0,
        }
    }
}

impl<const N: usize, C: Channels<N>> Half<N> for Radiance<'_, C, N> {
    fn channels(&self) -> usize {
        self.channels.count()
    }

    fn sites(&self) -> &[Site] {
        &self.sites
    }

    fn truth(&self) -> &[Lanes<N>] {
        &self.truth
    }

    fn known(&mut self) -> &mut Known<N> {
        &mut self.known
    }

    /// log2 (radiance / opacity) without the envelope.
    #[inline(always)]
    fn row(&self, height: f64, azimuths: &[f64]) -> Vec<Lanes<N>> {
        let ray = self.lattice.ray(height);
        let scale = 1.0 / self.opacity(&ray);
        // All azimuths meet at the poles.
        let same = vec![0.0; azimuths.len()];
        let azimuths = if height == 1.0 { &same } else { azimuths };
        let mut values = Vec::with_capacity(azimuths.len() * self.channels.blocks());
        let intervals = Lanes::splat(SUN as f32);
        self.along(&ray, azimuths, |angle, block, value| {
            let sun = taps(Lanes([angle.half_sine()]), intervals);
            let value = value.max(self.brightest[block] * FLOOR);
            values.push((value * scale).log2() - envelope(self.envelope, &sun, 0, block));
        });
        values
    }

    #[inline(always)]
    fn base<const W: usize>(&self, spots: &Spots<W>, i: usize, block: usize) -> Lanes<N> {
        spots.envelope(self.envelope, i, block)
    }

    #[inline(always)]
    fn compare(
        &self,
        (site, spots, i, block): (&Site, &Spots<WIDTH>, usize, usize),
        sum: Lanes<N>,
        truth: &Lanes<N>,
        count: usize,
        errors: &mut Errors,
    ) {
        let got = sum.exp2() * spots.opacity.0[i];
        let least = self.brightest[block] * DARK;
        let pairs = got.0.iter().zip(&truth.0).zip(&least.0);
        let differences = pairs.map(|((&got, &truth), &least)| difference(got, truth, least));
        let differences = differences.take(count);
        errors.add(differences, site.parts[i]);
    }
}

/// What surfaces are compared with.
struct Truth<'a, 'b, C, const N: usize>(&'a Radiance<'b, C, N>);

impl<const N: usize, C: Channels<N>> Kernel for Truth<'_, '_, C, N> {
    type Output = Vec<Lanes<N>>;

    #[inline(always)]
    fn run<I: Instructions>(self, _: I) -> Vec<Lanes<N>> {
        let mut truth = Vec::new();
        for site in &self.0.sites {
            let emit = |_, _, value| truth.push(value);
            self.0.along(&site.ray, &site.azimuths, emit);
        }
        truth
    }
}

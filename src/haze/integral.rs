//! The integral along a segment. Format specification, section 7.7.
//!
//! In a panel the optical depths towards the observer and towards the sun are taken to grow linearly with what is seen, so that the
//! sunlight scattered there is a closed integral at each wavelength: exact for an exponential atmosphere. The diffuse source is
//! taken to be constant. Whatever happens, a panel sends no less than nothing.

use super::Haze;
use super::directions::{Components, Local, MOST_VECTORS};
use super::marks::Heaven;
use super::panels::{MOST_PANELS, Panels};
use super::source::Spot;
use super::stations::MOST_STATIONS;
use super::sunlight::{Sunlight, mean_share};
use crate::air::{Amounts, Segment, dot};
use crate::lanes::Lanes;
use crate::math::LANES;
use crate::phase::SunAngle;
use crate::polarisation::Plane;
use crate::simd::{Instructions, Kernel};

/// Most constituents that a file can have.
const MOST_CONSTITUENTS: usize = 16;
/// Where the sun stands lower than this (rad), panels crowd where it shines.
const LOW_SUN: f64 = 0.14;

/// Two panels, each for a block of wavelengths.
type Pair = Lanes<8>;

/// What a segment does to light, for one block of wavelengths.
pub(crate) struct Block {
    /// In-scattered light per unit of solar irradiance, sr⁻¹.
    pub scattered: [f32; LANES],
    /// Q and U of that light in the vertical frame of the segment; zero unless they are asked for.
    pub linear: [[f32; LANES]; 2],
    pub depth: [f32; LANES],
}

/// Light alone: the source of molecules and that of particles.
pub(crate) const UNPOLARISED: usize = 2;
/// And Q and U of what molecules scatter.
pub(crate) const POLARISED: usize = 4;

/// Hands what the segment does to `emit` block by block; `M` is [`UNPOLARISED`] or [`POLARISED`].
pub(crate) struct Integral<'a, const M: usize, F> {
    pub haze: &'a Haze,
    pub segment: &'a Segment,
    /// Counts where Q and U are asked for.
    pub plane: Plane,
    pub emit: F,
}

impl<const M: usize, F: FnMut(usize, Block)> Kernel for Integral<'_, M, F> {
    type Output = ();

    #[inline(always)]
    fn run<I: Instructions>(mut self, _: I) {
        let (haze, segment) = (self.haze, self.segment);
        let layers = &haze.air.layers;
        let sky = Heaven {
            sun: haze.sun,
            low: haze.conditions.solar_elevation < LOW_SUN,
        };
        let panels = Panels::place(layers, segment, &haze.grey, &sky);
        let mut sunlight = [Sunlight::default(); MOST_PANELS + 2];
        for (at, sunlight) in panels.ends[..=panels.count].iter().zip(&mut sunlight) {
            let place = Place::new(haze, segment, *at);
            *sunlight = haze.beam.at(layers, place.altitude, place.sun);
        }
        let mut shares = [Pair::splat(0.0); MOST_PANELS / 2];
        for i in 0..panels.count {
            let share = mean_share(sunlight[i].rise, sunlight[i + 1].rise);
            shares[i / 2].0[4 * (i % 2)..][..4].fill(share);
        }
        let mut views = [const { None }; MOST_STATIONS];
        let stations = &panels.stations;
        for (view, at) in views.iter_mut().zip(&stations.at[..stations.shares.len()]) {
            *view = Some(View::new(
                haze,
                segment,
                &self.plane,
                &Place::new(haze, segment, *at),
            ));
        }
        let angle = SunAngle::between(segment.direction, haze.sun);
        let mut sunlit = [[0.0; LANES]; MOST_CONSTITUENTS];
        let sunlit = &mut sunlit[..layers.constituents];
        let mut dipoles = [[0.0; LANES]; MOST_CONSTITUENTS];
        let dipoles = &mut dipoles[..layers.constituents];
        let single = self.plane.single().map(|part| part as f32);
        for block in 0..haze.irradiance.len() {
            haze.species.sunlit(block, angle, sunlit);
            if M == POLARISED {
                haze.species.dipoles(block, dipoles);
            }
            let mut diffuse = [[Pair::splat(0.0); M]; MOST_STATIONS];
            for (out, view) in diffuse.iter_mut().zip(views.iter().flatten()) {
                let source = haze.source.scattered(&view.spot, &view.seen, block);
                *out = source.map(|half| Pair::twice(&half));
            }
            let mut walk = Walk::start();
            let pairs = (0..panels.count).step_by(2);
            for ((i, share), weights) in pairs.zip(&shares).zip(&stations.weights) {
                let mut light = [Pair::splat(0.0); M];
                for (at, weight) in diffuse.iter().zip(weights) {
                    for (light, at) in light.iter_mut().zip(at) {
                        *light = *light + *at * *weight;
                    }
                }
                for light in &mut light[..2] {
                    *light = light.max(Pair::splat(0.0));
                }
                let two = Two {
                    columns: [&panels.columns[i], &panels.columns[i + 1]],
                    sunlight: [&sunlight[i], &sunlight[i + 1], &sunlight[i + 2]],
                    share: *share,
                };
                walk.step::<M>(two.scatter(haze, block, (sunlit, dipoles), single, &light));
            }
            (self.emit)(
                block,
                Block {
                    scattered: walk.scattered.0,
                    linear: walk.linear.map(|part| part.0),
                    depth: walk.depth.0,
                },
            );
        }
    }
}

/// Two panels in a row.
struct Two<'a> {
    columns: [&'a Amounts; 2],
    /// At their ends.
    sunlight: [&'a Sunlight; 3],
    /// Mean share of the sun's disc that is visible.
    share: Pair,
}

/// What two panels do to light.
struct Scattered {
    /// Light that each sends to its start.
    light: Pair,
    /// Its Q and U.
    linear: [Pair; 2],
    depth: Pair,
    /// 1 − transmittance.
    absorbed: Pair,
}

impl Two<'_> {
    /// `sunlit` and dipoles of each constituent, what Q and U of `single` scattering are per dipole, and the `diffuse` source of
    /// molecules, of particles and of Q and U.
    #[inline(always)]
    fn scatter<const M: usize>(
        &self,
        haze: &Haze,
        block: usize,
        (sunlit, dipoles): (&[[f32; LANES]], &[[f32; LANES]]),
        single: [f32; 2],
        diffuse: &[Pair; M],
    ) -> Scattered {
        let zero = Pair::splat(0.0);
        let (mut depth, mut start, mut end) = (zero, zero, zero);
        let (mut direct, mut molecules, mut particles) = (zero, zero, zero);
        let mut dipole = zero;
        for (k, (sunlit, polarised)) in sunlit.iter().zip(dipoles).enumerate() {
            let [a, b, c] = self.sunlight.map(|light| light.columns.get(k));
            let column = Pair::pair(self.columns[0].get(k), self.columns[1].get(k));
            let extinction = Pair::twice(haze.air.extinction.row(k, block));
            let [m, p] = haze.species.totals(k, block).map(Pair::twice);
            depth = depth + column * extinction;
            start = start + Pair::pair(a, b) * extinction;
            end = end + Pair::pair(b, c) * extinction;
            direct = direct + column * Pair::twice(sunlit);
            molecules = molecules + column * m;
            particles = particles + column * p;
            if M == POLARISED {
                dipole = dipole + column * Pair::twice(polarised);
            }
        }
        // The way to the sun and back to the start of the panel, from its start and from its end.
        let end = end + depth;
        let sun = between(start, end) * self.share;
        let absorbed = depth.one_minus_exp_neg();
        let mean = mean_transmittance(depth, absorbed);
        let mut linear = [zero; 2];
        if M == POLARISED {
            for (part, linear) in linear.iter_mut().enumerate() {
                *linear = dipole * sun * single[part] + molecules * diffuse[2 + part] * mean;
            }
        }
        let diffuse = molecules * diffuse[0] + particles * diffuse[1];
        let light = direct * sun + diffuse * mean;
        Scattered {
            light,
            linear,
            depth,
            absorbed,
        }
    }
}

/// Light and optical depth from the start of a segment to where one has got.
struct Walk {
    scattered: Lanes<LANES>,
    linear: [Lanes<LANES>; 2],
    through: Lanes<LANES>,
    depth: Lanes<LANES>,
}

impl Walk {
    #[inline(always)]
    fn start() -> Self {
        let [zero, one] = [0.0, 1.0].map(Lanes::splat);
        Self {
            scattered: zero,
            linear: [zero; 2],
            through: one,
            depth: zero,
        }
    }

    /// Goes on through two panels.
    #[inline(always)]
    fn step<const M: usize>(&mut self, two: Scattered) {
        let pass = (Pair::splat(1.0) - two.absorbed).halves();
        let (light, depth) = (two.light.halves(), two.depth.halves());
        let linear = two.linear.map(Pair::halves);
        for i in 0..2 {
            if M == POLARISED {
                for (sum, part) in self.linear.iter_mut().zip(&linear) {
                    *sum = *sum + Lanes(part[i]) * self.through;
                }
            }
            self.scattered = self.scattered + Lanes(light[i]) * self.through;
            self.through = self.through * Lanes(pass[i]);
            self.depth = self.depth + Lanes(depth[i]);
        }
    }
}

/// Mean transmittance of what begins and ends with these optical depths.
#[inline(always)]
fn between(a: Pair, b: Pair) -> Pair {
    let span = (a - b).abs();
    (-a.min(b)).exp() * mean_transmittance(span, span.one_minus_exp_neg())
}

/// Mean transmittance of what has this optical depth and takes away this share.
#[inline(always)]
fn mean_transmittance(depth: Pair, absorbed: Pair) -> Pair {
    // The limit is reached before the quotient loses its digits.
    const THIN: f32 = 1e-3;
    let thin = Pair::splat(1.0) - depth * 0.5;
    depth.at_least(THIN, absorbed / depth.max(Pair::splat(THIN)), thin)
}

/// A point of a segment.
struct Place {
    /// m.
    altitude: f64,
    /// Cosine of the zenith angle of the segment there.
    zenith: f64,
    /// Sine of the sun's elevation there.
    sun: f64,
}

impl Place {
    #[inline(always)]
    fn new(haze: &Haze, segment: &Segment, s: f64) -> Self {
        let radius = haze.air.planet().radius;
        let w = segment.line.lowest + s * s / (2.0 * radius);
        let altitude = 2.0 * w / (1.0 + (1.0 + 2.0 * w / radius).max(0.0).sqrt());
        let zenith = (s / (radius + altitude)).clamp(-1.0, 1.0);
        let sun = segment.sine_of(haze.sun, s, radius + altitude);
        Self {
            altitude,
            zenith,
            sun,
        }
    }
}

/// A place in the source and how its components look from there.
struct View<const M: usize> {
    spot: Spot,
    seen: [Components; M],
}

impl<const M: usize> View<M> {
    #[inline(always)]
    fn new(haze: &Haze, segment: &Segment, plane: &Plane, place: &Place) -> Self {
        let between = dot(segment.direction, haze.sun);
        let local = Local::new(place.zenith, place.sun, between);
        let directions = &haze.source.directions;
        let mut seen = [[Lanes::splat(0.0); MOST_VECTORS]; M];
        seen[..2].copy_from_slice(&directions.at(&local));
        if M == POLARISED {
            let level = (1.0 - place.sun * place.sun).max(1e-18).sqrt();
            let sine = (plane.sun[1] / level).clamp(-1.0, 1.0);
            seen[2..].copy_from_slice(&directions.polarised(&local, sine));
        }
        Self {
            spot: haze.source.spot(place.altitude as f32, place.sun as f32),
            seen,
        }
    }
}

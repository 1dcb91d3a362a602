//! The integral along a segment. Format specification, section 7.7.
//!
//! In a panel the optical depths towards the observer and towards the sun are taken to grow linearly with what is seen, so that the
//! sunlight scattered there is a closed integral at each wavelength: exact for an exponential atmosphere. The diffuse source is
//! taken to be constant. Whatever happens, a panel sends no less than nothing.

use super::Haze;
use super::directions::{Components, Local, MOST_VECTORS};
use super::disc::mean_shares;
use super::marks::Heaven;
use super::panels::{MOST_PANELS, MOST_PLACES, Panels};
use super::places::{BATCH, Places};
use super::source::Spot;
use super::stations::MOST_STATIONS;
use super::sunlight::Two;
use crate::air::{Amounts, QUADS, Segment, dot};
use crate::lanes::Lanes;
use crate::math::LANES;
use crate::phase::SunAngle;
use crate::polarisation::Plane;
use crate::simd::{Instructions, Kernel};

/// Most constituents that a file can have.
const MOST_CONSTITUENTS: usize = QUADS * LANES;
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
    /// Light that the air beyond the segment would send to its start if nothing stood between that air and the sun, and no ground in
    /// the way; zero unless it is asked for.
    pub beyond: [f32; LANES],
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
    /// Whether light from beyond the segment counts.
    pub beyond: bool,
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
        let pairs = panels.count.div_ceil(2);
        let stations = panels.stations;
        let mut places = [Places::default(); MOST_PLACES / BATCH];
        let used = panels.count + 1 + stations.shares.len();
        let (at, _) = panels.places.as_chunks();
        for (places, at) in places.iter_mut().zip(at).take(used.div_ceil(BATCH)) {
            *places = Places::new(&layers.planet(), segment, haze.sun, at);
        }
        let sunlight = Sunlight::new(haze, &places, panels.count);
        let mut views = [View::<M>::default(); MOST_STATIONS];
        let views = &mut views[..stations.shares.len()];
        let between = dot(segment.direction, haze.sun);
        for (i, view) in views.iter_mut().enumerate() {
            let i = panels.count + 1 + i;
            view.look(haze, &self.plane, between, &places[i / BATCH], i % BATCH);
        }
        let beyond = self
            .beyond
            .then(|| layers.columns(segment.line, segment.to(), f64::INFINITY));
        let angle = SunAngle::between(segment.direction, haze.sun);
        let mut sunlit = [[0.0; LANES]; MOST_CONSTITUENTS];
        let sunlit = &mut sunlit[..layers.quads * LANES];
        let mut dipoles = [[0.0; LANES]; MOST_CONSTITUENTS];
        let dipoles = &mut dipoles[..layers.quads * LANES];
        let single = self.plane.single().map(|part| part as f32);
        for block in 0..haze.irradiance.len() {
            haze.species.sunlit(block, angle, sunlit);
            if M == POLARISED {
                haze.species.dipoles(block, dipoles);
            }
            let mut diffuse = [[Pair::splat(0.0); M]; MOST_STATIONS];
            for (out, view) in diffuse.iter_mut().zip(views.iter()) {
                let source = haze.source.scattered(&view.spot, &view.seen, block);
                *out = source.map(|half| Pair::twice(&half));
            }
            let mut walk = Walk::start();
            let mut near = Beams::new(haze, block, &sunlight.columns[0]);
            for (i, weights) in stations.weights.iter().enumerate().take(pairs) {
                let mut light = [Pair::splat(0.0); M];
                for (at, weight) in diffuse.iter().zip(weights) {
                    for (light, at) in light.iter_mut().zip(at) {
                        *light = *light + *at * *weight;
                    }
                }
                for light in &mut light[..2] {
                    *light = light.max(Pair::splat(0.0));
                }
                let far = Beams::new(haze, block, &sunlight.columns[i + 1]);
                let sun = Sun {
                    start: near,
                    end: near.shift(&far),
                    share: sunlight.shares[i],
                };
                let air = Air::new::<M>(haze, block, &panels.columns[i], sunlit, dipoles);
                walk.step::<M>(air.scatter(&sun, single, &light));
                near = far;
            }
            let beyond = beyond
                .as_ref()
                .map(|columns| sunlit_beyond(haze, block, columns, sunlit, walk.depth));
            (self.emit)(
                block,
                Block {
                    scattered: walk.scattered.0,
                    linear: walk.linear.map(|part| part.0),
                    depth: walk.depth.0,
                    beyond: beyond.unwrap_or_default(),
                },
            );
        }
    }
}

/// Sunlight along a segment.
struct Sunlight {
    /// Columns towards the sun at the ends of panels, two at a time.
    columns: [Two; MOST_PANELS / 2 + 1],
    /// Mean share of the sun's disc that is visible, two panels at a time.
    shares: [Pair; MOST_PANELS / 2],
}

impl Sunlight {
    #[inline(always)]
    fn new(haze: &Haze, places: &[Places], panels: usize) -> Self {
        const PAIRS: usize = BATCH / 2;
        let mut out = Self {
            columns: [[Pair::splat(0.0); QUADS]; MOST_PANELS / 2 + 1],
            shares: [Pair::splat(0.0); MOST_PANELS / 2],
        };
        let pairs = (panels + 1).div_ceil(2);
        let mut rise = [0.0; MOST_PLACES + BATCH];
        for (i, columns) in out.columns.chunks_mut(PAIRS).enumerate() {
            let pairs = pairs.saturating_sub(i * PAIRS);
            if pairs > 0 {
                let heights = haze.beam.at(&haze.air.layers, &places[i], pairs, columns);
                rise[i * BATCH..][..BATCH].copy_from_slice(&heights.0);
            }
        }
        for (i, shares) in out.shares.chunks_mut(PAIRS).enumerate() {
            if i * BATCH < panels {
                let [a, b] = [0, 1].map(|end| Lanes::load(&rise, i * BATCH + end));
                let means = mean_shares(a, b).0;
                for (share, mean) in shares.iter_mut().zip(means.chunks_exact(2)) {
                    *share = Pair::pair(mean[0], mean[1]);
                }
            }
        }
        out
    }
}

/// Sunlight at two ends of panels, for a block of wavelengths.
#[derive(Clone, Copy)]
struct Beams {
    depth: Pair,
    through: Pair,
}

impl Beams {
    #[inline(always)]
    fn new(haze: &Haze, block: usize, columns: &Two) -> Self {
        let mut depth = Pair::splat(0.0);
        for (q, columns) in columns.iter().enumerate().take(haze.air.layers.quads) {
            for k in 0..LANES {
                let extinction = haze.air.extinction.row(q * LANES + k, block);
                depth = depth + columns.spread(k) * Pair::twice(extinction);
            }
        }
        Self {
            depth,
            through: (-depth).exp(),
        }
    }

    /// At the second of these ends and the first of the `next` two.
    #[inline(always)]
    fn shift(&self, next: &Self) -> Self {
        let join = |a: Pair, b: Pair| Pair::join(a.halves()[1], b.halves()[0]);
        Self {
            depth: join(self.depth, next.depth),
            through: join(self.through, next.through),
        }
    }
}

/// Sunlight at the ends of two panels.
struct Sun {
    start: Beams,
    end: Beams,
    /// Mean share of the disc that is visible.
    share: Pair,
}

impl Sun {
    /// Mean of what is left of sunlight at the start of a panel when it gets there by way of a point of the panel.
    #[inline(always)]
    fn mean(&self, depth: Pair, through: Pair) -> Pair {
        /// Differences of thinner panels lose their digits.
        const THIN: f32 = 0.1;
        let far = self.end.through * through;
        let step = self.end.depth + depth - self.start.depth;
        let size = step.abs();
        let mean = (self.start.through - far).abs() / size.max(Pair::splat(THIN));
        let series = step.map(|x| 1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0))));
        size.at_least(THIN, mean, self.start.through * series) * self.share
    }
}

/// What is in two panels, for a block of wavelengths.
struct Air {
    depth: Pair,
    /// What it scatters of sunlight.
    direct: Pair,
    /// Scattering by molecules and by particles.
    diffuse: [Pair; 2],
    /// Polarised by molecules.
    dipole: Pair,
}

/// What two panels do to light.
struct Scattered {
    /// Light that each sends to its start.
    light: Pair,
    /// Its Q and U.
    linear: [Pair; 2],
    depth: Pair,
    through: Pair,
}

impl Air {
    /// From columns, and `sunlit` and dipoles of each constituent.
    #[inline(always)]
    fn new<const M: usize>(
        haze: &Haze,
        block: usize,
        columns: &Two,
        sunlit: &[[f32; LANES]],
        dipoles: &[[f32; LANES]],
    ) -> Self {
        let zero = Pair::splat(0.0);
        let mut out = Self {
            depth: zero,
            direct: zero,
            diffuse: [zero; 2],
            dipole: zero,
        };
        for (q, columns) in columns.iter().enumerate().take(haze.air.layers.quads) {
            for lane in 0..LANES {
                let (k, column) = (q * LANES + lane, columns.spread(lane));
                out.depth = out.depth + column * Pair::twice(haze.air.extinction.row(k, block));
                out.direct = out.direct + column * Pair::twice(&sunlit[k]);
                for (sum, total) in out.diffuse.iter_mut().zip(haze.species.totals(k, block)) {
                    if let Some(total) = total {
                        *sum = *sum + column * Pair::twice(total);
                    }
                }
                if M == POLARISED {
                    out.dipole = out.dipole + column * Pair::twice(&dipoles[k]);
                }
            }
        }
        out
    }

    /// `single` is what Q and U of scattering once are per dipole; `diffuse` the source of molecules, of particles and of Q and U.
    #[inline(always)]
    fn scatter<const M: usize>(
        &self,
        sun: &Sun,
        single: [f32; 2],
        diffuse: &[Pair; M],
    ) -> Scattered {
        let absorbed = self.depth.one_minus_exp_neg();
        let through = Pair::splat(1.0) - absorbed;
        let sun = sun.mean(self.depth, through);
        let mean = mean_transmittance(self.depth, absorbed);
        let [molecules, particles] = self.diffuse;
        let mut linear = [Pair::splat(0.0); 2];
        if M == POLARISED {
            for (part, linear) in linear.iter_mut().enumerate() {
                *linear = self.dipole * sun * single[part] + molecules * diffuse[2 + part] * mean;
            }
        }
        let diffuse = molecules * diffuse[0] + particles * diffuse[1];
        Scattered {
            light: self.direct * sun + diffuse * mean,
            linear,
            depth: self.depth,
            through,
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
        let pass = two.through.halves();
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

/// What air with these columns sends through this depth where all of it is in the sun.
#[inline(always)]
fn sunlit_beyond(
    haze: &Haze,
    block: usize,
    columns: &Amounts,
    sunlit: &[[f32; LANES]],
    before: Lanes<LANES>,
) -> [f32; LANES] {
    let depth = Lanes(haze.air.extinction.depth(columns, block));
    let mut light = Lanes::splat(0.0);
    for (k, sunlit) in sunlit.iter().enumerate() {
        light = light + Lanes(*sunlit) * columns.get(k);
    }
    let mean = mean_transmittance(depth, depth.one_minus_exp_neg());
    (light * mean * (-before).exp()).0
}

/// Mean transmittance of what has this optical depth and takes away this share.
#[inline(always)]
fn mean_transmittance<const N: usize>(depth: Lanes<N>, absorbed: Lanes<N>) -> Lanes<N> {
    // The limit is reached before the quotient loses its digits.
    const THIN: f32 = 1e-3;
    let thin = Lanes::splat(1.0) - depth * 0.5;
    depth.at_least(THIN, absorbed / depth.max(Lanes::splat(THIN)), thin)
}

/// A place in the source and how its components look from there.
#[derive(Clone, Copy)]
struct View<const M: usize> {
    spot: Spot,
    seen: [Components; M],
}

impl<const M: usize> Default for View<M> {
    fn default() -> Self {
        Self {
            spot: Spot::default(),
            seen: [[Lanes::splat(0.0); MOST_VECTORS]; M],
        }
    }
}

impl<const M: usize> View<M> {
    /// Looks along a segment from one of its places; `between` is the cosine of the angle between its direction and the sun.
    #[inline(always)]
    fn look(&mut self, haze: &Haze, plane: &Plane, between: f64, places: &Places, i: usize) {
        let [zenith, sun] = [places.zenith, places.sun].map(|lanes| f64::from(lanes.0[i]));
        let local = Local::new(zenith, sun, between);
        let directions = &haze.source.directions;
        self.seen[..2].copy_from_slice(&directions.at(&local));
        if M == POLARISED {
            let level = (1.0 - sun * sun).max(1e-18).sqrt();
            let sine = (plane.sun[1] / level).clamp(-1.0, 1.0);
            self.seen[2..].copy_from_slice(&directions.polarised(&local, sine));
        }
        self.spot = haze.source.spot(places.altitude.0[i], places.sun.0[i]);
    }
}

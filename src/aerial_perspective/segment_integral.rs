//! The integral along a segment. Format specification, section 7.7.
//!
//! In a panel the optical depths towards the observer and towards the sun are taken to grow linearly with what is seen,
//! so that the sunlight scattered there is a closed integral at each wavelength: exact for an exponential atmosphere.
//! The diffuse source is taken to be constant. Whatever happens, a panel sends no less than nothing.

use super::angular_basis::{Components, MOST_VECTORS, Sightline};
use super::direct_sunlight::{DirectSunlight, Pair, Sun, Sunlight};
use super::light_estimate::SunEstimate;
use super::local_scattering::{POLARISED, PanelAir, Scattered, sunlit_beyond};
use super::path_points::{BATCH, PathPoints};
use super::prepared::AerialPerspective;
use super::quadrature_limits::{MOST_PATH_POINTS, MOST_SOURCE_NODES};
use super::quadrature_panels::Panels;
use super::source_table::Spot;
use crate::kernel::lanes::Lanes;
use crate::kernel::math::LANES;
use crate::kernel::simd::{Instructions, Kernel};
use crate::phase_function::SunAngle;
use crate::polarisation::Plane;
use crate::transmittance::{QUADS, Segment};

/// Most constituents that a file can have.
const MOST_CONSTITUENTS: usize = QUADS * LANES;
/// Where the sun stands lower than this (rad), panels crowd where it shines.
const LOW_SUN: f64 = 0.14;

/// What a segment does to light, for one block of wavelengths.
pub(crate) struct Block {
    /// In-scattered light per unit of solar irradiance, sr⁻¹.
    pub scattered: [f32; LANES],
    /// Q and U of that light in the vertical frame of the segment; zero unless they are asked for.
    pub linear: [[f32; LANES]; 2],
    pub depth: [f32; LANES],
    /// Light that the air beyond the segment would send to its start if nothing stood between that air and the sun, and
    /// no ground in the way; zero unless it is asked for.
    pub beyond: [f32; LANES],
}

/// Hands what the segment does to `emit` block by block; `M` is [`UNPOLARISED`] or [`POLARISED`].
pub(crate) struct Integral<'a, const M: usize, F> {
    pub aerial: &'a AerialPerspective,
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
        let (aerial, segment) = (self.aerial, self.segment);
        let layers = &aerial.air.layers;
        let (panels, places, line) = aerial.panels(segment);
        let path = Path::<M>::new(aerial, panels, &places, &line);
        let beyond = self
            .beyond
            .then(|| layers.columns(segment.line, segment.to(), f64::INFINITY));
        let mut light = Light::new(aerial, segment.direction, &self.plane);
        for block in 0..aerial.irradiance.len() {
            light.select::<M>(aerial, block);
            let mut walk = Walk::start();
            path.walk(aerial, block, &light, &mut walk, |_, _| {});
            let beyond = beyond
                .as_ref()
                .map(|columns| sunlit_beyond(aerial, block, columns, light.sunlit(), walk.depth));
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

/// How constituents scatter sunlight along a line, in one block of wavelengths.
pub(super) struct Light {
    angle: SunAngle,
    /// Q and U of light that is scattered once.
    single: [f32; 2],
    quads: usize,
    sunlit: [[f32; LANES]; MOST_CONSTITUENTS],
    dipoles: [[f32; LANES]; MOST_CONSTITUENTS],
}

impl Light {
    #[inline(always)]
    pub fn new(aerial: &AerialPerspective, direction: [f64; 3], plane: &Plane) -> Self {
        Self {
            angle: SunAngle::between(direction, aerial.sun),
            single: plane.single().map(|part| part as f32),
            quads: aerial.air.layers.quads,
            sunlit: [[0.0; LANES]; MOST_CONSTITUENTS],
            dipoles: [[0.0; LANES]; MOST_CONSTITUENTS],
        }
    }

    /// Goes over to a block.
    #[inline(always)]
    pub fn select<const M: usize>(&mut self, aerial: &AerialPerspective, block: usize) {
        let n = self.quads * LANES;
        (aerial.species).sunlit(block, self.angle, &mut self.sunlit[..n]);
        if M == POLARISED {
            aerial.species.dipoles(block, &mut self.dipoles[..n]);
        }
    }

    #[inline(always)]
    fn sunlit(&self) -> &[[f32; LANES]] {
        &self.sunlit[..self.quads * LANES]
    }
}

/// Panels with what all wavelengths share.
pub(super) struct Path<const M: usize> {
    panels: Panels,
    sunlight: Sunlight,
    views: [View<M>; MOST_SOURCE_NODES],
}

impl<const M: usize> Path<M> {
    #[inline(always)]
    pub fn new(
        aerial: &AerialPerspective,
        panels: Panels,
        places: &AllPlaces,
        line: &Sightline,
    ) -> Self {
        let mut views = [View::<M>::default(); MOST_SOURCE_NODES];
        let count = panels.stations.shares.len();
        for (i, view) in views[..count].iter_mut().enumerate() {
            let i = panels.count + 1 + i;
            view.look(aerial, line, &places[i / BATCH], i % BATCH);
        }
        Self {
            sunlight: Sunlight::new(aerial, places, panels.count),
            panels,
            views,
        }
    }

    /// Goes on along all panels in a block of wavelengths; `after` sees each panel's number and where the walk is then.
    #[inline(always)]
    pub fn walk(
        &self,
        aerial: &AerialPerspective,
        block: usize,
        light: &Light,
        walk: &mut Walk,
        mut after: impl FnMut(usize, &Walk),
    ) {
        let Self {
            panels, sunlight, ..
        } = self;
        let stations = panels.stations;
        let (sunlit, dipoles) = (light.sunlit(), &light.dipoles);
        let mut diffuse = [[Pair::splat(0.0); M]; MOST_SOURCE_NODES];
        let views = &self.views[..stations.shares.len()];
        for (out, view) in diffuse.iter_mut().zip(views) {
            let source = aerial.source.scattered(&view.spot, &view.seen, block);
            *out = source.map(|half| Pair::twice(&half));
        }
        let mut near = DirectSunlight::new(aerial, block, &sunlight.columns[0]);
        let pairs = panels.count.div_ceil(2);
        for (i, weights) in stations.weights.iter().enumerate().take(pairs) {
            let mut source = [Pair::splat(0.0); M];
            for (at, weight) in diffuse.iter().zip(weights) {
                for (source, at) in source.iter_mut().zip(at) {
                    *source = *source + *at * *weight;
                }
            }
            for source in &mut source[..2] {
                *source = source.max(Pair::splat(0.0));
            }
            let far = DirectSunlight::new(aerial, block, &sunlight.columns[i + 1]);
            let sun = Sun {
                start: near,
                end: near.shift(&far),
                share: sunlight.shares[i],
            };
            let air = PanelAir::new::<M>(aerial, block, &panels.columns[i], sunlit, dipoles);
            let two = air.scatter(&sun, light.single, &source);
            walk.step::<M>(&two, |half, walk| after(2 * i + half, walk));
            near = far;
        }
    }
}

/// Ends of panels, then stations, in batches.
pub(super) type AllPlaces = [PathPoints; MOST_PATH_POINTS / BATCH];

impl AerialPerspective {
    /// Where light is evaluated along a segment.
    #[inline(always)]
    pub(super) fn panels(&self, segment: &Segment) -> (Panels, AllPlaces, Sightline) {
        let panels = Panels::place(&self.air.layers, segment, &self.grey, &self.sun_estimate());
        let line = Sightline::new(segment, self.sun);
        let places = self.places(segment, &panels, &line);
        (panels, places, line)
    }

    #[inline(always)]
    pub(super) fn sun_estimate(&self) -> SunEstimate {
        SunEstimate {
            sun: self.sun,
            low: self.conditions.solar_elevation < LOW_SUN,
        }
    }

    /// Where the panels of a segment and their stations are.
    #[inline(always)]
    pub(super) fn places(&self, segment: &Segment, panels: &Panels, line: &Sightline) -> AllPlaces {
        let planet = self.air.layers.planet();
        let mut places = [PathPoints::default(); MOST_PATH_POINTS / BATCH];
        let used = panels.count + 1 + panels.stations.shares.len();
        let (at, _) = panels.places.as_chunks();
        for (places, at) in places.iter_mut().zip(at).take(used.div_ceil(BATCH)) {
            *places = PathPoints::new(&planet, segment, self.sun, line.nearest, at);
        }
        places
    }
}

/// Light and optical depth from the start of a segment to where one has got.
#[derive(Clone, Copy)]
pub(super) struct Walk {
    pub scattered: Lanes<LANES>,
    linear: [Lanes<LANES>; 2],
    through: Lanes<LANES>,
    pub depth: Lanes<LANES>,
}

impl Walk {
    #[inline(always)]
    pub fn start() -> Self {
        let [zero, one] = [0.0, 1.0].map(Lanes::splat);
        Self {
            scattered: zero,
            linear: [zero; 2],
            through: one,
            depth: zero,
        }
    }

    /// Goes on through two panels; `after` sees where it is after each.
    #[inline(always)]
    fn step<const M: usize>(&mut self, two: &Scattered, mut after: impl FnMut(usize, &Self)) {
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
            after(i, self);
        }
    }
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
    /// Looks along a segment from one of its places.
    #[inline(always)]
    fn look(
        &mut self,
        aerial: &AerialPerspective,
        line: &Sightline,
        places: &PathPoints,
        i: usize,
    ) {
        let local = line.local(places.zenith.0[i], places.slope.0[i]);
        let directions = &aerial.source.directions;
        self.seen[..2].copy_from_slice(&directions.at(&local));
        if M == POLARISED {
            self.seen[2..].copy_from_slice(&directions.polarised(&local));
        }
        self.spot = aerial.source.spot(places.altitude.0[i], places.sun.0[i]);
    }
}

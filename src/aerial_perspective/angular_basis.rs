//! How the components of the source look in every direction. Format specification, section 7.7.

use core::f64::consts::PI;

use super::spherical_harmonics::orders;
use crate::azimuth_fade::azimuthal_per_sine;
use crate::format::{MAX_MOMENTS, SourceBasisView, TENSOR};
use crate::kernel::lanes::Lanes;
use crate::kernel::math::asin;
use crate::polarisation::{PARALLEL, cross};
use crate::transmittance::{Segment, dot};

/// Components in a vector.
pub(crate) const WIDE: usize = 8;
/// Most components of the moments, in vectors.
pub(crate) const MOST_VECTORS: usize = MAX_MOMENTS / WIDE;
/// Zenith angles of the table: 1.5° apart.
const ANGLES: usize = 120;

/// One number per component.
pub(crate) type Components = [Lanes<WIDE>; MOST_VECTORS];

/// A straight line, its vertical plane, and the sun.
pub(crate) struct Sightline {
    /// How near it comes to the planet's centre, m.
    pub nearest: f64,
    /// The sun's direction along the line, across it in the vertical plane (away from the centre), and to the right of
    /// that.
    sun: [f32; 3],
}

impl Sightline {
    /// `sun` is the unit vector towards it. Vertical lines are in the plane of the sun.
    #[inline(always)]
    pub fn new(segment: &Segment, sun: [f64; 3]) -> Self {
        let (v, start) = (segment.direction, segment.start);
        let along = dot(v, sun);
        let across: [f64; 3] = core::array::from_fn(|i| start[i] - segment.from * v[i]);
        let square = dot(across, across);
        if square <= PARALLEL * dot(start, start) {
            let level: [f64; 3] = core::array::from_fn(|i| sun[i] - along * v[i]);
            let across = -dot(level, level).sqrt().copysign(segment.from);
            return Self {
                nearest: 0.0,
                sun: [along, across, 0.0].map(|v| v as f32),
            };
        }
        let nearest = square.sqrt();
        let per_metre = 1.0 / nearest;
        let right = dot(cross(v, across), sun) * per_metre;
        Self {
            nearest,
            sun: [along, dot(across, sun) * per_metre, right].map(|v| v as f32),
        }
    }

    /// Where the line has this cosine and sine of its zenith angle.
    #[inline(always)]
    pub fn local(&self, view: f32, slope: f32) -> Local {
        let [along, across, right] = self.sun;
        // The sun's horizontal direction from its components: zenith angles of next to nothing have no digits in their
        // cosine.
        let ahead = slope * along - view * across;
        let gain = azimuthal_per_sine((ahead * ahead + right * right).sqrt());
        Local {
            view,
            slope,
            azimuth: [ahead * gain, right * gain],
        }
    }
}

/// A direction and the sun in the local frame of a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Local {
    /// Cosine and sine of the zenith angle of the view direction.
    pub view: f32,
    pub slope: f32,
    /// Cosine and sine of the azimuth of the view direction less that of the sun, both times what azimuths count.
    pub azimuth: [f32; 2],
}

impl Local {
    /// Squares of cosine and sine of the azimuth, as far as azimuths count: half each at a vertical sun.
    #[inline(always)]
    fn squares(&self) -> [f32; 2] {
        let [x, y] = self.azimuth;
        let double = x * x - y * y;
        [0.5 * (1.0 + double), 0.5 * (1.0 - double)]
    }
}

/// Values of the components in every direction.
#[derive(Clone, Debug)]
pub(crate) struct Directions {
    orders: usize,
    /// Vectors of components.
    pub vectors: usize,
    /// `[xx, yy, zz, xz][vector]`.
    tensor: Vec<Lanes<WIDE>>,
    /// `[zenith angle][order][vector]`.
    particles: Vec<Lanes<WIDE>>,
}

impl Directions {
    pub fn new(basis: &SourceBasisView) -> Self {
        let rank = basis.ranks[2];
        let vectors = rank.div_ceil(WIDE);
        let factor = |moment: usize, r: usize| f64::from(basis.factors[2][moment * rank + r].get());
        let pad = |values: &dyn Fn(usize) -> f64| -> Vec<Lanes<WIDE>> {
            let lane = |r: usize| if r < rank { values(r) as f32 } else { 0.0 };
            let vector = |v: usize| Lanes(core::array::from_fn(|i| lane(v * WIDE + i)));
            (0..vectors).map(vector).collect()
        };
        let mut particles = Vec::new();
        for angle in 0..=ANGLES {
            let cosine = (angle as f64 / ANGLES as f64 * PI).cos();
            let component = |r: usize| {
                orders(basis.degree, basis.orders, cosine, |i| {
                    factor(TENSOR + i, r)
                })
            };
            let columns: Vec<Vec<f64>> = (0..rank).map(component).collect();
            let order = |m: usize| pad(&|r| columns[r][m]);
            particles.extend((0..=basis.orders).flat_map(order));
        }
        Self {
            orders: basis.orders,
            vectors,
            tensor: (0..TENSOR).flat_map(|t| pad(&|r| factor(t, r))).collect(),
            particles,
        }
    }

    pub fn bytes(&self) -> usize {
        size_of_val(self.tensor.as_slice()) + size_of_val(self.particles.as_slice())
    }

    /// What molecules and what particles send from each component towards an observer.
    #[inline(always)]
    pub fn at(&self, local: &Local) -> [Components; 2] {
        [self.molecules(local), self.particles(local)]
    }

    /// Q and U of what molecules send from each component, in the vertical frame.
    #[inline(always)]
    pub fn polarised(&self, local: &Local) -> [Components; 2] {
        let Local { view, slope, .. } = *local;
        let [cosine, sine] = local.azimuth;
        let [along, across] = local.squares();
        let mixed = 2.0 * view * sine * cosine;
        [
            self.tensor([
                view * view * along - across,
                view * view * across - along,
                slope * slope,
                -2.0 * slope * view * cosine,
            ]),
            self.tensor([-mixed, mixed, 0.0, 2.0 * slope * sine]),
        ]
    }

    #[inline(always)]
    fn molecules(&self, local: &Local) -> Components {
        let Local { view, slope, .. } = *local;
        let [along, across] = local.squares();
        self.tensor([
            view * view * along + across,
            view * view * across + along,
            slope * slope,
            -2.0 * slope * view * local.azimuth[0],
        ])
    }

    /// The sum of the tensor's components times `form`.
    #[inline(always)]
    fn tensor(&self, form: [f32; TENSOR]) -> Components {
        let mut out = [Lanes::splat(0.0); MOST_VECTORS];
        for (row, factor) in self.tensor.chunks_exact(self.vectors).zip(form) {
            for (out, row) in out.iter_mut().zip(row) {
                *out = *out + *row * factor;
            }
        }
        out
    }

    #[inline(always)]
    fn particles(&self, local: &Local) -> Components {
        let zenith = core::f32::consts::FRAC_PI_2 - asin(local.view);
        let u = zenith * (ANGLES as f32 / core::f32::consts::PI);
        let i = (u as usize).min(ANGLES - 1);
        let t = u - i as f32;
        let stride = (self.orders + 1) * self.vectors;
        let rows = &self.particles[i * stride..(i + 2) * stride];
        let (near, far) = rows.split_at(stride);
        let [x, y] = local.azimuth;
        // Powers of a complex number: each order fades as its own power.
        let (mut cosine, mut sine) = (1.0, 0.0);
        let mut out = [Lanes::splat(0.0); MOST_VECTORS];
        let orders = near
            .chunks_exact(self.vectors)
            .zip(far.chunks_exact(self.vectors));
        for (near, far) in orders {
            for ((out, near), far) in out.iter_mut().zip(near).zip(far) {
                *out = *out + (*near + (*far - *near) * t) * cosine;
            }
            (cosine, sine) = (cosine * x - sine * y, cosine * y + sine * x);
        }
        out
    }
}

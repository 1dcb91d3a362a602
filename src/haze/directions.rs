//! How the components of the source look in every direction. Format specification, section 7.7.

use core::f64::consts::PI;

use super::harmonics::orders;
use crate::format::{MAX_MOMENTS, SourceBasisView, TENSOR};
use crate::lanes::Lanes;
use crate::math::asin;

/// Components in a vector.
pub(crate) const WIDE: usize = 8;
/// Most components of the moments, in vectors.
pub(crate) const MOST_VECTORS: usize = MAX_MOMENTS / WIDE;
/// Zenith angles of the table: 1.5° apart.
const ANGLES: usize = 120;

/// One number per component.
pub(crate) type Components = [Lanes<WIDE>; MOST_VECTORS];

/// A direction and the sun in the local frame of a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Local {
    /// Cosine of the zenith angle of the view direction.
    pub view: f64,
    /// Cosine of the azimuth of the view direction less that of the sun.
    pub cos_azimuth: f64,
}

impl Local {
    /// From the zenith cosines of view direction and sun and the cosine of the angle between them.
    pub fn new(view: f64, sun: f64, between: f64) -> Self {
        let sines = ((1.0 - view * view) * (1.0 - sun * sun)).max(0.0).sqrt();
        let cos_azimuth = match sines > 1e-9 {
            true => ((between - view * sun) / sines).clamp(-1.0, 1.0),
            false => 1.0,
        };
        Self { view, cos_azimuth }
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

    /// Q and U of what molecules send from each component, in the vertical frame; `sine` is that of the azimuth.
    #[inline(always)]
    pub fn polarised(&self, local: &Local, sine: f64) -> [Components; 2] {
        // Where the azimuth fades, at vertical views, the two need not agree.
        let square = local.cos_azimuth * local.cos_azimuth + sine * sine;
        let length = square.sqrt().max(f64::MIN_POSITIVE);
        let [view, cosine, sine] =
            [local.view, local.cos_azimuth / length, sine / length].map(|v| v as f32);
        let slope = (1.0 - view * view).max(0.0).sqrt();
        let mixed = 2.0 * view * sine * cosine;
        [
            self.tensor([
                view * view * cosine * cosine - sine * sine,
                view * view * sine * sine - cosine * cosine,
                slope * slope,
                -2.0 * slope * view * cosine,
            ]),
            self.tensor([-mixed, mixed, 0.0, 2.0 * slope * sine]),
        ]
    }

    #[inline(always)]
    fn molecules(&self, local: &Local) -> Components {
        let (view, azimuth) = (local.view as f32, local.cos_azimuth as f32);
        let (view2, azimuth2) = (view * view, azimuth * azimuth);
        let sine = (1.0 - view2).max(0.0).sqrt();
        self.tensor([
            view2 * azimuth2 + (1.0 - azimuth2),
            view2 * (1.0 - azimuth2) + azimuth2,
            1.0 - view2,
            -2.0 * sine * view * azimuth,
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
        let zenith = core::f32::consts::FRAC_PI_2 - asin(local.view as f32);
        let u = zenith * (ANGLES as f32 / core::f32::consts::PI);
        let i = (u as usize).min(ANGLES - 1);
        let t = u - i as f32;
        let stride = (self.orders + 1) * self.vectors;
        let rows = &self.particles[i * stride..(i + 2) * stride];
        let (near, far) = rows.split_at(stride);
        let azimuth = local.cos_azimuth as f32;
        // cos mφ by recursion from cos(−φ) and 1.
        let (mut before, mut cosine) = (azimuth, 1.0);
        let mut out = [Lanes::splat(0.0); MOST_VECTORS];
        let orders = near
            .chunks_exact(self.vectors)
            .zip(far.chunks_exact(self.vectors));
        for (near, far) in orders {
            for ((out, near), far) in out.iter_mut().zip(near).zip(far) {
                *out = *out + (*near + (*far - *near) * t) * cosine;
            }
            (before, cosine) = (cosine, 2.0 * azimuth * cosine - before);
        }
        out
    }
}

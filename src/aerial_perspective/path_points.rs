//! Points of a segment, several at a time.

use crate::geometry::Planet;
use crate::kernel::lanes::Lanes;
use crate::transmittance::{Segment, dot};

/// Points that are computed together.
pub(crate) const BATCH: usize = 8;

/// Points of a segment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PathPoints {
    /// m.
    pub altitude: Lanes<BATCH>,
    /// Cosine and sine of the zenith angle of the segment there.
    pub zenith: Lanes<BATCH>,
    pub slope: Lanes<BATCH>,
    /// Sine of the sun's elevation there.
    pub sun: Lanes<BATCH>,
}

impl Default for PathPoints {
    fn default() -> Self {
        let [altitude, zenith, slope, sun] = [Lanes::splat(0.0); 4];
        Self {
            altitude,
            zenith,
            slope,
            sun,
        }
    }
}

impl PathPoints {
    /// At these distances from the tangent point (m), which is `nearest` to the planet's centre; `sun` is the unit
    /// vector towards it.
    #[inline(always)]
    pub fn new(
        planet: &Planet,
        segment: &Segment,
        sun: [f64; 3],
        nearest: f64,
        at: &[f64; BATCH],
    ) -> Self {
        let (lowest, radius) = (segment.line.lowest, planet.radius);
        let (per_radius, per_metre) = (1.0 / radius, dot(segment.direction, sun));
        let towards = dot(segment.start, sun) - segment.from * per_metre;
        let mut out = Self::default();
        for (i, s) in at.iter().enumerate() {
            let w = lowest + s * s * (0.5 * per_radius);
            // The distance from the planet's centre over its radius.
            let root = (1.0 + 2.0 * w * per_radius).max(1e-12).sqrt();
            let per_distance = 1.0 / (radius * root);
            out.altitude.0[i] = (2.0 * w / (1.0 + root)) as f32;
            out.zenith.0[i] = (s * per_distance).clamp(-1.0, 1.0) as f32;
            out.slope.0[i] = (nearest * per_distance).min(1.0) as f32;
            out.sun.0[i] = ((towards + s * per_metre) * per_distance).clamp(-1.0, 1.0) as f32;
        }
        out
    }
}

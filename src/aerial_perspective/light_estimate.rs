//! What can be seen of a segment up to a distance, and how much light is there: roughly, to place panels by.

use super::path_points::BATCH;
use super::quadrature_limits::MOST_PATH_POINTS;
use crate::kernel::lanes::Lanes;
use crate::kernel::math::{bound, log2, one_minus_exp_neg};
use crate::transmittance::{Layers, Piece, Segment, dot};

type Batch = Lanes<BATCH>;

/// Most pieces of a segment in layers that are told apart.
const MOST_PIECES: usize = 112;
/// Room for them in whole batches, and for the start.
const ROOM: usize = MOST_PIECES + BATCH;
/// Length (m) up to which pieces are not divided.
const PART: f64 = 12e3;

/// The sun as far as panels care.
pub(crate) struct SunEstimate {
    /// Towards the sun.
    pub sun: [f64; 3],
    /// Whether it may be in shadow somewhere.
    pub low: bool,
}

/// How much light is along a segment, roughly.
struct LightEstimate {
    /// Distance towards the sun from the plane through the planet's centre: at the tangent point, and per metre.
    towards: [f64; 2],
    lowest: f64,
    per_diameter: f64,
}

impl LightEstimate {
    fn new(layers: &Layers, segment: &Segment, sky: &SunEstimate) -> Self {
        let per_metre = dot(segment.direction, sky.sun);
        Self {
            towards: [
                dot(segment.start, sky.sun) - segment.from * per_metre,
                per_metre,
            ],
            lowest: segment.line.lowest,
            per_diameter: 0.5 / layers.planet().radius,
        }
    }

    /// Density of the air, roughly, relative to that at the ground.
    #[inline(always)]
    fn density(&self, distance: &[f64; BATCH]) -> Batch {
        let mut w = Batch::splat(0.0);
        for (w, s) in w.0.iter_mut().zip(distance) {
            *w = (self.lowest + s * s * self.per_diameter) as f32;
        }
        (w * (-1.0 / 8e3)).exp()
    }

    /// Visible and ultraviolet light between these distances: between the glow of a dark sky and the light of day.
    #[inline(always)]
    fn light(&self, start: &[f64; BATCH], end: &[f64; BATCH]) -> [Batch; 2] {
        /// At the edge of the planet's shadow, and the depth in the shadow (m) over which it falls to 1/e.
        const GLOW: f32 = 0.1;
        const SHADE: f32 = 8e3;
        // How high above the ground the sunlight of these points passes.
        let mut clearance = Batch::splat(0.0);
        for (i, clearance) in clearance.0.iter_mut().enumerate() {
            let s = 0.5 * (start[i] + end[i]);
            let w = self.lowest + s * s * self.per_diameter;
            let towards = self.towards[0] + s * self.towards[1];
            let behind = w - towards * towards * self.per_diameter;
            let ahead = w + 0.03 * towards;
            *clearance = if towards < 0.0 { behind } else { ahead } as f32;
        }
        let glow = clearance.map(|c| bound(c * (1.0 / SHADE), -60.0, 0.0));
        [
            glow.exp() * GLOW + clearance.map(|c| bound(c * (1.0 / 10e3), 0.0, 1.0)),
            clearance.map(|c| bound((c - 20e3) * (1.0 / 30e3), 0.0, 1.0)),
        ]
    }
}

/// What panels share where the sun is low: visible light, ultraviolet light, change of the density of the air.
const KINDS: usize = 3;
/// How much each counts.
const SHARES: [f32; KINDS] = [0.7, 0.1, 0.2];

/// As much of each kind, in all of a segment, as gets its full share: little light is all there is in deep twilight.
const NOTICED: [f32; KINDS] = [1e-4, 0.01, 0.01];

/// What has been seen of a segment up to some distances: its start and the ends of its pieces; after the last, the last
/// once more.
pub(crate) struct CumulativeLight {
    len: usize,
    /// From the tangent point, m.
    distance: [f64; ROOM],
    /// Optical depth from the start.
    depth: [f32; ROOM],
    seen: [f32; ROOM],
}

impl Default for CumulativeLight {
    fn default() -> Self {
        Self {
            len: 0,
            distance: [0.0; ROOM],
            depth: [0.0; ROOM],
            seen: [0.0; ROOM],
        }
    }
}

impl CumulativeLight {
    /// CumulativeLight a segment.
    #[inline(always)]
    pub fn fill(
        &mut self,
        layers: &Layers,
        segment: &Segment,
        grey: &[[f32; 3]],
        sky: &SunEstimate,
    ) {
        let mut walker = layers.enter(segment.line, segment.from);
        let mut depth = 0.0;
        self.len = 1;
        self.distance[0] = walker.distance();
        walker.go(segment.to(), |piece: Piece| {
            // Along a level line air and light change within a piece.
            let length = piece.end - piece.start;
            if length < PART {
                depth += layers.column_of(grey, &piece);
                self.push(piece.end, depth);
                return;
            }
            let parts = (length / PART).min(12.0) as usize + 1;
            let mut start = piece.start;
            for part in 1..=parts {
                let end = piece.start + length * (part as f64 / parts as f64);
                let part = layers.part(segment.line, &piece, start, end);
                depth += layers.column_of(grey, &part);
                start = end;
                self.push(end, depth);
            }
        });
        let last = self.len - 1;
        let (distance, depth) = (self.distance[last], self.depth[last]);
        self.distance[self.len..][..BATCH].fill(distance);
        self.depth[self.len..][..BATCH].fill(depth);
        match sky.low {
            true => self.see_low(&LightEstimate::new(layers, segment, sky)),
            false => self.see(),
        }
    }

    #[inline(always)]
    fn push(&mut self, distance: f64, depth: f32) {
        // Many pieces more than there is room for are one.
        self.len = (self.len + 1).min(MOST_PIECES);
        self.distance[self.len - 1] = distance;
        self.depth[self.len - 1] = depth;
    }

    /// What has been seen where the sun shines on all of the segment.
    #[inline(always)]
    fn see(&mut self) {
        for first in (0..self.len).step_by(BATCH) {
            let depth = Batch::load(&self.depth, first);
            depth.one_minus_exp_neg().store(&mut self.seen, first);
        }
    }

    /// The same where it may not.
    #[inline(always)]
    fn see_low(&mut self, glance: &LightEstimate) {
        let [mut opacity, mut density] = [[0.0; ROOM]; 2];
        for first in (0..self.len + BATCH - 1).step_by(BATCH) {
            let depth = Batch::load(&self.depth, first);
            depth.one_minus_exp_neg().store(&mut opacity, first);
            let distance = batch(&self.distance, first);
            glance.density(distance).store(&mut density, first);
        }
        let mut light = [[0.0; ROOM]; KINDS];
        let mut total = [Batch::splat(0.0); KINDS];
        for first in (1..self.len).step_by(BATCH) {
            let load = |values: &[f32; ROOM]| [first - 1, first].map(|i| Batch::load(values, i));
            let [start, end] = [first - 1, first].map(|i| batch(&self.distance, i));
            let ([before, now], [thick, thin]) = (load(&opacity), load(&density));
            let [visible, ultraviolet] = glance.light(start, end);
            // Behind thick air nothing is seen, so a change of density there hardly counts.
            let through = Batch::splat(1.0) - (before + now) * 0.5;
            let kinds = [
                visible * (now - before),
                ultraviolet * (now - before),
                (thick - thin).abs() * through.sqrt().sqrt(),
            ];
            for ((total, light), kind) in total.iter_mut().zip(&mut light).zip(kinds) {
                *total = *total + kind;
                kind.store(light, first);
            }
        }
        let total = total.map(|lanes| lanes.0.iter().sum::<f32>());
        // What is hardly there gets no panels of its own.
        let factor: [f32; KINDS] = core::array::from_fn(|k| {
            let share = SHARES[k] * (total[k] / NOTICED[k]).min(1.0);
            share / total[k].max(f32::MIN_POSITIVE)
        });
        let (mut seen, [visible, ultraviolet, change]) = (0.0, &light);
        let kinds = visible.iter().zip(ultraviolet).zip(change);
        for (out, ((visible, ultraviolet), change)) in
            self.seen.iter_mut().zip(kinds).take(self.len)
        {
            seen += visible * factor[0] + ultraviolet * factor[1] + change * factor[2];
            *out = seen;
        }
    }

    /// The distances at which these shares of all have been seen.
    #[inline(always)]
    pub fn distances(&self, shares: &[f32], out: &mut [f64; MOST_PATH_POINTS]) {
        let total = self.seen[self.len - 1];
        let mut targets = [total; MOST_PATH_POINTS];
        for (target, share) in targets.iter_mut().zip(shares) {
            *target = share * total;
        }
        // As many marks as are passed before; without branches, which nobody could predict.
        let mut pieces = [1; MOST_PATH_POINTS];
        for seen in &self.seen[1..self.len.max(2) - 1] {
            for (piece, target) in pieces.iter_mut().zip(&targets) {
                *piece += u32::from(seen < target);
            }
        }
        for first in (0..shares.len()).step_by(BATCH) {
            let [mut t, mut depth] = [Batch::splat(0.0); 2];
            let (mut start, mut length) = ([0.0; BATCH], [0.0; BATCH]);
            for i in 0..BATCH {
                let piece = pieces[first + i] as usize;
                let (before, after) = (self.seen[piece - 1], self.seen[piece]);
                t.0[i] = (targets[first + i] - before) / (after - before).max(f32::MIN_POSITIVE);
                depth.0[i] = self.depth[piece] - self.depth[piece - 1];
                start[i] = self.distance[piece - 1];
                length[i] = self.distance[piece] - start[i];
            }
            for i in 0..BATCH {
                t.0[i] = within(bound(t.0[i], 0.0, 1.0), depth.0[i]);
            }
            for i in 0..BATCH {
                out[first + i] = start[i] + f64::from(t.0[i]) * length[i];
            }
        }
    }
}

#[inline(always)]
fn batch(values: &[f64; ROOM], first: usize) -> &[f64; BATCH] {
    // There is room for whole batches.
    values[first..].first_chunk().unwrap_or(&[0.0; BATCH])
}

/// Within a piece what is seen goes as 1 − T: the share of a piece of this depth in which a share `t` of that is seen.
#[inline(always)]
fn within(t: f32, depth: f32) -> f32 {
    /// Of thinner pieces the logarithm would lose its digits.
    const THICK: f32 = 0.03;
    let through = (1.0 - t * one_minus_exp_neg(depth)).max(f32::MIN_POSITIVE);
    let share = log2(through) * -core::f32::consts::LN_2 / depth.max(THICK);
    if depth > THICK { share.min(1.0) } else { t }
}

//! What can be seen of a segment up to a distance, and how much light is there: roughly, to place panels by.

use crate::air::{Layers, Piece, Segment, dot};
use crate::math::{exp, log2, one_minus_exp_neg};

/// Most pieces of a segment in layers that are told apart.
const MOST_PIECES: usize = 112;
/// Length (m) up to which pieces are not divided.
const PART: f64 = 12e3;

/// The sun as far as panels care.
pub(crate) struct Heaven {
    /// Towards the sun.
    pub sun: [f64; 3],
    /// Whether it may be in shadow somewhere.
    pub low: bool,
}

/// How much light is along a segment, roughly.
struct Glance {
    /// Distance towards the sun from the plane through the planet's centre: at the tangent point, and per metre.
    towards: [f64; 2],
    lowest: f64,
    diameter: f64,
}

impl Glance {
    fn new(layers: &Layers, segment: &Segment, sky: &Heaven) -> Self {
        let per_metre = dot(segment.direction, sky.sun);
        Self {
            towards: [
                dot(segment.start, sky.sun) - segment.from * per_metre,
                per_metre,
            ],
            lowest: segment.line.lowest,
            diameter: 2.0 * layers.planet().radius,
        }
    }

    /// Density of the air, roughly, relative to that at the ground.
    #[inline(always)]
    fn density(&self, s: f64) -> f32 {
        exp(-(self.lowest + s * s / self.diameter) as f32 * (1.0 / 8e3))
    }

    /// Visible and ultraviolet light at the distance `s` from the tangent point: between the glow of a dark sky and the light of day.
    #[inline(always)]
    fn light(&self, s: f64) -> [f32; 2] {
        const GLOW: f32 = 0.1;
        let w = self.lowest + s * s / self.diameter;
        let towards = self.towards[0] + s * self.towards[1];
        // How high above the ground the sunlight of this point passes.
        let clearance = match towards < 0.0 {
            true => w - towards * towards / self.diameter,
            false => w + 0.03 * towards,
        };
        let clearance = clearance as f32;
        [
            GLOW + (clearance * (1.0 / 10e3)).clamp(0.0, 1.0),
            ((clearance - 20e3) * (1.0 / 30e3)).clamp(0.0, 1.0),
        ]
    }
}

/// What panels share where the sun is low: visible light, ultraviolet light, change of the density of the air.
const KINDS: usize = 3;
/// How much each counts.
const SHARES: [f32; KINDS] = [0.7, 0.1, 0.2];

/// As much of a kind, in all of a segment, as gets its full share.
const NOTICED: f32 = 0.01;

/// What has been seen of a segment up to a distance.
#[derive(Clone, Copy, Default)]
struct Mark {
    distance: f64,
    depth: f32,
    seen: f32,
}

/// Marks along a segment.
pub(crate) struct Marks {
    marks: [Mark; MOST_PIECES],
    len: usize,
}

impl Marks {
    /// Marks at the ends of the pieces; `seen` ends at 1.
    #[inline(always)]
    pub fn new(layers: &Layers, segment: &Segment, grey: &[[f32; 3]], sky: &Heaven) -> Self {
        let mut out = Self {
            marks: [Mark::default(); MOST_PIECES],
            len: 1,
        };
        out.marks[0].distance = segment.from;
        let mut depth = 0.0;
        layers.walk(segment.line, segment.from, segment.to(), |piece: Piece| {
            // Along a level line air and light change within a piece.
            let length = piece.end - piece.start;
            let parts = (length / PART).min(12.0) as usize + 1;
            let mut start = piece.start;
            for part in 1..=parts {
                let end = piece.start + length * (part as f64 / parts as f64);
                let part = match parts {
                    1 => piece,
                    _ => layers.part(segment.line, &piece, start, end),
                };
                depth += layers.column_of(grey, &part);
                start = end;
                out.len = (out.len + 1).min(MOST_PIECES);
                out.marks[out.len - 1] = Mark {
                    distance: end,
                    depth,
                    seen: 0.0,
                };
            }
        });
        let marks = &mut out.marks[..out.len];
        match sky.low {
            true => see_low(marks, &Glance::new(layers, segment, sky)),
            false => see(marks),
        }
        out
    }

    /// The distance at which a share has been seen; `piece` only grows.
    #[inline(always)]
    pub fn distance(&self, share: f32, piece: &mut usize) -> f64 {
        while *piece + 1 < self.len && self.marks[*piece].seen < share {
            *piece += 1;
        }
        let (a, b) = (self.marks[*piece - 1], self.marks[*piece]);
        let t = (share - a.seen) / (b.seen - a.seen).max(f32::MIN_POSITIVE);
        let t = t.clamp(0.0, 1.0);
        let depth = b.depth - a.depth;
        // Within a piece what is seen goes as 1 − T.
        const THICK: f32 = 0.03;
        let t = match depth > THICK {
            true => {
                let through = (1.0 - t * one_minus_exp_neg(depth)).max(f32::MIN_POSITIVE);
                -log2(through) * core::f32::consts::LN_2 / depth
            }
            false => t,
        };
        a.distance + f64::from(t.clamp(0.0, 1.0)) * (b.distance - a.distance)
    }
}

/// What has been seen where the sun shines on all of the segment.
#[inline(always)]
fn see(marks: &mut [Mark]) {
    let total = marks
        .last()
        .map_or(1.0, |last| one_minus_exp_neg(last.depth));
    let factor = 1.0 / total.max(f32::MIN_POSITIVE);
    for mark in marks {
        mark.seen = one_minus_exp_neg(mark.depth) * factor;
    }
}

/// The same where it may not.
#[inline(always)]
fn see_low(marks: &mut [Mark], glance: &Glance) {
    let mut light = [[0.0; KINDS]; MOST_PIECES];
    let mut total = [0.0; KINDS];
    let mut before = (0.0, glance.density(marks[0].distance));
    for i in 1..marks.len() {
        let [start, end] = [marks[i - 1], marks[i]].map(|mark| mark.distance);
        let now = (one_minus_exp_neg(marks[i].depth), glance.density(end));
        let [visible, ultraviolet] = glance.light(0.5 * (start + end));
        let share = now.0 - before.0;
        // Behind thick air nothing is seen, so a change of density there hardly counts.
        let through = (1.0 - 0.5 * (now.0 + before.0)).sqrt().sqrt();
        light[i] = [
            visible * share,
            ultraviolet * share,
            (now.1 - before.1).abs() * through,
        ];
        before = now;
        for (total, light) in total.iter_mut().zip(light[i]) {
            *total += light;
        }
    }
    // What is hardly there gets no panels of its own.
    let share = |k: usize| SHARES[k] * (total[k] / NOTICED).min(1.0);
    let used: f32 = (0..KINDS).map(share).sum();
    let factor: [f32; KINDS] =
        core::array::from_fn(|k| share(k) / (used * total[k]).max(f32::MIN_POSITIVE));
    for i in 1..marks.len() {
        let more: f32 = light[i]
            .iter()
            .zip(factor)
            .map(|(light, factor)| light * factor)
            .sum();
        marks[i].seen = marks[i - 1].seen + more;
    }
}

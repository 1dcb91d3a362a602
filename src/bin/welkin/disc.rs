//! The sun's disc in a picture: how much of its light each pixel gets.
//!
//! A pixel that the disc touches is divided until its parts are small beside the disc, so that what pixels have
//! together is what the disc sends, however large they are.

use welkin::{Conditions, Model, SOLAR_ANGULAR_RADIUS, SolarDisc, xyz_to_linear_srgb};

use crate::failure::Result;

/// Largest radius of a part over that of the disc.
const FINENESS: f64 = 1.0 / 48.0;
/// A pixel is divided at least so often: 64 parts.
const LEAST_DEPTH: u32 = 3;
/// And at most so often, whatever the picture.
const MOST_DEPTH: u32 = 12;
/// Parts along an edge of a pixel, of which its solid angle is the sum.
const EDGE: usize = 12;

/// From a place in the picture, in pixels from its upper left corner, to a unit vector, if it shows any.
pub trait Look: Fn([f64; 2]) -> Option<[f64; 3]> {}
impl<F: Fn([f64; 2]) -> Option<[f64; 3]>> Look for F {}

pub struct Disc(SolarDisc);

impl Disc {
    pub fn new(model: &Model, conditions: &Conditions) -> Result<Self> {
        Ok(Self(model.solar_disc(conditions)?))
    }

    /// The mean over a pixel, linear sRGB in cd m⁻²; `is_open` says whether nothing stands before the sun in a
    /// direction.
    pub fn rgb(
        &self,
        pixel: [usize; 2],
        look: &impl Look,
        is_open: impl Fn([f64; 3]) -> bool,
    ) -> welkin::Result<[f32; 3]> {
        let mut sum = [0.0f64; 3];
        self.each_part(pixel, look, &mut |direction, share| {
            if is_open(direction) {
                let xyz = self.0.xyz(direction.map(|v| v as f32))?;
                sum = std::array::from_fn(|c| sum[c] + share * f64::from(xyz[c]));
            }
            Ok(())
        })?;
        Ok(xyz_to_linear_srgb(sum.map(|v| v as f32)))
    }

    /// Adds the mean over a pixel, W m⁻² sr⁻¹ nm⁻¹.
    pub fn add(&self, pixel: [usize; 2], look: &impl Look, out: &mut [f32]) -> welkin::Result<()> {
        let mut radiance = vec![0.0; out.len()];
        self.each_part(pixel, look, &mut |direction, share| {
            self.0
                .radiance(direction.map(|v| v as f32), &mut radiance)?;
            let all = out.iter_mut().zip(&radiance);
            all.for_each(|(out, l)| *out += share as f32 * l);
            Ok(())
        })
    }

    /// Calls `each` with the parts of a pixel that the disc may touch, and their shares of its solid angle.
    fn each_part(
        &self,
        [column, row]: [usize; 2],
        look: &impl Look,
        each: &mut impl FnMut([f64; 3], f64) -> welkin::Result<()>,
    ) -> welkin::Result<()> {
        let pixel = Part {
            middle: [column as f64 + 0.5, row as f64 + 0.5],
            half: 0.5,
            depth: 0,
        };
        if !self.0.is_visible() || !pixel.may_touch(self.sun(), look) {
            return Ok(());
        }
        let all = pixel.solid_angle(look);
        let mut parts = vec![pixel];
        while let Some(part) = parts.pop() {
            if !part.may_touch(self.sun(), look) {
                continue;
            }
            let is_small =
                part.radius(look) <= FINENESS * SOLAR_ANGULAR_RADIUS || part.depth == MOST_DEPTH;
            if !is_small || part.depth < LEAST_DEPTH {
                parts.extend(part.quarters());
            } else if let Some(direction) = look(part.middle) {
                each(direction, part.cell(look) / all)?;
            }
        }
        Ok(())
    }

    fn sun(&self) -> [f64; 3] {
        self.0.direction().map(f64::from)
    }
}

/// A square of the picture, in pixels.
#[derive(Clone, Copy)]
struct Part {
    middle: [f64; 2],
    half: f64,
    depth: u32,
}

impl Part {
    fn quarters(self) -> impl Iterator<Item = Self> {
        let half = 0.5 * self.half;
        [[-half, -half], [half, -half], [-half, half], [half, half]]
            .map(|[x, y]| Self {
                middle: [self.middle[0] + x, self.middle[1] + y],
                half,
                depth: self.depth + 1,
            })
            .into_iter()
    }

    /// A little inside, so that a pixel at the edge of a face of a cube stays on it.
    fn corners(&self, look: &impl Look) -> [Option<[f64; 3]>; 4] {
        let half = 0.999 * self.half;
        [[-half, -half], [half, -half], [half, half], [-half, half]]
            .map(|[x, y]| look([self.middle[0] + x, self.middle[1] + y]))
    }

    /// Largest angle from the middle to a corner (rad); 0 where there are none.
    fn radius(&self, look: &impl Look) -> f64 {
        let Some(middle) = look(self.middle) else {
            return 0.0;
        };
        let corners = self.corners(look).into_iter().flatten();
        corners
            .map(|corner| angle(corner, middle))
            .fold(0.0, f64::max)
    }

    /// Whether any of the disc can be in it. Half as much again, as corners of a part at a pole are not its farthest
    /// points.
    fn may_touch(&self, sun: [f64; 3], look: &impl Look) -> bool {
        let Some(middle) = look(self.middle) else {
            // A part beyond the edge of a fish-eye.
            return self.depth > 0 && self.depth < LEAST_DEPTH;
        };
        angle(middle, sun) <= SOLAR_ANGULAR_RADIUS + 1.5 * self.radius(look)
    }

    /// Solid angle of a part that is as good as flat, sr.
    fn cell(&self, look: &impl Look) -> f64 {
        let [Some(a), Some(b), Some(c), Some(d)] = self.corners(look) else {
            return 0.0;
        };
        let [p, q]: [[f64; 3]; 2] = [
            std::array::from_fn(|i| c[i] - a[i]),
            std::array::from_fn(|i| d[i] - b[i]),
        ];
        // Of the parallelogram of the diagonals, from a little inside.
        0.5 * length(cross(p, q)) / (0.999 * 0.999)
    }

    fn solid_angle(&self, look: &impl Look) -> f64 {
        let half = self.half / EDGE as f64;
        let place = |k: usize| (2 * k + 1) as f64 * half - self.half;
        let cells = (0..EDGE * EDGE).map(|k| Self {
            middle: [
                self.middle[0] + place(k % EDGE),
                self.middle[1] + place(k / EDGE),
            ],
            half,
            depth: self.depth,
        });
        cells.map(|cell| cell.cell(look)).sum()
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// Between unit vectors, rad; exact for small ones.
fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    let chord = length(std::array::from_fn(|i| a[i] - b[i]));
    2.0 * (0.5 * chord).min(1.0).asin()
}

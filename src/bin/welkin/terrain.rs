//! Landscapes: heights above the sphere, and where rays meet them.

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};
use std::path::Path;

use crate::failure::{Failure, Result};

/// How far rays are followed, m.
pub const FARTHEST: f64 = 400_000.0;

/// Heights above the ground of a planet, as a function of the distances x and y from the origin (m).
pub enum Terrain {
    /// Nothing but the ground.
    Flat,
    /// Built-in mountain ranges with plains between, up to so high (m).
    Hills(f64),
    /// A square picture of heights around the origin; flat beyond.
    Field(Field),
}

/// A grid of heights.
pub struct Field {
    size: [usize; 2],
    /// m, rows from the north (+y) to the south.
    heights: Vec<f32>,
    /// Width on the ground, m.
    width: f64,
    highest: f64,
}

impl Field {
    /// From a grey or colour PNG (the first channel; black is 0, white `highest` m) or an EXR (the first channel in
    /// metres, or in shares of `highest` where it is given), `width` metres wide.
    pub fn read(path: &Path, width: f64, highest: Option<f64>) -> Result<Self> {
        let fail = |text: String| Failure::message(format!("{}: {text}", path.display()));
        let extension = path.extension().map(|e| e.to_ascii_lowercase());
        let (size, mut heights) = match extension.as_ref().and_then(|e| e.to_str()) {
            Some("png") => read_png(path).map_err(fail)?,
            Some("exr") => read_exr(path).map_err(fail)?,
            _ => return Err(fail("a height field is a .png or an .exr".into())),
        };
        let is_png = extension.is_some_and(|e| e == "png");
        let scale = highest.unwrap_or(if is_png { 3000.0 } else { 1.0 });
        for height in &mut heights {
            *height *= scale as f32;
            if !(-500.0..=50_000.0).contains(height) {
                return Err(fail(format!(
                    "height {height:?} m is outside -500..50000 m"
                )));
            }
        }
        let highest = heights.iter().copied().fold(0.0, f32::max).into();
        Ok(Self {
            size,
            heights,
            width,
            highest,
        })
    }

    fn at(&self, x: f64, y: f64) -> f64 {
        let [columns, rows] = self.size;
        let scale = (columns - 1) as f64 / self.width;
        let u = x * scale + 0.5 * (columns - 1) as f64;
        let v = 0.5 * (rows - 1) as f64 - y * scale;
        if !(0.0..=(columns - 1) as f64).contains(&u) || !(0.0..=(rows - 1) as f64).contains(&v) {
            return 0.0;
        }
        let (i, j) = ((u as usize).min(columns - 2), (v as usize).min(rows - 2));
        let (s, t) = (u - i as f64, v - j as f64);
        let value = |i: usize, j: usize| f64::from(self.heights[j * columns + i]);
        let top = value(i, j) + s * (value(i + 1, j) - value(i, j));
        let bottom = value(i, j + 1) + s * (value(i + 1, j + 1) - value(i, j + 1));
        top + t * (bottom - top)
    }
}

fn read_png(path: &Path) -> std::result::Result<([usize; 2], Vec<f32>), String> {
    let file = std::fs::File::open(path).map_err(|e| e.to_string())?;
    let mut decoder = png::Decoder::new(std::io::BufReader::new(file));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(|e| e.to_string())?;
    let length = reader.output_buffer_size().ok_or("too large")?;
    let mut bytes = vec![0; length];
    let info = reader.next_frame(&mut bytes).map_err(|e| e.to_string())?;
    let channels = info.color_type.samples();
    let bytes = &bytes[..info.buffer_size()];
    let heights: Vec<f32> = match info.bit_depth {
        png::BitDepth::Sixteen => {
            let values = bytes.chunks_exact(2 * channels);
            values
                .map(|v| f32::from(u16::from_be_bytes([v[0], v[1]])) / 65_535.0)
                .collect()
        }
        _ => bytes
            .chunks_exact(channels)
            .map(|v| f32::from(v[0]) / 255.0)
            .collect(),
    };
    checked([info.width as usize, info.height as usize], heights)
}

fn read_exr(path: &Path) -> std::result::Result<([usize; 2], Vec<f32>), String> {
    use exr::prelude::*;
    let image = read_first_flat_layer_from_file(path).map_err(|e| e.to_string())?;
    let layer = image.layer_data;
    let channel = layer.channel_data.list.first().ok_or("it has no channel")?;
    let heights = channel.sample_data.values_as_f32().collect();
    checked([layer.size.width(), layer.size.height()], heights)
}

fn checked(
    size: [usize; 2],
    heights: Vec<f32>,
) -> std::result::Result<([usize; 2], Vec<f32>), String> {
    if size[0] < 2 || size[1] < 2 || heights.len() != size[0] * size[1] {
        return Err(format!("{} x {} is no height field", size[0], size[1]));
    }
    Ok((size, heights))
}

impl Terrain {
    /// Height above the ground, m.
    pub fn height(&self, x: f64, y: f64) -> f64 {
        self.height_under(x, y, 0.0)
    }

    /// The same, or what is not lower than that where it is well below an altitude: who passes far above wants no
    /// detail.
    fn height_under(&self, x: f64, y: f64, altitude: f64) -> f64 {
        match self {
            Terrain::Flat => 0.0,
            Terrain::Hills(highest) => {
                highest * hills([x, y].map(|v| v / 30_000.0), 0.7 * altitude / highest)
            }
            Terrain::Field(field) => field.at(x, y),
        }
    }

    fn highest(&self) -> f64 {
        match self {
            Terrain::Flat => 0.0,
            Terrain::Hills(highest) => *highest,
            Terrain::Field(field) => field.highest,
        }
    }

    /// Distance at which a ray from `origin` (world frame: the origin on the ground, +z up) meets the terrain of a
    /// planet with this radius.
    pub fn hit(&self, radius: f64, origin: [f64; 3], direction: [f64; 3]) -> Option<f64> {
        let above = |s: f64| {
            let [x, y, z]: [f64; 3] = std::array::from_fn(|k| origin[k] + s * direction[k]);
            let altitude = altitude(radius, [x, y, z]);
            (altitude, altitude - self.height_under(x, y, altitude))
        };
        let highest = self.highest();
        let mut s: f64 = 0.0;
        while s < FARTHEST {
            let (altitude, clearance) = above(s);
            if clearance < 0.0 {
                return Some(s);
            }
            // Slopes are rarely steeper than 45°; far away the step is the size of a pixel.
            let step = (0.4 * clearance.max(altitude - highest)).max(2.0 + 8e-4 * s);
            if above(s + step).1 < 0.0 {
                let (mut near, mut far) = (s, s + step);
                for _ in 0..30 {
                    let middle = 0.5 * (near + far);
                    if above(middle).1 < 0.0 {
                        far = middle
                    } else {
                        near = middle
                    }
                }
                return Some(near);
            }
            if altitude > highest && direction_rises(radius, origin, direction, s) {
                return None;
            }
            s += step;
        }
        None
    }

    /// Unit normal at a point of the surface, in the world frame; the curvature of the planet is included.
    pub fn normal(&self, radius: f64, [x, y, _]: [f64; 3]) -> [f64; 3] {
        const STEP: f64 = 8.0;
        let slope_x =
            (self.height(x + STEP, y) - self.height(x - STEP, y)) / (2.0 * STEP) - x / radius;
        let slope_y =
            (self.height(x, y + STEP) - self.height(x, y - STEP)) / (2.0 * STEP) - y / radius;
        let length = (1.0 + slope_x * slope_x + slope_y * slope_y).sqrt();
        [-slope_x / length, -slope_y / length, 1.0 / length]
    }
}

/// Altitude of a point in the world frame, m.
pub fn altitude(radius: f64, [x, y, z]: [f64; 3]) -> f64 {
    let w = z + (x * x + y * y + z * z) / (2.0 * radius);
    2.0 * w / (1.0 + (1.0 + 2.0 * w / radius).max(0.0).sqrt())
}

fn direction_rises(radius: f64, origin: [f64; 3], direction: [f64; 3], s: f64) -> bool {
    let place: [f64; 3] = std::array::from_fn(|k| origin[k] + s * direction[k]);
    place[0] * direction[0] + place[1] * direction[1] + (place[2] + radius) * direction[2] > 0.0
}

/// Mountain ranges of 0 to 1 with plains between, or something higher that is less than `enough`.
fn hills([x, y]: [f64; 2], enough: f64) -> f64 {
    let range = (0.5 + noise(1.1 * x + 5.3, 1.1 * y - 1.9)).clamp(0.08, 1.0);
    if range < enough {
        return range;
    }
    // Ridges wind.
    let bent = [
        x + 0.12 * noise(3.0 * x + 7.1, 3.0 * y),
        y + 0.12 * noise(3.0 * x - 4.4, 3.0 * y + 2.2),
    ];
    range * ridges(bent.map(|v| 1.6 * v), enough / range)
}

/// A ridged multifractal of 0 to 1: rough where it is high, smooth in valleys. After Musgrave, in Ebert et al. 2003,
/// Texturing and Modeling. Or something higher that is less than `enough`.
fn ridges([mut x, mut y]: [f64; 2], enough: f64) -> f64 {
    let (mut sum, mut amplitude, mut weight) = (0.0, 0.5, 1.0);
    for _ in 0..12 {
        let ridge = (1.0 - noise(x, y).abs()).max(0.0).powi(2) * weight;
        sum += amplitude * ridge;
        // All that can come.
        if sum + amplitude < enough {
            return sum + amplitude;
        }
        weight = (2.0 * ridge).min(1.0);
        amplitude *= 0.5;
        // Turned, so that no grid shows.
        (x, y) = (1.6 * x - 1.2 * y + 17.3, 1.2 * x + 1.6 * y - 9.1);
    }
    sum
}

/// Gradient noise of −1 to 1 with features of size 1: Perlin 2002, Improving Noise.
pub fn noise(x: f64, y: f64) -> f64 {
    let (i, j) = (x.floor(), y.floor());
    let (s, t) = (x - i, y - j);
    let smooth = |t: f64| t * t * t * (t * (6.0 * t - 15.0) + 10.0);
    let slope = |a: f64, b: f64| {
        let [p, q] = GRADIENTS[hash((i + a) as i64, (j + b) as i64) % GRADIENTS.len()];
        p * (s - a) + q * (t - b)
    };
    let across = |b: f64| slope(0.0, b) + smooth(s) * (slope(1.0, b) - slope(0.0, b));
    let (low, high) = (across(0.0), across(1.0));
    SQRT_2 * (low + smooth(t) * (high - low))
}

/// Unit vectors all around.
const GRADIENTS: [[f64; 2]; 16] = {
    // Cosines of multiples of 22.5°.
    const A: f64 = 0.923_879_532_511_286_8;
    const B: f64 = FRAC_1_SQRT_2;
    const C: f64 = 0.382_683_432_365_089_8;
    [
        [1.0, 0.0],
        [A, C],
        [B, B],
        [C, A],
        [0.0, 1.0],
        [-C, A],
        [-B, B],
        [-A, C],
        [-1.0, 0.0],
        [-A, -C],
        [-B, -B],
        [-C, -A],
        [0.0, -1.0],
        [C, -A],
        [B, -B],
        [A, -C],
    ]
};

/// A random number for a place.
fn hash(i: i64, j: i64) -> usize {
    let mut h = (i as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15)
        ^ (j as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f);
    h = (h ^ (h >> 31)).wrapping_mul(0x7fb5_d329_728e_a185);
    h = (h ^ (h >> 27)).wrapping_mul(0x81da_def4_bc2d_d44d);
    ((h ^ (h >> 33)) >> 32) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    const RADIUS: f64 = 6_378_000.0;

    #[test]
    fn rays_meet_the_ground_where_the_sphere_is() {
        let origin = [0.0, 0.0, 1000.0];
        let down = Terrain::Flat.hit(RADIUS, origin, [0.0, 0.0, -1.0]).unwrap();
        assert!((down - 1000.0).abs() < 0.01);
        assert!(Terrain::Flat.hit(RADIUS, origin, [1.0, 0.0, 0.0]).is_none());
        // The horizon is √(2Rh) away.
        let dip = (2.0 * 1000.0 / RADIUS).sqrt() + 1e-5;
        let far = Terrain::Flat
            .hit(RADIUS, origin, [dip.cos(), 0.0, -dip.sin()])
            .unwrap();
        assert!(
            (far / (2.0 * RADIUS * 1000.0f64).sqrt() - 1.0).abs() < 0.05,
            "{far}"
        );
    }

    #[test]
    fn fields_are_interpolated_and_end() {
        let field = Field {
            size: [3, 3],
            heights: vec![0.0, 0.0, 0.0, 0.0, 800.0, 0.0, 0.0, 0.0, 0.0],
            width: 2000.0,
            highest: 800.0,
        };
        assert_eq!(field.at(0.0, 0.0), 800.0);
        assert_eq!(field.at(500.0, 0.0), 400.0);
        assert_eq!(field.at(5000.0, 0.0), 0.0);
        let terrain = Terrain::Field(field);
        let hit = terrain
            .hit(RADIUS, [-3000.0, 0.0, 400.0], [1.0, 0.0, 0.0])
            .unwrap();
        assert!((hit - 2500.0).abs() < 5.0, "{hit}");
        assert!(terrain.normal(RADIUS, [-500.0, 0.0, 0.0])[0] < 0.0);
    }

    #[test]
    fn hills_stay_within_their_height() {
        for i in 0..2000 {
            let place = [f64::from(i) * 0.37 - 300.0, f64::from(i % 77) * 0.91 - 30.0];
            let h = hills(place, 0.0);
            assert!((0.0..=1.0).contains(&h), "{h}");
            // Detail is left out above the ground only.
            for enough in [0.3 * h, 0.99 * h, 1.01 * h, 0.5, 2.0] {
                let rough = hills(place, enough);
                assert!(
                    rough == h || h <= rough && rough < enough,
                    "{h} {rough} {enough}"
                );
            }
        }
    }
}

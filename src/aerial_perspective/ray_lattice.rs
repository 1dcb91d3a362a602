//! Rays in all directions from one place, as splines over direction and distance.

use super::aerial_buffers::{AerialBuffers, AerialHeader};
use super::colour_segments::ColourAerialPerspective;
use super::ray_nodes::RayNodes;
use crate::baked::{CROWDING, POLE, Start, coefficients, share_at_row, spline_value};
use crate::error::{Error, Result};
use crate::geometry::Side;
use crate::kernel::lanes::Lanes;
use crate::kernel::math::LANES;
use crate::sky::ColourSpace;

type Cell = Lanes<LANES>;

/// Intervals of the rows above and below the horizon, and of the azimuth.
const UP: usize = 32;
const DOWN: usize = 16;
const COLUMNS: usize = 16;
/// Intervals of the angle from the sun.
const SUN: usize = 32;
/// Intervals of the distance, and steps that each is marched in.
const DISTANCES: usize = 40;
const STEPS: usize = 4;
/// Where light next to the camera is taken, m.
const NEXT: f64 = 10.0;
/// What logarithms are bounded by: no light, and nothing that comes through.
const DARK: f32 = 1e-30;

impl ColourAerialPerspective {
    /// The air around a camera (m, in the frame of [`CameraVolume`](crate::CameraVolume)), for volumes that are filled
    /// elsewhere. Some hundred rays are marched; what lies between them is interpolated.
    ///
    /// # Errors
    /// As [`ColourAerialPerspective::linear_srgb_along`], for rays in all directions: a camera high above the air sees
    /// some that are beyond reach.
    pub fn buffers(&self, camera: [f64; 3]) -> Result<AerialBuffers> {
        RayLattice::new(self, camera)?.buffers()
    }
}

/// A camera and the axes that its rays are measured against.
pub(super) struct RayLattice<'a> {
    aerial: &'a ColourAerialPerspective,
    camera: [f64; 3],
    up: [f64; 3],
    forward: [f64; 3],
    left: [f64; 3],
    horizon: f64,
    nodes: RayNodes,
    /// Logarithm of the light per metre next to the camera over the angle from the sun.
    envelope: Vec<Cell>,
}

/// Light and optical depth per metre of a ray.
struct Ray {
    light: Vec<Cell>,
    depth: Vec<Cell>,
}

impl<'a> RayLattice<'a> {
    pub fn new(aerial: &'a ColourAerialPerspective, camera: [f64; 3]) -> Result<Self> {
        if !camera.iter().all(|v| v.is_finite()) {
            return Err(Error::Point { got: camera });
        }
        let planet = aerial.transmittance().planet();
        let centre = [camera[0], camera[1], camera[2] + planet.radius];
        let distance = dot(centre, centre).sqrt();
        let up = centre.map(|v| v / distance);
        let forward = across(up, aerial.sun_direction());
        let altitude = (distance - planet.radius).max(0.0);
        let mut lattice = Self {
            aerial,
            camera,
            up,
            forward,
            left: cross(up, forward),
            horizon: -planet.dip(altitude).sin(),
            nodes: RayNodes::new(planet, altitude, -planet.dip(altitude).sin()),
            envelope: Vec::new(),
        };
        lattice.envelope = lattice.envelope()?;
        Ok(lattice)
    }

    pub fn buffers(&self) -> Result<AerialBuffers> {
        let (mut light, mut depth) = (Vec::new(), Vec::new());
        for (side, rows) in [(Side::Up, UP), (Side::Down, DOWN)] {
            let (mut values, mut depths) = (Vec::new(), Vec::new());
            for row in 0..=rows {
                let share = share_at_row(side, row as f64 / rows as f64);
                let pole = if side == Side::Up { 1.0 } else { -1.0 };
                let z = self.horizon + share * (pole - self.horizon);
                for column in 0..=COLUMNS {
                    let ray = self.ray(side, z, column as f64 / COLUMNS as f64)?;
                    values.extend(ray.light);
                    depths.extend(ray.depth);
                }
            }
            light.push(splines(&values, rows + 1));
            depth.push(splines(&depths, rows + 1));
        }
        let mut table: Vec<[f32; LANES]> = self.envelope.iter().map(|cell| cell.0).collect();
        for [up, down] in [light, depth].map(|sides| [0, 1].map(|i| sides[i].clone())) {
            table.extend(by_distance(&up, &down));
        }
        Ok(AerialBuffers {
            header: self.header(),
            table,
        })
    }

    /// A ray by the cosine of its angle from the vertical and half its azimuth's sine.
    fn ray(&self, side: Side, z: f64, half_sine: f64) -> Result<Ray> {
        let level = (1.0 - z * z).max(0.0).sqrt();
        let phi = 2.0 * half_sine.min(1.0).asin();
        let (y, x) = phi.sin_cos();
        let direction = core::array::from_fn(|i| {
            z * self.up[i] + level * (x * self.forward[i] + y * self.left[i])
        });
        let mut ray = self.march(direction, &self.nodes.distances(side, z, DISTANCES))?;
        let peak = self.peak(direction);
        for cell in &mut ray.light {
            *cell = *cell - peak;
        }
        Ok(ray)
    }

    /// What the envelope is in a direction.
    fn peak(&self, direction: [f64; 3]) -> Cell {
        let sun = self.aerial.sun_direction();
        let squares = (0..3).map(|i| (direction[i] - sun[i]).powi(2));
        let half = 0.5 * squares.sum::<f64>().sqrt();
        spline_value(&self.envelope, half.min(1.0) as f32)
    }

    fn march(&self, direction: [f64; 3], nodes: &[f64]) -> Result<Ray> {
        let distances = marched(nodes);
        let n = distances.len();
        let [mut light, mut factors] = [(); 2].map(|()| vec![[0.0; 3]; n]);
        self.aerial.rgb_along(
            self.camera,
            direction,
            &distances,
            ColourSpace::Xyz,
            &mut light,
            &mut factors,
        )?;
        let cell = |value: &dyn Fn(f32) -> f32, [x, y, z]: [f32; 3]| {
            Lanes([value(x), value(y), value(z), 0.0])
        };
        let per = |k: usize| 1.0 / distances[k] as f32;
        let rows = light.iter().zip(&factors).enumerate().step_by(STEPS);
        let (light, depth) = rows
            .map(|(k, (light, factors))| {
                let logarithm = |v: f32| (v * per(k)).max(DARK).log2();
                let depth = |v: f32| -v.clamp(DARK, 1.0).log2() * per(k);
                (cell(&logarithm, *light), cell(&depth, *factors))
            })
            .unzip();
        Ok(Ray { light, depth })
    }

    /// Around the circle through the sun that is level there: away from horizon and ground as far as can be.
    fn envelope(&self) -> Result<Vec<Cell>> {
        let sun = self.aerial.sun_direction();
        let near = |i: usize| -> Result<Cell> {
            let gamma = 2.0 * (i as f64 / SUN as f64).asin();
            let (sine, cosine) = gamma.sin_cos();
            let direction = core::array::from_fn(|i| cosine * sun[i] + sine * self.left[i]);
            Ok(self.march(direction, &[NEXT])?.light[0])
        };
        let values = (0..=SUN).map(near).collect::<Result<Vec<_>>>()?;
        Ok(coefficients(&values, Start::Mirrored))
    }

    fn header(&self) -> AerialHeader {
        let measure = self.nodes.measure();
        let single = |v: [f64; 3]| v.map(|v| v as f32);
        let horizon = self.horizon as f32;
        AerialHeader {
            sun: single(self.aerial.sun_direction()),
            horizon,
            up: single(self.up),
            height: measure.height as f32,
            forward: single(self.forward),
            top: measure.top as f32,
            left: single(self.left),
            bend: measure.bend as f32,
            white: self.aerial.white(),
            pole: POLE,
            shrink: [1.0 / (1.0 - horizon), 1.0 / (1.0 + horizon)],
            crowding: CROWDING,
            intervals: [UP, DOWN, COLUMNS].map(|n| n as u32),
            sun_intervals: SUN as u32,
            distances: DISTANCES as u32,
            steepness: measure.steepness as f32,
            haze: measure.haze as f32,
            nearness: measure.nearness as f32,
            per_stretch: measure.per_stretch as f32,
            unused: [0; 2],
            layout: AerialBuffers::LAYOUT,
        }
    }
}

/// Distances that a ray is marched to, [`STEPS`] for each interval after the first node. That is not where the camera
/// is, as light and depths per metre are asked for.
fn marched(nodes: &[f64]) -> Vec<f64> {
    let first = nodes[0].max(nodes.get(1).map_or(0.0, |next| 1e-3 * next));
    let mut distances = vec![first];
    for pair in nodes.windows(2) {
        let from = pair[0].max(first);
        let step = (pair[1] - from) / STEPS as f64;
        distances.extend((1..=STEPS).map(|k| from + step * k as f64));
    }
    distances
}

/// Coefficients `[row][column][distance]` from values in the same order, of which there are fewer.
fn splines(values: &[Cell], rows: usize) -> Vec<Cell> {
    let along: Vec<Cell> = (values.chunks_exact(DISTANCES + 1))
        .flat_map(|ray| coefficients(ray, Start::Free))
        .collect();
    let along = across_axis(&along, DISTANCES + 3, COLUMNS + 1, Start::Mirrored);
    across_axis(&along, (DISTANCES + 3) * (COLUMNS + 3), rows, Start::Free)
}

/// Makes coefficients of the values along an axis of `length` whose neighbours are `stride` apart.
fn across_axis(values: &[Cell], stride: usize, length: usize, start: Start) -> Vec<Cell> {
    let mut out = Vec::new();
    for block in values.chunks_exact(stride * length) {
        let lines: Vec<Vec<Cell>> = (0..stride)
            .map(|i| {
                let line: Vec<Cell> = block[i..].iter().step_by(stride).copied().collect();
                coefficients(&line, start)
            })
            .collect();
        out.extend((0..length + 2).flat_map(|k| lines.iter().map(move |line| line[k])));
    }
    out
}

/// From `[row][column][distance]` of both sides to `[distance][row][column]`.
fn by_distance<'a>(up: &'a [Cell], down: &'a [Cell]) -> impl Iterator<Item = [f32; LANES]> + 'a {
    let slice = move |k: usize| {
        let both = up[k..].iter().step_by(DISTANCES + 3);
        both.chain(down[k..].iter().step_by(DISTANCES + 3))
    };
    (0..DISTANCES + 3).flat_map(slice).map(|cell| cell.0)
}

/// A unit vector across `up` towards the sun; any where the sun is vertical.
fn across(up: [f64; 3], sun: [f64; 3]) -> [f64; 3] {
    let level = |v: [f64; 3]| -> [f64; 3] {
        let along = dot(v, up);
        core::array::from_fn(|i| v[i] - along * up[i])
    };
    let mut forward = level(sun);
    if dot(forward, forward) < 1e-16 {
        forward = level([1.0, 0.0, 0.0]);
    }
    let length = dot(forward, forward).sqrt();
    forward.map(|v| v / length)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

//! Volumes of slices in front of a camera: most rays are interpolated between those of a lattice.

use super::colour_segments::ColourAerialPerspective;
use crate::error::{Error, Result};
use crate::parallel::each_chunk;
use crate::sky::check_length;

/// Cells of the volume between two rays of the lattice, across and down.
const STEP: usize = 4;
/// What the ray in the middle of a cell may be off by: a share of the light, to which a little of the last slice's is
/// added, and of the factors. Beyond it all rays of the cell are marched.
const LIGHT: f32 = 3e-3;
const FAINT: f32 = 1e-3;
const FACTOR: f32 = 2e-3;
/// Share of the cells of a band that must be rough for its rows to be looked at one by one, and of those of a row for
/// all of the band to be marched.
const STEEP: f32 = 0.25;
const HOPELESS: f32 = 0.5;

/// A camera-aligned volume ("froxels"). Row `r`, column `c`, slice `k` ends at `from + depths[k] · (axis + x·right +
/// y·up)` with `x = (2c + 1) / columns − 1` and `y = 1 − (2r + 1) / rows`: with `axis` a unit vector and the other two
/// across it, as long as the tangents of half the fields of view, slices are planes and depths are along the axis.
///
/// ```
/// use welkin::{CameraVolume, Conditions, Model};
///
/// let aerial = Model::default_model()?.colour_aerial_perspective(&Conditions::default())?;
/// let volume = CameraVolume {
///     from: [0.0, 0.0, 2.0],
///     axis: [1.0, 0.0, 0.0],
///     right: [0.0, -0.8, 0.0],
///     up: [0.0, 0.0, 0.45],
///     size: [32, 18],
///     depths: &[100.0, 1e3, 10e3, 50e3],
/// };
/// let [mut light, mut factors] = [(); 2].map(|()| vec![[0.0; 3]; 32 * 18 * 4]);
/// aerial.linear_srgb_volume(&volume, &mut light, &mut factors)?;
/// assert!(light[3][2] > light[0][2] && factors[3][2] < factors[0][2]);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct CameraVolume<'a> {
    /// The camera, m, in the frame of the conditions: the origin is the ground below their place, +z up there.
    pub from: [f64; 3],
    /// The middle of the picture.
    pub axis: [f64; 3],
    /// From the middle to the right edge.
    pub right: [f64; 3],
    /// From the middle to the upper edge.
    pub up: [f64; 3],
    /// Columns and rows.
    pub size: [usize; 2],
    /// Where slices end, growing, in lengths of `axis`.
    pub depths: &'a [f64],
}

/// Light and factors of rays, `[ray][slice][channel]`.
struct Rays {
    light: Vec<[f32; 3]>,
    factors: Vec<[f32; 3]>,
}

/// Rays of every [`STEP`]th row and column, with one more around them: row and column `i` are `(i − 1) · STEP` of the
/// volume.
struct Lattice {
    size: [usize; 2],
    rays: Rays,
}

impl CameraVolume<'_> {
    /// The ray of a column and a row, as far as depth 1; those that are not whole numbers are between rays or beyond
    /// the edge.
    pub fn direction(&self, [column, row]: [f64; 2]) -> [f64; 3] {
        let x = (2.0 * column + 1.0) / self.size[0] as f64 - 1.0;
        let y = 1.0 - (2.0 * row + 1.0) / self.size[1] as f64;
        core::array::from_fn(|i| self.axis[i] + x * self.right[i] + y * self.up[i])
    }

    fn check(&self) -> Result<()> {
        for vector in [self.axis, self.right, self.up] {
            if !vector.iter().all(|v| v.is_finite()) {
                let got = vector.map(|v| v as f32);
                return Err(Error::Direction { got });
            }
        }
        Ok(())
    }

    fn lattice_size(&self) -> [usize; 2] {
        self.size.map(|n| n.div_ceil(STEP) + 3)
    }

    /// Whether a lattice and the middles of its cells are fewer rays than the volume has.
    fn is_worth_a_lattice(&self) -> bool {
        let [columns, rows] = self.lattice_size();
        2 * columns * rows < self.size[0] * self.size[1]
    }
}

impl ColourAerialPerspective {
    /// Fills a camera-aligned volume in linear sRGB; the outputs are `[rows][columns][depths]`: light in cd m⁻² and
    /// factors as of [`ColourAerialPerspective::linear_srgb`]. Allocates some megabytes; with the feature `rayon` it runs
    /// on all cores and waits for them.
    ///
    /// Every fourth ray across and down is marched ([`ColourAerialPerspective::linear_srgb_along`]) and one in the
    /// middle between four; others are interpolated where that gives the middle (to 0.3 % of light, 0.002 of factors).
    /// Where many of a band of rows are not, as about the horizon, its rows are looked at one by one, and cells that are
    /// off still, as about the sun and a slanted horizon, are marched whole. Small volumes are marched whole.
    ///
    /// # Errors
    /// As [`ColourAerialPerspective::linear_srgb_along`]; [`Error::Direction`] for an axis that is not finite;
    /// [`Error::Length`] unless both outputs have an element for every slice of every ray. One ray of the volume in error
    /// ends it: cameras high up must not look further than
    /// [`AerialPerspective::reach`](crate::AerialPerspective::reach) below the ground. The outputs may be written in part
    /// then.
    pub fn linear_srgb_volume(
        &self,
        volume: &CameraVolume,
        light: &mut [[f32; 3]],
        factors: &mut [[f32; 3]],
    ) -> Result<()> {
        let ([columns, rows], depths) = (volume.size, volume.depths.len());
        let length = columns.saturating_mul(rows).saturating_mul(depths);
        for got in [light.len(), factors.len()] {
            check_length(got, length)?;
        }
        volume.check()?;
        if length == 0 {
            return Ok(());
        }
        // Beyond the edge of the picture there may be rays that cannot be marched.
        let lattice = match volume.is_worth_a_lattice() {
            true => Lattice::new(self, volume).ok(),
            false => None,
        };
        let band = STEP * columns * depths;
        let bands = light.chunks_mut(band).zip(factors.chunks_mut(band));
        each_chunk(bands, |j, (light, factors)| {
            let band = Band {
                aerial: self,
                volume,
                first: j * STEP,
            };
            match &lattice {
                Some(lattice) => band
                    .interpolate(lattice, j, light, factors)
                    .or_else(|_| band.march_all(light, factors)),
                None => band.march_all(light, factors),
            }
        })
    }

    /// Every [`STEP`]th ray of a row, from that many steps on.
    fn march_row(
        &self,
        volume: &CameraVolume,
        [from, row]: [f64; 2],
        light: &mut [[f32; 3]],
        factors: &mut [[f32; 3]],
    ) -> Result<()> {
        let (depths, mut distances) = (volume.depths.len(), Vec::new());
        let rays = light.chunks_mut(depths).zip(factors.chunks_mut(depths));
        for (i, (light, factors)) in rays.enumerate() {
            let place = [(i as f64 + from) * STEP as f64, row];
            self.march_ray(volume, place, &mut distances, light, factors)?;
        }
        Ok(())
    }

    fn march_ray(
        &self,
        volume: &CameraVolume,
        place: [f64; 2],
        distances: &mut Vec<f64>,
        light: &mut [[f32; 3]],
        factors: &mut [[f32; 3]],
    ) -> Result<()> {
        let direction = volume.direction(place);
        let length = direction.iter().map(|v| v * v).sum::<f64>().sqrt();
        distances.clear();
        distances.extend(volume.depths.iter().map(|depth| depth * length));
        self.linear_srgb_along(volume.from, direction, distances, light, factors)
    }
}

impl Lattice {
    fn new(aerial: &ColourAerialPerspective, volume: &CameraVolume) -> Result<Self> {
        let (size, depths) = (volume.lattice_size(), volume.depths.len());
        let mut rays = Rays::new(size[0] * size[1] * depths);
        let row = size[0] * depths;
        let rows = rays.light.chunks_mut(row).zip(rays.factors.chunks_mut(row));
        each_chunk(rows, |j, (light, factors)| {
            let place = [-1.0, (j as f64 - 1.0) * STEP as f64];
            aerial.march_row(volume, place, light, factors)
        })?;
        Ok(Self { size, rays })
    }

    /// The rows of the lattice around band `j`, blended.
    fn blend_rows(&self, j: usize, weights: [f32; 4], out: &mut Rays) {
        let row = out.light.len();
        let parts = [
            (&self.rays.light, &mut out.light),
            (&self.rays.factors, &mut out.factors),
        ];
        for (from, to) in parts {
            let rows = core::array::from_fn(|k| from[(j + k) * row..][..row].as_flattened());
            blend(rows, weights, to.as_flattened_mut());
        }
    }
}

impl Rays {
    fn new(length: usize) -> Self {
        let [light, factors] = [(); 2].map(|()| vec![[0.0; 3]; length]);
        Self { light, factors }
    }

    /// The ray `t` cells behind column `i` of rays in a row.
    fn blend_columns(&self, i: usize, t: f32, light: &mut [[f32; 3]], factors: &mut [[f32; 3]]) {
        let (depths, weights) = (light.len(), weights(t));
        let parts = [(&self.light, &mut *light), (&self.factors, &mut *factors)];
        for (from, to) in parts {
            let columns =
                core::array::from_fn(|k| from[(i + k) * depths..][..depths].as_flattened());
            blend(columns, weights, to.as_flattened_mut());
        }
        for factor in factors.as_flattened_mut() {
            *factor = factor.clamp(0.0, 1.0);
        }
    }
}

/// [`STEP`] rows of a volume.
#[derive(Clone, Copy)]
struct Band<'a> {
    aerial: &'a ColourAerialPerspective,
    volume: &'a CameraVolume<'a>,
    first: usize,
}

impl Band<'_> {
    fn march_all(self, light: &mut [[f32; 3]], factors: &mut [[f32; 3]]) -> Result<()> {
        let ([columns, _], depths) = (self.volume.size, self.volume.depths.len());
        let rays = light.chunks_mut(depths);
        let mut distances = Vec::new();
        for (n, (light, factors)) in rays.zip(factors.chunks_mut(depths)).enumerate() {
            let place = [n % columns, self.first + n / columns].map(|n| n as f64);
            (self.aerial).march_ray(self.volume, place, &mut distances, light, factors)?;
        }
        Ok(())
    }

    /// Every [`STEP`]th ray of row `r` of the band, from that many steps on.
    fn march_row(self, count: usize, from: f64, r: usize) -> Result<Rays> {
        let row = (self.first + r) as f64;
        let mut rays = Rays::new(count * self.volume.depths.len());
        let (light, factors) = (&mut rays.light, &mut rays.factors);
        (self.aerial).march_row(self.volume, [from, row], light, factors)?;
        Ok(rays)
    }

    fn interpolate(
        self,
        lattice: &Lattice,
        j: usize,
        light: &mut [[f32; 3]],
        factors: &mut [[f32; 3]],
    ) -> Result<()> {
        let ([columns, _], depths) = (self.volume.size, self.volume.depths.len());
        let middles = self.march_row(lattice.size[0] - 3, 0.5, STEP / 2)?;
        let mut rays = Rays::new(lattice.size[0] * depths);
        lattice.blend_rows(j, weights(0.5), &mut rays);
        let rough = rough_cells(&rays, &middles, depths);
        let row = columns * depths;
        let rows = light.chunks_mut(row).zip(factors.chunks_mut(row));
        if share(&rough) <= STEEP {
            for (r, (light, factors)) in rows.enumerate() {
                lattice.blend_rows(j, weights(r as f32 / STEP as f32), &mut rays);
                self.fill_row(r, &rays, &rough, light, factors)?;
            }
            return Ok(());
        }
        // As about the horizon: rows differ more than columns do.
        let rays = self.march_row(lattice.size[0], -1.0, STEP / 2)?;
        let rough = rough_cells(&rays, &middles, depths);
        if share(&rough) > HOPELESS {
            return self.march_all(light, factors);
        }
        for (r, (light, factors)) in rows.enumerate() {
            match r == STEP / 2 {
                true => self.fill_row(r, &rays, &rough, light, factors)?,
                false => self.march_steep(lattice.size[0], r, light, factors)?,
            }
        }
        Ok(())
    }

    /// A row from its own rays, every [`STEP`]th and those in the middle between them.
    fn march_steep(
        self,
        count: usize,
        r: usize,
        light: &mut [[f32; 3]],
        factors: &mut [[f32; 3]],
    ) -> Result<()> {
        let rays = self.march_row(count, -1.0, r)?;
        let middles = self.march_row(count - 3, 0.5, r)?;
        let rough = rough_cells(&rays, &middles, self.volume.depths.len());
        self.fill_row(r, &rays, &rough, light, factors)
    }

    /// Interpolates between rays of a row, and marches cells that are rough.
    fn fill_row(
        self,
        r: usize,
        rays: &Rays,
        rough: &[bool],
        light: &mut [[f32; 3]],
        factors: &mut [[f32; 3]],
    ) -> Result<()> {
        let depths = self.volume.depths.len();
        let mut distances = Vec::new();
        let parts = (light.chunks_mut(depths)).zip(factors.chunks_mut(depths));
        for (c, (light, factors)) in parts.enumerate() {
            if rough[c / STEP] {
                let place = [c as f64, (self.first + r) as f64];
                (self.aerial).march_ray(self.volume, place, &mut distances, light, factors)?;
            } else {
                let t = (c % STEP) as f32 / STEP as f32;
                rays.blend_columns(c / STEP, t, light, factors);
            }
        }
        Ok(())
    }
}

/// For each cell whether the ray in its middle, or in that of a neighbour, is not what is interpolated there.
fn rough_cells(rays: &Rays, middles: &Rays, depths: usize) -> Vec<bool> {
    let mut between = Rays::new(depths);
    let middles = middles
        .light
        .chunks(depths)
        .zip(middles.factors.chunks(depths));
    let rough = middles.enumerate().map(|(i, (light, factors))| {
        rays.blend_columns(i, 0.5, &mut between.light, &mut between.factors);
        !alike([light, &between.light], [factors, &between.factors])
    });
    let rough: Vec<bool> = rough.collect();
    let last = rough.len() - 1;
    (0..=last)
        .map(|i| rough[i.saturating_sub(1)..=(i + 1).min(last)].contains(&true))
        .collect()
}

fn share(rough: &[bool]) -> f32 {
    rough.iter().filter(|rough| **rough).count() as f32 / rough.len() as f32
}

fn alike(light: [&[[f32; 3]]; 2], factors: [&[[f32; 3]]; 2]) -> bool {
    let faint = FAINT * light[0].last().map_or(0.0, |light| light[1]);
    let near =
        |a: &[f32; 3], b: &[f32; 3], limit: f32| (0..3).all(|i| (a[i] - b[i]).abs() <= limit);
    let mut slices = light[0].iter().zip(light[1]);
    slices.all(|(a, b)| near(a, b, LIGHT * (a[1] + faint)))
        && (factors[0].iter().zip(factors[1])).all(|(a, b)| near(a, b, FACTOR))
}

/// Weights of four rays at −1, 0, 1 and 2: Catmull and Rom's.
fn weights(t: f32) -> [f32; 4] {
    let s = 1.0 - t;
    [
        -0.5 * t * s * s,
        1.0 + t * t * (1.5 * t - 2.5),
        1.0 + s * s * (1.5 * s - 2.5),
        -0.5 * s * t * t,
    ]
}

fn blend(rays: [&[f32]; 4], weights: [f32; 4], out: &mut [f32]) {
    let [a, b, c, d] = rays.map(|ray| &ray[..out.len()]);
    for (i, out) in out.iter_mut().enumerate() {
        let sum = weights[0] * a[i] + weights[1] * b[i] + weights[2] * c[i] + weights[3] * d[i];
        *out = sum;
    }
}

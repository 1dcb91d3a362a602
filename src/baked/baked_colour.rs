//! A baked sky in colour.

use super::baked_tables::Baked;
use super::batch::{Directions, Group, Sink, check_length};
use super::coordinates::LocalFrame;
use super::fill::Channels;
use super::grid_choice::BakeError;
use super::spline_table::Table;
use crate::bands::ColourSky;
use crate::conditions::Conditions;
use crate::error::Result;
use crate::kernel::lanes::Lanes;
use crate::sky::{ColourSpace, Sky};

/// X, Y, Z and nothing: the width of a vector.
const LANES: usize = 4;

/// A sky as tables of about 12 kB that hold the colours and no wavelengths. Otherwise as [`BakedSky`](crate::BakedSky).
///
/// The tables hold CIE XYZ, as the components of wide-gamut skies in RGB can be negative.
///
/// ```
/// use welkin::{BakedSky, Conditions, Model};
///
/// let sky = Model::default_model()?.sky(&Conditions::default())?;
/// let baked = sky.bake_colour(BakedSky::TOLERANCE)?;
/// let [red, _, blue] = baked.linear_srgb([0.0, 0.0, 1.0])?; // cd m⁻²
/// assert!(blue > red);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct BakedColourSky {
    pub(super) baked: Baked<LANES>,
}

struct Xyz<'a>(&'a Sky);

impl Channels<LANES> for Xyz<'_> {
    fn blocks(&self) -> usize {
        1
    }

    fn count(&self) -> usize {
        3
    }

    #[inline(always)]
    fn project(&self, radiance: &[f32], mut emit: impl FnMut(usize, Lanes<LANES>)) {
        let [x, y, z] = self.0.project_xyz(radiance);
        emit(0, Lanes([x, y, z, 1.0]));
    }
}

impl Sky {
    /// As [`Sky::bake`], for colours.
    ///
    /// # Errors
    /// As [`Sky::bake`].
    pub fn bake_colour(&self, tolerance: f64) -> Result<BakedColourSky> {
        let sky = self.coloured();
        let baked = Baked::new(sky, &Xyz(sky), tolerance)?;
        Ok(BakedColourSky { baked })
    }
}

impl ColourSky {
    /// Bakes the sky into tables of the sizes of `other`, which holds that at conditions nearby: the next frame under
    /// a sun that moves. What takes most of the time of [`ColourSky::bake`], measuring the error and choosing the
    /// sizes, is left out: the tolerance is kept about as well as `other` keeps it, and
    /// [`BakedColourSky::bake_error`] is that of `other`. Bake afresh every degree or so: sizes that were chosen far away
    /// keep it no more (from 10 to −8° at 9 km, p95 0.8 % instead of 0.25). While sizes stay, a small step of the conditions changes no
    /// pixel by more than it changes the sky.
    ///
    /// ```
    /// use welkin::{BakedSky, Conditions, Model};
    ///
    /// let model = Model::default_model()?;
    /// let mut conditions = Conditions::default();
    /// let mut frame = model.colour_sky(&conditions)?.bake(BakedSky::TOLERANCE)?;
    /// for _ in 0..3 {
    ///     conditions.solar_elevation -= 0.01_f64.to_radians();
    ///     frame = model.colour_sky(&conditions)?.bake_like(&frame);
    /// }
    /// assert_eq!(frame.conditions().solar_elevation, conditions.solar_elevation);
    /// # Ok::<(), welkin::Error>(())
    /// ```
    pub fn bake_like(&self, other: &BakedColourSky) -> BakedColourSky {
        BakedColourSky {
            baked: other.baked.like(self.sky(), &Xyz(self.sky())),
        }
    }

    /// As [`Sky::bake_colour`].
    ///
    /// # Errors
    /// As [`Sky::bake`].
    pub fn bake(&self, tolerance: f64) -> Result<BakedColourSky> {
        self.sky().bake_colour(tolerance)
    }
}

impl BakedColourSky {
    /// The conditions that the sky was prepared for.
    pub fn conditions(&self) -> &Conditions {
        &self.baked.conditions
    }

    /// As [`Sky::set_solar_azimuth`].
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] if the azimuth is not finite.
    pub fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        self.baked.set_solar_azimuth(azimuth)
    }

    /// What baking added to the error of X, Y and Z.
    pub fn bake_error(&self) -> BakeError {
        self.baked.error
    }

    pub(super) fn table(&self) -> &Table<LANES> {
        &self.baked.table
    }

    pub(super) fn frame(&self) -> LocalFrame {
        self.baked.frame
    }

    /// Memory on the heap, bytes.
    pub fn bytes(&self) -> usize {
        self.baked.table.bytes()
    }

    /// As [`Sky::xyz`].
    ///
    /// # Errors
    /// [`crate::Error::Direction`] for a vector that is zero or not finite.
    #[inline]
    pub fn xyz(&self, direction: [f32; 3]) -> Result<[f32; 3]> {
        self.one(direction, CieXyz)
    }

    /// As [`Sky::linear_srgb`].
    ///
    /// # Errors
    /// [`crate::Error::Direction`] for a vector that is zero or not finite.
    #[inline]
    pub fn linear_srgb(&self, direction: [f32; 3]) -> Result<[f32; 3]> {
        self.one(direction, Rgb(ColourSpace::Srgb.matrix()))
    }

    /// [`BakedColourSky::xyz`] for many directions.
    ///
    /// # Errors
    /// [`crate::Error::Direction`]; [`crate::Error::Length`] for components of different lengths, or unless `out` has
    /// one element per direction. What precedes a bad direction may or may not be written.
    pub fn xyz_batch(&self, directions: &Directions, out: &mut [[f32; 3]]) -> Result<()> {
        self.batch(directions, out, CieXyz)
    }

    /// [`BakedColourSky::linear_srgb`] for many directions.
    ///
    /// # Errors
    /// As [`BakedColourSky::xyz_batch`].
    pub fn linear_srgb_batch(&self, directions: &Directions, out: &mut [[f32; 3]]) -> Result<()> {
        self.batch(directions, out, Rgb(ColourSpace::Srgb.matrix()))
    }

    /// As [`BakedColourSky::linear_srgb`], in any colour space.
    ///
    /// # Errors
    /// [`crate::Error::Direction`] for a vector that is zero or not finite.
    #[inline]
    pub fn rgb(&self, direction: [f32; 3], space: ColourSpace) -> Result<[f32; 3]> {
        match space {
            ColourSpace::Xyz => self.xyz(direction),
            _ => self.one(direction, Rgb(space.matrix())),
        }
    }

    /// [`BakedColourSky::rgb`] for many directions.
    ///
    /// # Errors
    /// As [`BakedColourSky::xyz_batch`].
    pub fn rgb_batch(
        &self,
        directions: &Directions,
        space: ColourSpace,
        out: &mut [[f32; 3]],
    ) -> Result<()> {
        match space {
            ColourSpace::Xyz => self.xyz_batch(directions, out),
            _ => self.batch(directions, out, Rgb(space.matrix())),
        }
    }

    #[inline(always)]
    fn one(&self, direction: [f32; 3], space: impl Space) -> Result<[f32; 3]> {
        let mut out = [[0.0; 3]];
        let sink = Colours {
            out: &mut out,
            space,
        };
        self.baked.one(direction, sink)?;
        Ok(out[0])
    }

    #[inline(always)]
    fn batch(
        &self,
        directions: &Directions,
        out: &mut [[f32; 3]],
        space: impl Space,
    ) -> Result<()> {
        directions.check()?;
        check_length("output", out.len(), directions.len())?;
        self.baked.each(directions, Colours { out, space })
    }
}

/// Colours one after another.
struct Colours<'a, C> {
    out: &'a mut [[f32; 3]],
    space: C,
}

impl<C: Space> Sink<LANES> for Colours<'_, C> {
    #[inline(always)]
    fn put<const W: usize>(&mut self, group: &Group<LANES, W>) {
        let mut logarithms = [Lanes::splat(0.0); W];
        for i in 0..group.count {
            logarithms[i] = group.table.logarithm(group.spots, i, 0);
        }
        let [x, y, z, _] = transpose(&logarithms);
        let opacity = group.spots.opacity;
        let xyz = [x.exp2() * opacity, y.exp2() * opacity, z.exp2() * opacity];
        let [r, g, b] = self.space.convert(xyz);
        let (r, g, b) = (r.0, g.0, b.0);
        for (i, out) in self.out[group.first..][..group.count]
            .iter_mut()
            .enumerate()
        {
            *out = [r[i], g[i], b[i]];
        }
    }
}

/// A colour space.
trait Space {
    fn convert<const W: usize>(&self, xyz: [Lanes<W>; 3]) -> [Lanes<W>; 3];
}

struct CieXyz;

impl Space for CieXyz {
    #[inline(always)]
    fn convert<const W: usize>(&self, xyz: [Lanes<W>; 3]) -> [Lanes<W>; 3] {
        xyz
    }
}

/// By a matrix.
struct Rgb([[f32; 3]; 3]);

impl Space for Rgb {
    #[inline(always)]
    fn convert<const W: usize>(&self, [x, y, z]: [Lanes<W>; 3]) -> [Lanes<W>; 3] {
        let [r, g, b] = self.0;
        [weigh(x, y, z, r), weigh(x, y, z, g), weigh(x, y, z, b)]
    }
}

#[inline(always)]
fn weigh<const W: usize>(x: Lanes<W>, y: Lanes<W>, z: Lanes<W>, weight: [f32; 3]) -> Lanes<W> {
    let limit = Lanes::splat(f32::MAX);
    let sum = x * weight[0] + y * weight[1] + z * weight[2];
    sum.min(limit).max(-limit)
}

#[inline(always)]
fn transpose<const W: usize>(rows: &[Lanes<LANES>; W]) -> [Lanes<W>; LANES] {
    let mut columns = [Lanes::splat(0.0); LANES];
    for (k, column) in columns.iter_mut().enumerate() {
        for i in 0..W {
            column.0[i] = rows[i].0[k];
        }
    }
    columns
}

//! Many directions at once.

use super::coordinates::{LocalFrame, prepared};
use super::spline_table::{Spots, Table};
use crate::error::{Error, Result};
use crate::kernel::lanes::Lanes;
use crate::kernel::simd::{Instructions, Kernel};

/// Directions as a structure of arrays of equal length. They need not be normalised.
///
/// ```
/// use welkin::{BakedSky, Conditions, Directions, Model};
///
/// let sky = Model::default_model()?.sky(&Conditions::default())?;
/// let baked = sky.bake_colour(BakedSky::TOLERANCE)?;
/// let directions = Directions { x: &[0.0, 1.0], y: &[0.0, 0.0], z: &[1.0, 0.1] };
/// let mut rgb = [[0.0; 3]; 2];
/// baked.linear_srgb_batch(&directions, &mut rgb)?;
/// assert_eq!(rgb[0], baked.linear_srgb([0.0, 0.0, 1.0])?); // the same bits
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Directions<'a> {
    /// Components along x.
    pub x: &'a [f32],
    /// Components along y.
    pub y: &'a [f32],
    /// Components along z, up.
    pub z: &'a [f32],
}

impl Directions<'_> {
    /// Number of directions.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    pub(super) fn check(&self) -> Result<()> {
        check_length("y of directions", self.y.len(), self.len())?;
        check_length("z of directions", self.z.len(), self.len())
    }
}

/// A direction that is the only one.
pub(super) fn alone(direction: &[f32; 3]) -> Directions<'_> {
    let [x, y, z] = direction.each_ref().map(core::slice::from_ref);
    Directions { x, y, z }
}

pub(super) fn check_length(what: &'static str, got: usize, expected: usize) -> Result<()> {
    if got == expected {
        return Ok(());
    }
    Err(Error::Length {
        what,
        expected: expected as u64,
        got: got as u64,
    })
}

/// Directions that are located together.
const WIDTH: usize = 8;

/// Where results go.
pub(super) trait Sink<const N: usize> {
    /// Must be `#[inline(always)]`.
    fn put<const W: usize>(&mut self, group: &Group<N, W>);
}

/// Directions that were looked up together.
pub(super) struct Group<'a, const N: usize, const W: usize> {
    /// Index of the first.
    pub first: usize,
    /// How many of them count.
    pub count: usize,
    pub table: &'a Table<N>,
    pub spots: &'a Spots<W>,
    /// The directions as vectors of any length.
    pub vectors: &'a [Lanes<W>; 3],
}

/// Looks up directions until one is bad.
pub(super) struct Each<'a, const N: usize, S> {
    pub frame: &'a LocalFrame,
    pub table: &'a Table<N>,
    pub directions: Directions<'a>,
    pub sink: S,
}

impl<const N: usize, S: Sink<N>> Kernel for Each<'_, N, S> {
    type Output = Result<()>;

    #[inline(always)]
    fn run<I: Instructions>(mut self, _: I) -> Result<()> {
        let x = self.directions.x.as_chunks();
        let y = self.directions.y.as_chunks();
        let z = self.directions.z.as_chunks();
        let mut first = 0;
        for ((&x, &y), &z) in x.0.iter().zip(y.0).zip(z.0) {
            self.group(first, WIDTH, [Lanes(x), Lanes(y), Lanes(z)])?;
            first += WIDTH;
        }
        self.group(first, x.1.len(), [pad(x.1), pad(y.1), pad(z.1)])
    }
}

/// The last few directions and some that do not matter.
fn pad(rest: &[f32]) -> Lanes<WIDTH> {
    let mut lanes = Lanes::splat(1.0);
    lanes.0[..rest.len()].copy_from_slice(rest);
    lanes
}

impl<const N: usize, S: Sink<N>> Each<'_, N, S> {
    #[inline(always)]
    fn group(&mut self, first: usize, count: usize, d: [Lanes<WIDTH>; 3]) -> Result<()> {
        let Some(prepared) = prepared(d) else {
            return Err(Error::Direction { got: unsound(d) });
        };
        let spots = self.table.spots(self.frame.locate(prepared));
        self.sink.put(&Group {
            first,
            count,
            table: self.table,
            spots: &spots,
            vectors: &prepared,
        });
        Ok(())
    }
}

/// Looks up one direction.
pub(super) struct One<'a, const N: usize, S> {
    pub frame: &'a LocalFrame,
    pub table: &'a Table<N>,
    pub direction: [f32; 3],
    pub sink: S,
}

impl<const N: usize, S: Sink<N>> Kernel for One<'_, N, S> {
    type Output = Result<()>;

    #[inline(always)]
    fn run<I: Instructions>(mut self, _: I) -> Result<()> {
        // Four times the same costs no more than once, and vectors choose without branches.
        let [x, y, z] = self.direction;
        let direction = [Lanes::<4>::splat(x), Lanes::splat(y), Lanes::splat(z)];
        let Some(prepared) = prepared(direction) else {
            return Err(Error::Direction {
                got: self.direction,
            });
        };
        let spots = self.table.spots(self.frame.locate(prepared));
        self.sink.put(&Group {
            first: 0,
            count: 1,
            table: self.table,
            spots: &spots,
            vectors: &prepared,
        });
        Ok(())
    }
}

/// The first vector without a direction.
#[cold]
fn unsound(d: [Lanes<WIDTH>; 3]) -> [f32; 3] {
    let vector = |i: usize| d.map(|component| component.0[i]);
    let bad = |v: &[f32; 3]| prepared(v.map(|c| Lanes([c]))).is_none();
    (0..WIDTH).map(vector).find(bad).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::super::BakedSky;
    use super::super::baked_tables::Baked;
    use super::*;
    use crate::kernel::simd::{Portable, dispatch};
    use crate::{Conditions, Model};

    struct Values(Vec<[f32; 16]>);

    impl Sink<16> for &mut Values {
        #[inline(always)]
        fn put<const W: usize>(&mut self, group: &Group<16, W>) {
            let values = (0..group.count).map(|i| group.table.value(group.spots, i, 0).0);
            self.0.extend(values);
        }
    }

    #[test]
    #[cfg(feature = "default-model")]
    fn narrow_and_wide_vectors_give_the_same_bits() {
        let model = Model::default_model().unwrap();
        let sky = model.sky(&Conditions::default()).unwrap();
        let BakedSky { baked, .. } = sky.bake(BakedSky::TOLERANCE).unwrap();
        let Baked { frame, table, .. } = &baked;
        let wave = |k: f32| (0..1003).map(move |i| (k * i as f32 + 1.0).sin()).collect();
        let [x, y, z]: [Vec<f32>; 3] = [0.7, 1.1, 0.9].map(wave);
        let directions = Directions {
            x: &x,
            y: &y,
            z: &z,
        };
        let each = |sink| Each {
            frame,
            table,
            directions,
            sink,
        };
        let [mut narrow, mut wide] = [Values(Vec::new()), Values(Vec::new())];
        each(&mut narrow).run(Portable).unwrap();
        dispatch(each(&mut wide)).unwrap();
        assert_eq!(narrow.0, wide.0);
        assert_eq!(wide.0.len(), 1003);
    }
}

//! Tables of the estimates that fields are relative to (kind 10), in place. Format specification, section 6.10.

use zerocopy::little_endian::{F32, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::views::{check_length, take};
use crate::error::{Error, Result};

/// Width of the rows of constituents; files with more constituents have no estimates.
pub const MAX_ESTIMATE_CONSTITUENTS: usize = 8;
/// Most wavelengths of files with estimates.
pub const MAX_ESTIMATE_WAVELENGTHS: usize = 64;
/// Most levels.
pub const MAX_LEVELS: usize = 24;
/// Most rings.
const MAX_RINGS: u32 = 4;
/// Most estimates.
pub const MAX_ESTIMATES: usize = 4;
/// Most angles and suns, and most samples of the density.
const MAX_ANGLES: u32 = 256;
const MAX_DENSITIES: u32 = 4096;
/// Largest density, and largest logarithms.
const DENSEST: f32 = 1e6;
const LARGEST: f32 = 80.0;

#[derive(Clone, Copy, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub(super) struct EstimateCounts {
    pub levels: U32,
    pub angles: U32,
    pub suns: U32,
    pub densities: U32,
    pub rings: U32,
    pub estimates: U32,
    pub sun_lowest: F32,
    pub sun_width: F32,
}

/// Tables of the estimates that fields are relative to.
///
/// ```
/// use welkin::format::{EstimateView, Kind, parse};
///
/// let file = welkin::DEFAULT_MODEL;
/// let contents = parse(file)?;
/// let head = &contents.head;
/// if let Some(entry) = contents.directory.iter().find(|e| e.kind == Kind::Estimate) {
///     let bytes = &file[entry.offset..][..entry.length];
///     let view = EstimateView::new(bytes, head.constituents, head.wavelengths.len(), head.planet.top)?;
///     assert_eq!(view.level[0].get(), 0.0); // m
/// }
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct EstimateView<'a> {
    /// Constituents of the air.
    pub constituents: usize,
    /// Angles above the horizon.
    pub angles: usize,
    /// Solar elevations.
    pub suns: usize,
    /// Samples of the density.
    pub densities: usize,
    /// Wavelengths, rounded up to a multiple of 8: the width of rows over wavelengths.
    pub light_stride: usize,
    /// Sine of the lowest solar elevation of `light`.
    pub sun_lowest: f32,
    /// Sines of solar elevations of `light` are equidistant in arsinh(sine / width).
    pub sun_width: f32,
    /// Altitudes at which a ray has stops, m, from 0 to the top of the atmosphere.
    pub level: &'a [F32],
    /// Altitudes of rays of the sun that touch the Earth, behind which a view ray has stops, m.
    pub ring: &'a [F32],
    /// Bit k: constituent k scatters in the estimate. The last estimate is of diffuse light, the others of sunlight.
    pub scatters: &'a [U32],
    /// Share of the extinction that an estimate scatters, `[estimates][constituents][light_stride]`.
    pub albedo: &'a [F32],
    /// Profiles of the constituents, `[densities][8]`, equidistant in the root of the altitude.
    pub density: &'a [F32],
    /// ln of columns to space, m, `[levels][angles][8]`, equidistant in the root of the angle from horizon to zenith.
    pub column: &'a [F32],
    /// ln of the mean radiance of scattered light, sr⁻¹, `[levels][suns][light_stride]`.
    pub light: &'a [F32],
}

impl<'a> EstimateView<'a> {
    /// Views the bytes of a raw chunk of an atmosphere with the given top (m).
    ///
    /// # Errors
    /// [`Error::Invalid`] if they break the specification.
    pub fn new(bytes: &'a [u8], constituents: usize, wavelengths: usize, top: f64) -> Result<Self> {
        let view = Self::divide(bytes, constituents, wavelengths)?;
        view.check(wavelengths, top)?;
        Ok(view)
    }

    /// The same without a look at the numbers.
    pub(crate) fn divide(bytes: &'a [u8], constituents: usize, wavelengths: usize) -> Result<Self> {
        require(
            constituents <= MAX_ESTIMATE_CONSTITUENTS,
            "files with more than 8 constituents have no estimates",
        )?;
        require(
            wavelengths <= MAX_ESTIMATE_WAVELENGTHS,
            "files with more than 64 wavelengths have no estimates",
        )?;
        let mut rest = bytes;
        let counts = take::<EstimateCounts>(&mut rest, 1)?[0];
        let levels = within(counts.levels, 2, MAX_LEVELS as u32)?;
        let angles = within(counts.angles, 2, MAX_ANGLES)?;
        let suns = within(counts.suns, 2, MAX_ANGLES)?;
        let densities = within(counts.densities, 2, MAX_DENSITIES)?;
        let rings = within(counts.rings, 0, MAX_RINGS)?;
        let estimates = within(counts.estimates, 1, MAX_ESTIMATES as u32)?;
        let stride = wavelengths.next_multiple_of(8);
        let albedos = estimates * constituents * stride;
        let rows = MAX_ESTIMATE_CONSTITUENTS * (densities + levels * angles);
        let numbers = levels + rings + estimates + albedos + rows + levels * suns * stride;
        let expected = size_of::<EstimateCounts>() + 4 * numbers;
        check_length("estimate chunk", bytes, expected)?;
        Ok(Self {
            constituents,
            angles,
            suns,
            densities,
            light_stride: stride,
            sun_lowest: counts.sun_lowest.get(),
            sun_width: counts.sun_width.get(),
            level: take(&mut rest, levels)?,
            ring: take(&mut rest, rings)?,
            scatters: take(&mut rest, estimates)?,
            albedo: take(&mut rest, albedos)?,
            density: take(&mut rest, MAX_ESTIMATE_CONSTITUENTS * densities)?,
            column: take(&mut rest, MAX_ESTIMATE_CONSTITUENTS * levels * angles)?,
            light: take(&mut rest, levels * suns * stride)?,
        })
    }

    /// Whether what is beyond the constituents and these wavelengths is zero, every bit of it.
    #[cfg(feature = "std")]
    pub(super) fn is_padded(&self, wavelengths: usize) -> bool {
        let zero = |table: &[F32], stride: usize, width: usize| {
            let mut rows = table.chunks_exact(stride);
            rows.all(|row| row[width..].iter().all(|v| v.get().to_bits() == 0))
        };
        let spectral = [self.albedo, self.light];
        let rows = [self.density, self.column];
        spectral
            .iter()
            .all(|t| zero(t, self.light_stride, wavelengths))
            && rows
                .iter()
                .all(|t| zero(t, MAX_ESTIMATE_CONSTITUENTS, self.constituents))
    }

    /// Constituents that scatter in any estimate, as in `scatters`.
    #[inline(always)]
    pub(crate) fn any_scatters(&self) -> u32 {
        self.scatters.iter().fold(0, |any, s| any | s.get())
    }

    fn check(&self, wavelengths: usize, top: f64) -> Result<()> {
        let level = |l: usize| f64::from(self.level[l].get());
        let last = self.level.len() - 1;
        let rising = (0..last).all(|l| level(l) + 1e-3 <= level(l + 1));
        require(
            level(0) == 0.0 && rising && level(last) == f64::from(top as f32),
            "levels must increase from 0 to the top of the atmosphere",
        )?;
        let ring = |z: &F32| (0.0..=top as f32).contains(&z.get());
        require(
            self.ring.iter().all(ring),
            "rings must be between the ground and the top of the atmosphere",
        )?;
        let known = |bits: &U32| bits.get() >> self.constituents == 0;
        require(
            self.scatters.iter().all(known),
            "only constituents of the file scatter",
        )?;
        require(
            (-1.0..=0.0).contains(&self.sun_lowest) && (1e-3..=1e3).contains(&self.sun_width),
            "the axis of solar elevations starts between -1 and 0 and has a width of 1e-3 to 1e3",
        )?;
        let (stride, width) = (self.light_stride, MAX_ESTIMATE_CONSTITUENTS);
        let (nw, nk) = (wavelengths, self.constituents);
        require(
            within_rows(self.albedo, [stride, nw], [0.0, 1.0])
                && within_rows(self.density, [width, nk], [0.0, DENSEST])
                && within_rows(self.column, [width, nk], [-LARGEST, LARGEST])
                && within_rows(self.light, [stride, nw], [-LARGEST, LARGEST]),
            "albedos must be 0 to 1, densities 0 to 1e6, logarithms within 80",
        )
    }
}

/// Whether the first numbers of each row are in a range and the others, which are padding, finite.
fn within_rows(table: &[F32], [stride, width]: [usize; 2], [low, high]: [f32; 2]) -> bool {
    table.chunks_exact(stride).all(|row| {
        let (counted, padding) = row.split_at(width);
        counted.iter().all(|v| (low..=high).contains(&v.get()))
            && padding.iter().all(|v| v.get().is_finite())
    })
}

fn require(holds: bool, detail: &'static str) -> Result<()> {
    match holds {
        true => Ok(()),
        false => Err(Error::invalid("estimate chunk", detail)),
    }
}

fn within(count: U32, least: u32, most: u32) -> Result<usize> {
    let got = count.get();
    match (least..=most).contains(&got) {
        true => Ok(got as usize),
        false => Err(Error::invalid(
            "estimate chunk",
            "a count is out of its range",
        )),
    }
}

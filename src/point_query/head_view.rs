//! The head of a file in place, also where only the head is there: what a query needs, checked as every reader does.

use zerocopy::FromBytes;
use zerocopy::little_endian::{F32, F64, U32};

use super::head_counts::check_counts;
use crate::error::{Error, Result};
use crate::format::{
    CRC_RANGE, ENTRY_LENGTH, FEATURE_ESTIMATE, Header, MAGIC, RawEntry, Shape, VERSION_MAJOR,
};
use crate::geometry::Planet;
use crate::kernel::axis::ElevationAxis;

/// Axes and tables, borrowed from the file. Format specification, sections 3 and 4.
#[derive(Clone, Copy)]
pub(crate) struct HeadView<'a> {
    pub file_length: u64,
    pub shape: Shape,
    pub planet: Planet,
    /// Intervals and exponent above and below the horizon.
    pub alpha: [(usize, f64); 2],
    pub phi_intervals: usize,
    pub elevation: ElevationAxis,
    pub wavelengths: &'a [F64],
    pub altitudes: &'a [F64],
    pub visibilities: &'a [F64],
    /// `[visibility][constituent][wavelength]`.
    pub extinction: &'a [F64],
    /// Bit k: constituent k absorbs and does not scatter.
    pub absorbers: u16,
    /// `[visibility][wavelength]`.
    pub spherical_albedo: &'a [F64],
    /// `[field][wavelength]`.
    pub phase_parameter: &'a [F64],
    pub solar_axis: [f64; 2],
    pub solar: &'a [F32],
    pub fields: &'a [U32],
    pub directory: &'a [RawEntry],
}

/// What stands in a head that no query needs.
pub(super) struct Rest<'a> {
    pub xyz: &'a [F64],
    pub metadata: &'a [u8],
    pub padding: &'a [u8],
    pub head_length: u64,
    pub required_features: u32,
}

impl<'a> HeadView<'a> {
    /// Takes a head apart after comparing lengths, counts and checksum; its values are not checked yet.
    pub(super) fn parse(bytes: &'a [u8]) -> Result<(Self, Rest<'a>)> {
        let (header, head) = split(bytes)?;
        check_counts(header)?;
        let n = |count: zerocopy::little_endian::U16| usize::from(count.get());
        let (nw, nv, nk) = (
            n(header.wavelengths),
            n(header.visibilities),
            n(header.constituents),
        );
        let nf = n(header.fields);
        let mut rest = head;
        let (xyz, metadata, padding);
        let view = Self {
            file_length: header.file_length.get(),
            shape: Shape {
                up: n(header.alpha_up_intervals) + 3,
                down: n(header.alpha_down_intervals) + 3,
                phi: n(header.phi_intervals) + 1,
                elevation: n(header.elevation_intervals) + 3,
                wavelengths: nw,
                channels: nf * nw,
                constituents: nk,
                levels: match header.required_features.get() & FEATURE_ESTIMATE {
                    0 => n(header.elevation_intervals) + 3,
                    _ => 0,
                },
            },
            planet: Planet {
                radius: header.planet_radius.get(),
                top: header.top_altitude.get(),
            },
            alpha: [
                (n(header.alpha_up_intervals), header.alpha_up_exponent.get()),
                (
                    n(header.alpha_down_intervals),
                    header.alpha_down_exponent.get(),
                ),
            ],
            phi_intervals: n(header.phi_intervals),
            elevation: ElevationAxis {
                min: header.elevation_min.get(),
                max: header.elevation_max.get(),
                centre: header.elevation_centre.get(),
                width: header.elevation_width.get(),
                intervals: n(header.elevation_intervals),
            },
            wavelengths: take(&mut rest, nw)?,
            altitudes: take(&mut rest, n(header.altitudes))?,
            visibilities: take(&mut rest, nv)?,
            extinction: take(&mut rest, nv * nk * nw)?,
            absorbers: header.absorbers(),
            spherical_albedo: take(&mut rest, nv * nw)?,
            phase_parameter: take(&mut rest, nf * nw)?,
            solar_axis: {
                xyz = take(&mut rest, 3 * nw)?;
                let axis: &[F64] = take(&mut rest, 2)?;
                [axis[0].get(), axis[1].get()]
            },
            solar: take(&mut rest, n(header.solar_samples))?,
            fields: take(&mut rest, nf)?,
            directory: {
                metadata = take(&mut rest, header.metadata_length.get() as usize)?;
                let used = head.len() - rest.len();
                padding = take(&mut rest, used.next_multiple_of(8) - used)?;
                take(&mut rest, header.chunk_count.get() as usize)?
            },
        };
        let rest = Rest {
            xyz,
            metadata,
            padding,
            head_length: header.head_length.get(),
            required_features: header.required_features.get(),
        };
        Ok((view, rest))
    }

    /// Wavelengths of the first and last sample of the solar spectrum, nm.
    pub fn solar_range(&self) -> [f64; 2] {
        let [start, step] = self.solar_axis;
        [start, start + (self.solar.len() - 1) as f64 * step]
    }

    /// Spectral irradiance of the light, W m⁻² nm⁻¹: from samples in place of the sun's, if there are any.
    pub fn irradiance(&self, samples: Option<&[f32]>, wavelength: f64) -> f32 {
        let [start, step] = self.solar_axis;
        let last = self.solar.len() - 1;
        let sample = |i: usize| samples.map_or_else(|| self.solar[i].get(), |samples| samples[i]);
        let u = ((wavelength - start) / step).clamp(0.0, last as f64);
        let i = (u as usize).min(last - 1);
        let t = (u - i as f64) as f32;
        let [a, b] = [i, i + 1].map(sample);
        (1.0 - t) * a + t * b
    }
}

/// The header and what follows it up to the end of the head, after comparing lengths and checksum.
fn split(bytes: &[u8]) -> Result<(&Header, &[u8])> {
    let known = bytes.len().min(MAGIC.len());
    if bytes.is_empty() || bytes[..known] != MAGIC[..known] {
        return Err(Error::NotWelkin);
    }
    let short = |expected: u64| Error::Length {
        what: "file (is it truncated?)",
        expected,
        got: bytes.len() as u64,
    };
    let (header, _) =
        Header::ref_from_prefix(bytes).map_err(|_| short(size_of::<Header>() as u64))?;
    let got = header.version_major.get();
    if got != VERSION_MAJOR {
        let expected = VERSION_MAJOR;
        return Err(Error::Version { expected, got });
    }
    match header.unknown_features() {
        0 => {}
        bits => return Err(Error::Feature { bits }),
    }
    let length = header.head_length.get();
    let expected = header.counted_head_length();
    if length != expected {
        return Err(Error::Length {
            what: "head_length",
            expected,
            got: length,
        });
    }
    let head = usize::try_from(length).ok().and_then(|n| bytes.get(..n));
    let head = head.filter(|head| head.len() >= size_of::<Header>());
    let head = head.ok_or_else(|| short(length))?;
    let expected = header.head_crc32.get();
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&head[..CRC_RANGE.start]);
    hasher.update(&[0; 4]);
    hasher.update(&head[CRC_RANGE.end..]);
    let got = hasher.finalize();
    if got != expected {
        return Err(Error::Checksum {
            chunk: None,
            expected,
            got,
        });
    }
    Ok((header, &head[size_of::<Header>()..]))
}

fn take<'a, T>(rest: &mut &'a [u8], n: usize) -> Result<&'a [T]>
where
    T: FromBytes + zerocopy::Immutable + zerocopy::KnownLayout + zerocopy::Unaligned,
{
    let got = rest.len() as u64;
    let (taken, tail) = <[T]>::ref_from_prefix_with_elems(rest, n).map_err(|_| Error::Length {
        what: "head",
        expected: (n * size_of::<T>()) as u64,
        got,
    })?;
    *rest = tail;
    Ok(taken)
}

const _: () = assert!(size_of::<RawEntry>() == ENTRY_LENGTH);

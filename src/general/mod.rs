//! Radiance straight from the bytes of a file: nothing is prepared, nothing is allocated, everything may change from
//! query to query. Format specification, section 7. Works without the standard library.

mod chunks;
mod contract;
mod head;
mod light;
mod place;

use crate::conditions::Conditions;
use crate::error::{Error, Result};
use crate::format::RadianceView;
use crate::geometry::Side;
use crate::lanes::Lanes;
#[cfg(not(feature = "std"))]
use crate::real::Real;
use crate::simd::{Instructions, Kernel, dispatch};
pub(crate) use chunks::Chunks;
use chunks::limit;
use contract::{MOST_CHANNELS, MOST_RANK, WIDTH};
pub(crate) use head::HeadView;
use light::Light;
use place::Place;

/// Most wavelengths, in vectors, and most constituents that this evaluator has room for.
const WAVELENGTH_BLOCKS: usize = 8;
const MOST_CONSTITUENTS: usize = 16;
/// Most chunks around a query.
const MOST_AROUND: usize = 16;
/// Chunks between asking for one and using it.
const AHEAD: usize = 2;

/// A model, evaluated where it stands: for queries that share nothing, like those of path vertices at any altitude.
///
/// Costs about a microsecond per query and no preparation; skies that many queries share are cheaper
/// [prepared](crate::Model::sky). The file must not be larger than 64 altitudes, 256 radiance chunks, rank 512, 256
/// channels and 64 wavelengths. About 40 kB in size, nothing on the heap. `Send + Sync`.
pub struct General<'a> {
    head: HeadView<'a>,
    chunks: Chunks<'a>,
    /// h^(1/3) at the nodes.
    altitudes: [f64; chunks::MOST_ALTITUDES],
    light: Light,
}

impl<'a> General<'a> {
    /// Opens a file that is in memory, whose chunks are raw. Checks the head; the values in chunks are taken as they
    /// are, and give some number where they are none (see [`General::verify`]).
    ///
    /// # Errors
    /// Typed errors for a head or a directory that breaks the format specification, [`Error::Limit`] for a model that
    /// is too large, [`Error::Encoding`] for chunks that are compressed.
    pub fn new(bytes: &'a [u8]) -> Result<Self> {
        let head = HeadView::new(bytes)?;
        if head.file_length != bytes.len() as u64 {
            return Err(Error::Length {
                what: "file (is it truncated?)",
                expected: head.file_length,
                got: bytes.len() as u64,
            });
        }
        let chunks = Chunks::of_file(&head, bytes)?;
        Self::assemble(head, chunks)
    }

    /// Compares the checksums of all chunks of the file that this was made from.
    ///
    /// # Errors
    /// [`Error::Checksum`] for the first damaged chunk.
    pub fn verify(&self, bytes: &[u8]) -> Result<()> {
        for (i, entry) in self.head.directory.iter().enumerate() {
            let start = usize::try_from(entry.offset.get()).unwrap_or(usize::MAX);
            let length = usize::try_from(entry.stored_length.get()).unwrap_or(usize::MAX);
            let payload = bytes.get(start..).and_then(|rest| rest.get(..length));
            let got = payload.map_or(0, crc32fast::hash);
            let expected = entry.crc32.get();
            if payload.is_none() || got != expected {
                return Err(Error::Checksum {
                    chunk: Some(i),
                    expected,
                    got,
                });
            }
        }
        Ok(())
    }

    pub(crate) fn assemble(head: HeadView<'a>, chunks: Chunks<'a>) -> Result<Self> {
        let shape = &head.shape;
        limit("wavelengths", shape.wavelengths, WAVELENGTH_BLOCKS * WIDTH)?;
        limit(
            "channels",
            crate::format::ceil16(shape.channels),
            MOST_CHANNELS,
        )?;
        let rank = chunks.basis().map_or(0, |basis| basis.stride);
        limit("components", rank, MOST_RANK)?;
        let mut altitudes = [0.0; chunks::MOST_ALTITUDES];
        for (node, altitude) in altitudes.iter_mut().zip(head.altitudes) {
            *node = altitude.get().cbrt();
        }
        Ok(Self {
            light: Light::new(&head)?,
            altitudes,
            head,
            chunks,
        })
    }

    /// Wavelengths of the results, nm.
    pub fn wavelengths(&self) -> impl ExactSizeIterator<Item = f64> {
        self.head.wavelengths.iter().map(|l| l.get())
    }

    /// Spectral radiance in W m⁻² sr⁻¹ nm⁻¹ at each of [`General::wavelengths`]; frame and meaning as of
    /// [`Sky`](crate::Sky).
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for conditions outside the model, [`Error::Direction`] for a vector that is zero or not
    /// finite, [`Error::Length`] unless `out` has one element per wavelength, [`Error::MissingChunk`].
    pub fn radiance(
        &self,
        conditions: &Conditions,
        direction: [f32; 3],
        out: &mut [f32],
    ) -> Result<()> {
        self.relative_radiance(conditions, direction, out)?;
        for (out, wavelength) in out.iter_mut().zip(self.wavelengths()) {
            *out = (*out * self.solar_irradiance(wavelength)).min(f32::MAX);
        }
        Ok(())
    }

    /// Radiance per unit of solar spectral irradiance, sr⁻¹.
    ///
    /// # Errors
    /// As [`General::radiance`].
    pub fn relative_radiance(
        &self,
        conditions: &Conditions,
        direction: [f32; 3],
        out: &mut [f32],
    ) -> Result<()> {
        if out.len() != self.head.shape.wavelengths {
            return Err(Error::Length {
                what: "output",
                expected: self.head.shape.wavelengths as u64,
                got: out.len() as u64,
            });
        }
        let place = Place::new(&self.head, &self.altitudes, conditions, direction)?;
        dispatch(Query {
            model: self,
            place: &place,
            out,
        })
    }

    fn solar_irradiance(&self, wavelength: f64) -> f32 {
        let [start, step] = self.head.solar_axis;
        let last = self.head.solar.len() - 1;
        let u = ((wavelength - start) / step).clamp(0.0, last as f64);
        let i = (u as usize).min(last - 1);
        let t = (u - i as f64) as f32;
        let [a, b] = [i, i + 1].map(|i| self.head.solar[i].get());
        (1.0 - t) * a + t * b
    }
}

struct Query<'a, 'b> {
    model: &'b General<'a>,
    place: &'b Place,
    out: &'b mut [f32],
}

impl Kernel for Query<'_, '_> {
    type Output = Result<()>;

    #[inline(always)]
    fn run<I: Instructions>(self, instructions: I) -> Result<()> {
        let Self { model, place, out } = self;
        let chunks = &model.chunks;
        let mut components = [Lanes::splat(0.0); MOST_RANK / WIDTH];
        let mut level = [Lanes::splat(0.0); WAVELENGTH_BLOCKS];
        let mut columns = [0.0; MOST_CONSTITUENTS];
        let basis = chunks.basis();
        let basis = basis.ok_or_else(|| model.missing("radiance basis", None, None))?;
        let mut around = [None; MOST_AROUND];
        let mut n = 0;
        let taps = [&place.alpha, &place.elevation];
        for (a, altitude_weight) in place.altitudes.taps() {
            let column = chunks.column(a);
            let column = column.ok_or_else(|| model.missing("column", Some(a), None))?;
            model.add_column(column.values, place, altitude_weight as f32, &mut columns);
            for (v, weight) in place.visibilities.taps() {
                let chunk = chunks.radiance(a, v);
                let chunk = chunk.ok_or_else(|| model.missing("radiance", Some(a), Some(v)))?;
                around[n] = Some((chunk, (altitude_weight * weight) as f32));
                n += 1;
            }
        }
        for i in 0..n + AHEAD {
            if let Some((chunk, _)) = around.get(i).copied().flatten() {
                contract::fetch_chunk(instructions, chunk, heights(chunk, place), taps);
            }
            let Some((chunk, weight)) = i.checked_sub(AHEAD).and_then(|i| around[i]) else {
                continue;
            };
            let rows = heights(chunk, place);
            contract::add_chunk(instructions, chunk, rows, taps, weight, &mut components);
            let wavelengths = model.head.shape.wavelengths;
            contract::add_level(
                instructions,
                chunk,
                wavelengths,
                taps[1],
                weight,
                &mut level,
            );
        }
        contract::align(model.head.shape.wavelengths, &mut level);
        contract::turn(instructions, basis, &place.phi, &mut components);
        let mut channels = [Lanes::splat(0.0); MOST_CHANNELS / WIDTH];
        contract::project(instructions, basis, &components, &mut channels);
        let mut flat = [0.0; MOST_CHANNELS];
        for (flat, lanes) in flat.as_chunks_mut().0.iter_mut().zip(&channels) {
            *flat = lanes.0;
        }
        model.light.mix(place, &flat, &level, &columns, out);
        Ok(())
    }
}

/// The factor matrix on the ray's side of the horizon.
#[inline(always)]
fn heights<'a>(chunk: &RadianceView<'a>, place: &Place) -> &'a [zerocopy::little_endian::U16] {
    match place.ray.side {
        Side::Up => chunk.alpha_up,
        Side::Down => chunk.alpha_down,
    }
}

impl General<'_> {
    /// Adds ln n̄ of one altitude.
    #[inline(always)]
    fn add_column(
        &self,
        values: &[zerocopy::little_endian::F32],
        place: &Place,
        weight: f32,
        sums: &mut [f32; MOST_CONSTITUENTS],
    ) {
        let n = self.head.shape.constituents;
        let skipped = match place.ray.side {
            Side::Up => 0,
            Side::Down => self.head.shape.up,
        };
        for (&i, tap) in place.alpha.index.iter().zip(place.alpha.weight) {
            let row = &values[(skipped + i) * n..][..n];
            for (sum, value) in sums.iter_mut().zip(row) {
                *sum += weight * tap * value.get();
            }
        }
    }

    #[cold]
    fn missing(
        &self,
        kind: &'static str,
        altitude: Option<usize>,
        visibility: Option<usize>,
    ) -> Error {
        Error::MissingChunk {
            kind,
            altitude: altitude.map(|a| self.head.altitudes[a].get()),
            visibility: visibility.map(|v| self.head.visibilities[v].get()),
        }
    }
}

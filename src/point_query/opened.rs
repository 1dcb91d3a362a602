//! A model file, opened in place for point queries.

use super::capacity::WAVELENGTH_BLOCKS;
use super::chunk_directory;
use super::chunk_table::{Chunks, estimate_of_file, limit, spectrum_of_file};
use super::contraction::{MOST_CHANNELS, MOST_RANK, WIDTH};
use super::head_rules::checked_head;
use super::head_view::HeadView;
use super::neighbours::{Axis, Interpolation};
use super::optics::Light;
use crate::error::{Error, Result};
use crate::format::{EstimateView, SpectrumView};
#[cfg(not(feature = "std"))]
use crate::kernel::real::Real;

/// A model, evaluated where it stands: for queries that share nothing, like those of path vertices at any altitude.
///
/// Costs some two to three microseconds per query and no preparation; skies that many queries share are cheaper
/// [prepared](crate::Model::sky). The file must not be larger than 64 altitudes, 256 radiance chunks, rank 512, 256
/// channels and 64 wavelengths, nor than 64 visibilities. About 75 kB in size, nothing on the heap. `Send + Sync`.
///
/// Answers as [`Sky`](crate::Sky) does, but for rounding; [`Interpolation::Linear`] is faster by a sixth and coarser.
///
/// ```
/// use welkin::{Conditions, PointQuery};
///
/// let query = PointQuery::new(welkin::DEFAULT_MODEL)?;
/// let mut radiance = vec![0.0; query.wavelengths().len()];
/// for altitude in [0.0, 500.0, 3000.0] {
///     let conditions = Conditions { altitude, ..Conditions::default() };
///     query.radiance(&conditions, [0.0, 0.0, 1.0], &mut radiance)?;
///     assert!(radiance.iter().all(|&l| l > 0.0));
/// }
/// # Ok::<(), welkin::Error>(())
/// ```
pub struct PointQuery<'a> {
    pub(super) head: HeadView<'a>,
    pub(super) chunks: Chunks<'a>,
    /// Altitudes as h^(1/3), visibilities as 1/V.
    pub(super) axes: [Axis; 2],
    /// The ends of the axis of solar elevations before it is divided evenly.
    pub(super) suns: [f64; 2],
    /// Samples of the spectral irradiance of the moon, in its light.
    moonlight: Option<&'a [f32]>,
    /// Spectral irradiance of the light at the wavelengths.
    pub(super) irradiance: [f32; WAVELENGTH_BLOCKS * WIDTH],
    pub(super) light: Light,
    /// What lies between the wavelengths, if the file says.
    pub(super) spectrum: Option<SpectrumView<'a>>,
    /// What the fields are relative to, if the file says.
    pub(super) estimate: Option<EstimateView<'a>>,
    pub(super) interpolation: Interpolation,
}

impl<'a> PointQuery<'a> {
    /// Opens a file that is in memory, whose chunks are raw. Checks the head; the values in chunks are taken as they
    /// are, and give some number where they are none (see [`PointQuery::verify`]); those of a spectrum are checked.
    ///
    /// # Errors
    /// Typed errors for a head or a directory that breaks the format specification, [`Error::Limit`] for a model that
    /// is too large, [`Error::Encoding`] for chunks that are compressed.
    pub fn new(bytes: &'a [u8]) -> Result<Self> {
        let head = checked_head(bytes)?;
        if head.file_length != bytes.len() as u64 {
            return Err(Error::Length {
                what: "file (is it truncated?)",
                expected: head.file_length,
                got: bytes.len() as u64,
            });
        }
        let chunks = Chunks::of_file(&head, bytes)?;
        let spectrum = spectrum_of_file(&head, bytes)?;
        let estimate = estimate_of_file(&head, bytes)?;
        Self::assemble(head, chunks, spectrum, estimate)
    }

    /// Compares the checksums of all chunks of known kinds of the file that this was made from.
    ///
    /// # Errors
    /// [`Error::Checksum`] for the first damaged chunk.
    pub fn verify(&self, bytes: &[u8]) -> Result<()> {
        for (i, entry) in self.head.directory.iter().enumerate() {
            // Of other kinds the checksum, too, may be anything.
            if !chunk_directory::is_known(entry) {
                continue;
            }
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

    pub(crate) fn assemble(
        head: HeadView<'a>,
        chunks: Chunks<'a>,
        spectrum: Option<SpectrumView<'a>>,
        estimate: Option<EstimateView<'a>>,
    ) -> Result<Self> {
        let shape = &head.shape;
        limit("wavelengths", shape.wavelengths, WAVELENGTH_BLOCKS * WIDTH)?;
        limit(
            "channels",
            crate::format::ceil16(shape.channels),
            MOST_CHANNELS,
        )?;
        let rank = chunks.basis().map_or(0, |basis| basis.stride);
        limit("components", rank, MOST_RANK)?;
        let altitudes = head.altitudes.iter().map(|h| h.get().cbrt());
        let visibilities = head.visibilities.iter().map(|v| 1.0 / v.get());
        let query = Self {
            light: Light::new(&head)?,
            axes: [
                Axis::new("altitudes", altitudes)?,
                Axis::new("visibilities", visibilities)?,
            ],
            suns: head.elevation.ends(),
            moonlight: None,
            irradiance: [0.0; WAVELENGTH_BLOCKS * WIDTH],
            interpolation: Interpolation::default(),
            head,
            chunks,
            spectrum,
            estimate,
        };
        Ok(query.under(None))
    }

    /// In the light of the moon, whose spectral irradiance stands where the sun's does in the file; or of the sun.
    pub(crate) fn under(mut self, moonlight: Option<&'a [f32]>) -> Self {
        self.moonlight = moonlight;
        for (value, wavelength) in self.irradiance.iter_mut().zip(self.head.wavelengths) {
            *value = self.head.irradiance(moonlight, wavelength.get());
        }
        self
    }

    /// The same with another interpolation between chunks than [`Interpolation::Full`].
    #[must_use]
    pub fn with_interpolation(mut self, interpolation: Interpolation) -> Self {
        self.interpolation = interpolation;
        self
    }

    /// Wavelengths of the results, nm.
    pub fn wavelengths(&self) -> impl ExactSizeIterator<Item = f64> {
        self.head.wavelengths.iter().map(|l| l.get())
    }

    /// Spectral irradiance (W m⁻² nm⁻¹) of the sun, or of the moon in its light, at a wavelength, nm.
    pub(crate) fn solar_irradiance(&self, wavelength: f64) -> f32 {
        self.head.irradiance(self.moonlight, wavelength)
    }
}

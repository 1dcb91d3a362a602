//! A model file, opened: its head in memory, its chunks checked when they are first touched.

use std::collections::HashMap;
use std::fmt;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::conditions::Conditions;
use crate::error::{Error, Result};
use crate::format::{ColumnView, Contents, Entry, Head, Kind, RadianceView, parse};
use crate::sky::Sky;

/// A clear-sky model over a mapped file, owned bytes or static bytes. `Send + Sync`.
///
/// Opening reads the head of the file only; [`Model::sky`] touches the chunks that its conditions need.
pub struct Model {
    bytes: Bytes,
    contents: Contents,
    index: HashMap<(Kind, Option<usize>, Option<usize>), usize>,
    /// Chunks whose checksum and values were found right.
    verified: Box<[AtomicBool]>,
}

enum Bytes {
    Static(&'static [u8]),
    Owned(Vec<u8>),
    #[cfg(feature = "mmap")]
    Mapped(memmap2::Mmap),
}

impl Bytes {
    fn as_slice(&self) -> &[u8] {
        match self {
            Bytes::Static(bytes) => bytes,
            Bytes::Owned(bytes) => bytes,
            #[cfg(feature = "mmap")]
            Bytes::Mapped(map) => map,
        }
    }
}

impl Model {
    /// Opens a file; with the feature `mmap` by mapping it, otherwise as [`Model::read`].
    ///
    /// A mapped file must not be changed or truncated in place while the model lives (replacing it by renaming, as
    /// this crate's writer does, is fine). Use [`Model::read`] where that cannot be promised.
    ///
    /// # Errors
    /// [`Error::Io`], or as [`Model::from_bytes`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        #[cfg(feature = "mmap")]
        if let Some(map) = map(path).map_err(|e| io(path, e))? {
            return Self::new(Bytes::Mapped(map));
        }
        Self::read(path)
    }

    /// Opens a file by copying it into memory.
    ///
    /// # Errors
    /// [`Error::Io`], or as [`Model::from_bytes`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        Self::from_bytes(std::fs::read(path).map_err(|e| io(path, e))?)
    }

    /// Opens a file that is in memory.
    ///
    /// # Errors
    /// A typed error if the head breaks the format specification in any way. Chunks are not checked yet.
    pub fn from_bytes(bytes: impl Into<Vec<u8>>) -> Result<Self> {
        Self::new(Bytes::Owned(bytes.into()))
    }

    /// Opens a file that is part of the program, without copying it.
    ///
    /// # Errors
    /// As [`Model::from_bytes`].
    pub fn from_static(bytes: &'static [u8]) -> Result<Self> {
        Self::new(Bytes::Static(bytes))
    }

    /// The model that is embedded in this library.
    ///
    /// # Errors
    /// As [`Model::from_bytes`]; none in a sound build.
    #[cfg(feature = "default-model")]
    pub fn default_model() -> Result<Self> {
        Self::from_static(include_bytes!("../models/default.welkin"))
    }

    fn new(bytes: Bytes) -> Result<Self> {
        let contents = parse(bytes.as_slice())?;
        let directory = contents.directory.iter().enumerate();
        let index = directory
            .filter(|(_, entry)| !matches!(entry.kind, Kind::Unknown(_)))
            .map(|(i, entry)| ((entry.kind, entry.altitude, entry.visibility), i))
            .collect();
        let verified = contents.directory.iter().map(|_| AtomicBool::new(false));
        Ok(Self {
            verified: verified.collect(),
            index,
            contents,
            bytes,
        })
    }

    /// Prepares a sky: after this, queries cost no allocation and no system call.
    ///
    /// Touches the chunks of at most four altitudes and four visibilities around the conditions, and only one where
    /// altitude or visibility is a node of the model. The first touch of a chunk verifies it.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for conditions outside the model (see [`Conditions::clamped`]), [`Error::MissingChunk`] if
    /// the file lacks a needed chunk, [`Error::Checksum`], [`Error::Encoding`] or [`Error::Invalid`] if one is damaged.
    pub fn sky(&self, conditions: &Conditions) -> Result<Sky> {
        Sky::prepare(self, conditions)
    }

    /// Verifies all chunks at once instead of at their first touch.
    ///
    /// # Errors
    /// [`Error::Checksum`], [`Error::Encoding`] or [`Error::Invalid`] for the first damaged chunk.
    pub fn verify(&self) -> Result<()> {
        (0..self.contents.directory.len()).try_for_each(|i| self.touch(i).map(drop))
    }

    /// Axes, tables and provenance.
    pub fn head(&self) -> &Head {
        &self.contents.head
    }

    /// The chunks in the order of the file.
    pub fn directory(&self) -> &[Entry] {
        &self.contents.directory
    }

    /// Wavelengths of the model, nm.
    pub fn wavelengths(&self) -> &[f64] {
        &self.head().wavelengths
    }

    /// Lowest and highest solar elevation, rad.
    pub fn solar_elevation_range(&self) -> [f64; 2] {
        [self.head().elevation.min, self.head().elevation.max]
    }

    /// Lowest and highest visibility, m.
    pub fn visibility_range(&self) -> [f64; 2] {
        ends(&self.head().visibilities)
    }

    /// Lowest and highest altitude of the observer, m.
    pub fn altitude_range(&self) -> [f64; 2] {
        ends(&self.head().altitudes)
    }

    /// Shortest and longest wavelength, nm.
    pub fn wavelength_range(&self) -> [f64; 2] {
        ends(&self.head().wavelengths)
    }

    /// Length of the file, bytes.
    pub fn file_bytes(&self) -> usize {
        self.bytes.as_slice().len()
    }

    /// Length of the head, bytes: all that opening reads.
    pub fn head_bytes(&self) -> usize {
        self.contents.head_length
    }

    /// Bytes of the file that were read so far: the head and the touched chunks.
    pub fn touched_bytes(&self) -> usize {
        let touched = self.verified.iter().zip(self.directory());
        let chunks: usize = touched
            .filter(|(verified, _)| verified.load(Ordering::Relaxed))
            .map(|(_, entry)| entry.length)
            .sum();
        self.contents.head_length + chunks
    }

    pub(crate) fn radiance_chunk(
        &self,
        altitude: usize,
        visibility: usize,
    ) -> Result<RadianceView<'_>> {
        let i = self.find(Kind::Radiance, altitude, Some(visibility))?;
        let rank = self.contents.directory[i].rank;
        RadianceView::new(self.touch(i)?, &self.head().shape(), rank)
    }

    pub(crate) fn column_chunk(&self, altitude: usize) -> Result<ColumnView<'_>> {
        let i = self.find(Kind::Column, altitude, None)?;
        ColumnView::new(self.touch(i)?, &self.head().shape())
    }

    fn find(&self, kind: Kind, altitude: usize, visibility: Option<usize>) -> Result<usize> {
        let found = self.index.get(&(kind, Some(altitude), visibility));
        found.copied().ok_or_else(|| Error::MissingChunk {
            kind: kind.name(),
            altitude: self.head().altitudes[altitude],
            visibility: visibility.map(|v| self.head().visibilities[v]),
        })
    }

    /// The bytes of a chunk, verified now or earlier.
    fn touch(&self, i: usize) -> Result<&[u8]> {
        let entry = &self.contents.directory[i];
        let bytes = &self.bytes.as_slice()[entry.offset..entry.offset + entry.length];
        if !self.verified[i].load(Ordering::Relaxed) {
            self.check_chunk(i, entry, bytes)?;
            // Nothing else is published through the flag, so relaxed order is enough.
            self.verified[i].store(true, Ordering::Relaxed);
        }
        Ok(bytes)
    }

    fn check_chunk(&self, i: usize, entry: &Entry, bytes: &[u8]) -> Result<()> {
        let got = crc32fast::hash(bytes);
        if got != entry.crc32 {
            return Err(Error::Checksum {
                chunk: Some(i),
                expected: entry.crc32,
                got,
            });
        }
        let shape = self.head().shape();
        let finite = match entry.kind {
            Kind::Unknown(_) => return Ok(()),
            _ if entry.encoding != 0 => {
                return Err(Error::Encoding {
                    chunk: i,
                    got: entry.encoding,
                });
            }
            Kind::Radiance => RadianceView::new(bytes, &shape, entry.rank)?.is_finite(),
            Kind::Column => ColumnView::new(bytes, &shape)?.is_finite(),
        };
        if finite {
            return Ok(());
        }
        let detail = format!("chunk {i} holds NaN or infinity");
        Err(Error::invalid("chunk", detail))
    }
}

impl fmt::Debug for Model {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Model")
            .field("file_bytes", &self.file_bytes())
            .field("chunks", &self.directory().len())
            .finish_non_exhaustive()
    }
}

fn ends(axis: &[f64]) -> [f64; 2] {
    [axis[0], axis[axis.len() - 1]]
}

fn io(path: &Path, source: std::io::Error) -> Error {
    Error::Io {
        path: path.to_owned(),
        source,
    }
}

/// Maps a regular file; anything else (a pipe, say) cannot be mapped.
#[cfg(feature = "mmap")]
fn map(path: &Path) -> std::io::Result<Option<memmap2::Mmap>> {
    let file = std::fs::File::open(path)?;
    if !file.metadata()?.is_file() {
        return Ok(None);
    }
    // SAFETY: the map is read-only and private to the model; that nobody changes the file meanwhile is the caller's
    // part, stated at `Model::open`. All bytes are treated as untrusted integers and floats, of which every bit
    // pattern is valid.
    unsafe { memmap2::Mmap::map(&file) }.map(Some)
}

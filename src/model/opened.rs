//! A model file, opened: its head in memory, its chunks checked when they are first touched.

use std::any::Any;
use std::borrow::Cow;
use std::fmt;
use std::path::Path;
use std::sync::{Arc, OnceLock};

use super::read_at::ReadAt;
use super::store::{Bytes, Store, Traffic};
use crate::error::{Error, Result};
use crate::format::{
    BasisView, ColumnView, Contents, DensityView, Entry, EstimateView, FactorsView, Head, Key,
    Kind, SourceBasisView, SourceView, SpectrumView, spectrum_view,
};
use crate::ground::{Albedo, Ground};
use crate::spectrum::SpectralInterpolation;

/// A clear-sky model over a mapped file, bytes in memory or a source that is read in pieces. `Send + Sync`.
///
/// Opening reads the head of the file only; `Model::sky` touches the chunks that its conditions need.
///
/// ```
/// use welkin::{Conditions, Model};
///
/// let model = Model::default_model()?; // or Model::open("file.welkin")
/// let [lowest, highest] = model.solar_elevation_range(); // rad
/// assert!(lowest < 0.0 && highest > 1.5);
/// let sky = model.sky(&Conditions::default())?;
/// assert_eq!(sky.wavelengths(), model.wavelengths()); // nm
/// # Ok::<(), welkin::Error>(())
/// ```
pub struct Model {
    store: Arc<Store>,
    contents: Contents,
    /// The head in the light of the sun, where that of `contents` is in the light of the moon.
    sunlit: Option<Arc<Head>>,
    /// In place of the albedo of conditions.
    ground: Option<Arc<Ground>>,
    interpolation: OnceLock<Arc<SpectralInterpolation>>,
}

/// The bytes of the embedded model: a file like any other.
#[cfg(feature = "default-model")]
pub static DEFAULT_MODEL: &[u8] = {
    // Chunks start at multiples of 64 bytes: in cache lines of their own, as in a mapped file.
    #[repr(C, align(64))]
    struct Aligned<T: ?Sized>(T);
    const EMBEDDED: &Aligned<[u8]> = &Aligned(*include_bytes!("../../models/default.welkin"));
    &EMBEDDED.0
};

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
        if let Some(map) = super::memory_map::map(path).map_err(|e| io(path, e))? {
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

    /// Opens a file that is read in pieces, from a slow disk or over a network.
    ///
    /// Costs one request, or two if the head is longer than 48 KiB. Each sky asks for the chunks that no sky before
    /// needed, chunks that are neighbours in the file by one request; they stay in memory.
    ///
    /// # Errors
    /// [`Error::Read`] if the source fails, or as [`Model::from_bytes`].
    pub fn stream(source: impl ReadAt + 'static) -> Result<Self> {
        Ok(Self::assemble(Store::stream(Box::new(source))?))
    }

    /// The model that is embedded in this library.
    ///
    /// # Errors
    /// As [`Model::from_bytes`]; none in a sound build.
    #[cfg(feature = "default-model")]
    pub fn default_model() -> Result<Self> {
        Self::from_static(DEFAULT_MODEL)
    }

    fn new(bytes: Bytes) -> Result<Self> {
        Ok(Self::assemble(Store::new(bytes)?))
    }

    fn assemble((store, contents): (Store, Contents)) -> Self {
        Self {
            store: Arc::new(store),
            contents,
            sunlit: None,
            ground: None,
            interpolation: OnceLock::new(),
        }
    }

    /// The same model over a ground of this albedo, whatever [`Conditions::albedo`](crate::Conditions::albedo) says:
    /// everything that is prepared from it is in the light of that ground, wavelength by wavelength. The conditions of
    /// what is prepared have its albedo at 550 nm. Shares the chunks of this model; a grey albedo costs nothing.
    ///
    /// Over a ground whose albedo depends on wavelength light at a node is that over the albedo there, and light at
    /// any other wavelength that over the albedo of that: the model's own for a grey ground of the same albedo.
    /// [`SpectralInterpolation`](crate::SpectralInterpolation) does not know the ground: ask
    /// [`Sky::radiance_at`](crate::Sky::radiance_at) and its like. Colours and bands are sums over spectra; so they are prepared with the albedos that the ground has in them.
    /// A [`Sky`](crate::Sky) takes three to four times as long to prepare, colours and bands as long as over a grey
    /// ground after the first, for which light is fitted.
    ///
    /// ```
    /// use welkin::{Albedo, Conditions, Model};
    ///
    /// let model = Model::default_model()?;
    /// let sand = Albedo::table(&[400.0, 550.0, 700.0], &[0.15, 0.30, 0.40])?;
    /// let desert = model.over(&sand);
    /// let sky = desert.colour_sky(&Conditions::default())?;
    /// assert_eq!(sky.conditions().albedo, 0.30);
    /// // Sand sends more red light up than a grey ground of 0.3, and less blue.
    /// let grey = model.colour_sky(&Conditions { albedo: 0.30, ..Conditions::default() })?;
    /// let [brown, plain] = [&sky, &grey].map(|sky| sky.linear_srgb([0.0, 0.0, 1.0]));
    /// let ([r, _, b], [red, _, blue]) = (brown?, plain?);
    /// assert!(r > red && b < blue);
    /// # Ok::<(), welkin::Error>(())
    /// ```
    pub fn over(&self, albedo: &Albedo) -> Self {
        Self {
            ground: Some(Arc::new(Ground::new(albedo.clone()))),
            ..self.shared()
        }
    }

    /// The albedo of the ground, if it is not that of the conditions: see [`Model::over`].
    pub fn ground(&self) -> Option<&Albedo> {
        self.ground.as_ref().map(|ground| &ground.albedo)
    }

    /// The albedos that the ground has in colours, at the nodes that these are made of: once made, they stay.
    pub(crate) fn colour_albedos(
        &self,
        make: impl FnOnce() -> Result<Vec<f64>>,
    ) -> Result<Cow<'_, [f64]>> {
        let Some(ground) = self.ground.as_deref() else {
            return make().map(Cow::Owned);
        };
        if let Some(known) = ground.in_colours.get() {
            return Ok(Cow::Borrowed(known));
        }
        let made = make()?;
        Ok(Cow::Borrowed(ground.in_colours.get_or_init(|| made)))
    }

    /// The same model over the ground of the conditions.
    pub(crate) fn over_grey(&self) -> Self {
        Self {
            ground: None,
            ..self.shared()
        }
    }

    /// The same chunks in the same light.
    fn shared(&self) -> Self {
        let known = self.interpolation.get().cloned();
        Self {
            store: Arc::clone(&self.store),
            contents: self.contents.clone(),
            sunlit: self.sunlit.clone(),
            ground: self.ground.clone(),
            interpolation: known.map_or_else(OnceLock::new, OnceLock::from),
        }
    }

    /// The same chunks with the light of the moon, which `moonlight` makes of that of the sun.
    pub(crate) fn with_moonlight(&self, moonlight: impl FnOnce(&mut Head)) -> Self {
        let sunlit = match &self.sunlit {
            Some(sunlit) => Arc::clone(sunlit),
            None => Arc::new(self.head().clone()),
        };
        let mut head = Head::clone(&sunlit);
        moonlight(&mut head);
        Self {
            store: Arc::clone(&self.store),
            contents: Contents {
                head,
                ..self.contents.clone()
            },
            sunlit: Some(sunlit),
            ground: (self.ground()).map(|albedo| Arc::new(Ground::new(albedo.clone()))),
            interpolation: OnceLock::new(),
        }
    }

    /// Whether the light is that of the moon: see [`Model::moonlit`].
    pub fn is_moonlit(&self) -> bool {
        self.sunlit.is_some()
    }

    /// Verifies all chunks at once instead of at their first touch.
    ///
    /// # Errors
    /// [`Error::Checksum`], [`Error::Encoding`] or [`Error::Invalid`] for the first damaged chunk; [`Error::Read`].
    pub fn verify(&self) -> Result<()> {
        let all = 0..self.contents.directory.len();
        self.store.fetch(&self.contents, all.clone().collect())?;
        all.into_iter().try_for_each(|i| self.chunk(i).map(drop))
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

    /// Shortest and longest wavelength that can be asked for, nm: of the spectrum where the file has one, which is
    /// read for this, otherwise of [`Model::wavelengths`].
    ///
    /// # Errors
    /// Those of a damaged chunk; [`Error::Read`].
    pub fn wavelength_range(&self) -> Result<[f64; 2]> {
        Ok(self.shared_interpolation()?.range())
    }

    /// Whether the file has a spectrum chunk: what lies between the wavelengths, and what absorption lines make of it.
    pub fn has_spectrum(&self) -> bool {
        self.contents.index.contains_key(&SPECTRUM)
    }

    /// How values at the wavelengths make values at any wavelength. Reads the spectrum chunk where the file has one.
    ///
    /// # Errors
    /// Those of a damaged chunk; [`Error::Read`].
    pub fn spectral_interpolation(&self) -> Result<&SpectralInterpolation> {
        self.shared_interpolation().map(AsRef::as_ref)
    }

    /// The same, for what outlives the model.
    pub(crate) fn shared_interpolation(&self) -> Result<&Arc<SpectralInterpolation>> {
        if let Some(known) = self.interpolation.get() {
            return Ok(known);
        }
        let made = match self.contents.index.get(&SPECTRUM) {
            Some(&i) => SpectralInterpolation::of_cells(self.head(), self.chunk(i)?)?,
            None => SpectralInterpolation::of_nodes(self.head()),
        };
        Ok(self.interpolation.get_or_init(|| Arc::new(made)))
    }

    /// Length of the file, bytes.
    pub fn file_bytes(&self) -> usize {
        self.contents.file_length
    }

    /// Length of the head, bytes: all that opening reads.
    pub fn head_bytes(&self) -> usize {
        self.contents.head_length
    }

    /// Bytes of the file that were needed so far: the head and the touched chunks.
    pub fn touched_bytes(&self) -> usize {
        let directory = self.directory().iter().enumerate();
        let touched = directory.filter(|&(i, _)| self.store.is_loaded(i));
        self.contents.head_length + touched.map(|(_, entry)| entry.length).sum::<usize>()
    }

    /// What a streamed model has asked of its source so far; nothing for models in memory.
    pub fn traffic(&self) -> Traffic {
        self.store.traffic()
    }

    /// Gets the chunks with these keys with as few requests as possible. Absent ones are no error here.
    pub(crate) fn prefetch(&self, keys: impl IntoIterator<Item = Key>) -> Result<()> {
        let present = keys
            .into_iter()
            .filter_map(|key| self.contents.index.get(&key));
        self.store.fetch(&self.contents, present.copied().collect())
    }

    /// Reads and verifies chunks.
    pub(crate) fn load_chunks(&self, chunks: &[usize]) -> Result<()> {
        self.store.fetch(&self.contents, chunks.to_vec())?;
        chunks.iter().try_for_each(|&i| self.chunk(i).map(drop))
    }

    /// The file as far as it is in memory from its beginning: at least the head.
    pub(crate) fn front(&self) -> &[u8] {
        self.store.front()
    }

    pub(crate) fn radiance_basis(&self) -> Result<BasisView<'_>> {
        let i = self.find(Kind::RadianceBasis, None, None)?;
        let rank = self.contents.directory[i].rank;
        BasisView::radiance(self.chunk(i)?, &self.head().shape(), rank)
    }

    pub(crate) fn radiance_chunk(
        &self,
        altitude: usize,
        visibility: usize,
    ) -> Result<FactorsView<'_>> {
        let i = self.find(Kind::Radiance, Some(altitude), Some(visibility))?;
        let rank = self.contents.directory[i].rank;
        FactorsView::radiance(self.chunk(i)?, &self.head().shape(), rank)
    }

    pub(crate) fn column_chunk(&self, altitude: usize) -> Result<ColumnView<'_>> {
        let i = self.find(Kind::Column, Some(altitude), None)?;
        ColumnView::new(self.chunk(i)?, &self.head().shape())
    }

    pub(crate) fn polarisation_chunk(
        &self,
        altitude: usize,
        visibility: usize,
    ) -> Result<FactorsView<'_>> {
        let i = self.find(Kind::Polarisation, Some(altitude), Some(visibility))?;
        let rank = self.contents.directory[i].rank;
        FactorsView::polarisation(self.chunk(i)?, &self.head().shape(), rank)
    }

    pub(crate) fn polarisation_basis(&self) -> Result<BasisView<'_>> {
        let i = self.find(Kind::PolarisationBasis, None, None)?;
        let rank = self.contents.directory[i].rank;
        BasisView::polarisation(self.chunk(i)?, &self.head().shape(), rank)
    }

    pub(crate) fn estimate_chunk(&self) -> Result<EstimateView<'_>> {
        let head = self.head();
        let bytes = self.chunk(self.find(Kind::Estimate, None, None)?)?;
        EstimateView::divide(bytes, head.constituents, head.wavelengths.len())
    }

    pub(crate) fn density_chunk(&self) -> Result<DensityView<'_>> {
        let head = self.head();
        let bytes = self.chunk(self.find(Kind::Transmittance, None, None)?)?;
        DensityView::new(bytes, head.constituents, head.planet.top)
    }

    /// What one later room makes of the chunks, kept with them for all that ask after the first.
    pub(crate) fn derived<T: Any + Send + Sync>(
        &self,
        make: impl FnOnce() -> Result<T>,
    ) -> Result<Arc<T>> {
        self.store.derived(make)
    }

    pub(crate) fn source_basis_chunk(&self) -> Result<SourceBasisView<'_>> {
        let bytes = self.chunk(self.find(Kind::SourceBasis, None, None)?)?;
        SourceBasisView::new(bytes, self.head().wavelengths.len())
    }

    pub(crate) fn source_chunk(&self, visibility: usize) -> Result<SourceView<'_>> {
        let head = self.head();
        let bytes = self.chunk(self.find(Kind::Source, None, Some(visibility))?)?;
        SourceView::new(bytes, head.constituents, head.wavelengths.len())
    }

    /// What lies between the wavelengths, if the file says.
    pub(crate) fn spectrum_chunk(&self) -> Result<Option<SpectrumView<'_>>> {
        let place = self.contents.index.get(&SPECTRUM);
        let chunk = place.map(|&i| spectrum_view(self.head(), self.chunk(i)?));
        chunk.transpose()
    }

    pub(crate) fn find(
        &self,
        kind: Kind,
        altitude: Option<usize>,
        visibility: Option<usize>,
    ) -> Result<usize> {
        let found = self.contents.index.get(&(kind, altitude, visibility));
        found.copied().ok_or_else(|| Error::MissingChunk {
            kind: kind.name(),
            altitude: altitude.map(|a| self.head().altitudes[a]),
            visibility: visibility.map(|v| self.head().visibilities[v]),
        })
    }

    /// The payload of a chunk, verified now or earlier.
    pub(crate) fn chunk(&self, i: usize) -> Result<&[u8]> {
        self.store.chunk(&self.contents, i)
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

/// Where the spectrum chunk stands.
pub(crate) const SPECTRUM: Key = (Kind::Spectrum, None, None);

fn ends(axis: &[f64]) -> [f64; 2] {
    [axis[0], axis[axis.len() - 1]]
}

fn io(path: &Path, source: std::io::Error) -> Error {
    Error::Io {
        path: path.to_owned(),
        source,
    }
}

#[cfg(all(test, feature = "default-model"))]
mod tests {
    /// Rows of factor matrices that straddle cache lines cost a point query 5 to 10 %.
    #[test]
    fn the_embedded_model_starts_a_cache_line() {
        assert!(super::DEFAULT_MODEL.as_ptr().addr().is_multiple_of(64));
    }
}

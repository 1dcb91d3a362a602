//! The bytes of a model: in place where they are in memory, otherwise fetched when they are needed, and kept.

use std::any::Any;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

use super::read_at::ReadAt;
use crate::error::{Error, Result};
use crate::format::{
    CHUNK_ALIGNMENT, Contents, Entry, check_chunk, decode, head_length, parse_head,
};

/// Bytes that the first request to a source asks for; the head of a usual model is shorter.
const FIRST_REQUEST: usize = 48 << 10;
/// A source that has fewer bytes than its head declares is found out after this many.
const PIECE: usize = 1 << 20;

/// Requests to the source of a streamed model and the bytes that they brought.
///
/// ```
/// use welkin::{Conditions, Model};
///
/// let model = Model::stream(welkin::DEFAULT_MODEL.to_vec())?;
/// let opened = model.traffic();
/// assert!(opened.requests <= 2);
/// model.sky(&Conditions::default())?;
/// assert!(model.traffic().bytes > opened.bytes);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Traffic {
    /// Calls of [`ReadAt::read_at`].
    pub requests: u64,
    /// Bytes that came back.
    pub bytes: u64,
}

pub(crate) enum Bytes {
    Static(&'static [u8]),
    Owned(Vec<u8>),
    #[cfg(feature = "mmap")]
    Mapped(memmap2::Mmap),
    /// The first bytes of a file, and where to get the others.
    Ranged(Vec<u8>, Box<dyn ReadAt>),
}

/// A chunk that was checked.
enum Loaded {
    InPlace,
    Owned(Box<[u8]>),
}

pub(crate) struct Store {
    bytes: Bytes,
    chunks: Box<[OnceLock<Loaded>]>,
    requests: AtomicU64,
    received: AtomicU64,
    /// See [`Store::derived`].
    derived: OnceLock<Arc<dyn Any + Send + Sync>>,
}

impl Store {
    /// Opens bytes that are in memory as a whole.
    pub fn new(bytes: Bytes) -> Result<(Self, Contents)> {
        let contents = crate::format::parse(bytes.in_memory())?;
        Ok((Self::unopened(bytes).with(&contents), contents))
    }

    /// Opens a source with one request, or with two if the head is long.
    pub fn stream(source: Box<dyn ReadAt>) -> Result<(Self, Contents)> {
        let mut store = Self::unopened(Bytes::Ranged(Vec::new(), source));
        let mut head = store.request(0, FIRST_REQUEST)?;
        let length = head_length(&head)?;
        while (head.len() as u64) < length {
            let missing = length - head.len() as u64;
            let more = store.request(head.len() as u64, missing.min(PIECE as u64) as usize)?;
            if more.is_empty() {
                return Err(truncated(length, head.len() as u64));
            }
            head.extend(more);
        }
        let contents = parse_head(&head)?;
        if let Bytes::Ranged(prefix, _) = &mut store.bytes {
            *prefix = head;
        }
        Ok((store.with(&contents), contents))
    }

    fn unopened(bytes: Bytes) -> Self {
        Self {
            bytes,
            chunks: Box::default(),
            requests: AtomicU64::new(0),
            received: AtomicU64::new(0),
            derived: OnceLock::new(),
        }
    }

    fn with(self, contents: &Contents) -> Self {
        let chunks = contents.directory.iter().map(|_| OnceLock::new()).collect();
        Self { chunks, ..self }
    }

    /// Bytes that are in memory from the beginning on.
    pub fn front(&self) -> &[u8] {
        self.bytes.in_memory()
    }

    pub fn traffic(&self) -> Traffic {
        Traffic {
            requests: self.requests.load(Ordering::Relaxed),
            bytes: self.received.load(Ordering::Relaxed),
        }
    }

    /// What one later room makes of the chunks, kept for all that ask after the first.
    pub fn derived<T: Any + Send + Sync>(
        &self,
        make: impl FnOnce() -> Result<T>,
    ) -> Result<Arc<T>> {
        if let Some(kept) = self.derived.get()
            && let Ok(kept) = Arc::clone(kept).downcast()
        {
            return Ok(kept);
        }
        let made = Arc::new(make()?);
        // Another thread may have been faster: what it made is the same.
        let _ = self.derived.set(made.clone());
        Ok(made)
    }

    /// Whether a chunk was read and found right.
    pub fn is_loaded(&self, i: usize) -> bool {
        self.chunks[i].get().is_some()
    }

    /// The decoded bytes of a chunk, checked now or earlier.
    pub fn chunk(&self, contents: &Contents, i: usize) -> Result<&[u8]> {
        if !self.is_loaded(i) {
            match self.in_place(&contents.directory[i]) {
                Some(stored) => self.keep(contents, i, stored, true)?,
                None => self.fetch(contents, vec![i])?,
            }
        }
        match self.chunks[i].get() {
            Some(Loaded::Owned(bytes)) => Ok(bytes),
            _ => Ok(self.in_place(&contents.directory[i]).unwrap_or_default()),
        }
    }

    /// Gets chunks from the source, neighbours in the file by one request. Chunks in memory need no fetching.
    pub fn fetch(&self, contents: &Contents, mut wanted: Vec<usize>) -> Result<()> {
        wanted.retain(|&i| !self.is_loaded(i) && self.in_place(&contents.directory[i]).is_none());
        wanted.sort_unstable();
        wanted.dedup();
        let neighbours = |a: &usize, b: &usize| {
            let gap = contents.directory[*b].offset - end(&contents.directory[*a]);
            gap < CHUNK_ALIGNMENT as usize
        };
        wanted
            .chunk_by(neighbours)
            .try_for_each(|run| self.fetch_run(contents, run))
    }

    fn fetch_run(&self, contents: &Contents, run: &[usize]) -> Result<()> {
        let entries = &contents.directory;
        let (start, stop) = (entries[run[0]].offset, end(&entries[run[run.len() - 1]]));
        let mut bytes = Vec::new();
        while bytes.len() < stop - start {
            let at = start + bytes.len();
            let more = self.request(at as u64, (stop - at).min(16 * PIECE))?;
            if more.is_empty() {
                return Err(truncated(stop as u64, at as u64));
            }
            bytes.extend(more);
        }
        run.iter().try_for_each(|&i| {
            let stored = &bytes[entries[i].offset - start..end(&entries[i]) - start];
            self.keep(contents, i, stored, false)
        })
    }

    /// Checks the stored bytes of a chunk, and copies them unless they stay where they are.
    fn keep(&self, contents: &Contents, i: usize, stored: &[u8], in_place: bool) -> Result<()> {
        let decoded = decode(i, &contents.directory[i], stored)?;
        check_chunk(&contents.head, i, &contents.directory[i], &decoded)?;
        let loaded = match decoded {
            std::borrow::Cow::Borrowed(_) if in_place => Loaded::InPlace,
            bytes => Loaded::Owned(bytes.into()),
        };
        // Another thread may have been faster: its bytes are the same.
        let _ = self.chunks[i].set(loaded);
        Ok(())
    }

    /// The stored bytes of a chunk if they are in memory.
    fn in_place(&self, entry: &Entry) -> Option<&[u8]> {
        self.bytes.in_memory().get(entry.offset..end(entry))
    }

    fn request(&self, offset: u64, length: usize) -> Result<Vec<u8>> {
        let Bytes::Ranged(_, source) = &self.bytes else {
            return Ok(Vec::new());
        };
        let mut buffer = vec![0; length];
        self.requests.fetch_add(1, Ordering::Relaxed);
        let got = source
            .read_at(offset, &mut buffer)
            .map_err(|source| Error::Read { offset, source })?;
        buffer.truncate(got);
        self.received
            .fetch_add(buffer.len() as u64, Ordering::Relaxed);
        Ok(buffer)
    }
}

impl Bytes {
    fn in_memory(&self) -> &[u8] {
        match self {
            Bytes::Static(bytes) => bytes,
            Bytes::Owned(bytes) | Bytes::Ranged(bytes, _) => bytes,
            #[cfg(feature = "mmap")]
            Bytes::Mapped(map) => map,
        }
    }
}

fn end(entry: &Entry) -> usize {
    entry.offset + entry.length
}

fn truncated(expected: u64, got: u64) -> Error {
    Error::Length {
        what: "file (is it truncated?)",
        expected,
        got,
    }
}

//! Results of work units on disk: written whole or not at all, found again after a kill.

use anyhow::{Context, Result, ensure};
use cpu_time::ProcessTime;
use std::fs;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};
use welkin::output::{replace_file, sweep};

/// A folder of unit files. Every file carries the key of the settings that made it; others are not trusted.
#[derive(Clone, Debug)]
pub struct Store {
    folder: PathBuf,
    key: String,
}

/// What is in the file of a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// The unit, whole.
    Done,
    /// Nothing, or a unit of other settings.
    Missing,
    /// A part of the unit, or other bytes than were written. It is computed again when it is needed.
    Damaged,
}

impl Store {
    /// Uses `folder`, created if needed, for units made with the settings that `key` describes.
    pub fn open(folder: impl AsRef<Path>, key: impl Into<String>) -> Result<Self> {
        let folder = folder.as_ref().to_owned();
        fs::create_dir_all(&folder)
            .with_context(|| format!("cannot create {}", folder.display()))?;
        Ok(Self {
            folder,
            key: key.into(),
        })
    }

    /// The unit `name`, read from its file or computed and written.
    pub fn unit(&self, name: &str, compute: impl FnOnce() -> Result<Vec<f32>>) -> Result<Vec<f32>> {
        if let Some(values) = self.load(name)? {
            return Ok(values);
        }
        let start = ProcessTime::now();
        let values = compute()?;
        self.save(name, &values)?;
        let cost = format!("{:.3}\n", start.elapsed().as_secs_f64());
        replace_file(self.path(name, COST), cost.as_bytes())?;
        Ok(values)
    }

    /// Core-seconds that it took to compute the unit `name`, all threads of the process together; `None` if nobody
    /// knows.
    pub fn cost(&self, name: &str) -> Option<f64> {
        let text = fs::read_to_string(self.path(name, COST)).ok()?;
        text.trim().parse().ok()
    }

    /// As [`Store::unit`], for numbers that must come back exactly.
    pub fn unit_f64(
        &self,
        name: &str,
        compute: impl FnOnce() -> Result<Vec<f64>>,
    ) -> Result<Vec<f64>> {
        if let Some(bytes) = self.read(name)?
            && let (words, []) = bytes.as_chunks::<8>()
        {
            return Ok(words.iter().map(|w| f64::from_le_bytes(*w)).collect());
        }
        let values = compute()?;
        ensure!(
            values.iter().all(|v| v.is_finite()),
            "unit {name} holds a value that is not finite"
        );
        let body: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.write(name, &body)?;
        Ok(values)
    }

    /// Removes all units, and the folder if nothing else is in it.
    pub fn clear(self) -> Result<()> {
        let context = || format!("cannot clear {}", self.folder.display());
        sweep(&self.folder)?;
        for entry in fs::read_dir(&self.folder).with_context(context)? {
            let path = entry.with_context(context)?.path();
            if path.extension().is_some_and(|e| e == UNIT || e == COST) {
                fs::remove_file(&path).with_context(context)?;
            }
        }
        match fs::remove_dir(&self.folder) {
            Err(e) if e.kind() != ErrorKind::DirectoryNotEmpty => Err(e).with_context(context),
            _ => Ok(()),
        }
    }

    /// What is in the file of the unit `name`. Reads and checks all of it.
    pub fn state(&self, name: &str) -> Result<State> {
        // A folder cannot be read, and a pipe would keep the reader waiting.
        if fs::metadata(self.path(name, UNIT)).is_ok_and(|m| !m.is_file()) {
            return Ok(State::Damaged);
        }
        if self.has(name)? {
            return Ok(State::Done);
        }
        let bytes = match fs::read(self.path(name, UNIT)) {
            Ok(bytes) => bytes,
            Err(e) if e.kind() == ErrorKind::NotFound => return Ok(State::Missing),
            Err(e) => return Err(e).with_context(|| format!("cannot read unit {name}")),
        };
        let ours = self.header(&[]);
        let foreign = bytes.get(..8) == ours.get(..8)
            && bytes.len() >= HEADER
            && bytes.get(8..12) != ours.get(8..12);
        Ok(match foreign {
            true => State::Missing,
            false => State::Damaged,
        })
    }

    /// Whether the unit `name` is there and valid.
    pub fn has(&self, name: &str) -> Result<bool> {
        Ok(self.load(name)?.is_some())
    }

    /// The checksum in the file of the unit `name`, if there is one that belongs to these settings. Only the header is
    /// read.
    pub fn checksum(&self, name: &str) -> Result<Option<u32>> {
        let mut start = [0; HEADER];
        let read = fs::File::open(self.path(name, UNIT)).and_then(|mut f| f.read_exact(&mut start));
        match read {
            Ok(()) => {}
            Err(e) if matches!(e.kind(), ErrorKind::NotFound | ErrorKind::UnexpectedEof) => {
                return Ok(None);
            }
            Err(e) => return Err(e).with_context(|| format!("cannot read unit {name}")),
        }
        let (settings, body) = start.split_at(HEADER - 4);
        let ours = settings == &self.header(&[])[..HEADER - 4];
        Ok(body
            .try_into()
            .ok()
            .filter(|_| ours)
            .map(u32::from_le_bytes))
    }

    /// The values of the unit `name` if it is there and valid.
    pub fn load(&self, name: &str) -> Result<Option<Vec<f32>>> {
        let bytes = self.read(name)?;
        Ok(bytes.and_then(|bytes| match bytes.as_chunks::<4>() {
            (words, []) => Some(words.iter().map(|w| f32::from_le_bytes(*w)).collect()),
            _ => None,
        }))
    }

    /// The body of the unit `name` if its file exists, belongs to these settings and is intact.
    fn read(&self, name: &str) -> Result<Option<Vec<u8>>> {
        let path = self.path(name, UNIT);
        let bytes = match fs::read(&path) {
            Ok(bytes) => bytes,
            Err(e) if e.kind() == ErrorKind::NotFound => return Ok(None),
            Err(e) => return Err(e).with_context(|| format!("cannot read {}", path.display())),
        };
        let header = self.header(&bytes[bytes.len().min(HEADER)..]);
        if bytes.len() < HEADER || bytes[..HEADER] != header {
            return Ok(None);
        }
        Ok(Some(bytes[HEADER..].to_vec()))
    }

    fn save(&self, name: &str, values: &[f32]) -> Result<()> {
        ensure!(
            values.iter().all(|v| v.is_finite()),
            "unit {name} holds a value that is not finite"
        );
        let body: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.write(name, &body)
    }

    fn write(&self, name: &str, body: &[u8]) -> Result<()> {
        Ok(replace_file(
            self.path(name, UNIT),
            &[&self.header(body), body].concat(),
        )?)
    }

    fn path(&self, name: &str, extension: &str) -> PathBuf {
        self.folder.join(format!("{name}.{extension}"))
    }

    /// Checksums of the settings and of the body.
    fn header(&self, body: &[u8]) -> [u8; HEADER] {
        let mut out = [0; HEADER];
        out[..8].copy_from_slice(b"welkunit");
        out[8..12].copy_from_slice(&crc32fast::hash(self.key.as_bytes()).to_le_bytes());
        out[12..].copy_from_slice(&crc32fast::hash(body).to_le_bytes());
        out
    }
}

const HEADER: usize = 16;
/// Extension of unit files.
const UNIT: &str = "unit";
/// Extension of the files that tell what units cost. It differs from run to run, so it is not in the unit files.
const COST: &str = "cost";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_survive_and_damage_is_noticed() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path(), "a").unwrap();
        assert_eq!(store.unit("x", || Ok(vec![1.0, 2.0])).unwrap(), [1.0, 2.0]);
        assert_eq!(
            store.unit("x", || panic!("computed twice")).unwrap(),
            [1.0, 2.0]
        );
        assert!(store.cost("x").unwrap() >= 0.0 && store.cost("y").is_none());
        let body: Vec<u8> = [1f32, 2.0].iter().flat_map(|v| v.to_le_bytes()).collect();
        let checksum = store.checksum("x").unwrap();
        assert_eq!(checksum, Some(crc32fast::hash(&body)));
        let other = Store::open(folder.path(), "b").unwrap();
        assert_eq!(other.checksum("x").unwrap(), None);
        assert!(!other.has("x").unwrap());
        assert_eq!(store.state("x").unwrap(), State::Done);
        assert_eq!(store.state("y").unwrap(), State::Missing);
        assert_eq!(other.state("x").unwrap(), State::Missing);
        let path = folder.path().join("x.unit");
        let whole = fs::read(&path).unwrap();
        for i in 0..whole.len() {
            fs::write(&path, &whole[..i]).unwrap();
            assert_eq!(store.state("x").unwrap(), State::Damaged, "{i} bytes");
        }
        // A flip in the checksum of the settings makes it a unit of others.
        for i in (0..8).chain(12..whole.len()) {
            let mut flipped = whole.clone();
            flipped[i] ^= 1 << (i % 8);
            fs::write(&path, &flipped).unwrap();
            assert_eq!(store.state("x").unwrap(), State::Damaged, "byte {i}");
        }
        assert_eq!(store.unit("x", || Ok(vec![1.0, 2.0])).unwrap(), [1.0, 2.0]);
        assert_eq!(store.state("x").unwrap(), State::Done, "done again");
        let mut bytes = fs::read(&path).unwrap();
        bytes[17] ^= 1;
        fs::write(&path, &bytes).unwrap();
        assert!(!store.has("x").unwrap());
        fs::write(&path, &bytes[..5]).unwrap();
        assert!(!store.has("x").unwrap());
        assert!(store.unit("y", || Ok(vec![f32::NAN])).is_err());
    }

    #[test]
    fn doubles_come_back_exactly_until_the_store_is_cleared() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path().join("parts");
        let store = Store::open(&folder, "a").unwrap();
        let values = vec![std::f64::consts::PI, -1e-300];
        assert_eq!(store.unit_f64("x", || Ok(values.clone())).unwrap(), values);
        let again = store.unit_f64("x", || panic!("computed twice"));
        assert_eq!(again.unwrap(), values);
        fs::write(folder.join("foreign"), "").unwrap();
        // Of a writer that was killed.
        let half = folder.join(".welkin-0badcafe-0.tmp");
        fs::write(&half, "ha").unwrap();
        store.clear().unwrap();
        assert!(folder.join("foreign").exists() && !folder.join("x.unit").exists());
        assert!(!half.exists());
        Store::open(&folder, "a").unwrap().clear().unwrap();
    }
}

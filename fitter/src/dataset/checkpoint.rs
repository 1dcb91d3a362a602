//! Results of work units on disk: written whole or not at all, found again after a kill.

use anyhow::{Context, Result, ensure};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

/// A folder of unit files. Every file carries the key of the settings that made it; others are not trusted.
#[derive(Clone, Debug)]
pub struct Store {
    folder: PathBuf,
    key: String,
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
        let values = compute()?;
        self.save(name, &values)?;
        Ok(values)
    }

    /// Whether the unit `name` is there and valid.
    pub fn has(&self, name: &str) -> Result<bool> {
        Ok(self.load(name)?.is_some())
    }

    /// The unit `name` if its file exists, belongs to these settings and is intact.
    fn load(&self, name: &str) -> Result<Option<Vec<f32>>> {
        let path = self.path(name);
        let bytes = match fs::read(&path) {
            Ok(bytes) => bytes,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Err(e) => return Err(e).with_context(|| format!("cannot read {}", path.display())),
        };
        let header = self.header(&bytes[bytes.len().min(HEADER)..]);
        if bytes.len() < HEADER
            || bytes[..HEADER] != header
            || !(bytes.len() - HEADER).is_multiple_of(4)
        {
            return Ok(None);
        }
        let words = bytes[HEADER..].chunks_exact(4);
        Ok(Some(
            words
                .map(|w| f32::from_le_bytes([w[0], w[1], w[2], w[3]]))
                .collect(),
        ))
    }

    fn save(&self, name: &str, values: &[f32]) -> Result<()> {
        ensure!(
            values.iter().all(|v| v.is_finite()),
            "unit {name} holds a value that is not finite"
        );
        let body: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        let mut file = tempfile::NamedTempFile::new_in(&self.folder)?;
        file.write_all(&self.header(&body))?;
        file.write_all(&body)?;
        file.as_file().sync_all()?;
        file.persist(self.path(name))
            .with_context(|| format!("cannot write unit {name}"))?;
        Ok(())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{name}.unit"))
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
        let other = Store::open(folder.path(), "b").unwrap();
        assert!(!other.has("x").unwrap());
        let path = folder.path().join("x.unit");
        let mut bytes = fs::read(&path).unwrap();
        bytes[17] ^= 1;
        fs::write(&path, &bytes).unwrap();
        assert!(!store.has("x").unwrap());
        fs::write(&path, &bytes[..5]).unwrap();
        assert!(!store.has("x").unwrap());
        assert!(store.unit("y", || Ok(vec![f32::NAN])).is_err());
    }
}

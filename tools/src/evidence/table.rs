//! Tables as CSV files that the page is filled from.

use std::path::PathBuf;

use welkin::output::replace_file;

use super::Result;

/// Where they stand.
pub fn folder() -> PathBuf {
    crate::book::root().join("docs/evidence")
}

/// Rows with a header and the command that makes them.
pub struct Table {
    command: &'static str,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// With the names of the columns.
    pub fn new(command: &'static str, header: &[impl AsRef<str>]) -> Self {
        let header = header.iter().map(|name| name.as_ref().to_owned()).collect();
        Self {
            command,
            rows: vec![header],
        }
    }

    /// Appends a row.
    pub fn push(&mut self, row: Vec<String>) {
        self.rows.push(row);
    }

    /// Says the same in all cells of the last row but its first.
    pub fn replace_last(&mut self, text: &str) {
        let cells = self.rows.last_mut().into_iter().flatten();
        cells.skip(1).for_each(|cell| *cell = text.to_owned());
    }

    /// As a CSV file of the page's folder.
    ///
    /// # Errors
    /// Where it cannot be written.
    pub fn write(&self, name: &str) -> Result<()> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        for row in &self.rows {
            writer.write_record(row)?;
        }
        let mut bytes = format!("# Printed by `{}`.\n", self.command).into_bytes();
        bytes.extend(writer.into_inner()?);
        write(name, &bytes)
    }
}

/// A file of the page's folder.
///
/// # Errors
/// Where it cannot be written.
pub fn write(name: &str, bytes: &[u8]) -> Result<()> {
    let path = folder().join(name);
    println!("{name}");
    Ok(replace_file(&path, bytes)?)
}

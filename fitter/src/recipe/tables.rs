//! The tables that a recipe names, read into it.

use super::error::{RecipeError, field};
use super::file::{Columns, File};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Largest table that is read, bytes: nothing that belongs here is as large.
const LARGEST: u64 = 16 << 20;

/// Puts the columns of all files that `file` names, relative to `folder`, in the place of their names.
pub fn read_all(file: &mut File, folder: Option<&Path>) -> Result<(), RecipeError> {
    for (place, columns) in all(file) {
        if let Columns::File(path) = columns {
            *columns = Columns::Inline(read(&place, path, folder)?);
        }
    }
    Ok(())
}

/// Every table of the recipe with the name of its field.
fn all(file: &mut File) -> Vec<(String, &mut Columns)> {
    let mut out = vec![];
    let mut add = |place: String, columns| out.extend(Option::map(columns, |c| (place, c)));
    add("gases.table".into(), file.gases.table.as_mut());
    for (name, layer) in &mut file.layers {
        add(format!("layers.{name}.profile"), layer.profile.as_mut());
        add(format!("layers.{name}.optics"), layer.optics.as_mut());
        add(format!("layers.{name}.phase"), layer.phase.as_mut());
    }
    add("ground.table".into(), file.ground.table.as_mut());
    add("sun.spectrum".into(), file.sun.spectrum.as_mut());
    out
}

fn read(
    place: &str,
    name: &Path,
    folder: Option<&Path>,
) -> Result<BTreeMap<String, Vec<f64>>, RecipeError> {
    let path = folder.map_or_else(|| PathBuf::from(name), |folder| folder.join(name));
    let unreadable = |why| RecipeError::Unreadable {
        path: path.clone(),
        why,
    };
    let size = std::fs::metadata(&path).map_err(unreadable)?.len();
    if size > LARGEST {
        return Err(field(place, format!("{} has {size} bytes", path.display())));
    }
    let text = std::fs::read_to_string(&path).map_err(unreadable)?;
    parse(&text).map_err(|what| field(place, format!("{}: {what}", path.display())))
}

/// Refuses what other programs separate columns by.
fn separator(names: &csv::StringRecord) -> Result<(), String> {
    let marks = [(';', "semicolons"), ('\t', "tabs"), ('|', "bars")];
    let used = |mark: &char| names.iter().any(|name| name.contains(*mark));
    match marks.iter().find(|(mark, _)| used(mark)) {
        Some((_, name)) => Err(format!(
            "it seems to be separated by {name}: commas are expected, and points in decimals"
        )),
        None => Ok(()),
    }
}

/// CSV with `#` comments and one line of names.
fn parse(text: &str) -> Result<BTreeMap<String, Vec<f64>>, String> {
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let names = reader.headers().map_err(|e| e.to_string())?.clone();
    separator(&names)?;
    let mut columns: Vec<Vec<f64>> = vec![vec![]; names.len()];
    for record in reader.records() {
        let record = record.map_err(|e| e.to_string())?;
        let line = record.position().map_or(0, |p| p.line());
        for (i, cell) in record.iter().enumerate() {
            let value = cell.parse();
            columns[i].push(value.map_err(|_| format!("line {line}: {cell:?} is no number"))?);
        }
    }
    let mut out = BTreeMap::new();
    for (name, column) in names.iter().zip(columns) {
        if out.insert(name.to_owned(), column).is_some() {
            return Err(format!("two columns are called {name:?}"));
        }
    }
    Ok(out)
}

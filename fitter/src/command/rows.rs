//! Rows of numbers in CSV, whose errors name row and column.

use anyhow::{Context, Result, ensure};
use std::io::Read;

/// All rows under the names, which the first line must have in this order. Spaces beside commas mean nothing.
///
/// # Errors
/// If there is no row, the names are others, or something is no number.
pub fn numbers<const N: usize>(input: impl Read, names: [&str; N]) -> Result<Vec<[f64; N]>> {
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .flexible(true)
        .from_reader(input);
    let header = reader.headers()?;
    ensure!(!header.is_empty(), "empty: expected {}", names.join(","));
    ensure!(
        header.iter().eq(names),
        "the first line must be {}",
        names.join(",")
    );
    let mut rows = vec![];
    for (i, record) in reader.records().enumerate() {
        let row = record.map_err(anyhow::Error::from);
        let row = row.and_then(|record| row_of(&record, &names));
        rows.push(row.with_context(|| format!("row {}", i + 1))?);
    }
    ensure!(!rows.is_empty(), "no row below the names of the columns");
    Ok(rows)
}

fn row_of<const N: usize>(record: &csv::StringRecord, names: &[&str; N]) -> Result<[f64; N]> {
    ensure!(record.len() == N, "{} columns, expected {N}", record.len());
    let mut row = [0.0; N];
    for ((number, name), field) in row.iter_mut().zip(names).zip(record) {
        let parsed = field.parse::<f64>();
        *number = parsed.with_context(|| format!("{name}: {field:?} is no number"))?;
    }
    Ok(row)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(text: &str) -> Result<Vec<[f64; 2]>> {
        numbers(text.as_bytes(), ["x", "distance"])
    }

    #[test]
    fn spaces_are_taken() {
        let found = rows("x, distance\n1, inf\n -2 ,3\n").unwrap();
        assert_eq!(found, [[1.0, f64::INFINITY], [-2.0, 3.0]]);
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (text, said) in [
            ("", "empty"),
            ("x,distance\n", "no row"),
            ("1,2\n3,4\n", "first line"),
            ("x,distance\n1,2\n1,far\n", "row 2: distance: \"far\""),
            ("x,distance\n1\n", "row 1: 1 columns"),
            ("x,distance\n1,2,3\n", "row 1: 3 columns"),
        ] {
            let error = format!("{:#}", rows(text).unwrap_err());
            assert!(error.contains(said), "{text:?}: {error}");
        }
    }
}

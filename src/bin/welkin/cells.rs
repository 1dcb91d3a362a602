//! Cells of tables that people write.

use csv::ByteRecord;
use welkin::output::printable;

/// A number, or what is wrong with it.
pub fn number(name: &str, cell: &[u8]) -> Result<f64, String> {
    let number = std::str::from_utf8(cell)
        .ok()
        .and_then(|text| text.parse().ok());
    number.ok_or_else(|| not_a_number(name, cell))
}

#[cold]
fn not_a_number(name: &str, cell: &[u8]) -> String {
    if cell.is_empty() {
        return format!("{name} is empty");
    }
    let text = printable(&String::from_utf8_lossy(cell));
    let pointed = text.replacen(',', ".", 1);
    let hint = match pointed != text && pointed.parse::<f64>().is_ok() {
        true => format!(": decimals are written with a point, {pointed}"),
        false => String::new(),
    };
    format!("{name} must be a number, got \"{text}\"{hint}")
}

/// The name of a column; some programs put a byte order mark before the first.
pub fn name(cell: &[u8]) -> &[u8] {
    let cell = cell.strip_prefix(b"\xef\xbb\xbf").unwrap_or(cell);
    cell.trim_ascii()
}

/// What may be wrong with a header of which a column is not found.
pub fn separator_hint(header: &ByteRecord) -> String {
    for (mark, name) in [(b';', "semicolons"), (b'\t', "tabs"), (b'|', "bars")] {
        if header.iter().any(|cell| cell.contains(&mark)) {
            return format!(
                ". It seems to be separated by {name}: commas are expected, and points in decimals"
            );
        }
    }
    String::new()
}

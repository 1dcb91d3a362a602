//! Pages of the book whose figures come from files that measuring commands wrote.
//!
//! What stands in a page between `<!-- figures: NAME -->` and `<!-- end -->` is made from the file NAME in
//! `docs/figures`: a CSV file becomes a table, with its first lines, the ones that start with `#`, below it; a Markdown
//! file is a template. There `{SOURCE/KEY/KEY FORMAT}` stands for one figure: the keys lead into `SOURCE.json`, by name
//! where there is a list, or to the row and the column of `SOURCE.csv`; a row is called by its first cell, or by its
//! first two with a comma between where several begin alike. Formats are `time` (of ns), `bytes`, `%` (of a
//! share) and `2` (two digits); without one the text stands as it is.

use std::error::Error;
use std::fs;
use std::path::Path;

use serde_json::{Map, Value};

/// What is wrong, for whoever wrote the page.
pub type Result<T> = std::result::Result<T, Box<dyn Error>>;

const START: &str = "<!-- figures: ";
const CLOSE: &str = " -->\n";
const END: &str = "<!-- end -->";

/// The page with all its figures from `folder`.
///
/// # Errors
/// For markers without an end, files that are not there and figures that are not in them.
pub fn filled(page: &str, folder: &Path) -> Result<String> {
    let mut out = String::new();
    let mut rest = page;
    while let Some((before, after)) = rest.split_once(START) {
        let (name, after) = after.split_once(CLOSE).ok_or("a marker does not close")?;
        let (_, after) = after
            .split_once(END)
            .ok_or_else(|| format!("{name}: no {END}"))?;
        let made = block(&folder.join(name)).map_err(|error| format!("{name}: {error}"))?;
        out += &format!("{before}{START}{name}{CLOSE}{made}{END}");
        rest = after;
    }
    Ok(out + rest)
}

fn block(path: &Path) -> Result<String> {
    let text = fs::read_to_string(path)?;
    match path.extension().and_then(|e| e.to_str()) {
        Some("csv") => table(&text),
        Some("md") => template(&text, path.parent().unwrap_or(Path::new(""))),
        _ => Err("neither .csv nor .md".into()),
    }
}

/// CSV as Markdown.
fn table(text: &str) -> Result<String> {
    let notes: Vec<&str> = text.lines().map_while(|l| l.strip_prefix("# ")).collect();
    let mut out = String::new();
    for (i, record) in rows(text)?.iter().enumerate() {
        out += &format!("| {} |\n", record.join(" | "));
        if i == 0 {
            out += &format!("|{}\n", " --- |".repeat(record.len()));
        }
    }
    if !notes.is_empty() {
        out += &format!("\n{}\n", notes.join("\n"));
    }
    Ok(out)
}

fn rows(text: &str) -> Result<Vec<Vec<String>>> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let records = reader
        .records()
        .map(|record| Ok(record?.iter().map(str::to_owned).collect()));
    records.collect()
}

fn template(text: &str, folder: &Path) -> Result<String> {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('{') {
        let (figure, after) = after.split_once('}').ok_or("a figure does not close")?;
        let made = figure_of(figure, folder).map_err(|error| format!("{{{figure}}}: {error}"))?;
        out += &format!("{before}{made}");
        rest = after;
    }
    Ok(out + rest)
}

fn figure_of(figure: &str, folder: &Path) -> Result<String> {
    let (path, format) = match figure.rsplit_once(' ') {
        Some((path, format @ ("time" | "bytes" | "%" | "2"))) => (path, format),
        _ => (figure, ""),
    };
    let mut keys = path.split('/');
    let mut value = source(&folder.join(keys.next().unwrap_or_default()))?;
    for key in keys {
        value = member(value, key).ok_or_else(|| format!("no {key}"))?;
    }
    let text = match value {
        Value::String(text) => text,
        Value::Number(number) => number.to_string(),
        _ => return Err("no figure".into()),
    };
    match format {
        "" => Ok(text),
        _ => Ok(formatted(text.parse()?, format)),
    }
}

/// `SOURCE.json` as it is, or `SOURCE.csv` as columns by name in rows by name.
fn source(path: &Path) -> Result<Value> {
    let json = path.with_extension("json");
    if json.exists() {
        return Ok(serde_json::from_str(&fs::read_to_string(json)?)?);
    }
    let rows = rows(&fs::read_to_string(path.with_extension("csv"))?)?;
    let (head, rows) = rows.split_first().ok_or("an empty file")?;
    let name = |cells: &Vec<String>| {
        let first = cells.first()?;
        let alike = rows.iter().filter(|row| row.first() == Some(first));
        Some(match alike.count() {
            1 => first.clone(),
            _ => cells.iter().take(2).cloned().collect::<Vec<_>>().join(", "),
        })
    };
    let row = |cells: &Vec<String>| {
        let columns = head
            .iter()
            .cloned()
            .zip(cells.iter().cloned().map(Value::from));
        Some((name(cells)?, columns.collect::<Map<_, _>>().into()))
    };
    Ok(rows.iter().filter_map(row).collect::<Map<_, _>>().into())
}

fn member(value: Value, key: &str) -> Option<Value> {
    match value {
        Value::Object(mut members) => members.remove(key),
        Value::Array(items) => items.into_iter().find(|item| item["name"] == key),
        _ => None,
    }
}

/// A number as pages print it; `format` is one of those above.
pub fn formatted(value: f64, format: &str) -> String {
    let scaled = |units: [&str; 4]| {
        let steps = units.iter().zip(0..);
        // Where rounding reaches the next unit, that one.
        let fits = |power: &i32| value < 995.0 * 1e3f64.powi(*power);
        let (unit, power) = steps
            .clone()
            .find(|(_, power)| fits(power))
            .unwrap_or((&units[3], 3));
        format!("{} {unit}", two_digits(value / 1e3f64.powi(power)))
    };
    match format {
        "time" => scaled(["ns", "µs", "ms", "s"]),
        "bytes" => scaled(["B", "kB", "MB", "GB"]),
        "%" => format!("{} %", two_digits(100.0 * value)),
        _ => two_digits(value),
    }
}

/// Two significant digits, without zeros at the end of a fraction.
fn two_digits(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let scale = 10f64.powi(1 - value.abs().log10().floor() as i32);
    // Scaled back by what is exact where it can be.
    let rounded = match scale >= 1.0 {
        true => (value * scale).round() / scale,
        false => (value * scale).round() * (1.0 / scale).round(),
    };
    rounded.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_two_digits_and_the_unit_that_suits_them() {
        for (value, format, text) in [
            (29.4, "time", "29 ns"),
            (680_115.0, "time", "680 µs"),
            (999.0, "time", "1 µs"),
            (2.3e10, "time", "23 s"),
            (5e13, "time", "50000 s"),
            (9_325_296.0, "bytes", "9.3 MB"),
            (0.001_386, "%", "0.14 %"),
            (0.0, "%", "0 %"),
            (3.466, "%", "350 %"),
            (0.000_3, "%", "0.03 %"),
            (110.4, "2", "110"),
            (6.55, "2", "6.6"),
        ] {
            assert_eq!(formatted(value, format), text);
        }
    }

    #[test]
    fn pages_are_filled_and_stay_as_they_are() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
        write("a.csv", "# From `this`.\nwhat,time\n\"one, two\",5\n");
        write(
            "b.json",
            r#"{"date": "today", "rows": [{"name": "x y", "ns": 12.5}]}"#,
        );
        write("c.md", "{b/rows/x y/ns time} {b/date} {a/one, two/time}\n");
        let page =
            "<!-- figures: a.csv -->\nold\n<!-- end -->\n\n<!-- figures: c.md -->\n<!-- end -->.\n";
        let expected = "<!-- figures: a.csv -->\n| what | time |\n| --- | --- |\n| one, two | 5 |\n\nFrom `this`.\n\
                        <!-- end -->\n\n<!-- figures: c.md -->\n13 ns today 5\n<!-- end -->.\n";
        let once = filled(page, folder.path()).unwrap();
        assert_eq!(once, expected);
        assert_eq!(filled(&once, folder.path()).unwrap(), expected);
    }

    #[test]
    fn rows_that_begin_alike_are_called_by_two_cells() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
        write("a.csv", "what,rank,error\nx,1,0.5\nx,2,0.25\ny,2,0.1\n");
        write("b.md", "{a/x, 1/error} {a/x, 2/error %} {a/y/error}\n");
        write("c.md", "{a/x/error}");
        let fill = |name| {
            filled(
                &format!("<!-- figures: {name} -->\n<!-- end -->"),
                folder.path(),
            )
        };
        assert!(fill("b.md").unwrap().contains("\n0.5 25 % 0.1\n"));
        assert!(fill("c.md").is_err());
    }

    #[test]
    fn what_is_missing_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
        write("a.csv", "what,time\nx,5\n");
        write("row.md", "{a/y/time}");
        write("open.md", "{a/x/time");
        write("text.md", "{a/x/what time}");
        write("source.md", "{b/x/time}");
        for name in [
            "none.csv",
            "row.md",
            "open.md",
            "text.md",
            "source.md",
            "a.txt",
        ] {
            let page = format!("<!-- figures: {name} -->\n<!-- end -->");
            assert!(filled(&page, folder.path()).is_err(), "{name}");
        }
        assert!(filled("<!-- figures: a.csv -->\n", folder.path()).is_err());
        assert!(filled("<!-- figures: a.csv", folder.path()).is_err());
    }
}

//! Parts of the README that tests write and compare.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

fn path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md")
}

pub fn is_blessed() -> bool {
    std::env::var_os("WELKIN_BLESS").is_some_and(|v| v == "1")
}

/// Compares with the file, or writes it with `WELKIN_BLESS=1`.
pub fn compare(path: &Path, text: &str) {
    if is_blessed() {
        let temporary = path.with_extension("new");
        std::fs::write(&temporary, text).unwrap();
        return std::fs::rename(&temporary, path).unwrap();
    }
    let known = std::fs::read_to_string(path).unwrap_or_default();
    assert!(
        known == text,
        "{} is out of date: WELKIN_BLESS=1 cargo test",
        path.display()
    );
}

/// The first block of code in a language.
pub fn block(language: &str) -> String {
    let readme = std::fs::read_to_string(path()).unwrap();
    let (_, rest) = readme
        .split_once(&format!("```{language}\n"))
        .expect("a block of code");
    rest.split_once("```").expect("its end").0.to_string()
}

/// Compares what stands at a place, or writes it.
pub fn fill(place: &str, text: &str) {
    // Tests of one file run at once.
    static WRITING: Mutex<()> = Mutex::new(());
    let _writing = WRITING.lock();
    let readme = std::fs::read_to_string(path()).unwrap();
    let (before, rest) = readme
        .split_once(&format!("<!-- {place} -->\n"))
        .expect("a place");
    let (_, after) = rest.split_once("<!-- end -->").expect("its end");
    compare(
        &path(),
        &format!("{before}<!-- {place} -->\n{text}<!-- end -->{after}"),
    );
}

/// Writes a row of the errors, which are those of a device and so not compared.
pub fn record(row: [String; 3]) {
    insert("errors", ["what", "%", "of"], row);
}

/// Writes a row of a table that a machine fills, in place of that of the same name.
pub fn insert(place: &str, heads: [&str; 3], row: [String; 3]) {
    let readme = std::fs::read_to_string(path()).unwrap();
    let (_, rest) = readme
        .split_once(&format!("<!-- {place} -->\n"))
        .expect("a place");
    let known = rest.split_once("<!-- end -->").expect("its end").0;
    let rows = known.lines().skip(2).map(|line| {
        let mut cells = line.split('|').skip(1).map(|cell| cell.trim().to_string());
        std::array::from_fn(|_| cells.next().unwrap_or_default())
    });
    let mut rows: Vec<[String; 3]> = rows
        .filter(|known: &[String; 3]| known[0] != row[0])
        .collect();
    rows.push(row);
    rows.sort();
    fill(place, &table(&heads, &rows));
}

pub fn table<const N: usize>(heads: &[&str; N], rows: &[[String; N]]) -> String {
    let mut out = format!("| {} |\n|{}\n", heads.join(" | "), " --- |".repeat(N));
    for row in rows {
        writeln!(out, "| {} |", row.join(" | ")).unwrap();
    }
    out
}

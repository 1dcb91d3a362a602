//! What README.md and the book promise: figures that were measured, lines that fit, links that lead somewhere.

use std::fs;

use welkin_tools::{book, figures};

fn pages() -> Vec<(String, String)> {
    let page = |path: std::path::PathBuf| {
        let text = fs::read_to_string(&path).unwrap();
        (path.display().to_string(), text)
    };
    book::pages().unwrap().into_iter().map(page).collect()
}

#[test]
fn pages_hold_what_was_measured() {
    for (name, page) in pages() {
        let filled = figures::filled(&page, &book::figures()).unwrap();
        assert!(
            page == filled,
            "{name} is not what `cargo run -p welkin-tools --bin figures` makes of it"
        );
    }
}

/// Whether a cell of a table looks measured: a number with a unit of time, of memory, or in percent.
fn measured(cell: &str) -> bool {
    let mut words = cell.split_whitespace().peekable();
    let number = |word: &str| word.parse::<f64>().is_ok();
    let unit = |word: &str| ["ns", "µs", "ms", "s", "%", "B", "kB", "MB", "GB"].contains(&word);
    while let Some(word) = words.next() {
        if number(word) && words.peek().is_some_and(|next| unit(next)) {
            return true;
        }
    }
    false
}

#[test]
fn no_table_of_figures_is_typed() {
    for (name, page) in pages() {
        let mut generated = false;
        for line in page.lines() {
            generated = (generated || line.starts_with("<!-- figures: ")) && line != "<!-- end -->";
            let typed = !generated && line.starts_with('|') && line.split('|').any(measured);
            assert!(!typed, "{name}: {line}");
        }
    }
    assert!(measured("12 wavelengths, 3.5 µs") && !measured("12 wavelengths"));
}

#[test]
fn the_first_page_is_short() {
    let (_, readme) = pages()
        .into_iter()
        .find(|(name, _)| name.ends_with("README.md") && !name.contains("docs"))
        .unwrap();
    assert!(readme.lines().count() <= 120);
}

#[test]
fn lines_end_at_120() {
    for (name, page) in pages() {
        for line in page.lines() {
            assert!(line.chars().count() <= 120, "{name}: {line}");
        }
    }
}

/// The readers' own tests run what their READMEs show.
#[test]
fn examples_in_c_and_python_are_those_of_the_readers() {
    let readers = concat!(env!("CARGO_MANIFEST_DIR"), "/../format-spec/readers");
    let mut lines = 0;
    for (language, folder) in [("c", "c"), ("python", "python")] {
        let tested = fs::read_to_string(format!("{readers}/{folder}/README.md")).unwrap();
        for (name, page) in pages() {
            for block in page.split(&format!("```{language}\n")).skip(1) {
                for line in block.split("```").next().unwrap().lines() {
                    assert!(tested.contains(line), "{name}: {line}");
                    lines += 1;
                }
            }
        }
    }
    assert!(lines > 20);
}

#[test]
fn links_lead_somewhere() {
    for path in book::pages().unwrap() {
        let page = fs::read_to_string(&path).unwrap();
        for link in page.split("](").skip(1) {
            let target = link.split([')', '#']).next().unwrap();
            if !target.is_empty() && !target.contains("://") {
                let there = path.parent().unwrap().join(target).exists();
                assert!(there, "{}: {target}", path.display());
            }
        }
    }
}

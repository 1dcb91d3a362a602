//! What the pages promise: figures that were measured, lines that fit, links and paths that lead somewhere.

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
    let readme = fs::read_to_string(book::root().join("README.md")).unwrap();
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
        let mut tested = fs::read_to_string(format!("{readers}/{folder}/README.md")).unwrap();
        if language == "python" {
            let package = concat!(env!("CARGO_MANIFEST_DIR"), "/../python/README.md");
            tested += &fs::read_to_string(package).unwrap();
        }
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

/// The anchors that GitHub gives the headings of a page.
fn anchors(page: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let mut code = false;
    for line in page.lines() {
        code ^= line.starts_with("```");
        let heading = line.trim_start_matches('#');
        if code || heading == line || !heading.starts_with(' ') {
            continue;
        }
        let kept = |c: &char| c.is_alphanumeric() || [' ', '-', '_'].contains(c);
        let lower = heading.trim().to_lowercase();
        let slug: String = lower.chars().filter(kept).collect();
        let slug = slug.replace(' ', "-");
        let again = |n: usize| match n {
            0 => slug.clone(),
            n => format!("{slug}-{n}"),
        };
        found.extend((0..).map(again).find(|slug| !found.contains(slug)));
    }
    found
}

#[test]
fn links_lead_somewhere() {
    let mut with_anchors = 0;
    for path in book::pages().unwrap() {
        let page = fs::read_to_string(&path).unwrap();
        for link in page.split("](").skip(1) {
            let link = link.split(')').next().unwrap();
            if link.contains("://") {
                continue;
            }
            let (target, anchor) = link.split_once('#').unwrap_or((link, ""));
            let to = match target {
                "" => path.clone(),
                _ => path.parent().unwrap().join(target),
            };
            assert!(to.exists(), "{}: {link}", path.display());
            if !anchor.is_empty() {
                let there = anchors(&fs::read_to_string(&to).unwrap());
                let led = there.iter().any(|a| a == anchor);
                assert!(led, "{}: {link} is none of {there:?}", path.display());
                with_anchors += 1;
            }
        }
    }
    assert!(with_anchors > 3);
    let page = "# A `b`: c, d_e\n```sh\n# no\n```\n## What, then?\n## What, then?\n#no\n";
    assert_eq!(anchors(page), ["a-b-c-d_e", "what-then", "what-then-1"]);
}

/// Words in code that have the form of a path in this project.
fn paths(page: &str) -> impl Iterator<Item = &str> {
    let code = page.split('`').skip(1).step_by(2);
    let file = |word: &str| {
        let (_, extension) = word.rsplit_once('.').unwrap_or_default();
        ["rs", "md", "toml", "yml", "csv", "py", "c"].contains(&extension)
    };
    let own = |c: char| c.is_ascii_alphanumeric() || "_-./".contains(c);
    code.flat_map(str::split_whitespace)
        .filter(move |word| (word.contains('/') || file(word)) && word.chars().all(own))
}

#[test]
fn paths_in_code_exist() {
    let mut checked = 0;
    for name in ["DESIGN.md", "CONTRIBUTING.md"] {
        let page = fs::read_to_string(book::root().join(name)).unwrap();
        for path in paths(&page) {
            assert!(book::root().join(path).exists(), "{name}: {path}");
            checked += 1;
        }
    }
    assert!(checked > 50);
    let page = "`a/b` and `run c.rs d --e f/{g}` or/not `1.5`";
    assert_eq!(paths(page).collect::<Vec<_>>(), ["a/b", "c.rs"]);
}

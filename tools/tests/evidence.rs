//! The page of evidence: what stands there is what was measured, and its pictures exist.

use std::fs;

use welkin_tools::evidence::table::folder;
use welkin_tools::figures;

fn page() -> String {
    fs::read_to_string(folder().join("README.md")).unwrap()
}

#[test]
fn it_holds_what_was_measured() {
    let page = page();
    let filled = figures::filled(&page, &folder()).unwrap();
    assert!(
        page == filled,
        "not what `cargo run --release -p welkin-tools --bin evidence -- page` makes of it"
    );
    assert!(page.matches("<!-- figures: ").count() > 8);
}

#[test]
fn lines_end_at_120_and_links_lead_somewhere() {
    let page = page();
    for line in page.lines() {
        assert!(line.chars().count() <= 120, "{line}");
    }
    let mut links = 0;
    for link in page.split("](").skip(1) {
        let link = link.split([')', '#']).next().unwrap();
        if !link.is_empty() && !link.contains("://") {
            assert!(folder().join(link).exists(), "{link}");
            links += 1;
        }
    }
    assert!(links > 10);
}

/// Tables outside the marks would be typed.
#[test]
fn no_table_is_typed() {
    let mut generated = false;
    for line in page().lines() {
        generated = (generated || line.starts_with("<!-- figures: ")) && line != "<!-- end -->";
        let picture =
            line.contains("![") || line.starts_with("| ---") || line.starts_with("| model | sun");
        assert!(generated || picture || !line.starts_with('|'), "{line}");
    }
}

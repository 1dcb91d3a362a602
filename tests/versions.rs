//! The table of versions in CHANGELOG.md and README.md say what the sources say.

/// What stands between `before` and the next `after`.
fn between<'a>(text: &'a str, before: &str, after: &str) -> &'a str {
    let (_, rest) = text.split_once(before).expect(before);
    rest.split_once(after).expect(after).0
}

/// Parts and their versions, as the changelog has them.
fn listed() -> Vec<(String, String)> {
    let changelog = include_str!("../CHANGELOG.md");
    let rows = changelog.lines().filter_map(|line| {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let [_, part, version, _] = cells[..] else {
            return None;
        };
        let is_version = version.starts_with(|c: char| c.is_ascii_digit());
        is_version.then(|| (part.to_owned(), version.to_owned()))
    });
    rows.collect()
}

#[test]
fn the_changelog_lists_the_versions_of_all_parts() {
    let manifest = include_str!("../Cargo.toml");
    let fitter = include_str!("../fitter/Cargo.toml");
    let specification = include_str!("../format-spec/SPEC.md");
    let c = include_str!("../format-spec/readers/c/welkin.h");
    let project = include_str!("../format-spec/readers/python/pyproject.toml");
    let module = include_str!("../format-spec/readers/python/src/welkin_reader/__init__.py");
    let package = include_str!("../python/Cargo.toml");
    assert!(fitter.contains("\nversion.workspace = true\n"));

    let parts = [
        (
            "library and command (crate `welkin`), fitter",
            env!("CARGO_PKG_VERSION"),
        ),
        (
            "file format",
            between(specification, "Status: version ", ". "),
        ),
        (
            "reader in C (`welkin.h`)",
            between(c, "#define WELKIN_READER_VERSION \"", "\""),
        ),
        (
            "reader in Python (distribution `welkin-reader`)",
            between(module, "__version__ = \"", "\""),
        ),
        (
            "package for Python (distribution `welkin-sky`)",
            between(package, "\nversion = \"", "\""),
        ),
        (
            "least Rust, library and command",
            between(manifest, "\nrust-version = \"", "\""),
        ),
        (
            "least Rust, fitter",
            between(fitter, "\nrust-version = \"", "\""),
        ),
        (
            "least Python",
            between(project, "\nrequires-python = \">=", "\""),
        ),
    ];
    let parts = parts.map(|(part, version)| (part.to_owned(), version.to_owned()));
    assert_eq!(listed(), parts);
}

#[test]
fn the_first_page_says_which_rust_it_needs() {
    let readme = include_str!("../README.md");
    let manifest = include_str!("../Cargo.toml");
    let fitter = include_str!("../fitter/Cargo.toml");
    let least = |manifest| between(manifest, "\nrust-version = \"", "\"");
    assert_eq!(
        between(readme, "The first needs Rust ", " "),
        least(manifest)
    );
    assert_eq!(
        between(readme, "with those of the fitter, ", ";"),
        least(fitter)
    );
}

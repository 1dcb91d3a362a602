//! Where the pages are: README.md, the book, and what tells how welkin is made.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The folder of the workspace.
pub fn root() -> &'static Path {
    let tools = Path::new(env!("CARGO_MANIFEST_DIR"));
    tools.parent().expect("a workspace around the tools")
}

/// README.md, DESIGN.md, CONTRIBUTING.md, CHANGELOG.md and the pages of the book.
///
/// # Errors
/// Where the folder cannot be read.
pub fn pages() -> io::Result<Vec<PathBuf>> {
    let first = ["README.md", "DESIGN.md", "CONTRIBUTING.md", "CHANGELOG.md"];
    let mut pages = Vec::from(first.map(|name| root().join(name)));
    for entry in fs::read_dir(root().join("docs"))? {
        let path = entry?.path();
        if path.extension().is_some_and(|e| e == "md") {
            pages.push(path);
        }
    }
    pages.sort();
    Ok(pages)
}

/// The folder of what was measured.
pub fn figures() -> PathBuf {
    root().join("docs/figures")
}

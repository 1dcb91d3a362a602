//! Writes the figures in `docs/figures` into README.md, DESIGN.md and the book: `cargo run -p welkin-tools --bin
//! figures`.
//!
//! `bash docs/figures/measure` measures them first. `welkin_tools::figures` says how a page asks for them.

use std::fs;

use welkin_tools::{book, figures};

fn main() -> figures::Result<()> {
    for path in book::pages()? {
        let page = fs::read_to_string(&path)?;
        let filled = figures::filled(&page, &book::figures())
            .map_err(|error| format!("{}: {error}", path.display()))?;
        if filled != page {
            fs::write(&path, filled)?;
            println!("{}", path.display());
        }
    }
    Ok(())
}

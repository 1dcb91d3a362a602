//! Progress bars of long jobs, on standard error.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, Write};

/// A bar of `length` steps with the time that is left.
pub fn bar(length: usize, what: &str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg:<28} {wide_bar} {pos}/{len} {eta}");
    let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length as u64)
        .with_style(style)
        .with_message(what.to_owned())
}

/// A bar that is drawn at once; where nobody sees bars, a line that says what begins.
pub fn stage(length: usize, what: &str) -> ProgressBar {
    let mut stderr = std::io::stderr();
    if !stderr.is_terminal() {
        // Nobody is left to tell when standard error is closed.
        let _ = writeln!(stderr, "{what}");
    }
    let bar = bar(length, what);
    bar.tick();
    bar
}

/// What `work` makes, as a stage of one step.
pub fn whole<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let bar = stage(1, what);
    let out = work();
    bar.inc(1);
    bar.finish();
    out
}

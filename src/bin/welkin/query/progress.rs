//! How far a long table has got, for whoever waits.

use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

/// Says nothing before, and not more often.
const PAUSE: Duration = Duration::from_secs(1);

/// A line on standard error, where that is a terminal and the rows go elsewhere.
pub struct Progress {
    start: Instant,
    last: Option<Instant>,
    shown: bool,
}

impl Progress {
    pub fn new() -> Self {
        Self {
            start: Instant::now(),
            last: None,
            shown: io::stderr().is_terminal() && !io::stdout().is_terminal(),
        }
    }

    pub fn rows(&mut self, rows: u64) {
        if self.shown && self.last.unwrap_or(self.start).elapsed() >= PAUSE {
            self.last = Some(Instant::now());
            let rate = rows as f64 / self.start.elapsed().as_secs_f64();
            // Nobody is left to tell when standard error is closed.
            let _ = write!(io::stderr(), "\r\x1b[K{rows} rows, {rate:.0} rows/s");
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if self.last.is_some() {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
    }
}

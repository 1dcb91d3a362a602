//! Work on rows of arrays: without the interpreter's lock, on several threads, interruptible.

use std::time::{Duration, Instant};

use pyo3::prelude::*;
use rayon::prelude::*;
use welkin::Result;

use crate::errors::raise;
use crate::threads::{Threads, pool};

/// Most rows of a block, which one thread works on at a time.
pub const MOST_ROWS: usize = 512;

/// Blocks between two looks at whether the user wants to stop; more as long as they take less than [`PATIENCE`].
const FIRST_BLOCKS: usize = 64;
const PATIENCE: Duration = Duration::from_millis(50);

/// Rows of a block where there are so many in all: enough blocks for all threads, long enough to be worth it.
pub fn block_rows(rows: usize) -> usize {
    (rows / 64).clamp(8, MOST_ROWS)
}

/// Calls `work` with all blocks, which `number` counts. The first error in their order is raised.
pub fn run<B: Send>(
    py: Python<'_>,
    threads: Option<Threads>,
    blocks: impl IntoIterator<Item = B>,
    work: impl Fn(usize, B) -> Result<()> + Sync,
) -> PyResult<()> {
    let pool = pool(py, threads)?;
    let mut blocks = blocks.into_iter().enumerate();
    let mut count = FIRST_BLOCKS;
    loop {
        let some: Vec<_> = blocks.by_ref().take(count).collect();
        if some.is_empty() {
            return Ok(());
        }
        let start = Instant::now();
        let done = py.detach(|| match &pool {
            Some(pool) if some.len() > 1 => pool.install(|| together(some, &work)),
            _ => some.into_iter().try_for_each(|(i, block)| work(i, block)),
        });
        done.map_err(|error| raise(py, error))?;
        py.check_signals()?;
        if start.elapsed() < PATIENCE {
            count *= 2;
        }
    }
}

fn together<B: Send>(
    blocks: Vec<(usize, B)>,
    work: &(impl Fn(usize, B) -> Result<()> + Sync),
) -> Result<()> {
    let results = blocks.into_par_iter().map(|(i, block)| work(i, block));
    let first = results.filter_map(Result::err).find_first(|_| true);
    first.map_or(Ok(()), Err)
}

/// Runs what cannot be divided without the interpreter's lock.
pub fn alone<T: Send>(py: Python<'_>, work: impl FnOnce() -> Result<T> + Send) -> PyResult<T> {
    py.detach(work).map_err(|error| raise(py, error))
}

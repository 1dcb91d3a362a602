//! The threads that rows are shared among.

use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::errors::refuse;

/// More would not help any machine, and the system may refuse them.
const MOST: usize = 256;

/// How many threads a caller wants: a whole number in 1..=256.
#[derive(Clone, Copy)]
pub struct Threads(usize);

impl<'py> FromPyObject<'_, 'py> for Threads {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let py = value.py();
        let index = py.import("operator")?.call_method1("index", (value,));
        let index = index.map_err(|_| {
            let got = value
                .repr()
                .map_or_else(|_| "something else".into(), |r| r.to_string());
            PyTypeError::new_err(format!("threads must be None or a whole number, got {got}"))
        })?;
        match index.extract() {
            Ok(count @ 1..=MOST) => Ok(Self(count)),
            _ => {
                let message = format!("threads must be in 1..={MOST}, got {index}");
                Err(refuse(py, "value", &message))
            }
        }
    }
}

/// By process and wish: threads do not survive a fork, so that a child needs pools of its own.
type Pools = HashMap<(u32, usize), Arc<ThreadPool>>;

static POOLS: LazyLock<Mutex<Pools>> = LazyLock::new(Mutex::default);

/// The pool for a wish of the caller: `None` is what `RAYON_NUM_THREADS` says, otherwise all cores; one thread is the
/// caller's own, for which there is no pool.
///
/// Asked with the interpreter's lock held, so that no fork finds the pools locked.
pub fn pool(py: Python<'_>, wish: Option<Threads>) -> PyResult<Option<Arc<ThreadPool>>> {
    let count = match wish {
        Some(Threads(1)) => return Ok(None),
        Some(Threads(count)) => count,
        None => 0,
    };
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    let key = (std::process::id(), count);
    if let Some(pool) = pools.get(&key) {
        return Ok(several(pool));
    }
    let made = ThreadPoolBuilder::new().num_threads(count).build();
    let made = made.map_err(|e| refuse(py, "limit", &format!("no threads: {e}")))?;
    let pool = pools.entry(key).or_insert(Arc::new(made));
    Ok(several(pool))
}

fn several(pool: &Arc<ThreadPool>) -> Option<Arc<ThreadPool>> {
    (pool.current_num_threads() > 1).then(|| Arc::clone(pool))
}

/// Runs what would otherwise share itself among all cores on a thread of its own.
pub fn single<T: Send>(work: impl FnOnce() -> welkin::Result<T> + Send) -> welkin::Result<T> {
    match ThreadPoolBuilder::new().num_threads(1).build() {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    }
}

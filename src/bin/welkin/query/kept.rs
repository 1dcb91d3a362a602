//! What one row prepared and the next may need.

use welkin::Result;

/// Something prepared, and what for.
pub type Kept<T, K = [u64; 4]> = Option<(K, T)>;

/// What was prepared last if it was for the same, or else prepared now.
pub fn kept<K: PartialEq, T>(
    last: &mut Option<(K, T)>,
    key: K,
    prepare: impl FnOnce() -> Result<T>,
) -> Result<&T> {
    match last {
        Some((for_what, _)) if *for_what == key => {}
        _ => *last = Some((key, prepare()?)),
    }
    match last {
        Some((_, prepared)) => Ok(prepared),
        None => unreachable!("it was prepared just now"),
    }
}

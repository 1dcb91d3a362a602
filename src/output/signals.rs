//! What happens when somebody ends the process.

use std::io;

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use signal_hook::low_level::emulate_default_handler;

use super::temporary::abandon;

/// From now on SIGINT, SIGTERM and SIGHUP first remove the temporary files of unfinished writes, then end the process
/// as they would have without. Those that the process was started to ignore stay ignored. For the start of `main`.
///
/// # Errors
/// Those of the system; then nothing has changed, and the next write of the same target cleans up.
pub fn abandon_on_signals() -> io::Result<()> {
    let signals = [SIGHUP, SIGINT, SIGTERM].into_iter();
    let mut signals = Signals::new(signals.filter(|&signal| !is_ignored(signal)))?;
    std::thread::spawn(move || {
        for signal in signals.forever() {
            abandon();
            // Only an unknown signal is an error.
            let _ = emulate_default_handler(signal);
        }
    });
    Ok(())
}

fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    match mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()) {
        Some(mask) => (mask >> (signal - 1)) & 1 == 1,
        // Where it cannot be asked: as under `nohup`.
        None => signal == SIGHUP,
    }
}

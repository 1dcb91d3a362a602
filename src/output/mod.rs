//! Writes files whole or not at all.
//!
//! What a regular file, or nothing, is at gets replaced in one step: the bytes go to a temporary file in the same
//! folder, which is renamed when they are on disk. Symbolic links are followed, so that they stay and what they point
//! to is replaced or created. A replaced file keeps its mode and, as far as the system lets this process give files
//! away, its owner and group; if it does not, the set-user-ID and set-group-ID bits go. Other hard links to it keep the
//! old bytes.
//!
//! What is neither a regular file nor a folder (FIFOs, devices, sockets, and descriptors such as `/dev/stdout`) is
//! written straight to.
//!
//! Temporary files are named `.welkin-HASH-N.tmp`, `HASH` being that of the target's name, and locked as long as their
//! writer lives. One that a killed process has left behind is removed by the next write of the same target, or by
//! [`sweep`]. With the feature `signals`, `abandon_on_signals` leaves none behind where a process is asked to end.

mod path_kind;
mod printable;
mod replace;
#[cfg(all(unix, feature = "signals"))]
mod signals;
mod target;
mod temporary;

pub use printable::{printable, printable_json};
pub use replace::{check, replace_file, replace_files};
#[cfg(all(unix, feature = "signals"))]
pub use signals::abandon_on_signals;
pub use target::{Target, write};
pub use temporary::{abandon, sweep};

//! Reading from a slow place only what a scene needs: here a file that counts what is asked of it.
//!
//! A web server that answers range requests is one more implementation of `ReadAt`: `tools/src/http_file.rs`.
//!
//! `cargo run --release --example 09_streaming`

use std::io;

use welkin::{Conditions, DEFAULT_MODEL, Model, ReadAt, Result};

struct SlowDisk;

impl ReadAt for SlowDisk {
    fn read_at(&self, offset: u64, buffer: &mut [u8]) -> io::Result<usize> {
        println!("  {} bytes from {offset}", buffer.len());
        DEFAULT_MODEL.read_at(offset, buffer)
    }
}

fn main() -> Result<()> {
    println!("open:");
    let model = Model::stream(SlowDisk)?;
    for (name, altitude, visibility) in [
        ("on the ground, visibility at a node", 0.0, 59.4e3),
        ("the same again", 0.0, 59.4e3),
        ("at 1234 m, visibility between nodes", 1234.0, 50e3),
    ] {
        println!("{name}:");
        model.sky(&Conditions {
            altitude,
            visibility,
            ..Conditions::default()
        })?;
    }
    let traffic = model.traffic();
    println!(
        "{} requests, {} of {} bytes",
        traffic.requests,
        traffic.bytes,
        model.file_bytes()
    );
    Ok(())
}

//! What scenes cost over a network: serves the default model on the loopback and counts requests and bytes, as CSV.
//!
//! `cargo run --release -p welkin-tools --bin stream`

#[path = "../../../tests/common/server.rs"]
#[allow(dead_code, reason = "tests need more of it")]
mod server;

use std::time::Duration;

use server::Server;
use welkin::{Conditions, DEFAULT_MODEL, Model, Result, Traffic};
use welkin_tools::http_file::HttpFile;

fn main() -> Result<()> {
    let server = Server::start(DEFAULT_MODEL.to_vec());
    let file = || HttpFile::new(server.url(), Duration::from_secs(10));
    let scenes = [
        ("on the ground at a node of visibility", 0.0, 59.4e3),
        ("on the ground between two", 0.0, 50e3),
        ("between all nodes", 1234.0, 50e3),
    ];
    println!("scene,requests to open,bytes to open,requests,bytes");
    for (name, altitude, visibility) in scenes {
        let model = Model::stream(file())?;
        let head = model.traffic();
        model.sky(&Conditions {
            altitude,
            visibility,
            ..Conditions::default()
        })?;
        tell(name, &model, head);
    }
    let model = Model::stream(file())?;
    let head = model.traffic();
    model.aerial_perspective(&Conditions {
        visibility: 50e3,
        ..Conditions::default()
    })?;
    tell("aerial perspective", &model, head);
    Ok(())
}

fn tell(name: &str, model: &Model, head: Traffic) {
    let total = model.traffic();
    println!(
        "{name},{},{},{},{}",
        head.requests,
        head.bytes,
        total.requests - head.requests,
        total.bytes - head.bytes
    );
}

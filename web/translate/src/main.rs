//! A fragment shader in the GLSL of Vulkan on standard input becomes WGSL on standard output.

use std::error::Error;
use std::io::{Read, Write};

use naga::ShaderStage;
use naga::back::wgsl::{WriterFlags, write_string};
use naga::front::glsl::{Frontend, Options};
use naga::valid::{Capabilities, ValidationFlags, Validator};

fn main() -> Result<(), Box<dyn Error>> {
    let mut source = String::new();
    std::io::stdin().read_to_string(&mut source)?;
    let shader = translated(&source)?;
    std::io::stdout().write_all(shader.as_bytes())?;
    Ok(())
}

/// Without the indentation, which a browser does not need.
fn translated(source: &str) -> Result<String, Box<dyn Error>> {
    let options = Options::from(ShaderStage::Fragment);
    let module = Frontend::default()
        .parse(&options, source)
        .map_err(|error| error.emit_to_string(source))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::default())
        .validate(&module)
        .map_err(|error| error.emit_to_string(source))?;
    let shader = write_string(&module, &info, WriterFlags::empty())?;
    Ok(shader
        .lines()
        .map(|line| format!("{}\n", line.trim()))
        .collect())
}
